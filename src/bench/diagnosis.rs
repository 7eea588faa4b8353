//! How long a diagnosis takes on the machine at hand.

use std::path::Path;

use super::speed::{Figure, figure};
use super::stopwatch::{fastest_s, timed};
use crate::campaign;
use crate::diagnosis::{Gathered, Observation, diagnose};
use crate::pipeline::{self, Learnt, Options};
use crate::tank::{Scenario, write_campaign};

/// Times that a single run is diagnosed.
const REPEATS: usize = 5;

/// A campaign of twelve passes with an effect, written to `folder`, which must be empty; then its
/// first run alone.
///
/// # Errors
/// A sentence about what could not be written or read.
pub fn of_twelve_passes(folder: &Path) -> Result<Vec<Figure>, String> {
    let text = include_str!("twelve_passes.toml");
    let scenario =
        Scenario::parse(text, "twelve_passes.toml").map_err(|error| error.to_string())?;
    let written = write_campaign(&scenario, 1, folder, &mut |_, _| {});
    written.map_err(|error| error.to_string())?;
    let campaign = campaign::read(folder).map_err(|mistakes| {
        mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    })?;
    let mut runs: Vec<Observation> = Vec::new();
    let options = Options { keep_histories: false, ..Options::default() };
    pipeline::replay(&campaign, &options, &mut |_| {}, &mut |learnt| {
        if let Learnt::Run(run, _) = learnt {
            runs.push(Observation::new(run, &campaign, runs.len())?);
        }
        Ok(())
    })
    .map_err(|error| error.to_string())?;
    let first = runs.first().ok_or("no run was found in the twelve passes")?.clone();
    let n_runs = runs.len();
    let (all_s, diagnosis) =
        timed(|| diagnose(Gathered { runs, ..Gathered::default() }, &campaign.tank));
    let named: Vec<&str> = diagnosis.iter().flat_map(|d| &d.causes).map(|c| c.effect).collect();
    let named = if named.is_empty() { "no cause".to_owned() } else { named.join(", ") };
    let one_s = fastest_s(REPEATS, || {
        diagnose(Gathered { runs: vec![first.clone()], ..Gathered::default() }, &campaign.tank)
    });
    Ok(vec![
        figure(
            format!("diagnosis of {n_runs} runs, decays and forced, on all cores: {named}"),
            format!("{all_s:.2} s"),
        ),
        figure("diagnosis of one decay, on all cores", format!("{one_s:.3} s")),
    ])
}
