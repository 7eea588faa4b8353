//! The one table of topics beside the samples: raw bytes, runs, calibrations, with their schemas.

use std::borrow::Cow;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use serde::{Deserialize, Serialize};
use serde_json::{Map, json};

use crate::record::{Direction, Raw, Record};
use crate::topics::{PROFILE, TIME_FIELD};

/// What begins the name of the topic of a device's bytes.
pub(crate) const RAW_PREFIX: &str = "/raw/";
/// Place in [`DOCUMENTS`] of the raw bytes, whose topics carry the devices' names.
pub(crate) const RAW: usize = 0;
/// Place in [`DOCUMENTS`] of the runs' beginnings.
pub(crate) const RUN_START: usize = 5;
/// Place in [`DOCUMENTS`] of the runs' ends.
pub(crate) const RUN_STOP: usize = 6;

/// One kind of document, a flat JSON object that Lichtblick shows as it is.
pub(crate) struct Document {
    /// Topic in the file; for raw bytes only its beginning.
    pub(crate) topic: &'static str,
    /// The kind's name in its schema.
    name: &'static str,
    /// What it is, in words.
    meaning: &'static str,
    /// Fields beside the time, each with its JSON type.
    fields: &'static [(&'static str, &'static str)],
    /// Fields that may be left out.
    optional: &'static [&'static str],
    decode: fn(&[u8]) -> serde_json::Result<Record>,
}

macro_rules! decoder {
    ($kind:ident) => {
        |json| serde_json::from_slice(json).map(Record::$kind)
    };
}

/// Every kind of document.
pub(crate) const DOCUMENTS: [Document; 12] = [
    Document {
        topic: RAW_PREFIX,
        name: "raw",
        meaning: "bytes as they passed the port of a device, in base64",
        fields: &[("device", "string"), ("direction", "string"), ("bytes", "string")],
        optional: &[],
        decode: |json| serde_json::from_slice::<RawText>(json).and_then(RawText::record),
    },
    Document {
        topic: "/device",
        name: "device",
        meaning: "an attached instrument; settings is a TOML table",
        fields: &[
            ("device", "string"),
            ("profile", "string"),
            ("port", "string"),
            ("settings", "string"),
        ],
        optional: &[],
        decode: decoder!(Device),
    },
    Document {
        topic: "/calibration",
        name: "calibration",
        meaning: "a channel's calibration, in force from here on; definition is a TOML table",
        fields: &[
            ("device", "string"),
            ("channel", "string"),
            ("by", "string"),
            ("taken", "string"),
            ("definition", "string"),
        ],
        optional: &[],
        decode: decoder!(Calibration),
    },
    Document {
        topic: "/campaign",
        name: "campaign",
        meaning: "the campaign file, in force from here on",
        fields: &[("text", "string")],
        optional: &[],
        decode: decoder!(Campaign),
    },
    Document {
        topic: "/clock",
        name: "clock",
        meaning: "the computer's clocks, read together",
        fields: &[
            ("monotonic_ns", "number"),
            ("realtime_ns", "number"),
            ("tai_offset_s", "number"),
        ],
        optional: &[],
        decode: decoder!(Clock),
    },
    Document {
        topic: "/run_start",
        name: "run_start",
        meaning: "a run was found to begin",
        fields: &[
            ("run", "string"),
            ("kind", "string"),
            ("condition", "string"),
            ("start_s", "number"),
        ],
        optional: &[],
        decode: decoder!(RunStart),
    },
    Document {
        topic: "/run_stop",
        name: "run_stop",
        meaning: "a run ended, with what was counted on each channel",
        fields: &[
            ("run", "string"),
            ("start_s", "number"),
            ("end_s", "number"),
            ("exit_status", "string"),
            ("reason", "string"),
            ("counts", "array"),
        ],
        optional: &[],
        decode: decoder!(RunStop),
    },
    Document {
        topic: "/rejection",
        name: "rejection",
        meaning: "a stretch that gave no run, and why",
        fields: &[("start_s", "number"), ("end_s", "number"), ("reason", "string")],
        optional: &[],
        decode: decoder!(Rejection),
    },
    Document {
        topic: "/result",
        name: "result",
        meaning: "what was identified from a run, as JSON text",
        fields: &[("run", "string"), ("schema", "string"), ("document", "string")],
        optional: &[],
        decode: decoder!(Result),
    },
    Document {
        topic: "/gap",
        name: "gap",
        meaning: "a stretch without samples",
        fields: &[
            ("device", "string"),
            ("channel", "string"),
            ("start_s", "number"),
            ("end_s", "number"),
            ("lost", "number"),
            ("reason", "string"),
        ],
        optional: &["lost"],
        decode: decoder!(Gap),
    },
    Document {
        topic: "/loss",
        name: "loss",
        meaning: "samples that were lost, repeated, over range or damaged",
        fields: &[
            ("device", "string"),
            ("channel", "string"),
            ("kind", "string"),
            ("count", "number"),
        ],
        optional: &[],
        decode: decoder!(Loss),
    },
    Document {
        topic: "/quality",
        name: "quality",
        meaning: "what is wrong with a channel's samples from the next on; empty: nothing",
        fields: &[("device", "string"), ("channel", "string"), ("flags", "string")],
        optional: &[],
        decode: decoder!(Quality),
    },
];

/// Raw bytes as their message.
#[derive(Serialize, Deserialize)]
struct RawText<'a> {
    time_s: f64,
    #[serde(borrow)]
    device: Cow<'a, str>,
    direction: Direction,
    #[serde(borrow)]
    bytes: Cow<'a, str>,
}

impl RawText<'_> {
    fn record(self) -> serde_json::Result<Record> {
        let bytes = BASE64.decode(self.bytes.as_bytes());
        let bytes = bytes.map_err(<serde_json::Error as serde::de::Error>::custom)?;
        let (device, time_s, direction) = (self.device.into(), self.time_s, self.direction);
        Ok(Record::Raw(Raw { device, time_s, direction, bytes }))
    }
}

impl Document {
    /// Name of the schema.
    pub(crate) fn schema_name(&self) -> String {
        format!("{PROFILE}.{}", self.name)
    }

    /// JSON Schema of the messages.
    pub(crate) fn schema(&self) -> Vec<u8> {
        let time = json!({
            "type": "number",
            "description": "time [s] on the recording's own time base",
        });
        let mut properties = Map::from_iter([(TIME_FIELD.to_owned(), time)]);
        for (field, kind) in self.fields {
            let described = match (*field, *kind) {
                ("bytes", _) => json!({ "type": "string", "contentEncoding": "base64" }),
                (_, "array") => json!({ "type": "array", "items": { "type": "object" } }),
                (_, kind) => json!({ "type": kind }),
            };
            properties.insert((*field).to_owned(), described);
        }
        let required = properties.keys().filter(|field| !self.optional.contains(&field.as_str()));
        let schema = json!({
            "title": self.schema_name(),
            "description": self.meaning,
            "type": "object",
            "required": required.collect::<Vec<_>>(),
            "properties": properties,
        });
        schema.to_string().into_bytes()
    }

    /// The record of a message.
    pub(crate) fn decode(&self, message: &[u8]) -> serde_json::Result<Record> {
        (self.decode)(message)
    }
}

/// The kind of the document on a topic.
pub(crate) fn document_of(topic: &str) -> Option<&'static Document> {
    let is_raw = topic.starts_with(RAW_PREFIX);
    DOCUMENTS.iter().find(|document| document.topic == if is_raw { RAW_PREFIX } else { topic })
}

/// Writes the message of a record other than a sample and says which of [`DOCUMENTS`] it is.
pub(crate) fn write_document(record: &Record, message: &mut Vec<u8>) -> Option<usize> {
    message.clear();
    let (place, written) = match record {
        Record::Sample(_) => return None,
        Record::Raw(raw) => {
            let Raw { device, time_s, direction, bytes } = raw;
            let (device, bytes) = (Cow::from(&**device), BASE64.encode(bytes).into());
            let text = RawText { time_s: *time_s, device, direction: *direction, bytes };
            (RAW, serde_json::to_writer(message, &text))
        }
        Record::Device(device) => (1, serde_json::to_writer(message, device)),
        Record::Calibration(calibration) => (2, serde_json::to_writer(message, calibration)),
        Record::Campaign(campaign) => (3, serde_json::to_writer(message, campaign)),
        Record::Clock(clock) => (4, serde_json::to_writer(message, clock)),
        Record::RunStart(start) => (RUN_START, serde_json::to_writer(message, start)),
        Record::RunStop(stop) => (RUN_STOP, serde_json::to_writer(message, stop)),
        Record::Rejection(rejection) => (7, serde_json::to_writer(message, rejection)),
        Record::Result(result) => (8, serde_json::to_writer(message, result)),
        Record::Gap(gap) => (9, serde_json::to_writer(message, gap)),
        Record::Loss(loss) => (10, serde_json::to_writer(message, loss)),
        Record::Quality(change) => (11, serde_json::to_writer(message, change)),
    };
    written.expect("writing to memory cannot fail, and no key is anything but text");
    Some(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{CampaignFile, Loss, LossKind};

    #[test]
    fn the_places_that_are_named_are_those_of_the_table() {
        assert_eq!(DOCUMENTS[RAW].topic, RAW_PREFIX);
        assert_eq!(DOCUMENTS[RUN_START].topic, "/run_start");
        assert_eq!(DOCUMENTS[RUN_STOP].topic, "/run_stop");
    }

    #[test]
    fn a_record_is_written_in_its_place_and_read_back_from_there() {
        let (device, channel) = ("daq".to_owned(), "roll".to_owned());
        let loss = Loss { time_s: 0.1, device, channel, kind: LossKind::OverRange, count: 3 };
        let raw = Raw {
            device: "daq".into(),
            time_s: 0.1 + 0.2,
            direction: Direction::Received,
            bytes: vec![0, 0xff, b'"'],
        };
        let campaign = CampaignFile { time_s: 0.0, text: "a = \"b\"".to_owned() };
        let mut message = Vec::new();
        for (record, topic) in [
            (Record::Loss(loss), "/loss"),
            (Record::Raw(raw), "/raw/daq"),
            (Record::Campaign(campaign), "/campaign"),
        ] {
            let place = write_document(&record, &mut message).expect("it is a document");
            let document = document_of(topic).expect("the topic is known");
            assert_eq!(document.schema_name(), DOCUMENTS[place].schema_name());
            assert_eq!(document.decode(&message).expect("it reads back"), record);
        }
        assert!(document_of("/rawhide").is_none());
    }
}
