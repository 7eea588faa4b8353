//! A mistake in the campaign file, with its place and what to do about it.

use std::fmt;

use replay::edit_distance;
use serde::Serialize;

/// One mistake; a campaign file is read to its end, so all of them are reported at once.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Mistake {
    /// The file, as it was named on the command line.
    pub file: String,
    /// Line in the file, counted from 1; none when the file as a whole is meant.
    pub line: Option<usize>,
    /// What is wrong: the key, its value, the limit.
    pub message: String,
    /// What to do next.
    pub hint: Option<String>,
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.message)
    }
}

/// The known word that `word` was most likely meant to be, if any is near.
///
/// Near means that fewer than half of the letters differ. A wrong or missing unit at the end
/// counts as one letter (`gm` or `gm_mm` for `gm_m`).
pub(super) fn nearest<'k>(word: &str, known: &[&'k str]) -> Option<&'k str> {
    let word = word.to_lowercase();
    known
        .iter()
        .map(|&candidate| {
            let quantities = edit_distance(quantity_of(&word), quantity_of(candidate));
            (edit_distance(&word, candidate).min(1 + quantities), candidate)
        })
        .filter(|(distance, candidate)| 2 * distance < word.len().max(candidate.len()))
        .min()
        .map(|(_, candidate)| candidate)
}

/// A key without the unit at its end.
fn quantity_of(key: &str) -> &str {
    key.split_once('_').map_or(key, |(quantity, _)| quantity)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    const HULL: [&str; 5] = ["length_pp_m", "beam_m", "draft_m", "displacement_m3", "gm_m"];

    #[test]
    fn a_misspelt_key_finds_the_key_it_was_meant_to_be() {
        assert_eq!(nearest("displacment_m3", &HULL), Some("displacement_m3"));
        assert_eq!(nearest("draught_m", &HULL), Some("draft_m"));
        assert_eq!(nearest("gm", &HULL), Some("gm_m"));
        assert_eq!(nearest("displacement_kg", &HULL), Some("displacement_m3"));
        assert_eq!(nearest("Beam_m", &HULL), Some("beam_m"));
        assert_eq!(nearest("speeed", &["file", "speed_m_s"]), Some("speed_m_s"));
    }

    #[test]
    fn a_key_of_another_matter_finds_none() {
        assert_eq!(nearest("colour", &HULL), None);
        assert_eq!(nearest("", &HULL), None);
    }
}
