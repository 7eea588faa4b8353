//! Which files count as recordings, and what an import leaves behind.

use std::fs;

use devices::Quantity::Roll;
use replay::{ReplayError, import, list_recordings};

use crate::recordings::{columns, folder, table, write};

#[test]
fn tables_and_mcap_files_are_listed_sorted_without_results_and_hidden_ones() {
    let folder = folder();
    for name in ["b/c", "results/old", ".trash", "b/results"] {
        fs::create_dir_all(folder.path().join(name)).expect("the folder can be made");
    }
    let files = ["z.csv", "b/c/2.MCAP", "b/1.csv", "results/damping.csv", "results/old/x.mcap"];
    let others = [".hidden.csv", ".trash/gone.csv", "b/results/y.csv", "notes.txt", "z.mcap.part"];
    for name in files.iter().chain(&others) {
        write(&folder, name, "");
    }
    let listed = list_recordings(folder.path()).expect("the folder can be read");
    let expected = ["b/1.csv", "b/c/2.MCAP", "z.csv"].map(|name| folder.path().join(name));
    assert_eq!(listed, expected);
}

#[test]
fn a_folder_that_is_not_there_is_told() {
    let folder = folder();
    let error = list_recordings(&folder.path().join("gone")).expect_err("it is not there");
    assert!(matches!(error, ReplayError::Read { .. }));
    assert!(error.to_string().ends_with("gone\" cannot be read further"), "{error}");
}

#[test]
fn an_existing_file_is_never_overwritten() {
    let folder = folder();
    let pass = write(&folder, "pass.csv", "t,roll\n0,1\n");
    for taken in ["pass.mcap", "pass.mcap.part"] {
        let path = write(&folder, taken, "precious");
        let target = folder.path().join("pass.mcap");
        let files = [(None, pass.clone())];
        let error = import("pass", &files, &columns(&[Roll]), &target, "", &mut |_, _| {});
        let error = error.expect_err("the name is taken");
        assert!(matches!(error, ReplayError::Exists { .. }), "{error}");
        assert!(error.hint().expect("there is a hint").contains("another name"));
        assert_eq!(fs::read(&path).expect("it is there"), b"precious");
        fs::remove_file(&path).expect("it can be removed");
    }
}

#[test]
fn an_import_that_fails_leaves_nothing_behind() {
    let folder = folder();
    let rows = "0.5,1\n".repeat(3);
    let text = format!("t,roll\n0,1\n{rows}0.25,1\n");
    let target = folder.path().join("pass.mcap");
    let files = [(None, write(&folder, "pass.csv", text))];
    let error = import("pass", &files, &columns(&[Roll]), &target, "", &mut |_, _| {});
    assert!(matches!(error, Err(ReplayError::TimeBackwards { .. })), "{error:?}");

    let rows = (0..5000).map(|index| format!("{index},1")).chain(["5000,x".to_owned()]);
    let files = [(None, write(&folder, "pass.csv", table("t,roll", rows)))];
    let error = import("pass", &files, &columns(&[Roll]), &target, "", &mut |_, _| {});
    assert!(matches!(error, Err(ReplayError::Cell { line: 5002, .. })), "{error:?}");
    let left = fs::read_dir(folder.path()).expect("the folder can be read").count();
    assert_eq!(left, 1, "the table alone");
}
