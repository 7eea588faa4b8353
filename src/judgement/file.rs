//! `judgements.jsonl`: read whole, and only ever added to.

use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use super::line::Judgement;

/// Name of the file beside the campaign file.
pub const JUDGEMENTS_FILE: &str = "judgements.jsonl";

/// Its text, without a last line that a power cut has left unfinished; empty when there is none.
///
/// Such a line was never confirmed to anybody, for that waits for the disk.
///
/// # Errors
/// What the system said.
pub fn read(folder: &Path) -> io::Result<String> {
    match fs::read_to_string(folder.join(JUDGEMENTS_FILE)) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(String::new()),
        Err(error) => Err(error),
        Ok(mut text) => {
            text.truncate(whole(&text));
            Ok(text)
        }
    }
}

/// Adds a judgement and waits for the disk.
///
/// # Errors
/// What the system said; then the judgement does not count.
pub fn append(folder: &Path, judgement: &Judgement) -> io::Result<()> {
    let path = folder.join(JUDGEMENTS_FILE);
    let whole_bytes = read(folder)?.len() as u64;
    let mut file = File::options().create(true).write(true).truncate(false).open(&path)?;
    file.set_len(whole_bytes)?;
    file.seek(SeekFrom::Start(whole_bytes))?;
    file.write_all(format!("{}\n", judgement.line()).as_bytes())?;
    file.sync_all()
}

/// Bytes of the text up to its last line end.
fn whole(text: &str) -> usize {
    text.rfind('\n').map_or(0, |end| end + 1)
}

#[cfg(test)]
mod tests {
    use super::super::{Deed, Judgements};
    use super::*;

    #[test]
    fn a_line_that_a_power_cut_left_half_is_none_and_gives_way_to_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let judgement = |number| Judgement {
            number,
            at: "2026-11-26 09:12:33 UTC".to_owned(),
            by: "A. Nilsson".to_owned(),
            why: String::new(),
            deed: Deed::StopRecording,
        };
        append(folder.path(), &judgement(1)).unwrap();
        let path = folder.path().join(JUDGEMENTS_FILE);
        let torn = fs::read_to_string(&path).unwrap() + "{\"number\":2,\"at\":\"20";
        fs::write(&path, torn).unwrap();
        append(folder.path(), &judgement(2)).unwrap();
        let read = Judgements::parse(&read(folder.path()).unwrap()).unwrap();
        assert_eq!(read.all(), [judgement(1), judgement(2)]);
    }
}
