//! How recordings name their channels: columns of a table, topics and fields of an MCAP file.

use devices::Quantity;

/// Where each channel stands in the recordings and in which unit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// The time column of a table, or none when only a sample rate is known; the time field of an
    /// MCAP message, or none to take its log time.
    pub time: Option<TimeColumn>,
    /// Sample rate [Hz] for tables without time column; the first row is then at 0 s.
    pub sample_rate_hz: Option<f64>,
    /// Every other channel, at most one per quantity, in the order of [`Quantity::ALL`].
    pub channels: Vec<ChannelColumn>,
}

/// The column or field that carries the time.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeColumn {
    /// Header of the column, exactly as in the file.
    pub column: String,
    /// Seconds in one unit of the column.
    pub seconds_per_unit: f64,
}

/// The column or field that carries one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelColumn {
    /// What the channel measures.
    pub quantity: Quantity,
    /// Header of the CSV column, exactly as in the file; in an MCAP message the path of the field,
    /// keys and list indices joined by points (`angle.roll`, `position.0`).
    pub column: String,
    /// MCAP topic, for recordings made by other programs.
    pub topic: Option<String>,
    /// Own time column, when the channel has a time base of its own.
    pub time: Option<TimeColumn>,
    /// SI units in one unit of the column.
    pub si_per_unit: f64,
}
