//! The command line of the matrix.

use std::path::PathBuf;

use crate::hidden_tank::campaign::SCATTER;
use crate::hidden_tank::plan::RunSet;

/// What can be asked.
pub(crate) const USAGE: &str = "\
cargo test --test hidden_matrix -- WHAT [HOW]

  WHAT
    --all                     every effect, clean campaigns, invented effects, 50 pairs
    --effects a,b|catalogued  these alone; also `clean`, `invented`, `pairs`
    --tables                  no campaign, only write the tables anew
  HOW
    --sizes 0.5,1,2           by the middle of the range
    --sets rest,speeds,forced
    --seeds 10                seeds 0 to 9; `--seeds 3..5` for 3 and 4
    --scatter 0.03            standard deviation of the run-to-run damping
    --threads 1
    --briefly                 name, size and damping alone, in two thirds of the time: neither what
                              the true model foretells nor the runs that are asked for
    --program FILE            the rolltank to judge; else the one that cargo built
    --outcomes FILE           default target/hidden_effects.jsonl; what is in it is not run again
    --report FILE             default docs/hidden_effects.md
    --lambda                  no diagnosis: print what the base cannot take up
    --play FOLDER             no diagnosis: write the campaigns, the truth beside each
    --towed                   with `--play`: also with the runs that an undecided answer asks for";

/// What to do with the cells.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Errand {
    /// Say what can be asked.
    Help,
    /// Diagnose.
    Matrix,
    /// Write the tables of what is there.
    Tables,
    /// Print lambda.
    Lambda,
    /// Write the campaigns below a folder.
    Play(PathBuf),
}

/// The arguments.
#[derive(Clone, Debug)]
pub(crate) struct Arguments {
    pub(crate) errand: Errand,
    /// Effects and groups by name.
    pub(crate) effects: Vec<String>,
    pub(crate) sizes: Vec<f64>,
    pub(crate) sets: Vec<RunSet>,
    pub(crate) seeds: std::ops::Range<u64>,
    pub(crate) scatter: f64,
    pub(crate) threads: usize,
    /// Leave out what the true model foretells, and the runs that undecided answers ask for.
    pub(crate) is_brief: bool,
    /// Play also the campaigns that undecided answers ask for.
    pub(crate) is_towed: bool,
    pub(crate) program: PathBuf,
    pub(crate) outcomes: PathBuf,
    pub(crate) tables: PathBuf,
}

impl Arguments {
    /// Reads them.
    ///
    /// # Errors
    /// The first argument that is not understood.
    pub(crate) fn read(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let home = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let mut all = Self {
            errand: Errand::Help,
            effects: Vec::new(),
            sizes: vec![0.5, 1.0, 2.0],
            sets: RunSet::ALL.map(|(_, set)| set).to_vec(),
            seeds: 0..10,
            scatter: SCATTER,
            threads: 1,
            is_brief: false,
            is_towed: false,
            program: PathBuf::from(env!("CARGO_BIN_EXE_rolltank")),
            outcomes: home.join("target/hidden_effects.jsonl"),
            tables: home.join("docs/hidden_effects.md"),
        };
        let mut errand = None;
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or(format!("{word} wants a value"));
            match word.as_str() {
                "--all" => {
                    all.effects =
                        ["clean", "catalogued", "invented", "pairs"].map(str::to_owned).to_vec();
                }
                "--effects" => all.effects = value()?.split(',').map(str::to_owned).collect(),
                "--sizes" => all.sizes = numbers(&value()?)?,
                "--sets" => all.sets = sets(&value()?)?,
                "--seeds" => all.seeds = seeds(&value()?)?,
                "--scatter" => all.scatter = number(&value()?)?,
                "--threads" => all.threads = number(&value()?)? as usize,
                "--program" => all.program = value()?.into(),
                "--outcomes" => all.outcomes = value()?.into(),
                "--report" => all.tables = value()?.into(),
                "--briefly" => all.is_brief = true,
                "--towed" => all.is_towed = true,
                "--tables" => errand = Some(Errand::Tables),
                "--lambda" => errand = Some(Errand::Lambda),
                "--play" => errand = Some(Errand::Play(value()?.into())),
                // What `cargo test` passes on to every target is not meant for this one.
                _ => {}
            }
        }
        let asked = if all.effects.is_empty() { Errand::Help } else { Errand::Matrix };
        all.errand = errand.unwrap_or(asked);
        Ok(all)
    }
}

fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("{text} is no number"))
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(number).collect()
}

fn sets(text: &str) -> Result<Vec<RunSet>, String> {
    let known = |name: &str| {
        let found = RunSet::ALL.iter().find(|(known, _)| *known == name);
        found.map(|(_, set)| *set).ok_or(format!("{name} is no run set"))
    };
    text.split(',').map(known).collect()
}

fn seeds(text: &str) -> Result<std::ops::Range<u64>, String> {
    let whole = |text: &str| text.parse::<u64>().map_err(|_| format!("{text} is no seed"));
    match text.split_once("..") {
        Some((first, end)) => Ok(whole(first)?..whole(end)?),
        None => Ok(0..whole(text)?),
    }
}
