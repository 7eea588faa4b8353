//! The name most like a misspelt one.

/// Longest name compared [letters]; a longer one is no spelling mistake.
const LETTERS: usize = 200;

/// The name nearest to `wanted`, when it differs in at most a third of the letters.
pub(crate) fn nearest<'a>(wanted: &str, names: &'a [String]) -> Option<&'a str> {
    let plain = |name: &str| -> Vec<char> { name.trim().to_lowercase().chars().collect() };
    let wanted = plain(wanted);
    names
        .iter()
        .map(|name| (name, plain(name)))
        .filter(|(_, letters)| !letters.is_empty() && letters.len() <= LETTERS)
        .map(|(name, letters)| (edits(&wanted, &letters), letters.len(), name))
        .filter(|(edits, length, _)| 3 * edits <= wanted.len().max(*length))
        .min_by_key(|(edits, _, _)| *edits)
        .map(|(_, _, name)| name.as_str())
}

/// Letters to insert, remove or replace to turn one word into another (Levenshtein distance).
pub fn edit_distance(from: &str, to: &str) -> usize {
    let letters = |word: &str| -> Vec<char> { word.chars().collect() };
    edits(&letters(from), &letters(to))
}

fn edits(from: &[char], to: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, a) in from.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, b) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(a != b);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_name_is_recognised_and_a_different_one_is_not() {
        let names = ["time".to_owned(), "Roll [deg]".to_owned(), "force".to_owned()];
        assert_eq!(nearest("roll [deg]", &names), Some("Roll [deg]"));
        assert_eq!(nearest("tmie", &names), None, "two of four letters differ");
        assert_eq!(nearest("forces", &names), Some("force"));
        assert_eq!(nearest("speed", &names), None);
    }
}
