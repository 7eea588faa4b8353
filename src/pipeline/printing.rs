//! Printing a report: a browser that is installed makes the PDF from our own pages.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use crate::report::{self, Extent, ReportError};
use crate::results::Results;

/// The printed report in a report folder.
pub const PRINTED_REPORT: &str = "report.pdf";

/// Names under which Chromium and Chrome are installed.
const NAMES: [&str; 5] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// Where a browser is named that lies elsewhere.
pub const BROWSER_VARIABLE: &str = "ROLLTANK_CHROMIUM";

/// How often it is looked whether the browser has ended, and at most how many times: half an hour,
/// where a campaign of a thousand runs takes minutes.
const LOOK: Duration = Duration::from_millis(20);
const N_LOOKS: usize = 90_000;

/// A report that cannot be printed.
#[derive(Debug, thiserror::Error)]
pub enum PrintError {
    /// The pages cannot be put together.
    #[error(transparent)]
    Report {
        /// Why not.
        #[from]
        source: ReportError,
    },
    /// No browser is installed.
    #[error(
        "no Chromium or Chrome is on PATH, and the PDF needs one\n\
         hint: install it (`apt-get install chromium`), or name it in {BROWSER_VARIABLE}; the \
         pages are written and can be printed from any browser"
    )]
    NoBrowser,
    /// The browser cannot be started, or a file beside its PDF cannot be written.
    #[error("printing with \"{}\": {source}", browser.display())]
    System {
        /// The browser.
        browser: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The browser ended without a PDF.
    #[error(
        "\"{}\" printed nothing: {said}\nhint: try another browser, named in {BROWSER_VARIABLE}",
        browser.display()
    )]
    NothingPrinted {
        /// The browser.
        browser: PathBuf,
        /// The last line it said.
        said: String,
    },
}

/// Prints the pages in `dir` to one PDF with vector figures; returns its path.
pub fn print_report(
    campaign: &str,
    results: &Results,
    dir: &Path,
    extent: Extent,
) -> Result<PathBuf, PrintError> {
    let browser = browser().ok_or(PrintError::NoBrowser)?;
    let ids: Vec<&str> = results.runs.iter().map(|run| run.id.as_str()).collect();
    let book = report::book(campaign, &ids, dir, extent)?;
    // Not hidden: a browser that came as a snap sees no hidden folder.
    let workshop = dir.join("printing");
    let printed = print(&browser, &book, &workshop, &dir.join(PRINTED_REPORT));
    // The PDF is there or the error is told; a leftover is written over next time.
    fs::remove_dir_all(&workshop).ok();
    printed
}

fn browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os(BROWSER_VARIABLE) {
        return Some(named.into());
    }
    let folders = std::env::var_os("PATH")?;
    let mut all =
        std::env::split_paths(&folders).flat_map(|folder| NAMES.map(|name| folder.join(name)));
    all.find(|path| path.is_file())
}

fn print(browser: &Path, book: &str, workshop: &Path, pdf: &Path) -> Result<PathBuf, PrintError> {
    let system = |source| PrintError::System { browser: browser.to_owned(), source };
    let page = workshop.join("book.html");
    let said = workshop.join("said.txt");
    fs::create_dir_all(workshop).and_then(|()| fs::write(&page, book)).map_err(system)?;
    let workshop = workshop.canonicalize().map_err(system)?;
    let fresh = workshop.join("book.pdf");
    let option = |name: &str, path: &Path| {
        let mut option = OsString::from(name);
        option.push(path);
        option
    };
    let mut command = Command::new(browser);
    command
        .args(["--headless", "--disable-gpu", "--no-first-run", "--no-pdf-header-footer"])
        .arg(option("--user-data-dir=", &workshop.join("profile")))
        .arg(option("--print-to-pdf=", &fresh))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(fs::File::create(&said).map_err(system)?);
    if fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0) {
        // The sandbox refuses root, and the page is our own.
        command.arg("--no-sandbox");
    }
    let mut printer = command.arg(workshop.join("book.html")).spawn().map_err(system)?;
    let mut n_looks = 0;
    while printer.try_wait().map_err(system)?.is_none() {
        if n_looks == N_LOOKS {
            printer.kill().and_then(|()| printer.wait()).map_err(system)?;
        }
        n_looks += 1;
        thread::sleep(LOOK);
    }
    if !fresh.is_file() {
        let said = fs::read_to_string(&said).unwrap_or_default();
        let said = said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("no word of it");
        let (browser, said) = (browser.to_owned(), said.to_owned());
        return Err(PrintError::NothingPrinted { browser, said });
    }
    fs::rename(&fresh, pdf).map_err(system)?;
    Ok(pdf.to_owned())
}
