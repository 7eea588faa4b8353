//! The `[hull]`, `[water]`, `[tank]` and `[exciter]` tables, each value in its physical range.

use super::tree::{POSITIVE, SHARE, SIGN, Section};
use super::{Tank, Trueness};
use crate::hull::{Hull, Water};
use crate::roll::exciting_moment::{Arm, Exciter};

/// Block coefficients of floating bodies: a box has 1, a slender multihull about 0.05.
const BLOCK_COEFFICIENT: [f64; 2] = [0.05, 1.0];
/// Densities of water [kg/m3]: from hot fresh water to the saltiest sea with a margin.
const DENSITY_KG_M3: [f64; 2] = [950.0, 1100.0];
/// Gravity on the surface of the earth [m/s2], 9.764 to 9.834, with a margin.
const GRAVITY_M_S2: [f64; 2] = [9.75, 9.85];

/// Reads `[uncertainty]`.
pub(super) fn trueness(section: Option<&Section<'_>>) -> Trueness {
    let Some(section) = section else { return Trueness::default() };
    let share = |key| section.number(key, &SHARE);
    let trueness = Trueness {
        roll_gain: share("roll_gain"),
        force_gain: share("force_gain"),
        clock: share("clock"),
        gm: share("gm"),
    };
    section.close();
    trueness
}

/// Reads `[hull]`.
pub(super) fn hull(section: &Section<'_>) -> Option<Hull> {
    let length_pp_m = section.required_number("length_pp_m", &POSITIVE);
    let beam_m = section.required_number("beam_m", &POSITIVE);
    let draft_m = section.required_number("draft_m", &POSITIVE);
    let displacement_m3 = section.required_number("displacement_m3", &POSITIVE);
    let gm_m = section.required_number("gm_m", &POSITIVE);
    let hull = (|| {
        Some(Hull {
            length_pp_m: length_pp_m?,
            beam_m: beam_m?,
            draft_m: draft_m?,
            displacement_m3: displacement_m3?,
            gm_m: gm_m?,
        })
    })();
    if let Some(hull) = &hull {
        check_displacement(section, hull);
        if hull.gm_m > hull.beam_m {
            section.mistake(
                "gm_m",
                format!("gm_m = {} m is above the beam {} m", hull.gm_m, hull.beam_m),
                "gm_m is in metres at model scale; 74 mm are 0.074",
            );
        }
    }
    section.close();
    hull
}

fn check_displacement(section: &Section<'_>, hull: &Hull) {
    let box_m3 = hull.length_pp_m * hull.beam_m * hull.draft_m;
    let block = hull.displacement_m3 / box_m3;
    let [low, high] = BLOCK_COEFFICIENT;
    if !(low..=high).contains(&block) {
        section.mistake(
            "displacement_m3",
            format!(
                "displacement_m3 = {} m3 is {block:.3} of length x beam x draft = {box_m3:.4} m3, \
                 outside {low} to {high}",
                hull.displacement_m3
            ),
            "displacement_m3 is a volume in m3 at model scale, lengths are in m; \
             110 kg of fresh water are 0.110 m3",
        );
    }
}

/// Reads `[water]`, with the defaults of fresh water where it is silent.
pub(super) fn water(section: Option<&Section<'_>>) -> Water {
    let mut water = Water::default();
    let Some(section) = section else { return water };
    if let Some(density) = section.number("density_kg_m3", &POSITIVE) {
        check_range(section, "density_kg_m3", density, DENSITY_KG_M3, "fresh water has 1000");
        water.density_kg_m3 = density;
    }
    if let Some(gravity) = section.number("gravity_m_s2", &POSITIVE) {
        check_range(section, "gravity_m_s2", gravity, GRAVITY_M_S2, "standard gravity is 9.80665");
        water.gravity_m_s2 = gravity;
    }
    section.close();
    water
}

fn check_range(section: &Section<'_>, key: &str, value: f64, [low, high]: [f64; 2], hint: &str) {
    if !(low..=high).contains(&value) {
        section.mistake(key, format!("{key} = {value} is outside {low} to {high}"), hint);
    }
}

/// Reads `[tank]`.
pub(super) fn tank(section: Option<&Section<'_>>, hull: Option<&Hull>) -> Tank {
    let Some(section) = section else { return Tank::default() };
    let tank = Tank {
        length_m: section.number("length_m", &POSITIVE),
        width_m: section.number("width_m", &POSITIVE),
        depth_m: section.number("depth_m", &POSITIVE),
        carriage_max_speed_m_s: section.number("carriage_max_speed_m_s", &POSITIVE),
    };
    if let Some(hull) = hull {
        let fits = [
            ("length_m", tank.length_m, "length_pp_m", hull.length_pp_m),
            ("width_m", tank.width_m, "beam_m", hull.beam_m),
            ("depth_m", tank.depth_m, "draft_m", hull.draft_m),
        ];
        for (key, room, hull_key, size) in fits {
            if room.is_some_and(|room| room <= size) {
                section.mistake(
                    key,
                    format!(
                        "the tank's {key} = {} m does not hold the model's {hull_key} = {size} m",
                        room.unwrap_or_default()
                    ),
                    "both are in metres, the model at model scale",
                );
            }
        }
    }
    section.close();
    tank
}

/// Reads `[exciter]`.
pub(super) fn exciter(section: &Section<'_>, hull: Option<&Hull>) -> Option<Exciter> {
    let moment_arm_m = section.required_number("moment_arm_m", &POSITIVE);
    if let (Some(arm_m), Some(Hull { length_pp_m, .. })) = (moment_arm_m, hull)
        && arm_m > *length_pp_m
    {
        section.mistake(
            "moment_arm_m",
            format!("moment_arm_m = {arm_m} m is longer than the model, {length_pp_m} m"),
            "moment_arm_m is in metres; 430 mm are 0.43",
        );
    }
    let force_sign = section.number("force_sign", &SIGN).unwrap_or(1.0);
    let rod_length_m = section.number("rod_length_m", &POSITIVE);
    let arm = match section.text("arm") {
        None | Some("constant") => Some(Arm::Constant),
        Some("cosine") => Some(Arm::Cosine),
        Some("rod") => {
            section.require("rod_length_m", "the rod between its joints in m");
            rod_length_m.map(|rod_length_m| Arm::Rod { rod_length_m })
        }
        Some(other) => {
            section.mistake(
                "arm",
                format!("unknown arm \"{other}\" in [exciter]"),
                "known arms: constant, cosine, rod",
            );
            None
        }
    };
    if section.holds("rod_length_m") && !matches!(arm, Some(Arm::Rod { .. }) | None) {
        section.mistake(
            "rod_length_m",
            "`rod_length_m` in [exciter] has no effect on this arm".to_owned(),
            "write `arm = \"rod\"` to let the rod tilt, or leave `rod_length_m` out",
        );
    }
    section.close();
    Some(Exciter { moment_arm_m: moment_arm_m?, arm: arm?, force_sign })
}
