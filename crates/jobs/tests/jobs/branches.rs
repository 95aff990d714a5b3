//! The job as another program calls it, on a short stretch of the paper's damper.

use retune_dynamics::Parameter;
use retune_dynamics::periodic::settle::{Settled, settle};
use retune_dynamics::periodic::{EventKind, Onset};
use retune_jobs::branches::{Options, branches};
use retune_jobs::{Done, Error, Request, Silent};
use retune_model::Measure;
use retune_testkit::desk::{Desk, committed};
use retune_testkit::observers::{good, refused};
use retune_testkit::verified::{End, a_changed_digit_is_found, holds, look};
use serde_json::{Value, json};

/// The paper's damper of Table 2, about its first period doubling.
fn desk() -> Desk {
    Desk::with(&committed("ssvi.json"))
}

fn options() -> Options {
    // Farther on doublings follow each other, and take ten times as long.
    let [from, to] = ["5.2", "5.266"].map(|end| Some(end.to_owned()));
    Options { from, to, samples: 5, starts: 2, ..Options::default() }
}

fn request(desk: &Desk, threads: u16) -> Request {
    let out = Some(desk.path(&format!("out{threads}")));
    Request { out, threads: Some(threads), ..Request::new(&desk.path("study.json")) }
}

#[test]
fn invariant_the_motions_of_a_study_are_the_same_for_any_number_of_threads() {
    let desk = desk();
    let Done::Made(found) = good(branches(&request(&desk, 1), &options(), &Silent)) else {
        panic!("not made")
    };
    good(branches(&request(&desk, 2), &options(), &Silent));
    for name in
        ["branches.csv", "bifurcations.csv", "attractors.csv", "states.csv", "branches.svg", "README.md"]
    {
        assert_eq!(desk.read(&format!("out1/{name}")), desk.read(&format!("out2/{name}")), "{name}");
    }
    // The main branch loses its stability at the period doubling, to a motion of two periods.
    let main = &found.branches.branches[0];
    assert_eq!(main.shooting.periods, 1);
    let doubling = main.events.iter().find(|event| event.kind == EventKind::PeriodDoubling).expect("one");
    assert!((doubling.orbit.value - 5.265928358).abs() < 1e-8, "{}", doubling.orbit.value);
    assert!(found.branches.branches.iter().any(|branch| branch.shooting.periods == 2));
    let json: Value = desk.read_json("out1/branches.json");
    assert_eq!(json["branches"].as_array().map(Vec::len), Some(found.branches.branches.len()));
    assert_eq!(json["plan"]["over"], "omega");
    let events = desk.rows("out1/bifurcations.csv");
    assert!(events.iter().any(|row| row[2] == "period doubling"), "{events:?}");
    // They are verified.
    a_changed_digit_is_found(&desk, "out2", &["branches.csv", "bifurcations.csv", "attractors.csv"]);
}

#[test]
fn contract_what_is_asked_for_is_checked() {
    let desk = desk();
    let wrong = |options: Options, words: &str| {
        let error = refused(branches(&request(&desk, 1), &options, &Silent));
        assert!(matches!(error, Error::Argument { .. }), "{error}");
        assert!(error.to_string().contains(words), "{error}");
    };
    let text = |text: &str| Some(text.to_owned());
    wrong(Options { from: text("fast"), ..options() }, "--from: ");
    wrong(Options { from: text("6"), ..options() }, "--to: 5.266 is not above --from 6");
    wrong(Options { samples: 1, ..options() }, "--samples: 1 is not allowed here: give 2 to 10000");
    wrong(
        Options { over: Parameter::K2, from: text("-1"), to: text("9"), ..options() },
        "-1 N/m: give a value above 0",
    );
    let refuses = |change: fn(&mut Value), words: &str| {
        let mut study = committed("ssvi.json");
        study["optimize"] = Value::Null;
        change(&mut study["scene"]);
        let desk = Desk::with(&study);
        let error = refused(branches(&request(&desk, 1), &options(), &Silent));
        assert!(error.to_string().contains(words), "{error}");
    };
    refuses(|scene| scene["damper"] = Value::Null, "no damper");
    let pulse = |scene: &mut Value| {
        scene["forcing"] = json!({ "pulse": "rectangle", "of": "force", "peak": 1, "duration": 0.1 });
    };
    refuses(
        pulse,
        "under a rectangle of 1 N for 0.1 s, a force on the structure: only a forcing with an omega",
    );
}

/// The damper with an isola and 40 mm more D, which removes it: with a little more force it is back. Below the force that the margin says no
/// isola is found, above it one is, where and as high as said.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn exact_an_isola_begins_at_the_margin_of_the_force() {
    let mut study = committed("ssvi-isola.json");
    study["scene"]["damper"]["D"] = (0.607_212_882_590_035_9 + 0.04).into();
    let [from, to] = ["5.6", "6.3"].map(|end| Some(end.to_owned()));
    let options = Options { from, to, samples: 15, margin: true, ..Options::default() };
    let desk = Desk::with(&study);
    let Done::Made(found) = good(branches(&request(&desk, 2), &options, &Silent)) else { panic!("not made") };
    let Onset { value, omega, orbit } =
        found.margin.expect("asked for").birth.expect("within twice the force");
    assert!(value > 800.0, "{value}");
    assert!(desk.read("out2/README.md").contains(" times P"));
    for (share, is_there) in [(0.999, false), (1.003, true)] {
        study["scene"]["forcing"]["P"] = (share * value).into();
        let desk = Desk::with(&study);
        // Samples about the place where it begins, for just above its birth it is narrow.
        let [from, to] = [-0.05, 0.05].map(|way| Some((omega + way).to_string()));
        let options = Options { from, to, samples: 15, starts: 32, ..Options::default() };
        let Done::Made(found) = good(branches(&request(&desk, 2), &options, &Silent)) else { panic!("made") };
        let energies = found.largest.iter().flatten().map(|orbit| orbit.seen.largest(Measure::Energy));
        let most = energies.fold(0.0, f64::max);
        assert_eq!(
            most > 0.8 * orbit.seen.largest(Measure::Energy),
            is_there,
            "{most} J at {share} of the force"
        );
    }
    let wrong = Options { over: Parameter::K1, margin: true, ..Options::default() };
    let error = refused(branches(&request(&desk, 1), &wrong, &Silent));
    assert!(error.to_string().contains("--margin"), "{error}");
}

/// The damper with an isola, where both motions are: a start of the plane ends on the motion that a run from it settles on, the one in the middle
/// where the run from rest does; the table is the same for any number of threads, and is verified.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn exact_starts_of_a_plane_end_where_their_runs_settle() {
    let desk = Desk::with(&committed("ssvi-isola.json"));
    let [from, to] = ["5.97", "5.99"].map(|end| Some(end.to_owned()));
    let options =
        Options { from, to, samples: 3, starts: 16, basins: Some("5.98".to_owned()), ..Options::default() };
    let Done::Made(found) = good(branches(&request(&desk, 2), &options, &Silent)) else { panic!("not made") };
    good(branches(&request(&desk, 1), &options, &Silent));
    for name in ["starts.csv", "basins.svg", "README.md"] {
        assert_eq!(desk.read(&format!("out1/{name}")), desk.read(&format!("out2/{name}")), "{name}");
    }
    assert!(holds(&desk, "out2", 20).contains("starts.csv             20 of 6561 rows run again"));
    let whole = desk.read("out2/starts.csv");
    let last = whole.trim_end().len() - 1;
    let other = if whole[last..].starts_with('0') { "1" } else { "0" };
    desk.write("out2/starts.csv", [&whole[..last], other, "\n"].concat());
    let End::Not(problem) = look(&desk, "out2", 100, 0.0).1 else { panic!("it holds") };
    assert!(problem.contains("starts.csv, 1 differs"), "{problem}");
    let basins = found.basins.expect("asked for");
    let attractors = &basins.sample.attractors;
    assert!(attractors.iter().all(|one| one.branch.is_some()) && attractors.len() == 2, "{attractors:?}");
    let rest = attractors.iter().position(|one| one.from_rest);
    let middle = basins.starts().nth(basins.ends.len() / 2).expect("a start");
    assert_eq!(middle, ([0.0; 2], rest));
    let shooting = &found.branches.branches[0].shooting;
    let d = found.study.scene.damper.expect("a damper").rest_distance.get();
    let mut met = [0; 2];
    for ([x1, v1], end) in basins.starts().step_by(311) {
        let settled = settle(shooting, 5.98, [x1, v1, x1 + d, v1]).expect("a run");
        let Settled::On(periods, _) = settled else { panic!("a run that does not settle from {x1}, {v1}") };
        let end = end.expect("a motion");
        assert_eq!(attractors[end].orbit.periods, periods, "from {x1}, {v1}");
        met[end] += 1;
    }
    assert!(met[0] > 3 && met[1] > 3, "{met:?}");
}
