//! The house rules that the compiler does not hold: layers, owners of crates, sizes, front lines.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The layers of `src`, top first; each may name those below it.
const LAYERS: [&str; 23] = [
    "main",
    "command",
    "bench",
    "live",
    "page",
    "pipeline",
    "report",
    "catalogue",
    "reference",
    "tank",
    "diagnosis",
    "progress",
    "uncertainty",
    "procedure",
    "results",
    "inverse",
    "campaign",
    "judgement",
    "model",
    "settling",
    "run",
    "roll",
    "hull",
];

/// Crates that only some layers or workspace members may name, each with its owners.
const OWNERS: [(&str, &[&str]); 27] = [
    ("clap", &["src/main", "src/command"]),
    ("indicatif", &["src/command"]),
    ("tracing_subscriber", &["src/main"]),
    ("maud", &["src/report"]),
    ("plotters", &["src/report"]),
    ("rusqlite", &["src/catalogue"]),
    ("faer", &["src/inverse", "src/reference", "src/campaign/known_loads.rs"]),
    ("statrs", &["src/inverse", "src/uncertainty", "src/bench"]),
    ("rand", &["src/inverse", "src/tank", "src/reference", "src/bench"]),
    ("rand_chacha", &["src/inverse", "src/tank", "src/reference", "src/bench"]),
    ("rand_distr", &["src/inverse", "src/tank", "src/reference", "src/bench"]),
    (
        "toml",
        &[
            "src/campaign",
            "src/tank",
            "src/model",
            "devices/src/attachment",
            "devices/src/driver",
            "devices/src/emulator",
            "devices/src/profile",
            "devices/src/setup",
        ],
    ),
    ("csv", &["src/campaign/plan_table", "src/report", "replay/src"]),
    ("parquet", &["src/report/tables", "src/report/mod"]),
    ("sha2", &["src/pipeline/sha256"]),
    ("mcap", &["replay/src"]),
    ("tokio", &["src/live", "src/page"]),
    ("axum", &["src/page"]),
    ("prometheus_client", &["src/page"]),
    ("futures_core", &["src/page"]),
    ("sd_notify", &["src/live"]),
    ("jiff", &["src/page"]),
    ("serialport", &["devices/src/port"]),
    ("thread_priority", &["devices/src/realtime"]),
    ("rustix", &["devices/src/clock", "devices/src/emulator", "replay/src/recorder/disk"]),
    ("crc", &["devices/src/driver"]),
    ("cobs", &["devices/src/driver"]),
];

const LINES_PER_FILE: usize = 400;
const COLUMNS_PER_LINE: usize = 100;

struct File {
    /// Path from the top of the workspace, with forward slashes.
    path: String,
    text: String,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every Rust file of the workspace.
fn rust_files() -> Vec<File> {
    let mut files = Vec::new();
    let mut folders: Vec<PathBuf> =
        ["src", "devices", "replay", "tests"].map(|folder| root().join(folder)).to_vec();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of the workspace") {
            let path = entry.expect("an entry of it").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let relative = path.strip_prefix(root()).expect("it lies in the workspace");
                let text = fs::read_to_string(&path).expect("source files are text");
                files.push(File { path: relative.to_string_lossy().replace('\\', "/"), text });
            }
        }
    }
    assert!(files.len() > 40, "only {} files found", files.len());
    files
}

/// The modules from the crate root down to a file of `src`: `src/run/mod.rs` is `["run"]`.
fn module_path(path: &str) -> Vec<&str> {
    let inside = path.trim_start_matches("src/").trim_end_matches(".rs");
    let mut modules: Vec<&str> = inside.split('/').collect();
    if modules.last() == Some(&"mod") {
        modules.pop();
    }
    modules
}

/// The words that follow `prefix` where it does not continue a longer word or path.
fn words_after<'t>(text: &'t str, prefix: &str) -> Vec<&'t str> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(prefix)
        .filter(|(at, _)| !text[..*at].ends_with(|c: char| is_word(c) || c == ':'))
        .map(|(at, _)| {
            let rest = &text[at + prefix.len()..];
            &rest[..rest.find(|c: char| !is_word(c)).unwrap_or(rest.len())]
        })
        .collect()
}

/// The layers that a file of `src` names through `crate::` or through enough `super::`.
fn layers_named<'t>(text: &'t str, modules: &[&str]) -> BTreeSet<&'t str> {
    let to_root = "super::".repeat(modules.len());
    let mut named = words_after(text, "crate::");
    named.extend(words_after(text, &to_root));
    // One level deeper, from inside a `mod tests` of the file.
    named.extend(words_after(text, &format!("{to_root}super::")));
    named.into_iter().filter(|word| LAYERS.contains(word)).collect()
}

fn rank(layer: &str) -> usize {
    LAYERS.iter().position(|known| *known == layer).unwrap_or_else(|| panic!("layer {layer}"))
}

fn report(mistakes: &[String]) {
    assert!(mistakes.is_empty(), "\n{}\n", mistakes.join("\n"));
}

#[test]
fn no_layer_names_one_above_it() {
    let mut mistakes = Vec::new();
    for File { path, text } in rust_files() {
        if !path.starts_with("src/") || path == "src/lib.rs" {
            continue;
        }
        let modules = module_path(&path);
        let above = layers_named(&text, &modules)
            .into_iter()
            .filter(|named| rank(named) < rank(modules[0]));
        mistakes.extend(above.map(|named| format!("{path} names the higher layer {named}")));
        if text.contains("use crate::{") {
            mistakes.push(format!("{path}: one `use crate::layer` a line, so that layers show"));
        }
    }
    report(&mistakes);
}

/// The folders of `src/diagnosis`, top first; each may name those below it.
const STOREYS: [&str; 5] = ["told", "next_run", "search", "fit", "record"];

/// The files of `src/diagnosis` that one of them names, as paths from there without their endings.
fn files_named(text: &str, path: &str, all: &BTreeSet<String>) -> BTreeSet<String> {
    let own_folder =
        path.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
    let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let mut named = BTreeSet::new();
    for (prefix, folder) in [("super::", own_folder.as_str()), ("crate::diagnosis::", "")] {
        for (at, _) in text.match_indices(prefix).filter(|(at, _)| !text[..*at].ends_with(is_path))
        {
            let rest = &text[at + prefix.len()..];
            let rest = &rest[..rest.find(|c| !is_path(c)).unwrap_or(rest.len())];
            let words: Vec<&str> = rest.split("::").collect();
            let paths = (1..=words.len()).map(|n| format!("{folder}{}", words[..n].join("/")));
            named.extend(paths.filter(|path| all.contains(path)));
        }
    }
    named
}

#[test]
fn the_files_of_the_diagnosis_stand_on_one_another_and_never_in_a_circle() {
    let files: Vec<(String, String)> = rust_files()
        .into_iter()
        .filter_map(|File { path, text }| {
            let inside = path.strip_prefix("src/diagnosis/")?.strip_suffix(".rs")?;
            let program = text.split("#[cfg(test)]").next().unwrap_or_default().to_owned();
            (!inside.ends_with("mod")).then(|| (inside.to_owned(), program))
        })
        .collect();
    let all: BTreeSet<String> = files.iter().map(|(path, _)| path.clone()).collect();
    let storey = |path: &str| {
        let folder = path.split_once('/').map(|(folder, _)| folder);
        folder.map(|folder| STOREYS.iter().position(|one| *one == folder).expect("a storey"))
    };
    let mut mistakes = Vec::new();
    let mut standing: Vec<(String, BTreeSet<String>)> = Vec::new();
    for (path, text) in &files {
        let named = files_named(text, path, &all);
        for other in &named {
            if let (Some(own), Some(its)) = (storey(path), storey(other))
                && its < own
            {
                mistakes.push(format!("{path} names {other} above it"));
            }
        }
        if text.contains("use super::{") || text.contains("use crate::diagnosis::{") {
            mistakes.push(format!("{path}: one file a line, so that storeys show"));
        }
        standing.push((path.clone(), named));
    }
    // What names nothing that is left, or is named by nothing, is taken away: circles stay.
    loop {
        let left: BTreeSet<String> = standing.iter().map(|(path, _)| path.clone()).collect();
        let named: BTreeSet<String> = standing.iter().flat_map(|(_, all)| all.clone()).collect();
        standing.retain(|(path, all)| named.contains(path) && !all.is_disjoint(&left));
        if standing.len() == left.len() {
            break;
        }
    }
    mistakes.extend(standing.iter().map(|(path, _)| format!("{path} stands in a circle")));
    report(&mistakes);
}

#[test]
fn a_file_of_the_diagnosis_is_seen_however_it_is_named() {
    let all = ["fit/survey", "fit/solve", "whole"].map(str::to_owned).into();
    let named = |text: &str, path: &str| files_named(text, path, &all).into_iter().next();
    let survey = Some("fit/survey".to_owned());
    assert_eq!(named("use super::survey::Fit;", "fit/solve"), survey);
    assert_eq!(named("let x = crate::diagnosis::fit::survey::new();", "told/gain"), survey);
    assert_eq!(named("use super::fit::survey::{Fit, Survey};", "whole"), survey);
    assert_eq!(named("use super::survey::Fit;", "told/gain"), None);
}

#[test]
fn a_name_from_above_is_seen_however_it_is_written() {
    let upward = ["use crate::pipeline::replay;", "let x = super::pipeline::replay();"];
    for text in upward {
        assert!(layers_named(text, &["hull"]).contains("pipeline"), "{text}");
    }
    assert!(layers_named("use super::super::report::x;", &["run", "noise"]).contains("report"));
    assert!(layers_named("use super::report::x;", &["pipeline", "files"]).is_empty());
    assert!(layers_named("use mycrate::report::x;", &["hull"]).is_empty());
}

#[test]
fn every_layer_is_declared_and_every_module_is_a_layer() {
    let lib = fs::read_to_string(root().join("src/lib.rs")).unwrap();
    let declared: BTreeSet<&str> = words_after(&lib, "pub mod ").into_iter().collect();
    let layers: BTreeSet<&str> = LAYERS.into_iter().filter(|layer| *layer != "main").collect();
    assert_eq!(declared, layers);
}

#[test]
fn a_crate_is_named_only_by_its_owners() {
    let mut mistakes = Vec::new();
    for File { path, text } in rust_files() {
        if path.starts_with("tests/") || path.contains("/tests/") {
            continue;
        }
        // The unit tests at the end of a file may draw noise of their own.
        let program = text.split("#[cfg(test)]").next().unwrap_or_default();
        for (name, owners) in OWNERS {
            let named = !words_after(program, &format!("{name}::")).is_empty();
            if named && !owners.iter().any(|owner| path.starts_with(owner)) {
                mistakes.push(format!("{path} names {name}, which belongs to {owners:?}"));
            }
        }
    }
    report(&mistakes);
}

#[test]
fn every_story_is_in_the_table_of_contents() {
    let contents = fs::read_to_string(root().join("tests/main.rs")).unwrap();
    let listed: BTreeSet<String> =
        words_after(&contents, "mod ").into_iter().map(str::to_owned).collect();
    let stories = rust_files().into_iter().filter_map(|file| {
        let name = file.path.strip_prefix("tests/")?.strip_suffix(".rs")?;
        // A folder is a story, or what stories share, by its front file.
        let name = name.strip_suffix("/mod").unwrap_or(name).to_owned();
        (name != "main" && !name.contains('/')).then_some(name)
    });
    assert_eq!(stories.collect::<BTreeSet<_>>(), listed);
}

#[test]
fn every_file_opens_with_its_job_and_stays_short() {
    let mut mistakes = Vec::new();
    for File { path, text } in rust_files() {
        if !text.starts_with("//! ") {
            mistakes.push(format!("{path} does not open with a `//!` sentence"));
        }
        let n_lines = text.lines().count();
        if n_lines > LINES_PER_FILE {
            mistakes.push(format!("{path} has {n_lines} lines, at most {LINES_PER_FILE}"));
        }
        for (number, line) in text.lines().enumerate() {
            if line.chars().count() > COLUMNS_PER_LINE {
                let number = number + 1;
                mistakes.push(format!("{path}:{number} is longer than {COLUMNS_PER_LINE} columns"));
            }
        }
    }
    report(&mistakes);
}

#[test]
fn the_readme_shows_the_two_commands() {
    // A checkout of the code alone has no README to hold to anything.
    let Ok(readme) = fs::read_to_string(root().join("README.md")) else { return };
    for command in ["-- demo", "cargo test --workspace"] {
        assert!(readme.contains(command), "README.md does not show `{command}`");
    }
}
