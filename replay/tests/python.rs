//! One Python with the reference packages, installed once however many tests want it at once.

use std::env;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The packages, pinned: an upgrade is a change of ours, not of the day the tests run.
const PACKAGES: [&str; 6] = [
    "mcap==1.6.0",
    "protobuf==6.33.6",
    "zstandard==0.25.0",
    "lz4==4.4.5",
    "pandas==2.3.3",
    "pyarrow==22.0.0",
];
/// Folder of the virtual environment; a change of the packages needs a new number.
const HOME: &str = "python_mcap_2";
/// What an interpreter that has the packages can do.
const IMPORT: [&str; 2] =
    ["-c", "import mcap.reader, zstandard, lz4.frame, google.protobuf, pandas, pyarrow"];

/// The interpreter of a virtual environment that has the packages; none without Python or network,
/// unless this is CI, where nothing may be passed over.
pub(crate) fn python() -> Option<&'static Path> {
    static PYTHON: OnceLock<Option<PathBuf>> = OnceLock::new();
    let python = PYTHON.get_or_init(|| match installed() {
        Ok(python) => Some(python),
        Err(error) if env::var_os("CI").is_none() => {
            eprintln!("skipped: no Python with its packages here: {error}");
            None
        }
        Err(error) => panic!("no Python with its packages: {error}"),
    });
    python.as_deref()
}

/// The interpreter, installed by the first process to come while all others wait.
///
/// The lock keeps two processes from installing at once. The environment is built under a name of
/// its own and renamed when it is whole, so that an installer that is killed leaves no half of one
/// behind: the folder is there with every package or not at all.
fn installed() -> Result<PathBuf, String> {
    let below = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let told = |what: &str, error: io::Error| format!("{what}: {error}");
    fs::create_dir_all(below).map_err(|error| told("the folder below target", error))?;
    let lock = File::create(below.join(format!("{HOME}.lock")));
    let lock = lock.map_err(|error| told("the lock file", error))?;
    lock.lock().map_err(|error| told("the lock", error))?;
    let home = below.join(HOME);
    let python = home.join("bin/python3");
    if run(&python, &IMPORT).is_ok() {
        return Ok(python);
    }
    if home.exists() {
        // Its Python was upgraded away; nobody else can be using it either.
        fs::remove_dir_all(&home).map_err(|error| told("the broken environment", error))?;
    }
    let fresh = tempfile::Builder::new().prefix(HOME).tempdir_in(below);
    let fresh = fresh.map_err(|error| told("a fresh folder", error))?;
    let at = fresh.path().join("bin/python3");
    run(Path::new("python3"), &["-m", "venv", &fresh.path().display().to_string()])?;
    run(&at, &[&["-m", "pip", "install", "--quiet"], PACKAGES.as_slice()].concat())?;
    run(&at, &IMPORT)?;
    // Python finds its packages from where its program stands, so the folder may be renamed; only
    // the scripts beside it name the old folder, and none of them is used.
    fs::rename(fresh.keep(), &home).map_err(|error| told("the rename", error))?;
    run(&python, &IMPORT)?;
    Ok(python)
}

/// Runs a program to its good end, or gives what it said.
fn run(program: &Path, arguments: &[&str]) -> Result<(), String> {
    match Command::new(program).args(arguments).output() {
        Ok(output) if output.status.success() => Ok(()),
        Ok(output) => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
        Err(error) => Err(format!("{}: {error}", program.display())),
    }
}

#[test]
fn many_at_once_get_the_same_interpreter() {
    let Some(python) = python() else { return };
    // Each by-passes this process's memory of the answer, as another process would.
    let found = std::thread::scope(|scope| {
        let asked: Vec<_> = (0..4).map(|_| scope.spawn(installed)).collect();
        asked.into_iter().map(|one| one.join().expect("no panic")).collect::<Vec<_>>()
    });
    assert!(found.iter().all(|one| one.as_deref() == Ok(python)), "{found:?}");
}
