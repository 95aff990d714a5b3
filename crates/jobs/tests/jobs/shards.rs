//! A grid in parts: the bytes of a single process, and the errors of wrong parts.

use crate::{request, search};
use retune_jobs::tune::merge::merge;
use retune_jobs::tune::merge::share;
use retune_jobs::{Error, Request, Silent};
use retune_study::Rule;
use retune_testkit::desk::{Desk, edited, tiny};
use retune_testkit::observers::{Record, good, refused};
use serde_json::json;
use std::path::PathBuf;

/// The tiny study, and its results in `whole`.
fn desk() -> Desk {
    let desk = Desk::with(&tiny());
    search(&desk, "study.json", "whole");
    desk
}

#[track_caller]
fn make(desk: &Desk, study: &str, shards: &[&str]) {
    for shard in shards {
        good(share(&request(desk, study, "out"), shard.parse().expect("a share"), &Silent));
    }
}

/// The merge of the parts in `out`.
fn merged(desk: &Desk) -> Result<(), Error> {
    merge(&request(desk, "study.json", "out"), &[], &Silent).map(drop)
}

/// The file of a share, by the beginning of its name.
fn part(desk: &Desk, start: &str) -> String {
    let names = desk.names("out/parts");
    names.into_iter().find(|name| name.starts_with(start)).expect("a part")
}

/// The merge is refused because of this part, for this reason.
#[track_caller]
fn part_is_refused(desk: &Desk, name: &str, reason: &str) {
    match refused(merged(desk)) {
        Error::Part { path, problem } => {
            assert_eq!((path, problem.as_str()), (desk.path("out/parts").join(name), reason));
        }
        other => panic!("{other}"),
    }
    assert_eq!(desk.names("out"), ["parts"], "nothing may be left behind");
}

#[test]
fn contract_merged_parts_are_the_bytes_of_one_process() {
    let desk = desk();
    for shards in [vec!["1/1"], vec!["3/3", "1/3", "2/3"], vec!["1/4", "2/4", "4/4", "3/4"]] {
        make(&desk, "study.json", &shards);
        assert_eq!(desk.names("out/parts").len(), shards.len(), "no more than the parts");
        good(merged(&desk));
        desk.remove("out/parts");
        desk.assert_same("out", "whole");
        desk.remove("out");
    }
}

/// More shares than points, and parts from two divisions that are complementary.
#[test]
fn contract_shares_may_be_empty_or_of_different_sizes() {
    let desk = desk();
    make(&desk, "study.json", &["1/2", "3/4", "4/4"]);
    good(merged(&desk));
    assert_eq!(desk.read("out/optimum.json"), desk.read("whole/optimum.json"));
    desk.remove("out");
    let all: Vec<String> = (1..=30).map(|i| format!("{i}/30")).collect();
    make(&desk, "study.json", &all.iter().map(String::as_str).collect::<Vec<_>>());
    good(merged(&desk));
    assert_eq!(desk.read("out/manifest.json"), desk.read("whole/manifest.json"));
}

#[test]
fn contract_a_part_is_made_once_and_is_the_same_from_any_number_of_threads() {
    let desk = desk();
    let said = |out: &str, threads| {
        let record = Record::default();
        let request = Request { threads, ..request(&desk, "study.json", out) };
        good(share(&request, "2/3".parse().expect("a share"), &record));
        record.results()
    };
    let wrote = said("out", None);
    let name = part(&desk, "00002-of-00003-");
    let place = |out: &str| desk.path(out).join("parts").join(&name);
    assert_eq!(wrote, format!("wrote {}\n", place("out").display()));
    assert_eq!(said("out", None), format!("{} is there already\n", place("out").display()));
    assert!(std::fs::metadata(place("out")).expect("a part").permissions().readonly());
    assert_eq!(
        said("other", Some(1)),
        format!("wrote {}\n", place("other").display()),
        "the name holds the hash"
    );
}

#[test]
fn contract_missing_parts_are_named() {
    let desk = desk();
    make(&desk, "study.json", &["1/4", "3/4"]);
    match refused(merged(&desk)) {
        Error::MissingParts { points, len: 24, shards, command, place } => {
            assert_eq!(points, "6 to 11, 18 to 23");
            assert_eq!(shards.as_deref(), Some("2/4, 4/4"));
            let [study, out] = ["study.json", "out"].map(|name| desk.path(name));
            assert_eq!(command, format!("retune optimize {} --out {}", study.display(), out.display()));
            assert_eq!(place, desk.path("out/parts"));
        }
        other => panic!("{other}"),
    }
    assert_eq!(desk.names("out"), ["parts"], "nothing may be left behind");
}

#[test]
fn contract_parts_that_overlap_are_named() {
    let desk = desk();
    make(&desk, "study.json", &["1/2", "2/2", "2/3"]);
    let [half, second] = ["00001-of-00002", "00002-of-00003"].map(|start| part(&desk, start));
    let half = desk.path("out/parts").join(half);
    let reason = format!("it holds points that {} holds as well: keep one of the two", half.display());
    part_is_refused(&desk, &second, &reason);
}

#[test]
fn contract_a_duplicate_part_is_named() {
    let desk = desk();
    make(&desk, "study.json", &["1/2", "2/2"]);
    let parts = desk.path("out/parts");
    let name = part(&desk, "00001");
    let twice = format!("copy-{name}");
    std::fs::copy(parts.join(&name), parts.join(&twice)).expect("a copy");
    let first = parts.join(name);
    let reason = format!("it holds points that {} holds as well: keep one of the two", first.display());
    part_is_refused(&desk, &twice, &reason);
}

#[test]
fn contract_parts_of_another_study_or_version_are_named() {
    let desk = desk();
    desk.write_json("other.json", &edited(3e4));
    make(&desk, "study.json", &["1/2"]);
    make(&desk, "other.json", &["2/2"]);
    let foreign = desk.path("out/parts").join(part(&desk, "00002"));
    let share = share(&request(&desk, "study.json", "out"), "2/2".parse().expect("a share"), &Silent);
    // The part of another study is not accepted for the share either.
    for error in [refused(merged(&desk)), refused(share)] {
        let Error::Part { path, problem } = error else { panic!("{error}") };
        assert_eq!(path, foreign);
        assert!(problem.starts_with("it is of another study (SHA-256 "), "{problem}");
    }
}

#[test]
fn contract_a_damaged_part_is_named() {
    let desk = desk();
    make(&desk, "study.json", &["1/2", "2/2"]);
    let name = part(&desk, "00002");
    let place: PathBuf = desk.path("out/parts").join(&name);
    let whole = std::fs::read(&place).expect("a part");
    let write = |bytes: &[u8]| {
        std::fs::remove_file(&place).and_then(|()| std::fs::write(&place, bytes)).expect("a part");
    };
    write(&whole[..whole.len() - 5]);
    part_is_refused(&desk, &name, "it is damaged at number 23: make it again");
    // That makes it, the same.
    let record = Record::default();
    good(share(&request(&desk, "study.json", "out"), "2/2".parse().expect("a share"), &record));
    assert_eq!(
        record.warnings(),
        format!("{}: it is damaged at number 23: make it again\n", place.display())
    );
    assert_eq!(std::fs::read(&place).expect("a part"), whole);
    let last = whole[..whole.len() - 1].iter().rposition(|byte| *byte == b'\n').expect("lines") + 1;
    write(&whole[..last]);
    part_is_refused(&desk, &name, "it ends before number 23: make it again");
    write(b"something else\n");
    part_is_refused(&desk, &name, "it is no part: its first line is not that of one");
    write(&[whole.as_slice(), b"more\n"].concat());
    part_is_refused(&desk, &name, "it has more numbers than it says: make it again");
    write(&whole);
    let other = format!("{}.part", name.replace(".part", "0"));
    std::fs::rename(&place, desk.path("out/parts").join(&other)).expect("a part");
    let reason = "its name does not hold the hash of its content: it was changed or renamed";
    part_is_refused(&desk, &other, reason);
}

#[test]
fn contract_only_a_grid_has_shares() {
    let mut study = tiny();
    study["optimize"]["surf"] = json!(null);
    let desk = Desk::with(&study);
    let share = share(&request(&desk, "study.json", "out"), "1/2".parse().expect("a share"), &Silent);
    for error in [refused(share), refused(merged(&desk))] {
        assert!(matches!(&error, Error::Rule { name, rule: Rule::NoGrid } if name == "study"), "{error}");
    }
    assert!(!desk.path("out").exists(), "nothing may be left behind");
}
