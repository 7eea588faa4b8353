//! Sentences that differ only in their numbers, brought together.

use maud::{Markup, html};

/// Where a sentence belongs, with the sentence.
pub(super) type Line = (String, String);

/// Sentences alike that are all shown.
const N_IN_FULL: usize = 3;

/// The lines as list items, one per kind of sentence in order of its first line.
///
/// Of many alike the first is shown, the others folded beneath it; a few stand in full.
pub(super) fn list(lines: &[Line]) -> Markup {
    html! {
        ul {
            @for group in grouped(lines) {
                @let n_shown = if group.len() > N_IN_FULL { 1 } else { group.len() };
                @for (index, (source, text)) in group.iter().take(n_shown).enumerate() {
                    li {
                        b { (source) } ": " (text)
                        @if index == 0 && n_shown < group.len() { (folded(text, &group[1..])) }
                    }
                }
            }
        }
    }
}

fn folded(first: &str, others: &[&Line]) -> Markup {
    let same = others.iter().all(|(_, text)| text == first);
    html! {
        details {
            summary {
                (others.len()) " more " (if same { "that read the same" } else { "alike" })
            }
            ul {
                @if same {
                    li { @for (index, (source, _)) in others.iter().enumerate() {
                        @if index > 0 { ", " } (source)
                    } }
                } @else {
                    @for (source, text) in others { li { b { (source) } ": " (text) } }
                }
            }
        }
    }
}

fn grouped(lines: &[Line]) -> Vec<Vec<&Line>> {
    let mut groups: Vec<(String, Vec<&Line>)> = Vec::new();
    for line in lines {
        let kind = without_numbers(&line.1);
        match groups.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, group)) => group.push(line),
            None => groups.push((kind, vec![line])),
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

fn without_numbers(text: &str) -> String {
    text.chars().filter(|letter| !letter.is_ascii_digit() && *letter != '.').collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_that_differ_only_in_numbers_are_folded_below_the_first() {
        let line = |source: &str, text: &str| (source.to_owned(), text.to_owned());
        let mut lines = vec![line("a", "lost 3.5 s"), line("b", "mended"), line("c", "lost 12 s")];
        let sizes: Vec<_> = grouped(&lines).iter().map(Vec::len).collect();
        assert_eq!(sizes, [2, 1]);
        assert!(!list(&lines).into_string().contains("<details>"), "two stand in full");
        lines.extend([line("d", "lost 1 s"), line("e", "lost 2 s")]);
        assert!(list(&lines).into_string().contains("3 more alike"));
    }
}
