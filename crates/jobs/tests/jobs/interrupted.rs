//! Jobs that are cut off at one of their evaluations: nothing is lost, and the final results have the bytes of an uninterrupted
//! run. (Processes that are killed are in the tests of the program.)

use crate::{request, restart, resume, search};
use retune_jobs::Done;
use retune_jobs::tune::tune;
use retune_jobs::{Error, Request, Silent};
use retune_store::Error as StoreError;
use retune_testkit::desk::{Desk, count_lines, edited, longer, tiny};
use retune_testkit::observers::{Record, cut_off, good, refused};
use serde_json::{Value, json};

/// The study and its results in `whole`.
fn desk(study: &Value) -> Desk {
    let desk = Desk::with(study);
    search(&desk, "study.json", "whole");
    desk
}

/// Begins a search into `out` and cuts it off; returns the number of values that it has kept.
#[track_caller]
fn begin(desk: &Desk, study: &str, out: &str, at: u64) -> u64 {
    cut_off(at, |watch| tune(&Request { threads: Some(1), ..request(desk, study, out) }, watch));
    count_lines(&desk.path(out).join("unfinished/journal")) as u64 - 1
}

/// The difference that prevents resuming, if any, and how much is kept.
#[track_caller]
fn unfinished(error: Error, desk: &Desk) -> (u64, Option<String>) {
    match error {
        Error::Store(StoreError::Unfinished { path, lines, damaged: 0, difference }) => {
            assert_eq!(path, desk.path("out"));
            (lines, difference)
        }
        other => panic!("{other}"),
    }
}

/// In the grid, at its end, in the first refinement and in the second.
#[test]
fn contract_a_search_that_is_cut_off_resumes_and_ends_in_the_same_bytes() {
    let desk = desk(&tiny());
    for at in [2, 12, 25, 30, 45, 60] {
        let kept = begin(&desk, "study.json", "out", at);
        assert!(kept >= at.min(24) - 2, "{at}: {kept}");
        let error = refused(tune(&request(&desk, "study.json", "out"), &Silent));
        assert_eq!(unfinished(error, &desk), (kept, None), "{at}");
        let record = Record::default();
        good(tune(&resume(&desk, "study.json", "out"), &record));
        let known = if kept == 1 { "1 value is".to_owned() } else { format!("{kept} values are") };
        let said = record.all();
        assert!(said.starts_with(&format!("resumed: {known} known\n")), "{at}: {said}");
        assert_eq!(record.warnings(), "");
        desk.assert_same("whole", "out");
        desk.remove("out");
    }
}

/// A loop that retries until a run succeeds may run once more after it.
#[test]
fn contract_resuming_finished_work_computes_nothing() {
    let desk = desk(&tiny());
    let changed =
        || std::fs::metadata(desk.path("whole/surf.csv")).and_then(|file| file.modified()).expect("a time");
    let before = changed();
    desk.write("whole/.lock", "4711 what a run that was killed as it ended left\n");
    let record = Record::default();
    let tuned = good(tune(&resume(&desk, "study.json", "whole"), &record));
    assert!(matches!(tuned, Done::FinishedBefore));
    let place = desk.path("whole").display().to_string();
    let said = record.all();
    assert!(
        said.starts_with(&format!("finished already: nothing to resume\nresults in {place}: ")),
        "{said}"
    );
    assert!(!desk.path("whole/.lock").exists());
    assert_eq!(before, changed());
    desk.write_json("study.json", &edited(3e4));
    let tuned = good(tune(&resume(&desk, "study.json", "whole"), &Silent));
    assert!(matches!(tuned, Done::Made(_)), "another study is not finished");
}

#[test]
fn contract_unfinished_work_can_be_discarded() {
    let desk = desk(&tiny());
    begin(&desk, "study.json", "out", 15);
    let record = Record::default();
    good(tune(&restart(&desk, "study.json", "out"), &record));
    assert!(record.all().starts_with("surf: "), "{}", record.all());
    desk.assert_same("whole", "out");
}

/// The unfinished work of one study is neither mixed with that of another nor discarded for it.
#[test]
fn contract_unfinished_work_of_another_study_is_left_alone() {
    let desk = desk(&tiny());
    let kept = begin(&desk, "study.json", "out", 15);
    desk.write_json("other.json", &edited(3e4));
    for request in [request(&desk, "other.json", "out"), resume(&desk, "other.json", "out")] {
        let error = refused(tune(&request, &Silent));
        let words = error.to_string();
        assert!(words.ends_with("or discard it with --restart"), "{words}");
        let (lines, difference) = unfinished(error, &desk);
        assert_eq!(lines, kept);
        assert!(difference.is_some_and(|it| it.starts_with("of another study (SHA-256 ")), "{words}");
    }
    good(tune(&resume(&desk, "study.json", "out"), &Silent));
    desk.assert_same("whole", "out");
}

/// Until new results are complete, those of an earlier run stay unchanged.
#[test]
fn contract_earlier_results_outlive_a_run_that_is_cut_off() {
    let desk = desk(&tiny());
    let before = desk.everything("whole");
    desk.write_json("study.json", &edited(3e4));
    begin(&desk, "study.json", "whole", 40);
    let mut after = desk.everything("whole");
    after.retain(|name, _| !name.starts_with("unfinished"));
    assert_eq!(after, before);
}

/// The global search resumes as well, with the counts of an uninterrupted one.
#[test]
fn contract_a_global_search_resumes_where_it_was_cut_off() {
    let mut study = longer();
    study["window"] = json!({ "t0": 1, "T": 8 });
    study["optimize"]["surf"] = json!(null);
    study["optimize"]["bounds"] =
        json!({ "k2": [50, 800], "c2": [50, 400], "D": [0.02, 0.2], "C": [0.05, 0.6] });
    study["optimize"]["global"] = json!({ "samples": 256, "searches": 2, "evaluations": 200 });
    let desk = desk(&study);
    for at in [100, 400] {
        let kept = begin(&desk, "study.json", "out", at);
        assert!(kept >= at - 64, "{at}: {kept}");
        good(tune(&resume(&desk, "study.json", "out"), &Silent));
        desk.assert_same("whole", "out");
        desk.remove("out");
    }
}
