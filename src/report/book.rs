//! All pages of a report as one document for the printer, made from the pages on disk.

use std::fs;
use std::path::Path;

use maud::{Markup, PreEscaped, html};

use super::document::{self, run_file_name, run_link};
use super::{APPENDIX_PAGE, DIAGNOSIS_PAGE, ReportError};

/// The campaign's page in a report folder.
const CAMPAIGN_PAGE: &str = "index.html";

/// The campaign's page, the diagnosis, then every run, the appendix, each from a new sheet
/// on.
///
/// Links between the pages lead within the document.
///
/// # Errors
/// A page that is not there or cannot be read, or an id that can name none.
pub fn book(campaign: &str, ids: &[&str], dir: &Path) -> Result<String, ReportError> {
    let mut pages = vec![(CAMPAIGN_PAGE.to_owned(), CAMPAIGN_PAGE.to_owned())];
    pages.push((DIAGNOSIS_PAGE.to_owned(), DIAGNOSIS_PAGE.to_owned()));
    for id in ids {
        pages.push((run_file_name(id)?, run_link(id)));
    }
    if dir.join(APPENDIX_PAGE).is_file() {
        pages.push((APPENDIX_PAGE.to_owned(), APPENDIX_PAGE.to_owned()));
    }
    let mut sheets = Vec::new();
    for (index, (name, _)) in pages.iter().enumerate() {
        let path = dir.join(name);
        let read = fs::read_to_string(&path);
        let page = read.map_err(|source| ReportError::Read { path, source })?;
        sheets.push((name, sheet(&page, index, &pages)));
    }
    let body = html! {
        @for (name, sheet) in &sheets { article id=(name) { (sheet) } }
    };
    Ok(document::page(campaign, &body).into_string())
}

/// What a page says, its ids and links made unique in the whole document.
fn sheet(page: &str, index: usize, pages: &[(String, String)]) -> Markup {
    let body = page.split_once("<body>").map_or(page, |(_, body)| body);
    let own = body.rsplit_once("<footer>").map_or(body, |(own, _)| own);
    let mut text = own.replace(" id=\"", &format!(" id=\"s{index}-"));
    text = relabelled(&text, index);
    for (name, link) in pages {
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
        let pages = [("run-x y.html".to_owned(), "run-x%20y.html".to_owned())];
        assert_eq!(
            sheet(page, 3, &pages).into_string(),
            "<svg aria-labelledby=\"s3-a-title s3-a-text\"><title id=\"s3-a-title\">\
             <a href=\"#run-x y.html\">"
        );
    }
}
