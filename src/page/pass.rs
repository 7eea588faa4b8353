//! Where the carriage is in its pass: the way since it last stood, from its measured speed.

use serde::Serialize;

/// A carriage slower than this stands [m/s]: a speed log has noise.
const STANDS_M_S: f64 = 0.03;
/// It stands when it did for so long [s].
const STANDS_S: f64 = 1.5;
/// Time of the mean that is shown as its speed [s].
const MEAN_S: f64 = 0.5;
/// Samples further apart tell nothing of the way between [s].
const HOLE_S: f64 = 1.0;

/// The carriage as it is now.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Pass {
    /// Speed over the last moments [m/s].
    pub speed_m_s: f64,
    /// Way since it last stood [m]; astern is negative.
    pub way_m: f64,
    /// Whether it moves.
    pub moves: bool,
    #[serde(skip)]
    last_s: Option<f64>,
    #[serde(skip)]
    stood_s: f64,
}

impl Pass {
    /// Takes a sample of the speed [m/s].
    pub fn push(&mut self, time_s: f64, speed_m_s: f64) {
        let Some(last_s) = self.last_s.replace(time_s) else {
            self.speed_m_s = speed_m_s;
            return;
        };
        let step_s = time_s - last_s;
        if !(step_s > 0.0 && step_s <= HOLE_S && speed_m_s.is_finite()) {
            return;
        }
        self.speed_m_s += (speed_m_s - self.speed_m_s) * (step_s / MEAN_S).min(1.0);
        self.stood_s = if self.speed_m_s.abs() < STANDS_M_S { self.stood_s + step_s } else { 0.0 };
        if self.stood_s >= STANDS_S {
            self.moves = false;
        } else if !self.moves && self.speed_m_s.abs() >= STANDS_M_S {
            (self.moves, self.way_m) = (true, 0.0);
        }
        if self.moves {
            self.way_m += speed_m_s * step_s;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Pass;

    #[test]
    fn the_way_of_a_pass_is_kept_while_it_stands_and_begins_anew_with_the_next() {
        let mut pass = Pass::default();
        let mut time_s = 0.0;
        let mut drive = |pass: &mut Pass, speed_m_s: f64, for_s: f64| {
            for _ in 0..(for_s * 100.0) as usize {
                time_s += 0.01;
                pass.push(time_s, speed_m_s);
            }
        };
        drive(&mut pass, 0.004, 5.0);
        assert!(!pass.moves && pass.way_m.abs() < 1e-9);
        drive(&mut pass, 1.0, 10.0);
        assert!(pass.moves && (pass.way_m - 10.0).abs() < 0.1, "{pass:?}");
        drive(&mut pass, 0.0, 6.0);
        assert!(!pass.moves && (pass.way_m - 10.0).abs() < 0.1, "{pass:?}");
        drive(&mut pass, -0.5, 4.0);
        assert!(pass.moves && (pass.way_m + 2.0).abs() < 0.1, "{pass:?}");
    }
}
