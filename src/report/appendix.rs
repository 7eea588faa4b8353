//! The appendix: what the numbers came from and what computed them.

use maud::{Markup, html};
use serde::Serialize;

use super::document::{self, number_cell, section, table, text_cell};
use super::number::UNKNOWN;

/// Name and version of the JSON.
const SCHEMA: &str = "rolltank.appendix/1";

/// What a report rests on.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Appendix {
    /// Seed of everything random; the exact method draws nothing.
    pub seed: u64,
    /// Files of the recordings.
    pub files: Vec<RecordedFile>,
    /// Instruments, as far as recordings tell them.
    pub instruments: Vec<AttachedInstrument>,
    /// Calibrations under which was recorded, as far as recordings tell them.
    pub calibrations: Vec<ChannelCalibration>,
}

/// A file of a recording, to be known again by its sum.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RecordedFile {
    /// Name of the recording, as in the campaign file.
    pub recording: String,
    /// The file, relative to the campaign's folder.
    pub file: String,
    /// Its size [bytes]; none when it is not there any more.
    pub n_bytes: Option<u64>,
    /// SHA-256 in hexadecimal digits.
    pub sha256: Option<String>,
}

/// An instrument that was attached.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct AttachedInstrument {
    /// Name of the first recording that tells of it.
    pub recording: String,
    /// Name of the device.
    pub device: String,
    /// Name of its profile.
    pub profile: String,
    /// Its port.
    pub port: String,
}

impl AttachedInstrument {
    /// Whether it is the same instrument, whatever the recording.
    pub fn is_like(&self, other: &Self) -> bool {
        (&self.device, &self.profile, &self.port) == (&other.device, &other.profile, &other.port)
    }
}

/// A calibration of a channel.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ChannelCalibration {
    /// Name of the first recording made under it.
    pub recording: String,
    /// Name of the device.
    pub device: String,
    /// Name of the channel.
    pub channel: String,
    /// Zero and curve.
    pub definition: String,
    /// Who took it.
    pub by: String,
    /// When.
    pub taken: String,
}

impl ChannelCalibration {
    /// Whether it is the same calibration, whatever the recording.
    pub fn is_like(&self, other: &Self) -> bool {
        let own = (&self.device, &self.channel, &self.definition, &self.taken);
        own == (&other.device, &other.channel, &other.definition, &other.taken)
    }
}

/// The appendix as JSON.
///
/// # Panics
///
/// Never: every key is a string, which is all that can fail.
pub(super) fn json(appendix: &Appendix) -> String {
    #[derive(Serialize)]
    struct Document<'a> {
        schema: &'static str,
        version: &'static str,
        #[serde(flatten)]
        appendix: &'a Appendix,
    }
    let version = env!("CARGO_PKG_VERSION");
    let document = Document { schema: SCHEMA, version, appendix };
    let text = serde_json::to_string_pretty(&document).expect("every key is a string");
    text + "\n"
}

/// The page of the appendix.
pub(super) fn page(campaign: &str, appendix: &Appendix) -> Markup {
    let body = html! {
        h1 { "Appendix: what the numbers rest on" }
        p.lead { (campaign) " · " a href="index.html" { "campaign report" } }
        p {
            "Computed by rolltank " (env!("CARGO_PKG_VERSION")) " with seed " (appendix.seed)
            "; the same recordings, campaign file and version give the same bytes."
        }
        (instruments(appendix))
        (calibrations(appendix))
        (files(appendix))
    };
    document::page(&format!("Appendix – {campaign}"), &body)
}

fn instruments(appendix: &Appendix) -> Markup {
    let rows: Vec<Markup> = appendix
        .instruments
        .iter()
        .map(|one| {
            html! {
                (text_cell(&one.device)) (text_cell(&one.profile)) (text_cell(&one.port))
                (text_cell(&one.recording))
            }
        })
        .collect();
    let columns = [("Device", ""), ("Profile", ""), ("Port", ""), ("First in", "")];
    let caption = "Instruments, as the recordings tell them.";
    let untold = "The recordings are tables of numbers, which tell no instrument.";
    told(
        "instruments",
        "Instruments",
        untold,
        (!rows.is_empty()).then(|| table("instruments-table", caption, &columns, &rows)),
    )
}

fn calibrations(appendix: &Appendix) -> Markup {
    let rows: Vec<Markup> = appendix
        .calibrations
        .iter()
        .map(|one| {
            html! {
                (text_cell(&one.device)) (text_cell(&one.channel)) (text_cell(&one.definition))
                (text_cell(&one.by)) (text_cell(&one.taken)) (text_cell(&one.recording))
            }
        })
        .collect();
    let columns = [("Device", ""), ("Channel", ""), ("Calibration", ""), ("By", "")];
    let columns = [&columns[..], &[("Taken", ""), ("From", "")]].concat();
    let caption = "Calibrations in force: SI = curve of the raw reading less its zero.";
    let untold = "The recordings tell no calibration: their channels are taken as written.";
    told(
        "calibrations",
        "Calibrations",
        untold,
        (!rows.is_empty()).then(|| table("calibrations-table", caption, &columns, &rows)),
    )
}

fn files(appendix: &Appendix) -> Markup {
    let rows: Vec<Markup> = appendix
        .files
        .iter()
        .map(|one| {
            let unknown = || UNKNOWN.to_owned();
            html! {
                (text_cell(&one.file))
                (number_cell(&one.n_bytes.map_or_else(unknown, |n| n.to_string())))
                td.sum { (one.sha256.clone().unwrap_or_else(unknown)) }
            }
        })
        .collect();
    let columns = [("File", ""), ("Size", "bytes"), ("SHA-256", "")];
    let caption = "Files of the recordings with their check sums, as sha256sum prints them.";
    told(
        "files",
        "Recordings",
        "There is none.",
        (!rows.is_empty()).then(|| table("files-table", caption, &columns, &rows)),
    )
}

fn told(id: &str, heading: &str, untold: &str, table: Option<Markup>) -> Markup {
    section(id, heading, &table.unwrap_or_else(|| html! { p.note { (untold) } }))
}
