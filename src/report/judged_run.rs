//! What people have judged of a run, told at the head of its page when that lies on disk already.
//!
//! The page is written once, as soon as the run is identified; its histories are then let go of, so
//! that a later judgement can only be laid over the page.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use maud::{Markup, html};

use super::document::run_file_name;
use super::{ReportError, whole_file};
use crate::judgement;
use crate::results::Results;

/// How the place of the judgements begins and ends on a page.
const OPENING: &str = "<div id=\"judged\">";
const CLOSING: &str = "</div>";

/// Bytes of a page within which that place lies: the style sheet and the title come before it.
const HEAD: u64 = 32 * 1024;

/// The place of the judgements, with a rejection and with notes.
pub(super) fn place(rejection: Option<&str>, notes: &[&str]) -> Markup {
    html! {
        div id="judged" {
            @if let Some(reason) = rejection {
                p.warning {
                    "This run is " (reason) ". It is in no table and no law of the campaign; what "
                    "follows is what it said when it was identified."
                }
            }
            @for note in notes { p.note { (note) } }
        }
    }
}

/// Tells on the page of each run whether it is rejected, and what was noted of it.
pub(super) fn tell(results: &Results, dir: &Path) -> Result<(), ReportError> {
    for run in &results.runs {
        let remarks = run.identification.remarks.iter().map(String::as_str);
        let notes: Vec<&str> = remarks.filter(|remark| judgement::is_note(remark)).collect();
        lay_over(dir, &run.id, &place(None, &notes).into_string())?;
    }
    for stretch in &results.rejected {
        if let Some(id) = &stretch.run {
            lay_over(dir, id, &place(Some(&stretch.reason), &[]).into_string())?;
        }
    }
    Ok(())
}

/// Puts the place as it is to be on a page, unless it is so already or there is no page.
fn lay_over(dir: &Path, id: &str, place: &str) -> Result<(), ReportError> {
    let name = run_file_name(id)?;
    let path = dir.join(&name);
    let fault = |source| ReportError::Read { path: path.clone(), source };
    let mut head = Vec::new();
    match File::open(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        opened => opened.and_then(|file| file.take(HEAD).read_to_end(&mut head)).map_err(fault)?,
    };
    if head.windows(place.len()).any(|there| there == place.as_bytes()) {
        return Ok(());
    }
    let page = fs::read_to_string(&path).map_err(fault)?;
    // A page of a version that had no such place says nothing of judgements.
    let Some((before, rest)) = page.split_once(OPENING) else { return Ok(()) };
    let Some((_, after)) = rest.split_once(CLOSING) else { return Ok(()) };
    whole_file::write(dir, &name, format!("{before}{place}{after}").as_bytes())?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_tells_of_a_judgement_until_that_is_undone() {
        let folder = tempfile::tempdir().unwrap();
        let page = |place: &str| format!("<body><h1>Run a</h1>{place}<div>more</div></body>");
        let told = || fs::read_to_string(folder.path().join("run-a.html")).unwrap();
        let [none, rejected] = [None, Some("rejected by hand by C. Costa, today: <a gust>")]
            .map(|reason| place(reason, &[]).into_string());
        lay_over(folder.path(), "a", &rejected).unwrap();
        fs::write(folder.path().join("run-a.html"), page(&none)).unwrap();
        lay_over(folder.path(), "a", &rejected).unwrap();
        assert_eq!(told(), page(&rejected));
        assert!(told().contains("This run is rejected by hand by C. Costa, today: &lt;a gust&gt;"));
        lay_over(folder.path(), "a", &none).unwrap();
        assert_eq!(told(), page(&none));
    }
}
