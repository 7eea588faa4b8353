//! A small campaign folder for stories about the program: one decay at rest, written as a table.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;

/// A campaign file that is right: every story breaks one thing in it.
pub(crate) const CAMPAIGN: &str = r#"name = "one decay"
[hull]
length_pp_m = 2.5
beam_m = 0.387
draft_m = 0.132
displacement_m3 = 0.110
gm_m = 0.074
[tank]
carriage_max_speed_m_s = 2.0
[columns]
time = { column = "t", unit = "s" }
roll = { column = "roll", unit = "deg" }
[[recording]]
file = "pass_01.csv"
condition = "bare hull"
speed_m_s = 0.0
"#;

/// A campaign folder that vanishes with the story.
pub(crate) struct CampaignFolder {
    folder: tempfile::TempDir,
}

impl CampaignFolder {
    /// A campaign of one decay, right in every respect.
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let campaign = Self { folder };
        campaign.write("campaign.toml", CAMPAIGN);
        campaign.write("pass_01.csv", decay(0.0));
        campaign
    }

    /// The same with one passage of the campaign file replaced.
    pub(crate) fn with(from: &str, to: &str) -> Self {
        assert!(CAMPAIGN.contains(from), "{from}");
        let campaign = Self::new();
        campaign.write("campaign.toml", CAMPAIGN.replace(from, to));
        campaign
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path().join(name);
        fs::create_dir_all(path.parent().expect("it lies in the folder")).expect("it can be made");
        fs::write(path, content).expect("the disk has room");
    }

    /// Replaces the recording's line `number`, counted from 1 at the header.
    pub(crate) fn replace_row(&self, number: usize, row: &str) {
        let text = fs::read_to_string(self.path().join("pass_01.csv")).expect("a table");
        let mut rows: Vec<&str> = text.lines().collect();
        rows[number - 1] = row;
        self.write("pass_01.csv", rows.join("\n"));
    }

    /// Every file below the folder with its bytes.
    pub(crate) fn snapshot(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut files = BTreeMap::new();
        let mut folders = vec![self.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).expect("it can be read") {
                let path = entry.expect("it can be read").path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let relative =
                        path.strip_prefix(self.path()).expect("it lies in the folder").to_owned();
                    files.insert(relative, fs::read(&path).expect("it can be read"));
                }
            }
        }
        files
    }
}

/// What the program said and how it ended.
#[derive(Debug)]
pub(crate) struct Told {
    pub(crate) exit: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

/// Runs the built program in the folder of a campaign, which it names `.`.
pub(crate) fn rolltank(folder: &Path, arguments: &[&str]) -> Told {
    let mut command = Command::cargo_bin("rolltank").expect("the program is built");
    let output = command.current_dir(folder).env_remove("RUST_LOG").args(arguments).output();
    let output = output.expect("the program runs");
    Told {
        exit: output.status.code().expect("the program was not killed"),
        out: String::from_utf8(output.stdout).expect("text"),
        err: String::from_utf8(output.stderr).expect("text"),
    }
}

/// A table of a still stretch, a held heel of 15 deg and a decay at 5.7 rad/s, at 100 Hz.
///
/// The roll is rounded to 0.01 deg, as a digitiser does; its last digit wanders like noise.
pub(crate) fn decay(start_s: f64) -> String {
    let mut table = String::from("t,roll\n");
    for k in 0..3000_u32 {
        let t = f64::from(k) * 0.01;
        let since = t - 6.0;
        let roll_deg = if t < 3.0 {
            0.0
        } else if since < 0.0 {
            15.0 * (0.5 - 0.5 * (std::f64::consts::PI * (t - 3.0).min(1.0)).cos())
        } else {
            15.0 * (-0.15 * since).exp() * (5.7 * since).cos()
        };
        let digit = f64::from((k * 7919) % 5) - 2.0;
        let rounded = (roll_deg * 100.0 + 0.5 * digit).round() / 100.0;
        writeln!(table, "{:.3},{rounded:.2}", start_s + t).expect("memory has room");
    }
    table
}
