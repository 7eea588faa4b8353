//! The units that recordings may be written in.

use devices::Quantity;

use super::tree::Section;

/// SI units in one unit, by its names.
type Units = &'static [(&'static str, f64)];

const DEGREE_RAD: f64 = std::f64::consts::PI / 180.0;
/// Standard gravity, exact by definition (ISO 80000-4).
const KILOGRAM_FORCE_N: f64 = 9.806_65;
/// Avoirdupois pound 0.453 592 37 kg, exact, times standard gravity.
const POUND_FORCE_N: f64 = 0.453_592_37 * KILOGRAM_FORCE_N;
const FOOT_M: f64 = 0.304_8;
/// International nautical mile an hour, exact.
const KNOT_M_S: f64 = 1852.0 / 3600.0;

const TIME: Units = &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9), ("min", 60.0)];

const ROLL: Units = &[("rad", 1.0), ("mrad", 1e-3), ("deg", DEGREE_RAD), ("\u{b0}", DEGREE_RAD)];

const FORCE: Units = &[
    ("N", 1.0),
    ("mN", 1e-3),
    ("kN", 1e3),
    ("gf", 1e-3 * KILOGRAM_FORCE_N),
    ("kgf", KILOGRAM_FORCE_N),
    ("lbf", POUND_FORCE_N),
];

const MOMENT: Units = &[
    ("N m", 1.0),
    ("N*m", 1.0),
    ("Nm", 1.0),
    ("N\u{b7}m", 1.0),
    ("kN m", 1e3),
    ("kN*m", 1e3),
    ("kNm", 1e3),
    ("N cm", 1e-2),
    ("N mm", 1e-3),
    ("kgf m", KILOGRAM_FORCE_N),
    ("lbf ft", POUND_FORCE_N * FOOT_M),
];

const SPEED: Units = &[
    ("m/s", 1.0),
    ("cm/s", 1e-2),
    ("mm/s", 1e-3),
    ("km/h", 1.0 / 3.6),
    ("kn", KNOT_M_S),
    ("ft/s", FOOT_M),
];

fn units_of(quantity: Quantity) -> Units {
    match quantity {
        Quantity::Roll => ROLL,
        Quantity::Force => FORCE,
        Quantity::Moment => MOMENT,
        Quantity::Speed => SPEED,
    }
}

/// SI units in one of the unit named by the key `unit` of a channel.
pub(super) fn channel_unit(section: &Section<'_>, quantity: Quantity) -> Option<f64> {
    unit(section, quantity.name(), units_of(quantity))
}

/// Seconds in one of the unit named by the key `unit` of a time column.
pub(super) fn time_unit(section: &Section<'_>) -> Option<f64> {
    unit(section, "time", TIME)
}

fn unit(section: &Section<'_>, of: &str, known: Units) -> Option<f64> {
    let written = section.required_text("unit")?;
    let found = known.iter().find(|(name, _)| *name == written);
    if found.is_none() {
        let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        section.mistake(
            "unit",
            format!("unknown unit \"{written}\" of {of}"),
            format!("known units of {of}: {}", names.join(", ")),
        );
    }
    found.map(|(_, si)| *si)
}

#[cfg(test)]
mod tests {
    use super::{MOMENT, SPEED};

    #[test]
    fn a_knot_and_a_pound_foot_have_their_published_values() {
        // NIST SP 811, appendix B.8: 0.514 444 m/s and 1.355 818 N m, each to its last digit.
        let si = |units: super::Units, name| units.iter().find(|unit| unit.0 == name).unwrap().1;
        assert!((si(SPEED, "kn") - 0.514_444).abs() < 5e-7);
        assert!((si(MOMENT, "lbf ft") - 1.355_818).abs() < 5e-7);
    }
}
