//! The rod, its lever and its pin: what the load cell feels beside the exciting moment.

use crate::hidden_tank::base::ARM_M;
use crate::hidden_tank::effect::{Hidden, Row};
use crate::hidden_tank::motion::Motion;
use crate::hidden_tank::plan::Pass;

/// Moment of a force on the lever at this angle, by the moment itself: a fixed law of a rod.
type Felt = fn(value: f64, roll: f64, moment: f64) -> f64;

/// What the load cell feels, from the roll of the moment and the moment.
struct Rod {
    value: f64,
    felt: Felt,
}

impl Hidden for Rod {
    fn transduce(&self, motion: &mut Motion, pass: &Pass) {
        if pass.is_forced() {
            for (moment, roll) in motion.moment.iter_mut().zip(&motion.roll) {
                *moment = (self.felt)(self.value, *roll, *moment);
            }
        }
    }
}

/// The lever shortens with the cosine of the roll; 1 is the plain cosine, more a leaning rod.
pub(super) const ARM_GEOMETRY: Row = Row {
    id: "exciter.arm_geometry",
    symbols: &["share [-]"],
    draw: |size, _, _| vec![size],
    hide: |values| {
        let felt: Felt = |share, roll, moment| moment / (1.0 - share * (1.0 - roll.cos()));
        Box::new(Rod { value: values[0], felt })
    },
};

/// The pin sits above or below the lever's line: arm `l (1 - (h/l) sin phi)`; h/l within 0.5
/// either way, middle 0.25.
pub(super) const PIN_HEIGHT: Row = Row {
    id: "exciter.pin_height",
    symbols: &["h/l [-]"],
    draw: |size, draw, _| vec![size * 0.25 * draw.sign()],
    hide: |values| {
        let felt: Felt = |height, roll, moment| moment / (1.0 - height * roll.sin());
        Box::new(Rod { value: values[0], felt })
    },
};

/// The mass of the rod below the load cell, `m l^2`; 0.005 to 0.04 kg m2, middle 0.014.
pub(super) const ROD_INERTIA: Row = Row {
    id: "exciter.rod_inertia",
    symbols: &["m l2 [kg m2]"],
    draw: |size, _, _| vec![size * 0.014],
    hide: |values| Box::new(RodInertia(values[0])),
};

struct RodInertia(f64);

impl Hidden for RodInertia {
    fn transduce(&self, motion: &mut Motion, pass: &Pass) {
        if !pass.is_forced() {
            return;
        }
        // The imposed motion is smooth and free of noise here, so differences are safe.
        for at in 1..motion.roll.len() - 1 {
            let second = motion.roll[at + 1] - 2.0 * motion.roll[at] + motion.roll[at - 1];
            motion.moment[at] += self.0 * second / motion.step_s.powi(2);
        }
    }
}

/// Play of the pin, 0.05 to 0.5 mm, middle 0.16: the force rings at 25 Hz after each reversal, and
/// the model lags by half the play.
pub(super) const PIN_PLAY: Row = Row {
    id: "exciter.pin_play",
    symbols: &["play [m]"],
    draw: |size, _, _| vec![size * 0.16e-3],
    hide: |values| Box::new(PinPlay(values[0])),
};

/// Contact stiffness of the pin [N/m], and the time in which its ringing dies [s].
const CONTACT_N_M: f64 = 1.0e4;
const RINGING_S: f64 = 0.05;

struct PinPlay(f64);

impl Hidden for PinPlay {
    fn transduce(&self, motion: &mut Motion, pass: &Pass) {
        if !pass.is_forced() {
            return;
        }
        let felt = motion.moment.clone();
        let mut reversed: Option<(f64, f64)> = None;
        for at in 1..felt.len() {
            let now_s = motion.time_s[at];
            if felt[at] * felt[at - 1] < 0.0 {
                // It lies between two steps, and the ringing is fast beside these.
                let late = felt[at] / (felt[at] - felt[at - 1]);
                reversed = Some((now_s - late * motion.step_s, felt[at].signum()));
            }
            let Some((since_s, side)) = reversed.map(|(when_s, side)| (now_s - when_s, side))
            else {
                continue;
            };
            let ringing = (-since_s / RINGING_S).exp() * (157.0 * since_s).sin();
            motion.moment[at] += side * self.0 * CONTACT_N_M * ARM_M * ringing;
            let closing = 1.0 - (-since_s / 0.01).exp();
            motion.roll[at] -= side * 0.5 * self.0 / ARM_M * (2.0 * closing - 1.0);
        }
    }
}
