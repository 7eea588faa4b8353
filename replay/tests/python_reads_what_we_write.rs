//! The reference reader in Python opens our recordings and finds the same numbers.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use devices::Quantity::{Force, Moment, Roll, Speed};
use devices::Sample;
use replay::{Provenance, Recorder};

use crate::recordings::folder;

/// Checks the file named first against the lines `topic time_s value` in the file named second.
const CHECK: &str = r#"
import json, sys
from mcap.reader import make_reader
expected = {}
for line in open(sys.argv[2]):
    topic, time_s, value = line.split()
    expected.setdefault(topic, []).append((float(time_s), float(value)))
with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, validate_crcs=True)
    summary = reader.get_summary()
    assert summary.statistics.message_count == sum(map(len, expected.values()))
    found = {}
    for schema, channel, message in reader.iter_messages():
        assert channel.message_encoding == "json", channel
        assert schema.encoding == "jsonschema", schema
        kind = json.loads(schema.data)
        assert kind["type"] == "object", kind
        fields = kind["properties"]
        assert all(field["type"] == "number" for field in fields.values()), kind
        sample = json.loads(message.data)
        assert set(sample) == set(fields) == set(kind["required"]), (sample, kind)
        time_s = sample.pop("time_s")
        (value,) = sample.values()
        assert message.log_time == message.publish_time == round(time_s * 1e9), message
        found.setdefault(channel.topic, []).append((time_s, value))
    assert found == expected, "samples differ"
    (metadata,) = reader.iter_metadata()
    assert metadata.name == "rolltank", metadata
    assert metadata.metadata["campaign"] == 'name = "Python"', metadata
print("python agrees")
"#;

/// The interpreter of a virtual environment that has `mcap`; none without Python or network.
fn python() -> Option<PathBuf> {
    let home = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python_mcap");
    let python = home.join("bin/python3");
    let run = |program: &Path, arguments: &[&str]| -> Result<(), String> {
        match Command::new(program).args(arguments).output() {
            Ok(Output { status, .. }) if status.success() => Ok(()),
            Ok(Output { stderr, .. }) => Err(String::from_utf8_lossy(&stderr).into_owned()),
            Err(error) => Err(error.to_string()),
        }
    };
    let import = ["-c", "import mcap.reader, zstandard"];
    let made = run(&python, &import).or_else(|_| {
        run(Path::new("python3"), &["-m", "venv", &home.display().to_string()])?;
        run(&python, &["-m", "pip", "install", "--quiet", "mcap"])?;
        run(&python, &import)
    });
    match made {
        Ok(()) => Some(python),
        Err(error) if env::var_os("CI").is_none() => {
            eprintln!("skipped: no Python with the mcap package here: {error}");
            None
        }
        Err(error) => panic!("no Python with the mcap package: {error}"),
    }
}

#[test]
fn schema_times_and_values_are_equal() {
    let Some(python) = python() else { return };
    let folder = folder();
    let target = folder.path().join("story.mcap");
    let provenance =
        Provenance { campaign_text: "name = \"Python\"".to_owned(), ..Provenance::default() };
    let mut recorder = Recorder::create(&target, &provenance).expect("it starts");
    let mut expected = Vec::new();
    for index in 0..20_000 {
        let time_s = f64::from(index) / 300.0;
        let topics = [(Roll, "/roll"), (Force, "/force"), (Moment, "/moment"), (Speed, "/speed")];
        let (quantity, topic) = topics[index as usize % 4];
        let value = (time_s * 7.0).sin() * 10_f64.powi(index % 40 - 20);
        recorder.push(&Sample { quantity, time_s, value }).expect("it is recorded");
        expected.push(format!("{topic} {time_s:?} {value:?}"));
    }
    recorder.finish().expect("it is completed");
    let (script, lines) = (folder.path().join("check.py"), folder.path().join("expected.txt"));
    fs::write(&script, CHECK).expect("it is written");
    fs::write(&lines, expected.join("\n")).expect("it is written");
    let output = Command::new(python).arg(script).arg(target).arg(lines).output();
    let output = output.expect("Python runs");
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(String::from_utf8_lossy(&output.stdout), "python agrees\n", "{told}");
}
