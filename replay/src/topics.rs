//! The one table of topics that our own recordings hold, with the schema of each.

use std::io::Write;

use devices::{Quantity, Sample};
use serde_json::json;

/// Profile in the header of every recording we write.
pub(crate) const PROFILE: &str = "rolltank";
/// Name of the metadata record that tells where the recording comes from.
pub(crate) const METADATA: &str = "rolltank";
/// Message encoding of every topic.
pub(crate) const ENCODING: &str = "json";
/// Field of the time [s] on the recording's own time base, to the bit.
pub(crate) const TIME_FIELD: &str = "time_s";

/// One topic: a flat JSON object per sample, which Lichtblick and `PlotJuggler` plot as it is.
pub(crate) struct Topic {
    /// What it carries.
    pub(crate) quantity: Quantity,
    /// Name in the file.
    pub(crate) name: &'static str,
    /// Field of the value.
    pub(crate) field: &'static str,
    /// The value in words.
    meaning: &'static str,
}

/// Every topic, in the order of [`Quantity::ALL`].
pub(crate) const TOPICS: [Topic; Quantity::ALL.len()] = [
    Topic {
        quantity: Quantity::Roll,
        name: "/roll",
        field: "roll_rad",
        meaning: "roll angle [rad], starboard down positive",
    },
    Topic {
        quantity: Quantity::Force,
        name: "/force",
        field: "force_n",
        meaning: "force of the oscillator rod [N], positive where it rolls the model to starboard",
    },
    Topic {
        quantity: Quantity::Moment,
        name: "/moment",
        field: "moment_n_m",
        meaning: "roll exciting moment [N m]",
    },
    Topic {
        quantity: Quantity::Speed,
        name: "/speed",
        field: "speed_m_s",
        meaning: "carriage speed [m/s], ahead positive",
    },
];

impl Topic {
    /// Name of the topic's schema.
    pub(crate) fn schema_name(&self) -> String {
        format!("{PROFILE}.{}", self.quantity.name())
    }

    /// JSON Schema of the topic's messages.
    pub(crate) fn schema(&self) -> Vec<u8> {
        let schema = json!({
            "title": self.schema_name(),
            "type": "object",
            "properties": {
                TIME_FIELD: {
                    "type": "number",
                    "description": "time [s] on the recording's own time base",
                },
                self.field: { "type": "number", "description": self.meaning },
            },
            "required": [TIME_FIELD, self.field],
        });
        schema.to_string().into_bytes()
    }

    /// Writes the message of one sample, whose numbers are finite.
    pub(crate) fn write_message(&self, sample: &Sample, message: &mut Vec<u8>) {
        message.clear();
        let (field, time_s, value) = (self.field, sample.time_s, sample.value);
        // The debug form of a finite f64 is its shortest decimal that reads back to the bit.
        let written = write!(message, "{{\"{TIME_FIELD}\":{time_s:?},\"{field}\":{value:?}}}");
        written.expect("writing to memory cannot fail");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_stands_in_the_order_of_the_quantities() {
        assert!(TOPICS.iter().map(|topic| topic.quantity).eq(Quantity::ALL));
    }
}
