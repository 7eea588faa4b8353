//! The `[[recording]]` tables: which files were recorded, under which condition, at which speed.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use devices::Quantity;

use super::Recording;
use super::live::{DEFAULT_CONDITION, LIVE_FOLDER, described};
use super::mistake::nearest;
use super::tree::{NOT_NEGATIVE, Section};

/// Reads every `[[recording]]` table; `named` tells the channels that `[columns]` names.
pub(super) fn read(
    sections: Vec<Section<'_>>,
    folder: &Path,
    named: &dyn Fn(Quantity) -> bool,
) -> Vec<Recording> {
    let mut recordings = Vec::new();
    let mut first_line: BTreeMap<PathBuf, Option<usize>> = BTreeMap::new();
    for section in sections {
        let Some(recording) = recording(&section, folder, named) else {
            section.close();
            continue;
        };
        let mut own: Vec<PathBuf> =
            recording.files.iter().map(|(_, path)| resolved(path)).collect();
        own.sort();
        own.dedup();
        for path in own {
            if let Some(earlier) = first_line.insert(path, recording.line) {
                let earlier = earlier.map_or(String::new(), |line| format!(" on line {line}"));
                section.mistake(
                    if section.holds("file") { "file" } else { "files" },
                    format!("recording \"{}\" is listed twice, first{earlier}", recording.name),
                    "list every file once; its runs are told apart by the program",
                );
            }
        }
        section.close();
        recordings.push(recording);
    }
    recordings
}

/// Tables with an MCAP file of the same name beside them: what an import of the table leaves.
pub(super) fn copies(paths: &[PathBuf]) -> Vec<(&Path, &Path)> {
    let (mcap, tables): (Vec<&PathBuf>, _) =
        paths.iter().partition(|path| is_self_describing(path));
    let beside = |table: &PathBuf| {
        mcap.iter().find(|path| path.with_extension("") == table.with_extension("")).copied()
    };
    tables
        .into_iter()
        .filter_map(|table| Some((table.as_path(), beside(table)?.as_path())))
        .collect()
}

/// Every recording found in the folder, when the campaign file lists none.
///
/// A file and the links to it are one recording.
pub(super) fn found(folder: &Path, paths: Vec<PathBuf>) -> Vec<Recording> {
    let mut seen = BTreeSet::new();
    paths
        .into_iter()
        .filter(|path| seen.insert(resolved(path)))
        .map(|path| Recording {
            name: slashed(path.strip_prefix(folder).unwrap_or(&path)),
            files: vec![(None, path)],
            condition: DEFAULT_CONDITION.to_owned(),
            speed_m_s: None,
            line: None,
        })
        .map(|found| if is_live(&found) { described(found) } else { found })
        .collect()
}

/// Whether a recording lies where the campaign's own instruments leave theirs.
pub(super) fn is_live(recording: &Recording) -> bool {
    recording.name.starts_with(&format!("{LIVE_FOLDER}/"))
}

/// Those of `found` that are not listed.
pub(super) fn not_in(listed: &[Recording], found: Vec<Recording>) -> Vec<Recording> {
    let files = |recording: &Recording| -> Vec<PathBuf> {
        recording.files.iter().map(|(_, path)| resolved(path)).collect()
    };
    let known: BTreeSet<PathBuf> = listed.iter().flat_map(files).collect();
    found
        .into_iter()
        .filter(|found| files(found).iter().all(|path| !known.contains(path)))
        .collect()
}

/// Whether a file describes its own channels, as our MCAP recordings do.
pub(super) fn is_self_describing(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap"))
}

fn recording(
    section: &Section<'_>,
    folder: &Path,
    named: &dyn Fn(Quantity) -> bool,
) -> Option<Recording> {
    let condition = section.text("condition").unwrap_or(DEFAULT_CONDITION).to_owned();
    let speed_m_s = section.number("speed_m_s", &NOT_NEGATIVE);
    let (name, files) = if section.holds("files") {
        section.leave("file");
        if section.holds("file") {
            section.mistake(
                "file",
                "[[recording]] has both `file` and `files`".to_owned(),
                "use `file` for one file with every channel, `files` for one file a channel",
            );
        }
        per_channel(&section.section("files")?, folder, named)?
    } else {
        section.leave("files");
        let written = section.required_text("file")?;
        (written.to_owned(), vec![(None, existing(section, "file", written, folder)?)])
    };
    Some(Recording { name, files, condition, speed_m_s, line: section.own_line() })
}

type Files = Vec<(Option<Quantity>, PathBuf)>;

fn per_channel(
    files: &Section<'_>,
    folder: &Path,
    named: &dyn Fn(Quantity) -> bool,
) -> Option<(String, Files)> {
    let mut paths = Files::new();
    let mut complete = true;
    for quantity in Quantity::ALL {
        let key = quantity.name();
        let Some(written) = files.text(key) else {
            complete &= !files.holds(key);
            continue;
        };
        let path = existing(files, key, written, folder);
        complete &= path.is_some();
        if !named(quantity) && path.as_deref().is_some_and(|path| !is_self_describing(path)) {
            files.mistake(
                key,
                format!("\"{written}\" carries the {key} channel, which [columns] does not name"),
                format!("add `{key} = {{ column = \"...\", unit = \"...\" }}` below [columns]"),
            );
        }
        paths.extend(path.map(|path| (Some(quantity), path)));
    }
    files.require("roll", "the file with the roll channel");
    let name = files.text("roll").map(str::to_owned);
    files.close();
    if complete { Some((name?, paths)) } else { None }
}

/// The path of a file named in the campaign file, if it is one and lies in the folder.
fn existing(section: &Section<'_>, key: &str, written: &str, folder: &Path) -> Option<PathBuf> {
    let relative = Path::new(written);
    let inside =
        relative.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !inside {
        section.mistake(
            key,
            format!("recording \"{written}\" is outside the campaign folder"),
            "copy it into the folder and name it relative to campaign.toml",
        );
        return None;
    }
    let path = folder.join(relative.components().collect::<PathBuf>());
    if path.is_file() {
        return Some(path);
    }
    let message = if path.is_dir() {
        format!("recording \"{written}\" is a folder, expected a file")
    } else if path.is_symlink() {
        format!("recording \"{written}\" is a link to a file that is not there")
    } else {
        format!("recording \"{written}\" is not there")
    };
    section.mistake(key, message, near_file(&path, folder));
    None
}

fn near_file(path: &Path, folder: &Path) -> String {
    let parent = path.parent().unwrap_or(folder);
    let mut names: Vec<String> = std::fs::read_dir(parent)
        .into_iter()
        .flatten()
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort();
    let wanted = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    names.retain(|name| name != wanted);
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    nearest(wanted, &known).map_or_else(
        || format!("file names are relative to {}", folder.display()),
        |known| format!("did you mean \"{known}\"?"),
    )
}

/// One name for one file, however it was written.
fn resolved(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

/// A relative path with forward slashes, the same on every system.
fn slashed(path: &Path) -> String {
    let parts: Vec<_> = path.components().map(|part| part.as_os_str().to_string_lossy()).collect();
    parts.join("/")
}
