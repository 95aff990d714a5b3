//! Runs that end early, and results that must not be replaced.

use retune_store::{Begin, Directory, Error, Extent, Identity, Order, manifest};
use std::path::Path;

const TABLE: &str = "table.csv";

fn order(begin: Begin) -> Order {
    Order { command: "tune", study: "study.json".into(), begin, replace: false }
}

fn open(path: &Path, order: &Order, identity: &Identity) -> Result<Directory, Error> {
    Directory::open(path, order, identity, Extent::Whole, |name| [TABLE, manifest::NAME].contains(&name))
}

/// The value of an objective through the journal, and whether it was recalled. It is `value` where it is computed.
fn value(results: &Directory, value: f64) -> (f64, bool) {
    let mut recalled = false;
    let found = results.journal().value("search", &[1.0, 2.0], f64::INFINITY, || value, |_| recalled = true);
    (found, recalled)
}

/// Writes a table with its manifest and finishes.
fn finish(results: Directory, text: &str) -> Result<(), Error> {
    results.write(TABLE, text)?;
    results.write_manifest([serde_json::json!({ "method": "hybrid" })])?;
    results.finish()
}

#[test]
fn contract_a_run_that_ends_by_an_error_keeps_its_journal() {
    let desk = tempfile::tempdir().expect("a directory");
    let (path, identity) = (desk.path().join("results"), Identity::of("study"));
    let first = open(&path, &order(Begin::New), &identity).expect("an empty directory");
    assert_eq!(value(&first, 0.5), (0.5, false));
    drop(first); // as where `?` leaves the job

    match open(&path, &order(Begin::New), &identity).map(drop) {
        Err(Error::Unfinished { lines: 1, damaged: 0, difference: None, .. }) => {}
        other => panic!("{other:?}"),
    }
    let other = Identity::of("another study");
    match open(&path, &order(Begin::Resume), &other).map(drop) {
        Err(Error::Unfinished { lines: 1, difference: Some(_), .. }) => {}
        other => panic!("{other:?}"),
    }
    // Neither refusal removed anything, nor does a resumed run that computes nothing more.
    for _ in 0..2 {
        let resumed = open(&path, &order(Begin::Resume), &identity).expect("work to go on with");
        assert_eq!(value(&resumed, 7.0), (0.5, true));
    }
    let restarted = open(&path, &order(Begin::Restart), &identity).expect("work to throw away");
    assert_eq!(value(&restarted, 7.0), (7.0, false));
}

#[test]
fn contract_a_run_that_computed_nothing_leaves_nothing_behind() {
    let desk = tempfile::tempdir().expect("a directory");
    let (path, identity) = (desk.path().join("results"), Identity::of("study"));
    let first = open(&path, &order(Begin::New), &identity).expect("an empty directory");
    assert!(Directory::is_unfinished(&path));
    first.write(TABLE, "x\n").expect("a file");
    drop(first);
    let left: Vec<_> = std::fs::read_dir(&path).expect("the directory").collect();
    assert!(left.is_empty(), "{left:?}");
    let second = open(&path, &order(Begin::New), &identity).expect("nothing is in the way");
    assert_eq!(second.journal().known(), 0);
}

#[test]
fn contract_results_of_another_identity_are_refused_unless_they_may_be_replaced() {
    let desk = tempfile::tempdir().expect("a directory");
    let path = desk.path().join("results");
    let [own, edited, other] = ["study", "study, edited", "another study"].map(Identity::of);
    let table = || std::fs::read_to_string(path.join(TABLE)).expect("a table");
    let of_study = order(Begin::New);
    finish(open(&path, &of_study, &own).expect("an empty directory"), "1\n").expect("results");

    let of_other = Order { study: "other.json".into(), ..of_study.clone() };
    match open(&path, &of_other, &other).map(drop) {
        Err(Error::Standing { problem, .. }) => {
            assert!(problem.starts_with("the results of `retune tune` with "), "{problem}");
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(table(), "1\n");
    assert!(Directory::is_finished(&path, &own, TABLE));

    // The same study file, edited since, replaces its own results; another study only where it was told to.
    finish(open(&path, &of_study, &edited).expect("own results"), "2\n").expect("results");
    assert_eq!(table(), "2\n");
    let replace = Order { replace: true, ..of_other };
    finish(open(&path, &replace, &other).expect("results to replace"), "3\n").expect("results");
    assert_eq!(table(), "3\n");
    assert!(Directory::is_finished(&path, &other, TABLE) && !Directory::is_finished(&path, &edited, TABLE));
}

/// A process that was killed while it wrote the manifest leaves a temporary file beside the results; no other file is touched.
#[test]
fn regress_what_a_killed_process_left_of_a_manifest_is_removed() {
    let desk = tempfile::tempdir().expect("a directory");
    let (path, identity) = (desk.path().join("results"), Identity::of("study"));
    std::fs::create_dir(&path).expect("a directory");
    let left = [".manifest.json.4711.tmp", ".manifest.json.mine.tmp", ".hidden"].map(|name| path.join(name));
    left.iter().for_each(|path| std::fs::write(path, "half").expect("a file"));
    let results = open(&path, &order(Begin::New), &identity).expect("a directory");
    finish(results, "1,2\n").expect("results");
    assert_eq!(left.map(|path| path.exists()), [false, true, true]);
}
