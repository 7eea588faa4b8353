//! The diagnosis as a tank engineer reads it: verdict first, then cause, gain and next run.

use std::fmt::Write;

use super::diagnosis_json::{CUT_SHORT, log10, where_it_lives, word};
use crate::diagnosis::{Cause, Change, Diagnosis, Verdict};
use crate::model::effects::UNTESTABLE;

/// Effects told of the ranking.
const RANKED: usize = 6;

/// The sentences.
pub fn diagnosis_text(diagnosis: Option<&Diagnosis>) -> String {
    let mut text = String::new();
    let Some(diagnosis) = diagnosis else { return "no run could be diagnosed\n".to_owned() };
    // Writing to a string cannot fail.
    let _ = tell(&mut text, diagnosis);
    text
}

fn tell(text: &mut String, diagnosis: &Diagnosis) -> std::fmt::Result {
    let verdict = diagnosis.verdict;
    writeln!(text, "{}: {}", word(verdict).to_uppercase(), meaning(verdict))?;
    for one in &diagnosis.causes {
        cause(text, one)?;
    }
    if !diagnosis.suspects.is_empty() {
        writeln!(
            text,
            "\n  explains a part, but not the whole: {}",
            diagnosis.suspects.join(", ")
        )?;
    }
    if diagnosis.cut_short {
        writeln!(text, "\n  {CUT_SHORT}")?;
    }
    writeln!(text, "\nleft: {}", where_it_lives(&diagnosis.left_after))?;
    match &diagnosis.gain {
        Some(gain) if !diagnosis.causes.is_empty() => {
            writeln!(text, "\ngain on runs held out, mean over runs    before      after")?;
            line(text, "roll error [deg]", &gain.rmse_deg)?;
            line(text, "log predictive density a sample", &gain.log_density)?;
            line(text, "unexplained share", &gain.unexplained_share)?;
        }
        None => writeln!(text, "\nwith a single run nothing can be held out to measure a gain")?,
        Some(_) => {}
    }
    if !diagnosis.causes.is_empty() {
        writeln!(text, "\ndamping                                  before      after")?;
        for bias in &diagnosis.bias {
            line(text, &format!("b0 [1/s], {}", bias.condition), &bias.b1_per_s)?;
            line(text, "b3 [s]", &bias.b3_s)?;
            if let Some(kappa) = &bias.kappa {
                line(text, "kappa [-]", kappa)?;
            }
        }
    }
    if let Some(next) = &diagnosis.next_run {
        writeln!(text, "\nnext run: {}", next.why)?;
    }
    writeln!(text, "\nlog10 Bayes factors against the simulation as it was:")?;
    for (effect, log) in diagnosis.ranking.iter().take(RANKED) {
        writeln!(text, "  {:9.1}  {effect}", log10(*log))?;
    }
    let untestable: Vec<&str> = UNTESTABLE.iter().map(|(effect, _)| *effect).collect();
    writeln!(text, "\nno roll test can say anything of {}", untestable.join(", "))
}

/// What a verdict says of the simulation.
pub(super) fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Adequate => "the simulation agrees with these runs to within their noise",
        Verdict::Named => "the simulation lacks what follows",
        Verdict::Ambiguous => "the simulation lacks what follows; these runs leave a choice",
        Verdict::Unexplained => "the simulation lacks something that no known effect explains",
    }
}

fn cause(text: &mut String, cause: &Cause) -> std::fmt::Result {
    let log = log10(cause.log_bayes_factor);
    writeln!(text, "\n  {}   {}   (log10 Bayes factor {log:.1})", cause.effect, cause.equation)?;
    if !cause.equivalent_to.is_empty() {
        writeln!(text, "    or {}: these runs cannot tell", cause.equivalent_to.join(" or "))?;
    }
    for (symbol, unit, e) in &cause.parameters {
        writeln!(text, "    {symbol} = {:.4} [{:.4}, {:.4}] {unit}", e.mean, e.lo95, e.hi95)?;
    }
    Ok(())
}

fn line(text: &mut String, what: &str, change: &Change) -> std::fmt::Result {
    let (before, after) = (&change.before, &change.after);
    writeln!(
        text,
        "  {what:36} {:8.4} [{:.4}, {:.4}]  {:8.4} [{:.4}, {:.4}]",
        before.mean, before.lo95, before.hi95, after.mean, after.lo95, after.hi95
    )
}
