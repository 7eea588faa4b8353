//! One measured value with its quantity, its time and its SI unit.

/// What a channel measures; every [`Sample`] carries its value in this quantity's SI unit.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// Roll angle [rad], starboard down positive.
    Roll,
    /// Force of the oscillator rod [N], positive where it rolls the model to starboard.
    Force,
    /// Roll exciting moment [N m], recorded instead of a force.
    Moment,
    /// Carriage speed [m/s], ahead positive.
    Speed,
}

impl Quantity {
    /// Every quantity, in the order in which channels are listed everywhere and which `Ord` gives.
    pub const ALL: [Self; 4] = [Self::Roll, Self::Force, Self::Moment, Self::Speed];

    /// Name in campaign files, topics and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Roll => "roll",
            Self::Force => "force",
            Self::Moment => "moment",
            Self::Speed => "speed",
        }
    }

    /// SI unit of the values in a [`Sample`].
    pub fn unit(self) -> &'static str {
        match self {
            Self::Roll => "rad",
            Self::Force => "N",
            Self::Moment => "N m",
            Self::Speed => "m/s",
        }
    }
}

/// One value of one channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// What was measured.
    pub quantity: Quantity,
    /// When [s], on the time base of the recording.
    pub time_s: f64,
    /// Value in the SI unit of the quantity.
    pub value: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_of_quantities_is_whole_and_in_their_order() {
        assert!(Quantity::ALL.is_sorted());
        assert!(Quantity::ALL.iter().enumerate().all(|(at, quantity)| *quantity as usize == at));
    }
}
