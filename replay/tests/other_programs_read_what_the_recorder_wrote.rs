//! The reference packages in Python read our recordings, finished or not; so does the `mcap`
//! command line where it is installed.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use replay::{Exit, LocalDisk, Provenance, Recorder};

use crate::everything_recorded_comes_back::every_kind;
use crate::python::python;
use crate::recorded_days::{live, records};
use crate::recordings::{folder, write};

/// Instants recorded, those of the first records included.
const INSTANTS: u64 = 5000;

/// Checks a finished file, and prints its messages of each topic.
const FINISHED: &str = r#"
import base64, json, sys
from mcap.reader import make_reader
kinds = {"string": str, "number": (int, float), "array": list}
with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, validate_crcs=True)
    summary = reader.get_summary()
    assert summary.chunk_indexes, "it is indexed"
    assert all(chunk.compression == "zstd" for chunk in summary.chunk_indexes)
    assert all(chunk.message_index_offsets for chunk in summary.chunk_indexes)
    found, last = {}, 0
    for schema, channel, message in reader.iter_messages():
        assert channel.message_encoding == "json" and schema.encoding == "jsonschema"
        assert message.log_time == message.publish_time >= last, "in the order of time"
        last = message.log_time
        definition, sample = json.loads(schema.data), json.loads(message.data)
        assert definition["type"] == "object"
        assert set(definition["required"]) <= set(sample) <= set(definition["properties"])
        for field, value in sample.items():
            assert isinstance(value, kinds[definition["properties"][field]["type"]]), field
        if channel.topic.startswith("/raw/"):
            assert definition["properties"]["bytes"]["contentEncoding"] == "base64"
            assert channel.topic == "/raw/" + sample["device"]
            sample["bytes"] = base64.b64decode(sample["bytes"], validate=True)
            assert len(sample["bytes"]) > 250
        found[channel.topic] = found.get(channel.topic, 0) + 1
    statistics = summary.statistics
    counts = {summary.channels[id].topic: n for id, n in statistics.channel_message_counts.items()}
    assert counts == found, (counts, found)
    half = [m for _, _, m in reader.iter_messages(topics=["/roll"], start_time=2_500_000_000)]
    assert len(half) == 2500, len(half)
    (metadata,) = reader.iter_metadata()
    assert metadata.metadata["exit_status"] == "success", metadata
    assert int(metadata.metadata["messages"]) == statistics.message_count
for topic in sorted(found):
    print(topic, found[topic])
"#;

/// Reads a part file as it stands, up to where it stops.
const PART: &str = r#"
import sys
from mcap.exceptions import McapError
from mcap.stream_reader import StreamReader
from mcap.records import Channel, Message
found, topics = {}, {}
with open(sys.argv[1], "rb") as file:
    try:
        for record in StreamReader(file, skip_magic=False, validate_crcs=True).records:
            if isinstance(record, Channel):
                topics[record.id] = record.topic
            if isinstance(record, Message):
                topic = topics[record.channel_id]
                found[topic] = found.get(topic, 0) + 1
    except McapError:
        pass  # It has no end yet.
for topic in sorted(found):
    print(topic, found[topic])
"#;

/// What a script prints about a file.
#[track_caller]
fn run(python: &Path, script: &Path, file: &Path) -> String {
    let output = Command::new(python).arg(script).arg(file).output().expect("Python runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("it prints text")
}

/// Topics with their messages, as the scripts print them.
fn printed(topics: &BTreeMap<String, u64>) -> String {
    topics
        .iter()
        .fold(String::new(), |text, (topic, messages)| format!("{text}{topic} {messages}\n"))
}

#[test]
fn python_reads_a_recording_while_it_grows_and_when_it_is_finished() {
    let Some(python) = python() else { return };
    let folder = folder();
    let (target, part) = (folder.path().join("pass.mcap"), folder.path().join("pass.mcap.part"));
    let mut recorder =
        Recorder::start(&target, &Provenance::default(), live(), Box::new(LocalDisk))
            .expect("it starts");
    for record in every_kind().into_iter().chain((11..INSTANTS).flat_map(records)) {
        recorder.push(record).expect("it is recorded");
    }
    let pushed = recorder.progress().records;
    recorder.tick(Duration::from_secs(1)).expect("the disk has room");
    let growing = run(python, &write(&folder, "part.py", PART), &part);

    let finished = recorder.finish(Exit::success("the pass is over")).expect("it is finished");
    let found = run(python, &write(&folder, "finished.py", FINISHED), &target);
    assert_eq!(found, printed(&finished.topics));
    let stopped = finished.runs_stopped.len() as u64;
    assert_eq!(finished.topics.values().sum::<u64>(), pushed + stopped);
    let mut topics = finished.topics;
    *topics.get_mut("/run_stop").expect("runs were stopped") -= stopped;
    assert_eq!(growing, printed(&topics), "all but the ends that finishing added");
    doctor(&target);
}

/// Has the `mcap` command line examine the file, where there is one.
fn doctor(file: &Path) {
    let Ok(output) = Command::new("mcap").arg("doctor").arg(file).output() else {
        eprintln!("skipped: no `mcap` command line here");
        return;
    };
    let told = [output.stdout, output.stderr].concat();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&told));
}
