//! Replacement of results: without an option, only those that the same command made of the same study are replaced.

use crate::{replace, request, restart, resume, search};
use retune_jobs::certify::certify_file;
use retune_jobs::table2::table2;
use retune_jobs::tune::tune;
use retune_jobs::{Error, Request, Silent};
use retune_store::Error as StoreError;
use retune_testkit::desk::{Desk, edited, tiny};
use retune_testkit::observers::{good, refused};
use serde_json::json;

const RESULTS: &str = "results/small";

/// A job that must not replace the results in a directory of the desk; returns what stands there.
#[track_caller]
fn stands<T>(desk: &Desk, out: &str, result: Result<T, Error>) -> String {
    match refused(result) {
        Error::Store(StoreError::Standing { path, problem }) => {
            assert_eq!(path, desk.path(out));
            problem
        }
        other => panic!("{other}"),
    }
}

#[test]
fn contract_an_edited_study_replaces_its_own_results() {
    let desk = Desk::new();
    desk.write_json("studies/small.json", &tiny());
    search(&desk, "studies/small.json", RESULTS);
    desk.write_json("studies/small.json", &edited(3e4));
    search(&desk, "studies/small.json", RESULTS);
    assert_eq!(desk.read_json("results/small/study.json")["scene"]["primary"]["k1"], 3e4);
    let manifest = desk.read_json("results/small/manifest.json");
    assert_eq!(manifest["made_by"], json!({ "command": "optimize", "study": "../../studies/small.json" }));
    assert_eq!(manifest.get("earlier"), None);
    search(&desk, "./studies/../studies/small.json", RESULTS);
}

#[test]
fn contract_results_of_another_study_are_not_replaced_unasked() {
    let desk = Desk::new();
    desk.write_json("studies/small.json", &tiny());
    desk.write_json("other/small.json", &edited(3e4));
    desk.write_json("table2.json", &json!({ "rows": [
        { "damper": "a", "study": "other/small.json", "reference": { "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 } }
    ]}));
    search(&desk, "studies/small.json", RESULTS);
    desk.write("results/small/notes.txt", "mine");
    let before = desk.everything("results");
    type Of = fn(&Desk, &str, &str) -> Request;
    type Job<'a> = &'a dyn Fn(&Request) -> Result<(), Error>;
    let optimize: Job = &|request| tune(request, &Silent).map(drop);
    let jobs: [(Of, &str, Job); 4] = [
        (request, "other/small.json", optimize),
        (resume, "other/small.json", optimize),
        (restart, "other/small.json", optimize),
        (request, "table2.json", &|request| table2(request, &Silent).map(drop)),
    ];
    for (of, study, job) in jobs {
        let said = stands(&desk, RESULTS, job(&of(&desk, study, RESULTS)));
        assert!(said.starts_with("the directory holds results of `retune optimize` for "), "{said}");
        assert_eq!(desk.everything("results"), before, "{study}");
    }
    let certified = certify_file(&request(&desk, "other/small.json", RESULTS), &Silent);
    assert!(matches!(refused(certified), Error::Store(StoreError::Output { .. })));
    assert_eq!(desk.everything("results"), before);
    good(table2(&replace(&desk, "table2.json", RESULTS), &Silent));
    let names = ["manifest.json", "notes.txt", "resolved.json", "small", "table2.csv", "table2.txt"];
    assert_eq!(desk.names(RESULTS), names, "nothing of the replaced, all of the others");
}

/// A copy of the study: its results are the same, and remain those of the original.
#[test]
fn contract_a_copy_is_another_study_once_it_differs() {
    let desk = Desk::new();
    let mut study = tiny();
    study["name"] = json!("small");
    desk.write_json("small.json", &study);
    search(&desk, "small.json", RESULTS);
    let before = desk.everything("results");
    desk.write_json("copy/small.json", &study);
    search(&desk, "copy/small.json", RESULTS);
    search(&desk, "results/small/study.json", RESULTS);
    assert_eq!(desk.everything("results"), before);
    desk.write_json("copy/small.json", &edited(3e4));
    stands(&desk, RESULTS, tune(&request(&desk, "copy/small.json", RESULTS), &Silent));
    search(&desk, "small.json", RESULTS);
}

#[test]
fn contract_files_that_retune_did_not_make_are_kept() {
    let desk = Desk::with(&tiny());
    let before = desk.read("study.json");
    for of in [request, replace] {
        match refused(tune(&of(&desk, "study.json", "."), &Silent)) {
            Error::Store(StoreError::Protected { problem, .. }) => {
                assert!(problem.starts_with("it is the study itself"), "{problem}");
            }
            other => panic!("{other}"),
        }
        assert_eq!(desk.read("study.json"), before);
    }
    let standing = || stands(&desk, "out", tune(&request(&desk, "study.json", "out"), &Silent));
    let by_hand =
        |name: &str| format!("{name} is in the way: Retune did not make it, or it was changed since");
    desk.write("out/surf-mine.svg", "mine");
    assert_eq!(standing(), by_hand("surf-mine.svg"));
    desk.remove("out/surf-mine.svg");
    search(&desk, "study.json", "out");
    desk.write("out/optimum.json", "{ \"changed\": \"by hand\" }");
    assert_eq!(standing(), by_hand("optimum.json"));
    good(tune(&replace(&desk, "study.json", "out"), &Silent));
    // This file is not replaced: a later search does not write a picture of that name.
    desk.write("out/surf-k2-D.svg", "changed");
    let mut other = tiny();
    other["optimize"] = json!({ "vary": ["c2"], "refine": { "MaxFunEvals": 5 } });
    desk.write_json("study.json", &other);
    assert_eq!(standing(), by_hand("surf-k2-D.svg"));
    assert_eq!(desk.read("out/surf-k2-D.svg"), "changed");
}
