//! The reference packages in Python and we find the same numbers in each other's recordings.

use std::fs;
use std::process::Command;

use devices::Quantity::{Force, Moment, Roll, Speed};
use devices::Sample;
use replay::{ChannelColumn, Columns, Exit, Provenance, Recorder, TimeColumn};

use crate::python::python;
use crate::recordings::{channel, folder, play_whole, write};

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

/// Writes protobuf messages by the reference implementation to the file named first.
const WRITE: &str = r#"
import sys
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.writer import Writer
Field = descriptor_pb2.FieldDescriptorProto
file = descriptor_pb2.FileDescriptorProto(name="tank.proto", package="oe.tank", syntax="proto3")
imu, other = file.message_type.add(name="Imu"), file.message_type.add(name="Angle")
inner = imu.nested_type.add(name="Angle")
inner.field.add(name="roll", number=2, type=Field.TYPE_DOUBLE, label=Field.LABEL_OPTIONAL)
imu.field.add(name="angle", number=5, type=Field.TYPE_MESSAGE, label=Field.LABEL_OPTIONAL,
              type_name=".oe.tank.Imu.Angle")
imu.field.add(name="force", number=300, type=Field.TYPE_SINT32, label=Field.LABEL_REPEATED)
imu.field.add(name="t_us", number=7, type=Field.TYPE_INT64, label=Field.LABEL_OPTIONAL)
pool = descriptor_pool.DescriptorPool()
pool.Add(file)
Imu = message_factory.GetMessageClass(pool.FindMessageTypeByName("oe.tank.Imu"))
definition = descriptor_pb2.FileDescriptorSet(file=[file]).SerializeToString()
with open(sys.argv[1], "wb") as output:
    writer = Writer(output)
    writer.start()
    schema = writer.register_schema("oe.tank.Imu", "protobuf", definition)
    channel = writer.register_channel("/imu", "protobuf", schema)
    for index in range(1000):
        message = Imu(t_us=10_000 * index - 5_000_000, force=[1, -index])
        message.angle.roll = (index - 500) / 7
        writer.add_message(channel, index, message.SerializeToString(), index)
    writer.finish()
"#;

#[test]
fn protobuf_written_by_the_reference_implementation_is_read() {
    let Some(python) = python() else { return };
    let folder = folder();
    let script = write(&folder, "write.py", WRITE);
    let target = folder.path().join("story.mcap");
    let status = Command::new(python).arg(script).arg(&target).status().expect("Python runs");
    assert!(status.success());
    let on_imu = |quantity, path| {
        let topic = Some("/imu".to_owned());
        ChannelColumn { topic, ..channel(quantity, path) }
    };
    let given = Columns {
        time: Some(TimeColumn { column: "t_us".to_owned(), seconds_per_unit: 1e-6 }),
        sample_rate_hz: None,
        channels: vec![on_imu(Roll, "angle.roll"), on_imu(Force, "force.1")],
    };
    let played = play_whole(&target, &given);
    let time_s = |index: i32| f64::from(10_000 * index - 5_000_000) * 1e-6;
    let expected = |value: &dyn Fn(f64) -> f64| -> Vec<_> {
        (0..1000).map(|index| (time_s(index), value(f64::from(index)))).collect()
    };
    assert_eq!(played.of(Roll), expected(&|index| (index - 500.0) / 7.0));
    assert_eq!(played.of(Force), expected(&|index| -index));
}

#[test]
fn schema_times_and_values_of_our_recordings_are_equal_in_python() {
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
        recorder.push(Sample { quantity, time_s, value }).expect("it is recorded");
        expected.push(format!("{topic} {time_s:?} {value:?}"));
    }
    recorder.finish(Exit::success("story")).expect("it is completed");
    let (script, lines) = (folder.path().join("check.py"), folder.path().join("expected.txt"));
    fs::write(&script, CHECK).expect("it is written");
    fs::write(&lines, expected.join("\n")).expect("it is written");
    let output = Command::new(python).arg(script).arg(target).arg(lines).output();
    let output = output.expect("Python runs");
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(String::from_utf8_lossy(&output.stdout), "python agrees\n", "{told}");
}
