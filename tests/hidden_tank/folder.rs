//! The campaign folder of a user, and the truth sealed beside it.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::base::{
    ARM_M, BEAM_M, DISPLACEMENT_M3, DRAFT_M, GM_M, GRAVITY_M_S2, LENGTH_PP_M, froude,
};
use super::campaign::Campaign;
use super::timeline::Timeline;

/// A played campaign on disk.
pub(crate) struct Played {
    /// The folder that the program is given.
    pub(crate) folder: PathBuf,
    /// The truth, which lies outside of it.
    pub(crate) truth: PathBuf,
}

/// Plays a campaign into `place/campaign`, and seals the truth in `place/truth.json`.
///
/// # Panics
/// When the disk does not take it.
pub(crate) fn play(campaign: &Campaign, place: &Path) -> Played {
    let folder = place.join("campaign");
    fs::create_dir_all(folder.join("runs")).expect("a place for the recordings");
    let mut toml = head(campaign);
    for pass in &campaign.passes {
        let file = format!("runs/pass_{:02}.csv", pass.index + 1);
        let condition = condition(campaign);
        write!(toml, "\n[[recording]]\nfile = \"{file}\"\ncondition = \"{condition}\"\n")
            .expect("a string takes all");
        let rows = campaign.rows(pass, true);
        let mut csv = String::from(if campaign.has_force() {
            "t,roll,force,speed\n"
        } else {
            "t,roll,speed\n"
        });
        for i in 0..rows.time_s.len() {
            write!(csv, "{:.2},{:.3}", rows.time_s[i], rows.roll_deg[i]).expect("text");
            if campaign.has_force() {
                write!(csv, ",{:.2}", rows.force_n[i]).expect("text");
            }
            writeln!(csv, ",{:.3}", rows.speed_m_s[i]).expect("text");
        }
        fs::write(folder.join(file), csv).expect("a recording is written");
    }
    fs::write(folder.join("campaign.toml"), toml).expect("the campaign file is written");
    let sealed = place.join("truth.json");
    fs::write(&sealed, format!("{:#}\n", truth(campaign))).expect("the truth is written");
    Played { folder, truth: sealed }
}

fn condition(campaign: &Campaign) -> &'static str {
    if campaign.keels { "bilge keels" } else { "bare hull" }
}

/// Everything before the recordings.
fn head(campaign: &Campaign) -> String {
    let mut toml = format!(
        "name = \"A simulated day\"\n\n\
         [hull]\nlength_pp_m = {LENGTH_PP_M}\nbeam_m = {BEAM_M}\ndraft_m = {DRAFT_M}\n\
         displacement_m3 = {DISPLACEMENT_M3}\ngm_m = {GM_M}\n\n\
         [water]\ndensity_kg_m3 = 1000.0\ngravity_m_s2 = {GRAVITY_M_S2}\n\n\
         [tank]\nlength_m = 50.0\nwidth_m = 10.0\ndepth_m = 5.0\n\
         carriage_max_speed_m_s = 2.0\n\n"
    );
    if campaign.has_force() {
        write!(toml, "[exciter]\nmoment_arm_m = {ARM_M}\n\n").expect("a string takes all");
    }
    toml.push_str(
        "[columns]\ntime = { column = \"t\", unit = \"s\" }\n\
         roll = { column = \"roll\", unit = \"deg\" }\n\
         speed = { column = \"speed\", unit = \"m/s\" }\n",
    );
    if campaign.has_force() {
        toml.push_str("force = { column = \"force\", unit = \"N\" }\n");
    }
    toml
}

/// What really was: the effects with their values, the coefficients, the runs.
pub(crate) fn truth(campaign: &Campaign) -> Value {
    let base = &campaign.base;
    let effects: Vec<Value> = campaign
        .effects
        .iter()
        .map(|effect| {
            let values: serde_json::Map<String, Value> = effect
                .row
                .symbols
                .iter()
                .zip(&effect.values)
                .map(|(symbol, value)| ((*symbol).to_owned(), json!(value)))
                .collect();
            json!({ "effect": effect.row.id, "values": values })
        })
        .collect();
    let runs: Vec<Value> = campaign
        .passes
        .iter()
        .map(|pass| {
            let line = Timeline::of(pass);
            let hull = campaign.base_of(pass);
            let fr = froude(pass.speed_m_s);
            json!({
                "recording": format!("pass_{:02}", pass.index + 1),
                "kind": if pass.is_forced() { "forced" } else { "decay" },
                "start_s": line.start_s, "end_s": line.end_s, "froude": fr,
                "b1_per_s": pass.scatter[0] * hull.linear(fr) / hull.inertia,
                "b3_s": pass.scatter[1] * hull.b3 / hull.inertia,
                "other_hull": pass.other_hull, "speed_shown": pass.speed_shown,
                "force_reversed": pass.force_reversed,
            })
        })
        .collect();
    json!({
        "name": campaign.asked.name(), "hidden": effects, "size": campaign.asked.size,
        "set": campaign.asked.set.name(), "seed": campaign.asked.seed,
        "scatter": campaign.asked.scatter, "condition": condition(campaign),
        "natural_frequency_rad_s": base.natural_rad_s(), "inertia_kg_m2": base.inertia,
        "restoring_n_m": base.restoring, "b0_per_s": base.b0 / base.inertia,
        "kappa": base.kappa, "b3_s": base.b3 / base.inertia, "runs": runs,
    })
}
