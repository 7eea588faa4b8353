//! Whatever stands in a file, the player says what is wrong with it and lives on.

use devices::Quantity::{Roll, Speed};
use mcap::WriteOptions;
use proptest::prelude::*;
use replay::{Columns, Fate, LocalDisk, Orphan, recover};

use crate::foreign_mcap_recordings_are_read_by_topic_and_field::mcap_file;
use crate::recordings::{channel, columns, folder, play, write};

/// A small whole MCAP file in one of the layouts MCAP allows.
fn whole(layout: u8) -> Vec<u8> {
    let options = match layout {
        0 => WriteOptions::new(),
        1 => WriteOptions::new().compression(None),
        2 => WriteOptions::new().use_chunks(false),
        _ => WriteOptions::new().compression(Some(mcap::Compression::Lz4)),
    };
    let messages: Vec<_> = (0..40)
        .map(|index| ("/roll", index * 1_000_000, format!("{{\"time_s\":{index},\"roll_rad\":1}}")))
        .collect();
    mcap_file(options.chunk_size(Some(300)).profile("rolltank"), "json", &messages)
}

fn play_bytes(name: &str, bytes: &[u8]) {
    let folder = folder();
    let mut given = columns(&[Roll, Speed]);
    for mapped in &mut given.channels {
        mapped.topic = Some("/roll".to_owned());
    }
    let path = write(&folder, name, bytes);
    for given in [given, Columns { channels: vec![channel(Roll, "1")], ..Columns::default() }] {
        let Ok(played) = play(&path, &given) else { continue };
        for sample in &played.samples {
            assert!(sample.time_s.is_finite() && sample.value.is_finite(), "{sample:?}");
        }
    }
}

proptest! {
    #[test]
    fn any_bytes_as_a_table(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        play_bytes("story.csv", &bytes);
        play_bytes("story.csv", &[b"t,roll,speed\n".as_slice(), &bytes].concat());
    }

    #[test]
    fn any_text_as_a_table(text in "([-0-9.,;\te\"\r\n a]|NaN|inf){0,200}") {
        play_bytes("story.csv", text.as_bytes());
        play_bytes("story.csv", format!("t,roll,speed\n{text}").as_bytes());
        play_bytes("story.csv", format!("t;roll;speed\n{text}").as_bytes());
    }

    #[test]
    fn any_bytes_as_mcap(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        play_bytes("story.mcap", &[mcap::MAGIC, &bytes].concat());
    }

    #[test]
    fn any_bytes_as_an_orphan_are_left_as_they_are(
        bytes in prop::collection::vec(any::<u8>(), 9..400),
    ) {
        for bytes in [bytes.clone(), [mcap::MAGIC, &bytes].concat()] {
            let folder = folder();
            let path = write(&folder, "story.mcap.part", &bytes);
            let orphans = recover(folder.path(), &mut LocalDisk).expect("the folder can be read");
            let left = matches!(&orphans[..], [Orphan { fate: Fate::Left(_), .. }]);
            prop_assert!(left, "{:?}", orphans);
            prop_assert_eq!(std::fs::read(path).expect("it is there"), bytes);
        }
    }

    #[test]
    fn a_recording_with_changed_bytes(
        layout in 0..4_u8,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in any::<prop::sample::Index>(),
        is_cut in any::<bool>(),
    ) {
        let mut bytes = whole(layout);
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if is_cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        play_bytes("story.mcap", &bytes);
    }

    #[test]
    fn a_recording_with_a_changed_length(
        layout in 0..4_u8,
        at in any::<prop::sample::Index>(),
        length in prop::sample::select(vec![0, 1, 255, 1 << 20, 1 << 40, u64::MAX - 8, u64::MAX]),
    ) {
        let mut bytes = whole(layout);
        let at = at.index(bytes.len() - 8);
        bytes[at..at + 8].copy_from_slice(&length.to_le_bytes());
        play_bytes("story.mcap", &bytes);
    }
}
