//! Series of runs put down in a file without a name until the next diagnosis needs them.

use std::fs::{self, File};
use std::io;
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::process;

/// The file; the system takes it back when the last handle is gone, however that comes.
#[derive(Debug)]
pub(super) struct Shelf {
    file: File,
    end_bytes: u64,
}

/// Where some series lie on the shelf.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lying {
    at_bytes: u64,
    lengths: Vec<usize>,
}

impl Shelf {
    /// An empty one on the disk of a folder, which is made if it is not there.
    pub(super) fn in_folder(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let path = folder.join(format!(".series-{}", process::id()));
        let file =
            File::options().read(true).write(true).create(true).truncate(true).open(&path)?;
        fs::remove_file(&path)?;
        Ok(Self { file, end_bytes: 0 })
    }

    /// Puts series down; on a full disk nothing is.
    pub(super) fn put(&mut self, series: &[&[f64]]) -> io::Result<Lying> {
        let bytes: Vec<u8> =
            series.iter().copied().flatten().flat_map(|value| value.to_le_bytes()).collect();
        self.file.write_all_at(&bytes, self.end_bytes)?;
        let lengths = series.iter().map(|values| values.len()).collect();
        let lying = Lying { at_bytes: self.end_bytes, lengths };
        self.end_bytes += bytes.len() as u64;
        Ok(lying)
    }

    /// The series as they were put down, to the bit.
    pub(super) fn get(&self, lying: &Lying) -> io::Result<Vec<Vec<f64>>> {
        let mut at_bytes = lying.at_bytes;
        let mut one = |length: &usize| {
            let mut bytes = vec![0; length * size_of::<f64>()];
            self.file.read_exact_at(&mut bytes, at_bytes)?;
            at_bytes += bytes.len() as u64;
            let values = bytes.as_chunks().0.iter().map(|eight| f64::from_le_bytes(*eight));
            Ok(values.collect())
        };
        lying.lengths.iter().map(&mut one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_come_back_to_the_bit_and_leave_no_file_behind() {
        let folder = tempfile::tempdir().unwrap();
        let mut shelf = Shelf::in_folder(folder.path()).unwrap();
        let series: [&[f64]; 3] = [&[1.0, -0.0, f64::MIN_POSITIVE], &[], &[f64::MAX, 0.1]];
        let lying = [shelf.put(&series[..1]).unwrap(), shelf.put(&series).unwrap()];
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        let bits = |series: &[f64]| series.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        let again = shelf.get(&lying[1]).unwrap();
        assert_eq!(again.len(), 3);
        assert!(again.iter().zip(series).all(|(a, b)| bits(a) == bits(b)));
        assert_eq!(shelf.get(&lying[0]).unwrap(), [series[0]]);
    }
}
