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
            assert!(problem.starts_with("the directory holds results of `retune tune` for "), "{problem}");
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

/// Names in a manifest and in a journal are not this program's own words: whoever gives results away can have written them.
#[cfg(unix)]
#[test]
fn contract_names_that_lead_elsewhere_are_refused_and_what_is_there_stays() {
    let desk = tempfile::tempdir().expect("a directory");
    let (ours, theirs, identity) =
        (desk.path().join("ours"), desk.path().join("theirs"), Identity::of("study"));
    let precious = theirs.join("precious");
    for place in [&ours, &precious] {
        finish(open(place, &order(Begin::New), &identity).expect("a directory"), "x\n1\n").expect("results");
    }
    std::os::unix::fs::symlink(&theirs, ours.join("a")).expect("a link");
    let told = std::fs::read_to_string(ours.join(manifest::NAME)).expect("a manifest");
    let absolute = precious.display().to_string();
    let sha = manifest::file_sha256(&precious.join(TABLE)).expect("a file");
    let files = |name: &str| {
        let mut said: serde_json::Value = serde_json::from_str(&told).expect("JSON");
        said["files"][name] = sha.clone().into();
        said.to_string()
    };
    let parts = |name: &str| {
        let mut said: serde_json::Value = serde_json::from_str(&told).expect("JSON");
        said["parts"][name] = "the SHA-256 of its study".into();
        said.to_string()
    };
    let elsewhere = ["a/precious", "../theirs/precious", "a", "", absolute.as_str()];
    let of_parts = elsewhere.map(|name| ("parts", parts(name)));
    let of_files =
        ["a/precious/table.csv", "../theirs/precious/table.csv", ""].map(|name| ("files", files(name)));
    for (field, said) in of_parts.into_iter().chain(of_files) {
        std::fs::write(ours.join(manifest::NAME), &said).expect("a manifest");
        let tried = open(&ours, &order(Begin::New), &identity).and_then(|found| finish(found, "x\n2\n"));
        let Err(Error::Input { path, source }) = tried else { panic!("{field} {said}: {tried:?}") };
        assert_eq!(path, ours.join(manifest::NAME));
        assert!(source.to_string().starts_with(&format!("{field}: `")), "{source}");
        assert_eq!(std::fs::read_to_string(precious.join(TABLE)).expect("their table"), "x\n1\n", "{said}");
    }
    std::fs::write(ours.join(manifest::NAME), &told).expect("a manifest");

    // A run that is stopped leaves a journal with its parts; a link that is put there later leads nowhere either.
    for (name, link) in [("b/precious", "b"), ("../theirs/precious", "c")] {
        let first = open(&ours, &order(Begin::Restart), &identity).expect("results to replace");
        value(&first, 0.5);
        first.journal().note_part(name);
        drop(first);
        std::os::unix::fs::symlink(&theirs, ours.join(link)).expect("a link");
        for begin in [Begin::Resume, Begin::Restart] {
            let tried = open(&ours, &order(begin), &identity).and_then(|found| finish(found, "x\n2\n"));
            assert!(
                matches!(&tried, Err(Error::Input { path, .. }) if path.ends_with("journal")),
                "{tried:?}"
            );
            assert_eq!(std::fs::read_to_string(precious.join(TABLE)).expect("their table"), "x\n1\n");
        }
        std::fs::remove_dir_all(ours.join("unfinished")).expect("the work");
    }
    let own = open(&ours, &order(Begin::New), &identity).expect("results to replace");
    assert!(own.part("a/new").is_err() && own.part("../new").is_err());
    assert_eq!(own.part("inner/new").expect("a part"), ours.join("inner/new"));
}
