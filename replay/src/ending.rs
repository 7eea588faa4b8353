//! What one of our recordings says about its own end, when that was not as it should be.

use std::collections::BTreeMap;
use std::path::Path;

use crate::note::{Note, counted};

/// A note on a recording that was cut short, from its metadata; none when nothing is missing.
pub(crate) fn note(path: &Path, metadata: &BTreeMap<String, String>) -> Option<Note> {
    let number = |key: &str| metadata.get(key).and_then(|text| text.parse().ok()).unwrap_or(0);
    let status = metadata.get("exit_status").map_or("success", String::as_str);
    let missing = [
        ("unrecorded", "record", "came after recording had stopped"),
        ("torn_bytes", "byte", "at its end never reached the disk whole"),
        ("spoilt_bytes", "byte", "of it were spoilt by the disk"),
        ("unreadable", "message", "became unreadable by that"),
    ];
    let missing: Vec<String> = missing
        .into_iter()
        .filter(|(key, ..)| number(key) > 0)
        .map(|(key, what, happened)| format!("{} {happened}", counted(number(key), what)))
        .collect();
    if missing.is_empty() && !matches!(status, "recovered" | "fail" | "abort") {
        return None;
    }
    let reason = metadata.get("reason").map_or("", String::as_str);
    let ended = if status == "recovered" { "was recovered" } else { "ended early" };
    let told = std::iter::once(format!("\"{}\" {ended}: {reason}", path.display()));
    Some(Note::lost(told.chain(missing).collect::<Vec<_>>().join("; ")))
}
