//! The diagnosis as a tank engineer reads it: verdict first, then cause, gain and next run.

use std::fmt::Write;

use super::diagnosis_json::word;
use crate::diagnosis::Diagnosis;

/// The sentences.
pub fn diagnosis_text(diagnosis: Option<&Diagnosis>) -> String {
    let mut text = String::new();
    let Some(diagnosis) = diagnosis else { return "no run could be diagnosed\n".to_owned() };
    let _ = writeln!(text, "verdict: {}", word(diagnosis.verdict));
    for cause in &diagnosis.causes {
        let log10 = cause.log_bayes_factor / std::f64::consts::LN_10;
        let _ = writeln!(text, "  {}   {}   log10 BF {log10:.1}", cause.effect, cause.equation);
        if !cause.equivalent_to.is_empty() {
            let _ = writeln!(text, "    or {}", cause.equivalent_to.join(", "));
        }
        for (symbol, unit, e) in &cause.parameters {
            let _ = writeln!(text, "    {symbol} = {:.4e} +- {:.1e} {unit}", e.mean, e.sd);
        }
    }
    let _ = writeln!(text, "ranking against the base model (log10 Bayes factor):");
    for (effect, log) in diagnosis.ranking.iter().take(8) {
        let _ = writeln!(text, "  {:8.1}  {effect}", log / std::f64::consts::LN_10);
    }
    text
}
