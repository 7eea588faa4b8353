//! One notation for subscripts, `b_{eq}`, in pages, in figures, in plain text.

use maud::{Markup, html};

/// A text cut into plain stretches and subscripts, in order.
fn pieces(text: &str) -> Vec<(&str, bool)> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("_{") {
        let Some((subscript, behind)) = after.split_once('}') else { break };
        pieces.push((before, false));
        pieces.push((subscript, true));
        rest = behind;
    }
    pieces.push((rest, false));
    pieces
}

/// The text as HTML, escaped, with subscripts lowered.
pub(crate) fn html(text: &str) -> Markup {
    html! {
        @for (piece, lowered) in pieces(text) {
            @if lowered { sub { (piece) } } @else { (piece) }
        }
    }
}

/// The text without markup: `b_eq`.
pub(crate) fn plain(text: &str) -> String {
    pieces(text)
        .into_iter()
        .map(|(piece, lowered)| if lowered { format!("_{piece}") } else { piece.to_owned() })
        .collect()
}

/// The text of an SVG drawing, already escaped, with subscripts lowered.
///
/// Browsers differ on `baseline-shift`, so the shift down is taken back on an empty character.
pub(crate) fn svg(escaped: &str) -> String {
    pieces(escaped)
        .into_iter()
        .map(|(piece, lowered)| {
            if lowered {
                format!(
                    "<tspan dy=\"0.25em\" font-size=\"75%\">{piece}</tspan>\
                     <tspan dy=\"-0.19em\">\u{200b}</tspan>"
                )
            } else {
                piece.to_owned()
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subscripts_are_lowered_while_all_else_is_escaped() {
        assert_eq!(html("b_{eq} < 1").into_string(), "b<sub>eq</sub> &lt; 1");
        assert_eq!(plain("b_{eq} [1/s]"), "b_eq [1/s]");
    }

    #[test]
    fn a_brace_left_open_is_plain_text() {
        assert_eq!(html("run_{1").into_string(), "run_{1");
    }
}
