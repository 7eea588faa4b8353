//! What is towed: the three run sets.

use super::base::speed_m_s;
use super::draw::Draw;

/// What the crew does in a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Action {
    /// Heel, hold, release.
    Decay {
        /// Heel of the hold [rad].
        heel_rad: f64,
    },
    /// The rod imposes `A sin(w t)`.
    Forced {
        /// Amplitude [rad].
        amplitude_rad: f64,
        /// Frequency [rad/s].
        frequency_rad_s: f64,
    },
}

/// One pass of the carriage.
#[derive(Clone, Debug)]
pub(crate) struct Pass {
    /// Its place in the campaign, from nought.
    pub(crate) index: usize,
    /// Steady speed [m/s].
    pub(crate) speed_m_s: f64,
    /// What is done.
    pub(crate) action: Action,
    /// Factors on linear and cubic damping: no two runs are quite alike.
    pub(crate) scatter: [f64; 2],
    /// Numbers between 0 and 1, for effects that differ from pass to pass.
    pub(crate) chance: [f64; 6],
    /// The hull is not the one of the label.
    pub(crate) other_hull: bool,
    /// What the speed channel shows of one metre a second.
    pub(crate) speed_shown: f64,
    /// The load cell was wired the other way round.
    pub(crate) force_reversed: bool,
}

impl Pass {
    /// A pass with the luck of its day.
    pub(crate) fn drawn(
        index: usize,
        froude: f64,
        action: Action,
        scatter: f64,
        draw: &mut Draw,
    ) -> Self {
        Self {
            index,
            speed_m_s: speed_m_s(froude),
            action,
            scatter: [(); 2].map(|()| 1.0 + scatter * draw.normal()),
            chance: [(); 6].map(|()| draw.between(0.0, 1.0)),
            other_hull: false,
            speed_shown: 1.0,
            force_reversed: false,
        }
    }

    /// The pass with the labels that it should have.
    pub(crate) fn well_labelled(&self) -> Self {
        Self { other_hull: false, speed_shown: 1.0, force_reversed: false, ..self.clone() }
    }

    /// The pass as its labels have it.
    pub(crate) fn as_labelled(&self) -> Self {
        Self { speed_m_s: self.speed_m_s * self.speed_shown, ..self.well_labelled() }
    }

    /// The rod drives the model.
    pub(crate) fn is_forced(&self) -> bool {
        matches!(self.action, Action::Forced { .. })
    }
}

/// Which runs a campaign has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RunSet {
    /// Decays of 15 and 4 degrees at rest, to both sides.
    Rest,
    /// Decays over Froude numbers 0 to 0.4.
    Speeds,
    /// Decays at rest, and forced rolling over amplitudes and over frequencies.
    Forced,
}

impl RunSet {
    /// All of them, with the name on the command line.
    pub(crate) const ALL: [(&'static str, Self); 3] =
        [("rest", Self::Rest), ("speeds", Self::Speeds), ("forced", Self::Forced)];

    /// Its name on the command line.
    pub(crate) fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, set)| *set == self).map_or("", |(name, _)| name)
    }

    /// Froude number and action of every pass, in the order of the day.
    fn script(self) -> Vec<(f64, Action)> {
        let decay = |froude: f64, heel_deg: f64| {
            (froude, Action::Decay { heel_rad: heel_deg.to_radians() })
        };
        let forced = |amplitude_deg: f64, frequency_rad_s: f64| {
            let amplitude_rad = f64::to_radians(amplitude_deg);
            (0.0, Action::Forced { amplitude_rad, frequency_rad_s })
        };
        match self {
            Self::Rest => [15.0, 4.0, -15.0, 4.0].map(|heel| decay(0.0, heel)).to_vec(),
            Self::Speeds => {
                let mut all = Vec::new();
                for froude in [0.0, 0.1, 0.2, 0.3, 0.4] {
                    all.extend([decay(froude, 12.0), decay(froude, 5.0)]);
                }
                all.extend([decay(0.05, 12.0), decay(0.15, -12.0)]);
                all
            }
            Self::Forced => {
                let mut all = [15.0, 4.0, -15.0].map(|heel| decay(0.0, heel)).to_vec();
                all.extend([2.5, 5.0, 10.0, 15.0].map(|amplitude| forced(amplitude, 5.12)));
                all.extend([4.0, 6.0, 6.905, 8.0].map(|frequency| forced(5.0, frequency)));
                all
            }
        }
    }

    /// The passes, each with the luck of its day; `scatter` is the standard deviation of the
    /// factors on the damping.
    pub(crate) fn passes(self, scatter: f64, draw: &mut Draw) -> Vec<Pass> {
        let script = self.script().into_iter().enumerate();
        let pass = |(index, (froude, action))| Pass::drawn(index, froude, action, scatter, draw);
        script.map(pass).collect()
    }
}
