//! The frame of every page: head, style, sections, tables.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{ReportError, notation, number};
use crate::inverse::estimate::Estimate;

/// The style sheet, which is part of every page.
pub(super) const STYLE: &str = include_str!("page.css");

/// Rows of a table, each of two lines, that fit on an A4 page with its heading.
const ROWS_ON_A_PAGE: usize = 24;

/// A whole page; it needs nothing beside itself.
pub(super) fn page(title: &str, body: &Markup) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) (PreEscaped(running_head(title))) }
            }
            body {
                (body)
                footer {
                    "Written by rolltank " (env!("CARGO_PKG_VERSION"))
                    ". SI units, model scale; intervals are central 95 % credible intervals."
                }
            }
        }
    }
}

/// A page of ours with its style sheet beside it, as a server gives it that lets no page bring
/// styles of its own.
pub(super) fn with_style_beside(page: &str, address: &str) -> String {
    const END: &str = "</style>";
    let (Some(from), Some(to)) = (page.find("<style>"), page.find(END)) else {
        return page.to_owned();
    };
    let beside = html! { link rel="stylesheet" href=(address); }.into_string();
    format!("{}{beside}{}", &page[..from], &page[to + END.len()..])
}

/// The rule that prints the title at the head of every sheet.
fn running_head(title: &str) -> String {
    // What ends a string of CSS, or the element that holds the rule, is written by its number.
    let escaped = title.chars().map(|letter| match letter {
        '"' | '\\' | '<' | '>' | '&' => format!("\\{:x} ", u32::from(letter)),
        letter if letter.is_control() => " ".to_owned(),
        letter => letter.to_string(),
    });
    format!("@page {{ @top-left {{ content: \"{}\"; }} }}", escaped.collect::<String>())
}

/// A section with its heading; `id` is unique on its page.
pub(super) fn section(id: &str, heading: &str, content: &Markup) -> Markup {
    html! { section id=(id) { h2 { (heading) } (content) } }
}

/// A column: its heading and its unit, empty for a column without one.
pub(super) type Column<'a> = (&'a str, &'a str);

/// A table with a caption, one markup per row holding its cells.
pub(super) fn table(id: &str, caption: &str, columns: &[Column], rows: &[Markup]) -> Markup {
    html! {
        // A table that fits on a page is not cut; the head of a longer one is printed again.
        // One that is wider than its window is scrolled, by keys too.
        div.table.whole[rows.len() <= ROWS_ON_A_PAGE]
            tabindex="0" role="region" aria-label=(label(caption)) {
            table id=(id) {
                caption { (notation::html(caption)) }
                thead { tr {
                    @for (name, unit) in columns {
                        th scope="col" {
                            (notation::html(name))
                            @if !unit.is_empty() { " " span.unit { "[" (unit) "]" } }
                        }
                    }
                } }
                tbody { @for row in rows { tr { (row) } } }
            }
        }
    }
}

/// What a screen reader calls a table: the first sentence of its caption.
fn label(caption: &str) -> String {
    let end = caption.find(['.', ':', ';', ',']).unwrap_or(caption.len());
    notation::plain(&caption[..end])
}

/// A cell with an estimate, its interval on the line below.
pub(super) fn estimate_cell(estimate: Option<&Estimate>) -> Markup {
    html! {
        @if let Some(estimate) = estimate {
            td.number.stacked {
                (typeset(&number::mean(estimate))) " "
                span.interval { (typeset(&number::interval(estimate))) }
            }
        } @else {
            td.number { (number::UNKNOWN) }
        }
    }
}

/// The same with at most four significant digits of the mean, for a table read at a glance.
pub(super) fn short_estimate_cell(estimate: Option<&Estimate>) -> Markup {
    let Some(estimate) = estimate else { return estimate_cell(None) };
    let (mean, interval) = number::parts_within(estimate, 4);
    html! { td.number.stacked { (typeset(&mean)) " " span.interval { (typeset(&interval)) } } }
}

/// A cell with a number that is already rounded.
pub(super) fn number_cell(text: &str) -> Markup {
    html! { td.number { (typeset(text)) } }
}

/// A cell with words.
pub(super) fn text_cell(text: &str) -> Markup {
    html! { td { (notation::html(text)) } }
}

/// A number with the printer's minus sign.
pub(super) fn typeset(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

/// File name of the page of a run.
pub(super) fn run_file_name(id: &str) -> Result<String, ReportError> {
    let inside = !id.is_empty() && !id.starts_with('.') && !id.contains(['/', '\\', '\0']);
    if inside {
        Ok(format!("run-{id}.html"))
    } else {
        Err(ReportError::RunId { id: id.to_owned() })
    }
}

/// The same name in a link, every byte outside the unreserved set of RFC 3986 written as `%XX`.
pub(super) fn run_link(id: &str) -> String {
    let escaped = id.bytes().map(|byte| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => {
            char::from(byte).to_string()
        }
        _ => format!("%{byte:02X}"),
    });
    format!("run-{}.html", escaped.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_id_cannot_lead_out_of_the_folder() {
        for id in ["", "../x", "a/b", "..", "a\\b", ".hidden"] {
            assert!(run_file_name(id).is_err(), "{id}");
        }
        assert_eq!(run_file_name("pass_03-2").unwrap(), "run-pass_03-2.html");
    }

    #[test]
    fn a_link_is_valid_for_any_id() {
        assert_eq!(run_link("fähre 3"), "run-f%C3%A4hre%203.html");
    }
}
