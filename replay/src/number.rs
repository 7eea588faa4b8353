//! A cell of a table as a number, with decimal point or decimal comma.

use std::fmt;
use std::str;

/// Longest number read [bytes]; the exact decimal form of any f64 worth writing is far shorter.
const NUMBER_BYTES_MAX: usize = 512;

/// Why a cell is not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellFault {
    /// Text.
    NotNumber,
    /// NaN, infinite, or beyond the range of an f64.
    NotFinite,
    /// A quoted comma in a table whose cells are parted by commas.
    CommaInside,
    /// Decimal point and decimal comma in one file.
    MixedSeparators,
}

impl fmt::Display for CellFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotNumber => "not a number",
            Self::NotFinite => "not a finite number",
            Self::CommaInside => "a number with a comma between comma-separated cells",
            Self::MixedSeparators => "written with the other decimal separator",
        })
    }
}

/// Reads the cells of one file, and holds it to one decimal separator.
#[derive(Debug, Clone)]
pub(crate) struct Numbers {
    comma_allowed: bool,
    separator: Option<u8>,
}

impl Numbers {
    /// Numbers between cells parted by `delimiter`.
    pub(crate) fn new(delimiter: u8) -> Self {
        Self { comma_allowed: delimiter != b',', separator: None }
    }

    /// The number in a cell, or none when the cell is empty.
    pub(crate) fn read(&mut self, cell: &[u8]) -> Result<Option<f64>, CellFault> {
        let cell = cell.trim_ascii();
        if cell.is_empty() {
            return Ok(None);
        }
        let number = if cell.contains(&b',') {
            self.with_comma(cell)?
        } else {
            let number = parse(cell)?;
            if self.comma_allowed && cell.contains(&b'.') {
                self.keep_to(b'.')?;
            }
            number
        };
        if number.is_finite() { Ok(Some(number)) } else { Err(CellFault::NotFinite) }
    }

    fn with_comma(&mut self, cell: &[u8]) -> Result<f64, CellFault> {
        let mut pointed = [0_u8; NUMBER_BYTES_MAX];
        let pointed = pointed.get_mut(..cell.len()).ok_or(CellFault::NotNumber)?;
        pointed.copy_from_slice(cell);
        for byte in pointed.iter_mut() {
            match *byte {
                b',' => *byte = b'.',
                b'.' => return Err(CellFault::MixedSeparators),
                _ => {}
            }
        }
        let number = parse(pointed)?;
        if !self.comma_allowed {
            return Err(CellFault::CommaInside);
        }
        self.keep_to(b',')?;
        Ok(number)
    }

    fn keep_to(&mut self, separator: u8) -> Result<(), CellFault> {
        match self.separator.replace(separator) {
            Some(before) if before != separator => Err(CellFault::MixedSeparators),
            _ => Ok(()),
        }
    }
}

fn parse(cell: &[u8]) -> Result<f64, CellFault> {
    str::from_utf8(cell).ok().and_then(|text| text.parse().ok()).ok_or(CellFault::NotNumber)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn point_and_comma_are_read_and_never_mixed() {
        let mut numbers = Numbers::new(b';');
        assert_eq!(numbers.read(b" -1,5e-3 "), Ok(Some(-1.5e-3)));
        assert_eq!(numbers.read(b"7"), Ok(Some(7.0)));
        assert_eq!(numbers.read(b""), Ok(None));
        assert_eq!(numbers.read(b"1.234,5"), Err(CellFault::MixedSeparators));
        assert_eq!(numbers.read(b"1.5"), Err(CellFault::MixedSeparators));
        assert_eq!(numbers.read(b"1,2,3"), Err(CellFault::NotNumber));
    }

    #[test]
    fn what_is_no_finite_number_is_refused() {
        let mut numbers = Numbers::new(b',');
        for text in ["NaN", "inf", "-infinity", "1e999"] {
            assert_eq!(numbers.read(text.as_bytes()), Err(CellFault::NotFinite), "{text}");
        }
        assert_eq!(numbers.read(b"0x10"), Err(CellFault::NotNumber));
        assert_eq!(numbers.read(b"1,5"), Err(CellFault::CommaInside));
        assert_eq!(numbers.read(b"a,b"), Err(CellFault::NotNumber));
        assert_eq!(numbers.read(&[0xff, 0xfe]), Err(CellFault::NotNumber));
    }
}
