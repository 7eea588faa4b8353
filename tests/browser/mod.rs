//! A real browser for stories about the page: Chromium, driven by the scripts beside this file.

use std::env;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;

/// Where a package manager puts Chromium.
const CHROMIUM: [&str; 3] =
    ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
/// What to do where something is missing and cannot be installed from here.
const HINT: &str = "the stories of the page need Chromium and node 20 with npm: \
    apt-get install chromium nodejs npm";

/// What every story shares: the browser, and the folder with the packages that drive it.
struct Stage {
    chromium: PathBuf,
    packages: PathBuf,
}

/// Set up once, however many stories want it at once.
fn stage() -> &'static Stage {
    static STAGE: OnceLock<Stage> = OnceLock::new();
    STAGE.get_or_init(|| Stage { chromium: chromium(), packages: packages() })
}

fn chromium() -> PathBuf {
    let known = || CHROMIUM.iter().map(PathBuf::from).find(|path| path.exists());
    if let Some(chromium) = known() {
        return chromium;
    }
    for arguments in [&["update"][..], &["install", "-y", "--no-install-recommends", "chromium"]] {
        run(Command::new("apt-get").args(arguments).env("DEBIAN_FRONTEND", "noninteractive"));
    }
    known().unwrap_or_else(|| panic!("no Chromium after its installation; {HINT}"))
}

/// The packages of `package-lock.json`, below `target/`.
fn packages() -> PathBuf {
    let home = Path::new(env!("CARGO_TARGET_TMPDIR")).join("browser");
    fs::create_dir_all(&home).expect("a folder below target");
    // Another run of the tests may be installing them.
    let lock = File::create(home.join("lock")).expect("a lock file");
    lock.lock().expect("the lock");
    let files = ["package.json", "package-lock.json"].map(|name| (beside(name), home.join(name)));
    let same = |(from, to): &(PathBuf, PathBuf)| {
        fs::read(to).is_ok_and(|installed| installed == fs::read(from).expect("a file of ours"))
    };
    if files.iter().all(same) && home.join("node_modules/playwright-core").exists() {
        return home;
    }
    for (from, to) in files.iter().rev() {
        fs::copy(from, to).expect("the disk has room");
    }
    run(Command::new("npm").args(["ci", "--no-audit", "--no-fund"]).current_dir(&home));
    home
}

fn beside(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser").join(name)
}

/// Runs a program to its good end.
fn run(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}; {HINT}"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}\n{HINT}");
}

/// Plays a story of the browser; what it asks of the tank is done by `tank`, whose answer it gets.
pub(crate) fn play(story: &str, arguments: &[&str], mut tank: impl FnMut(&str) -> String) {
    let Stage { chromium, packages } = stage();
    let node = Command::new("node")
        .arg(beside(&format!("{story}.mjs")))
        .args(arguments)
        .current_dir(packages)
        .env("CHROMIUM", chromium)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut node = Ended(node.unwrap_or_else(|error| panic!("node: {error}; {HINT}")));
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
