//! The whole matrix of hidden effects: `cargo test --test hidden_matrix -- --all`.
//!
//! Without arguments it says what it can do, so that the plain test command stays short. Every
//! outcome is one line of `target/hidden_effects.jsonl`; a matrix that was stopped goes on from
//! there. The tables go to `docs/hidden_effects.md`.
#![expect(clippy::print_stdout, reason = "a matrix tells how far it is")]

#[path = "../hidden_tank/mod.rs"]
mod hidden_tank;

mod arguments;
mod bias;
mod cells;
mod count;
mod coverage;
mod figures;
mod outcome;
mod tables;

use std::collections::BTreeSet;
use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use arguments::{Arguments, Errand};
use hidden_tank::campaign::{Asked, Campaign};
use hidden_tank::{next_run, verdict};

fn main() -> ExitCode {
    let arguments = match Arguments::read(std::env::args().skip(1)) {
        Ok(arguments) => arguments,
        Err(complaint) => {
            println!("{complaint}\n\n{}", arguments::USAGE);
            return ExitCode::from(2);
        }
    };
    match &arguments.errand {
        Errand::Help => println!("{}", arguments::USAGE),
        Errand::Play(place) => play(&arguments, place),
        Errand::Lambda => lambda(&arguments),
        Errand::Matrix => matrix(&arguments),
        Errand::Tables => {}
    }
    if matches!(arguments.errand, Errand::Matrix | Errand::Tables) {
        let outcomes = outcome::read(&arguments.outcomes);
        fs::write(&arguments.tables, tables::page(&outcomes)).expect("the tables are written");
        println!("{} outcomes, tables in {}", outcomes.len(), arguments.tables.display());
    }
    ExitCode::SUCCESS
}

/// Writes the campaigns asked for, to be looked at or diagnosed by hand.
fn play(arguments: &Arguments, place: &Path) {
    for asked in cells::all(arguments) {
        let campaign = Campaign::draw(&asked);
        let name = asked.name().replace([' ', '#'], "_");
        let written = |campaign: &Campaign, name: &str| {
            let played = hidden_tank::folder::play(campaign, &place.join(name));
            println!("{}\n  truth: {}", played.folder.display(), played.truth.display());
            played
        };
        let played = written(&campaign, &name);
        if arguments.is_towed
            && let Ok(verdict) = verdict::diagnose(&arguments.program, &played.folder)
            && let Some(longer) = next_run::towed(&campaign, &verdict)
        {
            written(&longer, &format!("{name}_towed"));
        }
    }
}

/// Prints what the base cannot take up of each campaign asked for.
fn lambda(arguments: &Arguments) {
    for asked in cells::all(arguments) {
        let campaign = Campaign::draw(&asked);
        println!("{:60} {:?}", asked.name(), outcome::lambdas(&campaign));
    }
}

/// Diagnoses every cell that has no outcome yet.
fn matrix(arguments: &Arguments) {
    let done: BTreeSet<String> = outcome::read(&arguments.outcomes)
        .iter()
        .filter_map(|line| line["name"].as_str().map(str::to_owned))
        .collect();
    let cells: Vec<Asked> =
        cells::all(arguments).into_iter().filter(|asked| !done.contains(&asked.name())).collect();
    println!("{} done, {} to do with {}", done.len(), cells.len(), arguments.program.display());
    if let Some(folder) = arguments.outcomes.parent() {
        fs::create_dir_all(folder).expect("a folder for the outcomes");
    }
    let file = OpenOptions::new().create(true).append(true).open(&arguments.outcomes);
    let file = Mutex::new(file.expect("the file of outcomes can be written"));
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(asked) = cells.get(next.fetch_add(1, Ordering::Relaxed)) {
            let line = outcome::of(asked, &arguments.program, arguments.is_brief);
            println!(
                "{:60} lambda {} -> {} {}",
                asked.name(),
                line["lambda"],
                line["outcome"],
                line["causes"]
            );
            let mut file = file.lock().expect("no worker died with it");
            writeln!(file, "{line}").expect("an outcome is written");
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..arguments.threads {
            scope.spawn(work);
        }
    });
}
