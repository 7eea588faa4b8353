//! All pages of a report as one document for the printer, made from the pages on disk.

use std::fs;
use std::path::Path;

use maud::{Markup, PreEscaped, html};

use super::document::{self, run_file_name, run_link};
use super::{APPENDIX_PAGE, DIAGNOSIS_PAGE, ReportError};

/// The campaign's page in a report folder.
const CAMPAIGN_PAGE: &str = "index.html";

/// How much of a report is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// The campaign, the diagnosis, the appendix, and of each run how well its law describes it.
    Summary,
    /// Every page.
    EveryPage,
}

/// The section of a run's page that stands in a summary.
const SHOWN_OF_A_RUN: &str = "<section id=\"resimulation-section\">";

/// The campaign's page, the diagnosis, every run, the appendix; whole pages each begin a sheet.
///
/// Links between the pages lead within the document.
///
/// # Errors
/// A page that is not there or cannot be read, or an id that can name none.
pub fn book(
    campaign: &str,
    ids: &[&str],
    dir: &Path,
    extent: Extent,
) -> Result<String, ReportError> {
    let fixed = |name: &str| Page { name: name.to_owned(), link: name.to_owned(), of_a_run: false };
    let mut pages = vec![fixed(CAMPAIGN_PAGE), fixed(DIAGNOSIS_PAGE)];
    for id in ids {
        pages.push(Page { name: run_file_name(id)?, link: run_link(id), of_a_run: true });
    }
    if dir.join(APPENDIX_PAGE).is_file() {
        pages.push(fixed(APPENDIX_PAGE));
    }
    let mut sheets = Vec::new();
    for (index, page) in pages.iter().enumerate() {
        let path = dir.join(&page.name);
        let read = fs::read_to_string(&path);
        let text = read.map_err(|source| ReportError::Read { path, source })?;
        let is_excerpt = page.of_a_run && extent == Extent::Summary;
        let shown = if is_excerpt { excerpt(own(&text)) } else { own(&text).to_owned() };
        sheets.push((&page.name, is_excerpt, sheet(&shown, index, &pages)));
    }
    let body = html! {
        @for (name, is_excerpt, sheet) in &sheets {
            article.excerpt[*is_excerpt] id=(name) { (sheet) }
        }
    };
    Ok(document::page(campaign, &body).into_string())
}

/// A page of the report on disk.
struct Page {
    name: String,
    /// The name as links say it.
    link: String,
    of_a_run: bool,
}

/// What a page says, without its frame.
fn own(page: &str) -> &str {
    let body = page.split_once("<body>").map_or(page, |(_, body)| body);
    body.rsplit_once("<footer>").map_or(body, |(own, _)| own)
}

/// Title, judgements and resimulation of a run.
fn excerpt(own: &str) -> String {
    const END: &str = "</section>";
    let title = own.split_once("<section").map_or(own, |(title, _)| title);
    let shown = own.split_once(SHOWN_OF_A_RUN).and_then(|(_, rest)| rest.split_once(END));
    match shown {
        Some((shown, _)) => format!("{title}{SHOWN_OF_A_RUN}{shown}{END}"),
        None => title.to_owned(),
    }
}

/// A page with its ids and links made unique in the whole document.
fn sheet(own: &str, index: usize, pages: &[Page]) -> Markup {
    let mut text = own.replace(" id=\"", &format!(" id=\"s{index}-"));
    text = relabelled(&text, index);
    for Page { name, link, .. } in pages {
        text = text.replace(&format!(" href=\"{link}\""), &format!(" href=\"#{name}\""));
    }
    PreEscaped(text)
}

/// The ids that label a drawing, each made unique like the ids themselves.
fn relabelled(text: &str, index: usize) -> String {
    const LABELS: &str = " aria-labelledby=\"";
    let mut parts = text.split(LABELS);
    let mut relabelled = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (ids, rest) = part.split_once('"').unwrap_or((part, ""));
        let ids: Vec<String> = ids.split(' ').map(|id| format!("s{index}-{id}")).collect();
        relabelled.push_str(LABELS);
        relabelled.push_str(&ids.join(" "));
        relabelled.push('"');
        relabelled.push_str(rest);
    }
    relabelled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_labels_and_links_of_a_page_stay_together_within_the_book() {
        let page = "<body><svg aria-labelledby=\"a-title a-text\"><title id=\"a-title\">\
            <a href=\"run-x%20y.html\"><footer>rolltank";
        let (name, link) = ("run-x y.html".to_owned(), "run-x%20y.html".to_owned());
        let pages = [Page { name, link, of_a_run: true }];
        assert_eq!(
            sheet(own(page), 3, &pages).into_string(),
            "<svg aria-labelledby=\"s3-a-title s3-a-text\"><title id=\"s3-a-title\">\
             <a href=\"#run-x y.html\">"
        );
    }

    #[test]
    fn an_excerpt_is_the_title_and_the_resimulation() {
        let page = "<h1>Run a</h1><section id=\"facts\">much</section>\
            <section id=\"resimulation-section\">this</section>\
            <section id=\"gates\">more</section>";
        let wanted = "<h1>Run a</h1><section id=\"resimulation-section\">this</section>";
        assert_eq!(excerpt(page), wanted);
        assert_eq!(excerpt("<h1>Run a</h1>"), "<h1>Run a</h1>");
    }
}
