//! `rolltank reference`: the errata of the paper, each computed again from its own numbers.

use std::io::{self, Write};

use clap::Args;
use serde_json::{Value, json};

use super::{Exit, Failure};
use crate::reference::{self, Erratum};

/// Schema of the JSON output; its number rises when a field changes its meaning.
const SCHEMA: &str = "rolltank.reference/1";

/// Print where the paper behind the method does not hold as printed, computed from its own tables
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let errata = reference::errata();
    if arguments.json {
        let errata: Vec<Value> = errata.iter().map(erratum_json).collect();
        writeln!(out, "{:#}", json!({"schema": SCHEMA, "errata": errata}))?;
    } else {
        for (index, erratum) in errata.iter().enumerate() {
            tell(out, index + 1, erratum)?;
        }
    }
    Ok(Exit::Done)
}

fn tell(out: &mut dyn Write, number: usize, erratum: &Erratum) -> io::Result<()> {
    let Erratum { title, printed, computed, how } = erratum;
    writeln!(out, "{number}. {title}")?;
    writeln!(out, "   printed:  {printed}")?;
    writeln!(out, "   computed: {computed}")?;
    writeln!(out, "   how:      {how}\n")
}

fn erratum_json(erratum: &Erratum) -> Value {
    let Erratum { title, printed, computed, how } = erratum;
    json!({"title": title, "printed": printed, "computed": computed, "how": how})
}
