//! Journals damaged by a disk, a power cut or a person: every whole record is kept, lost ones are reported and computed
//! again, and a journal of unknown origin is refused.

mod common;

use common::{Answer, Desk, assert_same, begun, longer};

const RUN: [&str; 5] = ["optimize", "study.json", "--quiet", "--out", "out"];
const JOURNAL: &str = "out/unfinished/journal";

/// A desk with the results of a study in `whole`, the journal of a killed run of it, and the number of its records.
fn desk() -> (Desk, Vec<u8>, usize) {
    let desk = Desk::new();
    desk.write_json("study.json", &longer());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "whole"]);
    let mut child = begun(&desk, &RUN, "out", 300);
    child.kill().and_then(|()| child.wait()).expect("killed");
    let journal = std::fs::read(desk.path(JOURNAL)).expect("a journal");
    let kept = journal.iter().filter(|byte| **byte == b'\n').count() - 1;
    (desk, journal, kept)
}

/// The run resumes, reports the damage with `words`, and ends in the bytes of an uninterrupted one.
#[track_caller]
fn goes_on(desk: &Desk, words: &str) {
    let with = |option| [&RUN[..], &[option]].concat();
    let Answer { code, stderr, .. } = desk.run(&with("--resume"));
    assert_eq!((code, stderr), (Some(0), format!("warning: {JOURNAL}: {words}\n")));
    assert_same(desk, "whole", "out");
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
        let Answer { code, stdout, stderr } = desk.run(&RUN);
        assert_eq!((code, stdout.as_str()), (Some(2), ""), "byte {place}");
        let kept = kept - lost;
        let said = format!(
            "error: out: unfinished work was found here ({kept} results are kept, 1 line is damaged): "
        );
        assert!(stderr.starts_with(&said), "byte {place}: {stderr}");
        assert_eq!(
            std::fs::read(desk.path(JOURNAL)).ok().as_ref(),
            Some(&flipped),
            "byte {place}: as it was"
        );
        goes_on(&desk, &format!("{words}{kept} results are kept"));
        std::fs::remove_dir_all(desk.path("out")).expect("the results");
    }
}

#[test]
fn contract_a_journal_that_is_nobodys_is_refused_and_left_alone() {
    let (desk, journal, _) = desk();
    let head = journal.iter().position(|byte| *byte == b'\n').expect("a line") + 1;
    let mut other = longer();
    other["scene"]["primary"]["k1"] = serde_json::json!(3e4);
    desk.write_json("other.json", &other);
    let mut flipped = journal.clone();
    flipped[head / 2] ^= 1;
    for (study, bytes) in [
        ("other.json", flipped),
        ("study.json", vec![0; 4096]),
        ("study.json", b"what somebody wrote down\n".to_vec()),
        ("study.json", journal[..head / 2].to_vec()),
    ] {
        desk.write(JOURNAL, &bytes);
        for option in ["--quiet", "--resume"] {
            let Answer { code, stdout, stderr } = desk.run(&["optimize", study, "--out", "out", option]);
            assert_eq!((code, stdout.as_str()), (Some(2), ""), "{stderr}");
            assert!(
                stderr
                    .starts_with(&format!("error: {JOURNAL}: its first line, which says whose work it is, ")),
                "{stderr}"
            );
            assert!(stderr.ends_with("throw the unfinished work away with --restart\n"), "{stderr}");
            assert_eq!(std::fs::read(desk.path(JOURNAL)).expect("a journal"), bytes);
        }
    }
    desk.good(&["optimize", "study.json", "--quiet", "--out", "out", "--restart"]);
    assert_same(&desk, "whole", "out");
}

/// A foreign directory named `unfinished` is not work of Retune's, and neither is the target of a link.
#[test]
fn contract_a_directory_of_that_name_is_left_alone() {
    let desk = Desk::new();
    desk.write_json("study.json", &longer());
    desk.write("out/unfinished/notes.txt", "mine");
    for option in ["--quiet", "--resume", "--restart", "--replace"] {
        let Answer { code, stderr, .. } = desk.run(&["optimize", "study.json", "--out", "out", option]);
        assert_eq!(code, Some(2));
        assert!(
            stderr.starts_with("error: out/unfinished: not replaced: it holds files but no journal"),
            "{stderr}"
        );
    }
    assert_eq!(desk.read("out/unfinished/notes.txt"), "mine");
}
