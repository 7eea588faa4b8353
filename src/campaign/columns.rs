//! The `[columns]` table: how recordings name their channels.

use devices::Quantity;
use replay::{ChannelColumn, Columns, TimeColumn};

use super::tree::{POSITIVE, Section};
use super::units;

/// Reads `[columns]`.
pub(super) fn read(section: &Section<'_>) -> Columns {
    let time = section.section("time").as_ref().and_then(time_column);
    let sample_rate_hz = section.number("sample_rate_hz", &POSITIVE);
    let mut channels = Vec::new();
    for quantity in Quantity::ALL {
        if let Some(entry) = section.section(quantity.name()) {
            channels.extend(channel(&entry, quantity));
            entry.close();
        }
    }
    if !section.holds("roll") {
        section.mistake(
            "roll",
            "[columns] names no roll channel".to_owned(),
            "add `roll = { column = \"...\", unit = \"deg\" }` with the header as in the file",
        );
    }
    if section.holds("force") && section.holds("moment") {
        section.mistake(
            "moment",
            "[columns] names both a force and a moment".to_owned(),
            "keep the one that was measured; a force becomes a moment through [exciter]",
        );
    }
    if section.holds("time") && section.holds("sample_rate_hz") {
        section.mistake(
            "sample_rate_hz",
            "[columns] gives both a time column and a sample rate".to_owned(),
            "keep `time`; `sample_rate_hz` is for recordings without time stamps",
        );
    }
    section.close();
    Columns { time, sample_rate_hz, channels }
}

fn channel(entry: &Section<'_>, quantity: Quantity) -> Option<ChannelColumn> {
    let time = entry.section("time").as_ref().and_then(time_column);
    let si_per_unit = units::channel_unit(entry, quantity);
    let (column, topic) = if entry.holds("topic") || entry.holds("field") {
        if entry.holds("column") {
            entry.mistake(
                "column",
                format!("{} has both a `column` and a `topic`", quantity.name()),
                "use `column` for CSV recordings, `topic` and `field` for MCAP ones",
            );
        }
        entry.leave("column");
        (entry.required_text("field"), Some(entry.required_text("topic")?.to_owned()))
    } else {
        let column = entry.required_text("column");
        entry.leave("topic");
        entry.leave("field");
        (column, None)
    };
    let (column, si_per_unit) = (column?.to_owned(), si_per_unit?);
    Some(ChannelColumn { quantity, column, topic, time, si_per_unit })
}

fn time_column(section: &Section<'_>) -> Option<TimeColumn> {
    let column = section.required_text("column").map(str::to_owned);
    let seconds_per_unit = units::time_unit(section);
    section.close();
    Some(TimeColumn { column: column?, seconds_per_unit: seconds_per_unit? })
}
