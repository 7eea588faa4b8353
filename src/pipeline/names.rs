//! Run ids: unique in the campaign, safe in a file name.

use std::collections::BTreeSet;
use std::path::Path;

use crate::campaign::Recording;

/// One label per recording; a run's id is its label and its number in the recording.
///
/// The label is the file's stem. Stems that two recordings share are told apart by their folders,
/// then by a number; letters of either case count as the same, as some file systems hold.
pub fn labels(recordings: &[Recording]) -> Vec<String> {
    let stems: Vec<String> = recordings.iter().map(|recording| stem(&recording.name)).collect();
    let shared = |label: &str| {
        stems.iter().filter(|stem| stem.to_lowercase() == label.to_lowercase()).count() > 1
    };
    let mut taken = BTreeSet::new();
    let mut labels = Vec::with_capacity(recordings.len());
    for (recording, stem) in recordings.iter().zip(&stems) {
        let label = if shared(stem) { safe(&recording.name) } else { stem.clone() };
        let mut unique = label.clone();
        let mut number = 2;
        while !taken.insert(unique.to_lowercase()) {
            unique = format!("{label}.{number}");
            number += 1;
        }
        labels.push(unique);
    }
    labels
}

fn stem(name: &str) -> String {
    let stem = Path::new(name).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    safe(&stem.unwrap_or_else(|| name.to_owned()))
}

/// Letters, digits, `_`, `-` and inner dots stay; all else becomes `_`.
fn safe(name: &str) -> String {
    let kept: String = name
        .chars()
        .map(|c| if c.is_alphanumeric() || matches!(c, '_' | '-' | '.') { c } else { '_' })
        .collect();
    let trimmed = kept.trim_matches('.');
    if trimmed.is_empty() { "recording".to_owned() } else { trimmed.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::labels;
    use crate::campaign::Recording;

    fn labels_of(names: &[&str]) -> Vec<String> {
        let recording = |name: &&str| Recording {
            name: (*name).to_owned(),
            files: Vec::new(),
            condition: String::new(),
            speed_m_s: None,
            line: None,
        };
        labels(&names.iter().map(recording).collect::<Vec<_>>())
    }

    #[test]
    fn a_run_is_named_after_its_file() {
        assert_eq!(labels_of(&["runs/pass_01.csv", "pass_02.mcap"]), ["pass_01", "pass_02"]);
    }

    #[test]
    fn files_of_the_same_name_in_two_folders_keep_their_runs_apart() {
        assert_eq!(labels_of(&["am/p.csv", "pm/P.csv"]), ["am_p.csv", "pm_P.csv"]);
        assert_eq!(labels_of(&["a/p.csv", "a p.csv", "b/p.csv"]), ["a_p.csv", "a_p", "b_p.csv"]);
        assert_eq!(labels_of(&["a?.csv", "a*.csv"]), ["a_.csv", "a_.csv.2"]);
    }

    #[test]
    fn no_name_leaves_its_folder() {
        assert_eq!(labels_of(&["../..csv"]), ["recording"]);
        assert_eq!(labels_of(&["a/ pass 1: \"x\".csv"]), ["_pass_1___x_"]);
    }
}
