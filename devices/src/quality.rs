//! What is wrong with a reading, as flags that travel with it.

/// Flags of one reading; none set means that the instrument had no complaint.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Quality(u8);

impl Quality {
    /// Nothing is wrong.
    pub const GOOD: Self = Self(0);
    /// Above or below what the instrument or the channel can measure.
    pub const OVER_RANGE: Self = Self(1);
    /// The same conversion was delivered before.
    pub const REPEATED: Self = Self(2);
    /// The instrument reports its sensor broken: bridge integrity, open wire.
    pub const SENSOR_FAULT: Self = Self(4);
    /// A calibration or shunt signal is switched on.
    pub const CALIBRATING: Self = Self(8);
    /// Delayed by a filter whose lag is not compensated.
    pub const LAGGED: Self = Self(16);

    const NAMES: [(Self, &'static str); 5] = [
        (Self::OVER_RANGE, "over range"),
        (Self::REPEATED, "repeated"),
        (Self::SENSOR_FAULT, "sensor fault"),
        (Self::CALIBRATING, "calibrating"),
        (Self::LAGGED, "lagged"),
    ];

    /// These flags and those of `other`.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// These flags, and `flag` when `on`.
    #[must_use]
    pub fn with_if(self, on: bool, flag: Self) -> Self {
        if on { self.with(flag) } else { self }
    }

    /// Whether every flag of `other` is set.
    pub fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether the value says something of the quantity: not beyond its range, not of a broken
    /// sensor, not of a calibration signal.
    pub fn is_usable(self) -> bool {
        let none = [Self::OVER_RANGE, Self::SENSOR_FAULT, Self::CALIBRATING];
        !none.into_iter().any(|flag| self.has(flag))
    }

    /// Names of the flags that are set.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        Self::NAMES.into_iter().filter(move |(flag, _)| self.has(*flag)).map(|(_, name)| name)
    }
}
