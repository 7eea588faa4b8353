//! `rolltank demo`: a day in a folder of its own, watched in a browser while it lasts, then told.

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

use super::browser;

#[test]
fn the_demo_reports_the_papers_campaign_in_a_folder_of_its_own_and_shows_it_meanwhile() {
    // The day does not wait until a browser is installed.
    browser::set();
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("rolltank-demo")).unwrap();
    let mut demo = Command::new(env!("CARGO_BIN_EXE_rolltank"))
        .arg("demo")
        .current_dir(folder.path())
        .env_remove("RUST_LOG")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program was built");
    let mut out = BufReader::new(demo.stdout.take().expect("it is piped"));
    let mut told = String::new();
    while !told.contains("http://") {
        assert!(out.read_line(&mut told).expect("it is text") > 0, "no page is told: {told}");
    }
    let address = told.split("http://").nth(1).and_then(|rest| rest.split('/').next());
    browser::play("demo", &[address.expect("an address")], |what| panic!("nobody can {what}"));

    out.read_to_string(&mut told).expect("it is text");
    let status = demo.wait().expect("it is our child");
    assert!([Some(0), Some(3)].contains(&status.code()), "{told}");
    for words in ["bare hull", "bilge keels", "kappa = ", "report: rolltank-demo-2/results/"] {
        assert!(told.contains(words), "{words} is not in:\n{told}");
    }
    assert!(folder.path().join("rolltank-demo-2/results/index.html").is_file());
    // Nothing hides in that tank, and its instruments' noise is white.
    let diagnosis = folder.path().join("rolltank-demo-2/results/diagnosis.json");
    let diagnosis = std::fs::read_to_string(diagnosis).expect("the day was diagnosed");
    let diagnosis: serde_json::Value = serde_json::from_str(&diagnosis).expect("JSON");
    assert_eq!(diagnosis["verdict"], "adequate", "{:#}", diagnosis["causes"]);
    assert_eq!(std::fs::read_dir(folder.path().join("rolltank-demo")).unwrap().count(), 0);
}
