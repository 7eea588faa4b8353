//! What `rolltank diagnose --json` says of a campaign.

use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;

/// A cause that the program names, with what it says these runs cannot part from it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cause {
    /// Name of the effect.
    pub(crate) effect: String,
    /// Names that would do as well.
    pub(crate) equivalent_to: Vec<String>,
}

/// The answer of the program.
#[derive(Clone, Debug)]
pub(crate) struct Verdict {
    /// `adequate`, `named`, `ambiguous` or `unexplained`.
    pub(crate) word: String,
    /// What it names, in order of entry.
    pub(crate) causes: Vec<Cause>,
    /// The whole answer.
    pub(crate) json: Value,
}

/// Runs the program on a campaign folder.
///
/// # Errors
/// What went wrong, with what the program told on standard error.
pub(crate) fn diagnose(program: &Path, folder: &Path) -> Result<Verdict, String> {
    let told = Command::new(program)
        .arg("diagnose")
        .arg(folder)
        .arg("--json")
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("{}: {error}", program.display()))?;
    let complaint = String::from_utf8_lossy(&told.stderr);
    let complaint = complaint.trim_end();
    // Exit code 3 is an answer: runs were rejected that were asked for.
    if !matches!(told.status.code(), Some(0 | 3)) {
        return Err(format!("exit {:?}: {complaint}", told.status.code()));
    }
    let json: Value = serde_json::from_slice(&told.stdout)
        .map_err(|error| format!("no JSON ({error}): {complaint}"))?;
    read(json)
}

/// Reads the contract `rolltank.diagnosis/1`.
///
/// # Errors
/// The part that is not there.
pub(crate) fn read(json: Value) -> Result<Verdict, String> {
    if json["schema"] != "rolltank.diagnosis/1" {
        return Err(format!("schema {}", json["schema"]));
    }
    let word = json["verdict"].as_str().ok_or("no verdict")?.to_owned();
    if !["adequate", "named", "ambiguous", "unexplained"].contains(&word.as_str()) {
        return Err(format!("unknown verdict {word}"));
    }
    let names = |list: &Value| -> Vec<String> {
        let all = list.as_array().into_iter().flatten();
        all.filter_map(|name| name.as_str().map(str::to_owned)).collect()
    };
    let mut causes = Vec::new();
    for cause in json["causes"].as_array().ok_or("no causes")? {
        let effect = cause["effect"].as_str().ok_or("a cause without effect")?.to_owned();
        causes.push(Cause { effect, equivalent_to: names(&cause["equivalent_to"]) });
    }
    if (word == "named" || word == "ambiguous") && causes.is_empty() {
        return Err(format!("verdict {word} without a cause"));
    }
    Ok(Verdict { word, causes, json })
}
