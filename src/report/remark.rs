//! Remarks on runs, sorted by what they bear on and set like the rest of the page.

/// Words of the remarks that say what the fitted model misses or what spoils its intervals.
const OF_THE_MODEL: [&str; 5] =
    ["does not capture", "leaves", "not converged", "not calibrated", "not scale free"];

/// Whether a reader must know this remark before using the coefficients.
pub(super) fn is_of_the_model(remark: &str) -> bool {
    OF_THE_MODEL.iter().any(|words| remark.contains(words))
}

/// The remark with the symbols of the page in place of their plain names.
pub(super) fn typeset(remark: &str) -> String {
    remark.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

fn word(word: &str) -> String {
    let bare = word.trim_matches(|letter: char| !letter.is_alphanumeric());
    let is_symbol = ["phi", "b1", "b3", "k3", "sigma"].contains(&bare)
        || word.contains("phi^3")
        || word.contains("phi'^3")
        || bare == "1/rad2";
    if !is_symbol {
        return word.to_owned();
    }
    [
        ("phi'", "φ′"),
        ("phi", "φ"),
        ("sigma", "σ"),
        ("^3", "³"),
        ("b1", "b₁"),
        ("b3", "b₃"),
        ("k3", "k₃"),
        ("rad2", "rad²"),
    ]
    .iter()
    .fold(word.to_owned(), |text, (plain, set)| text.replace(plain, set))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_symbols_become_those_of_the_page_while_words_stay() {
        assert_eq!(typeset("b1 phi' + b3 phi'^3 leaves"), "b₁ φ′ + b₃ φ′³ leaves");
        assert_eq!(typeset("K (phi + k3 phi^3) 1/rad2"), "K (φ + k₃ φ³) 1/rad²");
        assert_eq!(typeset("recording graphics_b1.csv"), "recording graphics_b1.csv");
    }
}
