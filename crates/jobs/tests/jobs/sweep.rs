//! `sweep`: its files, in parallel, in parts, cut off, and checked. What its numbers are is in the tests of `retune-sweep`.

use crate::{request, resume, search};
use retune_jobs::sweep::Options;
use retune_jobs::sweep::{Points, sweep};
use retune_jobs::verify::verify;
use retune_jobs::{Error, Observer, Request, Silent};
use retune_model::{Parameter, Scene};
use retune_solver::decay_time;
use retune_study::Study;
use retune_testkit::desk::{Desk, count_lines, tiny};
use retune_testkit::observers::{Record, cut_off, good, refused};
use serde_json::json;

/// A sweep of seven frequencies about resonance.
fn options() -> Options {
    let over = "omega".parse().expect("a parameter");
    let quantities = ["E1max", "stroke"].map(|name| name.parse().expect("a quantity")).to_vec();
    Options { from: "0.9Hz".into(), to: "1.1Hz".into(), points: 7, quantities, ..Options::over(over) }
}

fn swept(request: &Request, points: &Points, watch: &dyn Observer) -> Result<(), Error> {
    sweep(request, &options(), points, watch)
}

/// The sweep of the tiny study in `whole`, by one thread.
fn desk() -> Desk {
    let desk = Desk::with(&tiny());
    let request = Request { threads: Some(1), ..request(&desk, "study.json", "whole") };
    good(swept(&request, &Points::All, &Silent));
    desk
}

fn share(desk: &Desk, study: &str, shard: &str) {
    let shard = Points::of(Some(shard.parse().expect("a share")), false);
    good(swept(&request(desk, study, "out"), &shard, &Silent));
}

#[test]
fn contract_a_sweep_writes_table_figure_and_words() {
    let desk = desk();
    let names = ["manifest.json", "resolved.json", "sweep.csv", "sweep.json", "sweep.svg", "sweep.txt"];
    assert_eq!(desk.names("whole"), names);
    let rows = desk.rows("whole/sweep.csv");
    assert_eq!((rows.len(), &rows[0][..5].join(",")), (8, &"omega,f_Hz,n_rpm,E1max,x1max".to_owned()));
    let json = desk.read_json("whole/sweep.json");
    assert_eq!(json["rows"].as_array().map(Vec::len), Some(7));
    assert_eq!(json["rows"][6]["E1max"].as_f64(), rows[7][3].parse().ok());
    assert_eq!((&json["units"]["stroke"], &json["sweep"]["over"]), (&"m".into(), &"omega".into()));
    let (text, svg) = (desk.read("whole/sweep.txt"), desk.read("whole/sweep.svg"));
    assert!(text.contains("E1max: largest ") && text.contains("without a damper largest "), "{text}");
    assert!(svg.contains("frequency, Hz") && svg.contains("stroke, m") && svg.contains("no damper"), "{svg}");
}

/// In the place of a transmissibility, which only harmonic motions have; missing where the run is too short for it.
#[test]
fn contract_a_sweep_after_a_pulse_has_the_decay_time() {
    let mut study = tiny();
    study["scene"]["forcing"] = json!({ "pulse": "half sine", "of": "force", "peak": 9000, "duration": 0.2 });
    (study["window"], study["optimize"]) = (json!({ "t0": 0, "T": 9 }), json!(null));
    let desk = Desk::with(&study);
    let over = Parameter::C1;
    let quantities = vec!["decay_time".parse().expect("a quantity")];
    let options =
        Options { from: "5".into(), to: "3000".into(), points: 2, quantities, ..Options::over(over) };
    good(sweep(&request(&desk, "study.json", "out"), &options, &Points::All, &Silent));
    let rows = desk.rows("out/sweep.csv");
    assert_eq!(rows[0][5..10].join(","), "ground_force,decay_time,stroke,contact_force,contact_pressure");
    assert_eq!(rows[0].last().map(String::as_str), Some("decay_time_none"));
    assert_eq!((rows[1].last().map(String::as_str), rows[1].len()), (Some(""), rows[0].len()));
    let read = retune_study::read(&desk.path("study.json")).expect("a study");
    let damped = read.scene_with(&["c1=3000".parse().expect("a setting")]).expect("a scene");
    for (scene, found) in
        [(damped, &rows[2][6]), (Scene { damper: None, ..damped }, rows[2].last().expect("a column"))]
    {
        let expected = decay_time(&scene, 9.0, &read.solver.settings()).expect("a run");
        assert!(
            expected.is_some_and(f64::is_finite) && found.parse().ok() == expected,
            "{found} {expected:?}"
        );
    }
    assert_eq!(desk.read_json("out/sweep.json")["units"]["decay_time"], "s");
    assert!(desk.read("out/sweep.txt").contains("decay_time"));
    good(verify(&desk.path("out"), 2, 0.0, &Silent));
    // What `simulate` says of the same run.
    let simulated = json!(good(retune_jobs::simulate::simulate(&Study { scene: damped, ..read }, None)));
    assert_eq!(simulated["decay_time"].as_f64(), rows[2][6].parse().ok());
}

#[test]
fn contract_a_sweep_has_the_same_bytes_from_any_number_of_threads() {
    let desk = desk();
    let request = Request { threads: Some(3), ..request(&desk, "study.json", "out") };
    good(swept(&request, &Points::All, &Silent));
    desk.assert_same("whole", "out");
}

#[test]
fn contract_merged_shares_of_a_sweep_are_the_bytes_of_one_process() {
    let desk = desk();
    for shards in [vec!["1/1"], vec!["3/3", "1/3", "2/3"]] {
        shards.iter().for_each(|shard| share(&desk, "study.json", shard));
        assert_eq!(desk.names("out/parts").len(), shards.len());
        good(swept(&request(&desk, "study.json", "out"), &Points::Merged, &Silent));
        desk.remove("out/parts");
        desk.assert_same("whole", "out");
        desk.remove("out");
    }
}

#[test]
fn contract_missing_shares_of_a_sweep_are_named_in_points() {
    let desk = desk();
    share(&desk, "study.json", "1/3");
    let error = refused(swept(&request(&desk, "study.json", "out"), &Points::Merged, &Silent));
    match error {
        Error::MissingParts { points, len: 7, shards, command, .. } => {
            assert_eq!((points.as_str(), shards.as_deref()), ("2 to 6", Some("2/3, 3/3")));
            assert!(
                command.starts_with("retune sweep ")
                    && command.contains(" --over omega --from 5.65")
                    && command.contains(" --points 7 --quantity E1max,stroke --out "),
                "{command}"
            );
        }
        other => panic!("{other}"),
    }
}

/// Between any two points, and after the last.
#[test]
fn contract_a_sweep_that_is_cut_off_resumes_and_ends_in_the_same_bytes() {
    let desk = desk();
    for at in [1, 4, 7] {
        let request = Request { threads: Some(1), ..request(&desk, "study.json", "out") };
        cut_off(at, |watch| swept(&request, &Points::All, watch));
        let kept = count_lines(&desk.path("out/unfinished/journal")) - 1;
        assert!(kept > 0 && kept.is_multiple_of(15), "{at}: {kept}"); // numbers of a point
        good(swept(&resume(&desk, "study.json", "out"), &Points::All, &Silent));
        desk.assert_same("whole", "out");
        desk.remove("out");
    }
    let record = Record::default();
    good(swept(&resume(&desk, "study.json", "whole"), &Points::All, &record));
    assert!(record.results().starts_with("finished already"), "{}", record.results());
}

/// The design that a search found is swept, not that of its study.
#[test]
fn contract_results_stand_for_the_design_that_was_found() {
    let desk = desk();
    let found = search(&desk, "study.json", "tuned");
    let over = Parameter::K2;
    let k2 = found.damper.design.get(over);
    let options =
        Options { from: k2.to_string(), to: (2.0 * k2).to_string(), points: 2, ..Options::over(over) };
    good(sweep(&request(&desk, "tuned", "out"), &options, &Points::All, &Silent));
    assert_eq!(desk.rows("out/sweep.csv")[1][1].parse(), Ok(found.value()));
}

#[test]
fn contract_verify_runs_points_again_and_sees_a_changed_number() {
    let desk = desk();
    let record = Record::default();
    good(verify(&desk.path("whole"), 3, 0.0, &record));
    let said = record.results();
    assert!(
        said.contains("sweep.csv              3 of 7 rows run again (omega to transmissibility_none): the same to the last bit"),
        "{said}"
    );
    let text = desk.read("whole/sweep.csv");
    let last = text.trim_end().rfind(',').expect("a field");
    desk.write("whole/sweep.csv", format!("{}1{}", &text[..=last], &text[last + 1..]));
    let record = Record::default();
    assert!(matches!(refused(verify(&desk.path("whole"), 3, 0.0, &record)), Error::NotHeld { .. }));
    let said = record.results();
    assert!(said.contains("3 of 7 rows run again (omega to transmissibility_none): 1 differs"), "{said}");
}

/// Along a sweep of the objective the smallest is that of a design that keeps the limits; the others are marked.
#[test]
fn contract_designs_that_break_a_limit_are_marked() {
    let mut study = tiny();
    study["optimize"]["limits"] = json!({ "cavity": 0.4 });
    let desk = Desk::with(&study);
    let ends = ["0.02", "0.2"].map(str::to_owned);
    let [from, to] = ends;
    let options = Options { objective: true, points: 3, from, to, ..Options::over(Parameter::D) };
    good(sweep(&request(&desk, "study.json", "out"), &options, &Points::All, &Silent));
    let said = desk.read("out/sweep.txt");
    assert_eq!(said.matches(" over limit").count(), 2, "{said}");
    assert!(said.contains("2 values with a design that breaks a limit"), "{said}");
    assert!(said.contains("E1max: largest") && said.contains("smallest that keeps the limits"), "{said}");
    // Where none keeps them, the smallest does not either.
    study["optimize"]["limits"] = json!({ "cavity": 0.1 });
    let desk = Desk::with(&study);
    good(sweep(&request(&desk, "study.json", "out"), &options, &Points::All, &Silent));
    let said = desk.read("out/sweep.txt");
    assert_eq!(said.matches(" over limit").count(), 3, "{said}");
    assert!(said.contains("  smallest 3") && !said.contains("that keeps"), "{said}");
}
