//! A grid in parts: the bytes of a single process, and the errors of wrong parts.

mod common;

use common::{Answer, Desk, tiny};
use serde_json::json;
use std::path::PathBuf;

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write_json("study.json", &tiny());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "whole"]);
    desk
}

fn make(desk: &Desk, study: &str, shards: &[&str]) {
    for shard in shards {
        desk.good(&["optimize", study, "--quiet", "--out", "out", "--shard", shard]);
    }
}

/// The file of share number `i`.
fn part(desk: &Desk, i: usize) -> String {
    let start = format!("{i:05}-of-");
    desk.names("out/parts").into_iter().find(|name| name.starts_with(&start)).expect("a part")
}

#[track_caller]
fn refused(desk: &Desk, sentence: &str) {
    let Answer { code, stdout, stderr } = desk.run(&["merge", "study.json", "--quiet", "--out", "out"]);
    assert_eq!(
        (code, stdout.as_str(), stderr.as_str()),
        (Some(2), "", format!("error: {sentence}\n").as_str())
    );
    assert_eq!(desk.names("out"), ["parts"], "nothing may be left behind");
}

#[test]
fn contract_merged_parts_are_the_bytes_of_one_process() {
    let desk = desk();
    for shards in [vec!["1/1"], vec!["3/3", "1/3", "2/3"], vec!["1/4", "2/4", "4/4", "3/4"]] {
        make(&desk, "study.json", &shards);
        assert_eq!(desk.names("out/parts").len(), shards.len(), "no more than the parts");
        desk.good(&["merge", "study.json", "--quiet", "--out", "out"]);
        std::fs::remove_dir_all(desk.path("out/parts")).expect("the parts");
        assert_eq!(desk.names("out"), desk.names("whole"));
        for name in desk.names("whole") {
            assert_eq!(desk.read(&format!("out/{name}")), desk.read(&format!("whole/{name}")), "{name}");
        }
        std::fs::remove_dir_all(desk.path("out")).expect("the results");
    }
}

/// More shares than points, and parts from two divisions that are complementary.
#[test]
fn contract_shares_may_be_empty_or_of_different_sizes() {
    let desk = desk();
    make(&desk, "study.json", &["1/2", "3/4", "4/4"]);
    desk.good(&["merge", "study.json", "--quiet", "--out", "out"]);
    assert_eq!(desk.read("out/optimum.json"), desk.read("whole/optimum.json"));
    std::fs::remove_dir_all(desk.path("out")).expect("the results");
    let all: Vec<String> = (1..=30).map(|i| format!("{i}/30")).collect();
    make(&desk, "study.json", &all.iter().map(String::as_str).collect::<Vec<_>>());
    desk.good(&["merge", "study.json", "--quiet", "--out", "out"]);
    assert_eq!(desk.read("out/manifest.json"), desk.read("whole/manifest.json"));
}

#[test]
fn contract_a_part_is_made_once_and_is_the_same_from_any_number_of_threads() {
    let desk = desk();
    make(&desk, "study.json", &["2/3"]);
    let name = part(&desk, 2);
    let said = desk.good(&["optimize", "study.json", "--out", "out", "--shard", "2/3"]);
    assert_eq!(said, format!("out/parts/{name} is there already\n"));
    assert!(
        std::fs::metadata(desk.path(&format!("out/parts/{name}"))).expect("a part").permissions().readonly()
    );
    let one = ["optimize", "study.json", "--quiet", "--out", "other", "--shard", "2/3", "--threads", "1"];
    let said = desk.good(&one);
    assert_eq!(said, format!("wrote other/parts/{name}\n"), "the name holds the hash");
}

#[test]
fn contract_missing_parts_are_named() {
    let desk = desk();
    make(&desk, "study.json", &["1/4", "3/4"]);
    let sentence = "out/parts: no part holds points 6 to 11, 18 to 23 of 24: \
                    make what is missing with `retune optimize study.json --shard i/N`, i/N = 2/4, 4/4";
    refused(&desk, sentence);
}

#[test]
fn contract_parts_that_overlap_are_named() {
    let desk = desk();
    make(&desk, "study.json", &["1/2", "2/2", "2/3"]);
    let [half, third] = [part(&desk, 1), part(&desk, 2)];
    let second =
        desk.names("out/parts").into_iter().find(|name| name.starts_with("00002-of-00003")).expect("a part");
    assert!(half.starts_with("00001-of-00002") && third.starts_with("00002-of-00002"));
    let sentence = format!(
        "out/parts/{second}: it holds points that out/parts/{half} holds as well: keep one of the two"
    );
    refused(&desk, &sentence);
}

#[test]
fn contract_a_duplicate_part_is_named() {
    let desk = desk();
    make(&desk, "study.json", &["1/2", "2/2"]);
    let name = part(&desk, 1);
    let twice = format!("copy-{name}");
    std::fs::copy(desk.path(&format!("out/parts/{name}")), desk.path(&format!("out/parts/{twice}")))
        .expect("a copy");
    let sentence = format!(
        "out/parts/{twice}: it holds points that out/parts/{name} holds as well: keep one of the two"
    );
    refused(&desk, &sentence);
}

#[test]
fn contract_parts_of_another_study_or_version_are_named() {
    let desk = desk();
    let mut other = tiny();
    other["scene"]["primary"]["k1"] = json!(3e4);
    desk.write_json("other.json", &other);
    make(&desk, "study.json", &["1/2"]);
    make(&desk, "other.json", &["2/2"]);
    let Answer { code, stderr, .. } = desk.run(&["merge", "study.json", "--out", "out"]);
    assert_eq!(code, Some(2));
    let words = format!("error: out/parts/{}: it is of another study (SHA-256 ", part(&desk, 2));
    assert!(stderr.starts_with(&words), "{stderr}");
    // The part of another study is not accepted either.
    let Answer { code, stderr, .. } = desk.run(&["optimize", "study.json", "--out", "out", "--shard", "2/2"]);
    assert!(code == Some(2) && stderr.starts_with(&words), "{stderr}");
}

#[test]
fn contract_a_damaged_part_is_named() {
    let desk = desk();
    make(&desk, "study.json", &["1/2", "2/2"]);
    let name = part(&desk, 2);
    let place: PathBuf = desk.path(&format!("out/parts/{name}"));
    let whole = std::fs::read(&place).expect("a part");
    let write = |bytes: &[u8]| {
        std::fs::remove_file(&place).and_then(|()| std::fs::write(&place, bytes)).expect("a part");
    };
    write(&whole[..whole.len() - 5]);
    refused(&desk, &format!("out/parts/{name}: it is damaged at point 23: make it again"));
    let last = whole[..whole.len() - 1].iter().rposition(|byte| *byte == b'\n').expect("lines") + 1;
    write(&whole[..last]);
    refused(&desk, &format!("out/parts/{name}: it ends before point 23: make it again"));
    write(b"something else\n");
    refused(&desk, &format!("out/parts/{name}: it is no part: its first line is not that of one"));
    write(&[whole.as_slice(), b"more\n"].concat());
    refused(&desk, &format!("out/parts/{name}: it has more points than it says: make it again"));
    write(&whole);
    let other = format!("out/parts/{}.part", name.replace(".part", "0"));
    std::fs::rename(&place, desk.path(&other)).expect("a part");
    refused(
        &desk,
        &format!("{other}: its name does not hold the hash of its content: it was changed or renamed"),
    );
}

#[test]
fn contract_invalid_shares_are_refused() {
    let desk = desk();
    for shard in ["0/3", "4/3", "3", "a/b"] {
        let Answer { code, stderr, .. } = desk.run(&["optimize", "study.json", "--shard", shard]);
        assert_eq!(code, Some(2));
        let words = format!(
            "error: invalid value '{shard}' for '--shard <i/N>': give i/N with 1 <= i <= N, for instance 3/64"
        );
        assert!(stderr.starts_with(&words), "{stderr}");
    }
    let mut study = tiny();
    study["optimize"]["surf"] = json!(null);
    desk.write_json("flat.json", &study);
    for arguments in [["optimize", "flat.json", "--shard=1/2"].as_slice(), &["merge", "flat.json"]] {
        let Answer { code, stderr, .. } = desk.run(arguments);
        let words = "error: study flat: optimize.surf: missing, but only the grid can be made in parts\n";
        assert_eq!((code, stderr.as_str()), (Some(2), words));
    }
}
