//! A tmpfs in a mount namespace of its own, which vanishes with the process that uses it.

use std::env;
use std::process::Command;

/// Names the folder with the small disk to the process on it, whose temporary files lie there too.
pub(crate) const FOLDER: &str = "ROLLTANK_SMALL_DISK";

/// What an ignored story of this program says on a disk of that size; none where this system lets
/// nobody mount one. The story's name begins with its crate.
pub(crate) fn told_on_a_disk_of(bytes: u64, story: &str) -> Option<String> {
    let namespaces: [&[&str]; 2] = [&["--mount"], &["--user", "--map-root-user", "--mount"]];
    namespaces.into_iter().find_map(|namespace| told_in(namespace, bytes, story))
}

fn told_in(namespace: &[&str], bytes: u64, story: &str) -> Option<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, story) = story.split_once("::").expect("the crate comes first");
    let script = "mount -t tmpfs -o size=$0 tmpfs $1 && echo mounted && shift && exec \"$@\"";
    let output = Command::new("unshare")
        .args(namespace)
        .args(["sh", "-c", script, &bytes.to_string()])
        .arg(folder.path())
        .arg(env::current_exe().expect("this program has a path"))
        .args(["--exact", story, "--ignored", "--nocapture"])
        .env(FOLDER, folder.path())
        .env("TMPDIR", folder.path())
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if !text.starts_with("mounted") {
        return None;
    }
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    Some(text)
}
