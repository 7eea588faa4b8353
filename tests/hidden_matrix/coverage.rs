//! Whether the parameters of a named effect hold the truth in their 95 % intervals.

use serde_json::{Value, json};

use crate::hidden_tank::campaign::Campaign;

/// What a parameter of the program should be, from the values of the hidden effect: damping is
/// told by inertia, restoring by `K`, frequencies by the natural one where the symbol says so.
fn expected(id: &str, symbol: &str, v: &[f64], campaign: &Campaign) -> Option<f64> {
    let base = &campaign.base;
    let by_inertia = v[0] / base.inertia;
    let natural = base.natural_rad_s();
    Some(match (id, symbol) {
        ("damping.quadratic" | "damping.vortex_history", "b2")
        | ("damping.quintic", "b5")
        | ("damping.coulomb" | "damping.friction_speed", "f")
        | ("damping.displacement_weighted", "bf")
        | ("damping.memory", "bm") => by_inertia,
        ("damping.power_law", "p")
        | ("damping.vortex_history", "tau")
        | ("damping.start_up", "T") => v[1],
        ("damping.start_up", "be")
        | ("restoring.cubic", "k3")
        | ("restoring.quintic", "k5")
        | ("restoring.asymmetric", "k2")
        | ("inertia.amplitude", "a")
        | ("restoring.heel" | "instrument.roll_offset", "e0")
        | ("instrument.roll_backlash", "d")
        | ("instrument.roll_lag" | "instrument.channel_skew", "tau") => v[0],
        ("restoring.free_surface", "kt") => v[0] / base.restoring,
        ("damping.memory", "q") | ("restoring.free_surface", "wt/w") => v[1] / natural,
        ("damping.memory", "a1") | ("restoring.free_surface", "z") => v[2],
        // Told as the drift in 20 s.
        ("instrument.roll_drift", "d") => 20.0 * v[0],
        _ => return None,
    })
}

/// Each parameter whose truth is known, and whether its interval holds it.
pub(crate) fn covered(campaign: &Campaign, causes: &Value) -> Value {
    let mut hits = Vec::new();
    for cause in causes.as_array().into_iter().flatten() {
        let effect = campaign.effects.iter().find(|effect| cause["effect"] == effect.row.id);
        let Some(effect) = effect else { continue };
        for told in cause["parameters"].as_array().into_iter().flatten() {
            let symbol = told["symbol"].as_str().unwrap_or_default();
            let truth = expected(effect.row.id, symbol, &effect.values, campaign);
            let bounds = (told["lo95"].as_f64(), told["hi95"].as_f64());
            if let (Some(truth), (Some(low), Some(high))) = (truth, bounds) {
                let inside = (low..=high).contains(&truth);
                let (mean, sd) = (&told["mean"], &told["sd"]);
                hits.push(json!({
                    "symbol": symbol, "truth": truth, "mean": mean, "sd": sd, "inside": inside,
                }));
            }
        }
    }
    hits.into()
}
