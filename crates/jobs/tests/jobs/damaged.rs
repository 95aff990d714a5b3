//! Journals damaged by a disk, a power cut or a person: every whole record is kept, lost ones are reported and computed
//! again, and a journal of unknown origin is refused.

use crate::{replace, request, restart, resume, search};
use retune_jobs::tune::tune;
use retune_jobs::{Error, Silent};
use retune_store::Error as StoreError;
use retune_testkit::desk::{Desk, edited, tiny};
use retune_testkit::observers::{Record, cut_off, good, refused};

const JOURNAL: &str = "out/unfinished/journal";

/// A desk with the results of a study in `whole`, the journal of a run of it that was cut off, and the number of its records.
fn desk() -> (Desk, Vec<u8>, u64) {
    let desk = Desk::with(&tiny());
    search(&desk, "study.json", "whole");
    cut_off(60, |watch| tune(&request(&desk, "study.json", "out"), watch));
    let journal = std::fs::read(desk.path(JOURNAL)).expect("a journal");
    let kept = journal.iter().filter(|byte| **byte == b'\n').count() as u64 - 1;
    (desk, journal, kept)
}

/// The run resumes, reports the damage with `words`, and ends in the bytes of an uninterrupted one.
#[track_caller]
fn goes_on(desk: &Desk, words: &str) {
    let record = Record::default();
    good(tune(&resume(desk, "study.json", "out"), &record));
    assert_eq!(record.warnings(), format!("{}: {words}\n", desk.path(JOURNAL).display()));
    desk.assert_same("whole", "out");
}

#[test]
fn contract_a_flipped_bit_is_told_and_costs_one_value() {
    let (desk, journal, kept) = desk();
    let head = journal.iter().position(|byte| *byte == b'\n').expect("a line");
    for (place, lost, words) in [
        (3, 0, "its first line is damaged, but its records are of this study; "),
        (head / 2, 0, "its first line is damaged, but its records are of this study; "),
        (head + 8, 1, "1 of its lines is damaged, and what it held is computed again; "),
        (journal.len() / 2, 1, "1 of its lines is damaged, and what it held is computed again; "),
        (journal.len() - 3, 1, "1 of its lines is damaged, and what it held is computed again; "),
    ] {
        let mut flipped = journal.clone();
        flipped[place] ^= 1;
        if flipped[place] == b'\n' || journal[place] == b'\n' {
            continue;
        }
        desk.write(JOURNAL, &flipped);
        let kept = kept - lost;
        match refused(tune(&request(&desk, "study.json", "out"), &Silent)) {
            Error::Store(StoreError::Unfinished { lines, damaged: 1, difference: None, .. }) => {
                assert_eq!(lines, kept, "byte {place}");
            }
            other => panic!("byte {place}: {other}"),
        }
        let left = std::fs::read(desk.path(JOURNAL)).expect("a journal");
        assert!(left == flipped, "byte {place}: as it was");
        goes_on(&desk, &format!("{words}{kept} results are kept"));
        desk.remove("out");
    }
}

#[test]
fn contract_a_journal_that_is_nobodys_is_refused_and_left_alone() {
    let (desk, journal, _) = desk();
    let head = journal.iter().position(|byte| *byte == b'\n').expect("a line") + 1;
    desk.write_json("other.json", &edited(3e4));
    let mut flipped = journal.clone();
    flipped[head / 2] ^= 1;
    for (study, bytes) in [
        ("other.json", flipped),
        ("study.json", vec![0; 4096]),
        ("study.json", b"what somebody wrote down\n".to_vec()),
        ("study.json", journal[..head / 2].to_vec()),
    ] {
        desk.write(JOURNAL, &bytes);
        for request in [request(&desk, study, "out"), resume(&desk, study, "out")] {
            match refused(tune(&request, &Silent)) {
                Error::Store(StoreError::Journal { path, problem }) => {
                    assert_eq!(path, desk.path(JOURNAL));
                    assert!(
                        problem.starts_with("its first line, which says whose work it is, "),
                        "{problem}"
                    );
                }
                other => panic!("{other}"),
            }
            assert_eq!(std::fs::read(desk.path(JOURNAL)).expect("a journal"), bytes);
        }
    }
    good(tune(&restart(&desk, "study.json", "out"), &Silent));
    desk.assert_same("whole", "out");
}

/// A foreign directory named `unfinished` is not work of Retune's.
#[test]
fn contract_a_directory_of_that_name_is_left_alone() {
    let desk = Desk::with(&tiny());
    desk.write("out/unfinished/notes.txt", "mine");
    for request in [request, resume, restart, replace].map(|of| of(&desk, "study.json", "out")) {
        match refused(tune(&request, &Silent)) {
            Error::Store(StoreError::Protected { path, problem }) => {
                assert_eq!(path, desk.path("out/unfinished"));
                assert!(problem.starts_with("it holds files but no journal"), "{problem}");
            }
            other => panic!("{other}"),
        }
    }
    assert_eq!(desk.read("out/unfinished/notes.txt"), "mine");
}
