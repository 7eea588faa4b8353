//! A real browser for stories about the page: Chromium, driven by the scripts beside this file.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;

use super::{chromium, debian};

/// What every story shares: the programs, and the folder with the packages that drive the browser.
struct Stage {
    chromium: &'static Path,
    node: PathBuf,
    packages: PathBuf,
}

/// Sets the stage before a story whose tank does not wait for it.
pub(crate) fn set() {
    stage();
}

/// Set up once, however many stories want it at once.
fn stage() -> &'static Stage {
    static STAGE: OnceLock<Stage> = OnceLock::new();
    STAGE.get_or_init(|| Stage {
        chromium: chromium::program(),
        node: debian::program("node", "nodejs"),
        packages: packages(),
    })
}

/// The packages of `package-lock.json`, below `target/`.
fn packages() -> PathBuf {
    let home = Path::new(env!("CARGO_TARGET_TMPDIR")).join("browser");
    fs::create_dir_all(&home).expect("a folder below target");
    // Another run of the tests may be installing them.
    let lock = File::create(home.join("lock")).expect("a lock file");
    lock.lock().expect("the lock");
    let (installed, wanted) = (home.join("installed"), fs::read(beside("package-lock.json")));
    let wanted = wanted.expect("a file of ours");
    if fs::read(&installed).is_ok_and(|installed| installed == wanted) {
        return home;
    }
    for name in ["package.json", "package-lock.json"] {
        fs::copy(beside(name), home.join(name)).expect("the disk has room");
    }
    let npm = debian::program("npm", "npm");
    let output = Command::new(npm)
        .args(["ci", "--no-audit", "--no-fund"])
        .current_dir(&home)
        .output()
        .expect("npm runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "npm ci in {}: {said}", home.display());
    // Told last, so that half of an installation is none.
    fs::write(installed, wanted).expect("the disk has room");
    home
}

fn beside(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser").join(name)
}

/// Plays a story of the browser; what it asks of the tank is done by `tank`, whose answer it gets.
pub(crate) fn play(story: &str, arguments: &[&str], mut tank: impl FnMut(&str) -> String) {
    let Stage { chromium, node, packages } = stage();
    let driver = Command::new(node)
        .arg(beside(&format!("{story}.mjs")))
        .args(arguments)
        .current_dir(packages)
        .env("CHROMIUM", chromium)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut node = Ended(driver.expect("node runs"));
    let mut asks = node.0.stdin.take().expect("it is piped");
    let mut stderr = node.0.stderr.take().expect("it is piped");
    let complaints = std::thread::spawn(move || {
        let mut said = String::new();
        stderr.read_to_string(&mut said).ok();
        said
    });
    let mut is_done = false;
    for line in BufReader::new(node.0.stdout.take().expect("it is piped")).lines() {
        let line = line.expect("it is text");
        match line.strip_prefix("ask ") {
            // A story that has failed meanwhile says so at its end.
            Some(what) => writeln!(asks, "{}", tank(what)).unwrap_or_default(),
            None if line == "done" => is_done = true,
            None => println!("{story}: {line}"),
        }
    }
    let status = node.0.wait().expect("it is our child");
    let said = complaints.join().expect("it only reads");
    assert!(status.success() && is_done, "{story}: {said}");
}

/// The driver, killed when the story fails before it.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}
