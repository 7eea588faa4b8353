//! The test plan of a virtual day: what its scenario is going to play, as `[[plan]]` tables.

use std::fmt::Write as _;

use crate::tank::{Action, Pass, Scenario};

/// The tables, one for the decays of a pass and one for each frequency that is forced in it.
pub(super) fn plan(scenario: &Scenario) -> String {
    let mut text = String::new();
    for pass in &scenario.passes {
        for action in &pass.actions {
            match *action {
                Action::Release { .. } | Action::Strike { .. } => row(&mut text, pass, "decay", ""),
                Action::Forced { frequency_rad_s, .. } => {
                    let frequency = format!("frequency_rad_s = {frequency_rad_s:?}\n");
                    row(&mut text, pass, "forced", &frequency);
                }
                _ => {}
            }
        }
    }
    text
}

fn row(text: &mut String, pass: &Pass, kind: &str, frequency: &str) {
    let Pass { condition, repeat, .. } = pass;
    let speed = match (pass.froude, pass.speed_m_s) {
        (Some(froude), _) => format!("froude = {froude:?}"),
        (None, speed_m_s) => format!("speed_m_s = {:?}", speed_m_s.unwrap_or(0.0)),
    };
    // A string takes every text.
    let _ = write!(
        text,
        "\n[[plan]]\ncondition = {condition:?}\n{speed}\nkind = \"{kind}\"\n{frequency}repeats = \
         {repeat}\n"
    );
}
