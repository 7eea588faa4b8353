//! Measured decays of the KVLCC2 tanker model against the damping published for them.
//!
//! Published: Alexandersson and Kjellberg, ISOPE-2021 (2021-TPC-0232), from peaks between 15 and
//! 3.5 deg; total inertia 135.6 kg m2.

use std::path::PathBuf;

use rolltank::campaign::{self, Campaign};
use rolltank::inverse::estimate::Estimate;
use rolltank::inverse::identification::{Identification, Method};
use rolltank::inverse::{Setting, identify};
use rolltank::pipeline::{self, Options};
use rolltank::results::{IdentifiedRun, Results};
use rolltank::run::{Run, Series};
use rolltank::uncertainty::rises;

const INERTIA_KG_M2: f64 = 135.6;

/// Folder of the measured data; none where they are not at hand.
pub(crate) fn folder() -> Option<PathBuf> {
    let root = std::env::var_os("ROLLTANK_MEASURED").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/measured"),
        PathBuf::from,
    );
    let folder = root.join("kvlcc2");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("no measured data at {}: story not told (set ROLLTANK_MEASURED)", folder.display());
    None
}

fn replayed() -> Option<(Campaign, Results)> {
    let campaign = campaign::read(&folder()?).expect("the campaign file is right");
    let results = pipeline::replay(&campaign, &Options::default(), &mut |_| {}, &mut |_| Ok(()))
        .expect("the recordings can be read");
    Some((campaign, results))
}

fn at_five_degrees(identification: &Identification) -> (f64, f64) {
    let five = identification
        .equivalent_damping
        .iter()
        .find(|e| (e.amplitude_deg - 5.0).abs() < 1e-9)
        .expect("five degrees are always reported");
    let local = five.local_per_s.expect("both runs pass five degrees");
    (five.fitted_per_s.mean * INERTIA_KG_M2, local.mean * INERTIA_KG_M2)
}

/// The part of a run whose half cycles lie above 3.5 deg, as the publication used it.
fn published_window(run: &IdentifiedRun) -> Run {
    let last = run.identification.half_cycles.iter().rfind(|h| h.amplitude_rad.to_degrees() > 3.5);
    let end_s = last.expect("the runs start near 10 deg").time_s;
    let n = run.run.roll.time_s.partition_point(|t| *t <= end_s);
    let roll = Series {
        time_s: run.run.roll.time_s[..n].to_vec(),
        value: run.run.roll.value[..n].to_vec(),
    };
    Run { end_s, roll, ..run.run.clone() }
}

#[test]
fn both_decays_are_found_and_the_stop_is_rejected() {
    let Some((_, results)) = replayed() else { return };
    assert_eq!(results.runs.len(), 2, "{:?}", results.rejected);
    let (rest, towed) = (&results.runs[0].run, &results.runs[1].run);
    // Half a roll period is 1.27 s.
    assert!((rest.start_s - 8.1).abs() < 1.27 && rest.end_s > 188.0, "{}", rest.end_s);
    assert!((towed.start_s - 23.1).abs() < 1.27, "{}", towed.start_s);
    assert!((towed.end_s - 76.0).abs() < 1.27, "{}", towed.end_s);
    let stop = results.rejected.iter().find(|r| r.end_s > 78.0).expect("the stop is rejected");
    assert!(stop.reason.contains("stopped"), "{}", stop.reason);
}

#[test]
fn frequency_and_damping_are_the_published_ones() {
    let Some((campaign, results)) = replayed() else { return };
    let setting = Setting {
        restoring_n_m_per_rad: campaign.hull.restoring_n_m_per_rad(&campaign.water),
        exciter: None,
        method: Method::Exact,
        seed: 1,
    };
    for (run, published) in results.runs.iter().zip([3.24, 8.87]) {
        let whole = &run.identification;
        let frequency = whole.natural_frequency_rad_s.mean;
        assert!((2.458..2.470).contains(&frequency), "{frequency} rad/s");
        let window = identify(&published_window(run), &setting).expect("the window is a decay");
        let ((law, local), (their_law, _)) = (at_five_degrees(whole), at_five_degrees(&window));
        println!(
            "{}: B_eq(5 deg) law {law:.2}, local {local:.2}, law in their window {their_law:.2}, \
             published {published} N m s; resimulation rms {:.3} deg",
            run.id,
            whole.resimulation.rmse_rad.to_degrees()
        );
        // The publication's integrator and window are worth up to 5 %.
        for value in [law, local, their_law] {
            assert!((value / published - 1.0).abs() < 0.05, "{value} N m s for {published}");
        }
    }
}

#[test]
fn what_the_law_does_not_capture_is_said() {
    let Some((_, results)) = replayed() else { return };
    for run in &results.runs {
        let remarks = run.identification.remarks.join("\n");
        assert!(remarks.contains("frequency changes with amplitude"), "{remarks}");
        assert!(remarks.contains("leaves more than noise"), "{remarks}");
        // A widened covariance must stay one.
        assert!(run.identification.natural_frequency_rad_s.sd > 0.0);
        assert!(run.identification.roll_offset_rad.sd > 0.0);
    }
}

#[test]
fn speed_changes_the_linear_damping_and_the_nonlinear_one() {
    let Some((_, results)) = replayed() else { return };
    let linear = |k: usize| results.runs[k].identification.damping.b1_per_s;
    assert!(linear(1).lo95 > 2.0 * linear(0).hi95, "{:?}, {:?}", linear(0), linear(1));
    let rises = rises(&results);
    let [rest, towed] = &rises[..] else { panic!("{rises:?}") };
    for rise in &rises {
        let ([from, to], rise_per_s) = (rise.amplitudes_deg, rise.rise_per_s);
        let Estimate { mean, sd, .. } = rise_per_s;
        println!("Fr {:.3}: {mean:.4} +- {sd:.4} 1/s from {from} to {to} deg", rise.froude);
    }
    // The eddies of the bilge are carried away: what rises with the roll is less under way.
    let (rest, towed) = (rest.rise_per_s, towed.rise_per_s);
    assert!(rest.mean - towed.mean > 3.0 * rest.sd.hypot(towed.sd) && towed.lo95 > 0.0);
}
