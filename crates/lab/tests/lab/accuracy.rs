//! The scenes of the comparison: their references, the default tolerance, the smallest models, the tables of other programs.

use retune_lab::reference::Reference;
use retune_lab::runs::{errors, parse, run, settings};
use retune_lab::savings::savings;
use retune_lab::scenes::{Case, cases};
use retune_lab::statistics;
use retune_solver::{Contacts, Method, Settings};
use std::fs;
use std::path::Path;

/// How much farther neighbours part in a scene than in most: with a restitution by a factor of e^(0.35 20) = 1100 over the run, ten times as far.
fn grown(case: &Case) -> f64 {
    if case.name == "restitution" { 10.0 } else { 1.0 }
}

/// DOP853 with located contacts gives the same motion, and every run ends within the predictable horizon.
#[test]
fn reference_of_every_scene_is_confirmed_and_predictable() {
    for case in cases() {
        let reference = Reference::of(&case).expect("runs");
        let [e1, state, times] = reference.uncertainty;
        // On a stiff dashpot DOP853 takes steps at the edge of its stability.
        let grown = if case.name == "stiff-dashpot" { 10.0 } else { grown(&case) };
        let [e1, state, times] = [e1, state, times].map(|error| error / grown);
        assert!(e1 < 1e-11 && state < 1e-9 && times < 1e-10, "{}: {e1:e} {state:e} {times:e}", case.name);
        assert!(case.to < reference.horizon(), "{}", case.name);
    }
}

/// The certificate asks for E1max to 1e-9.
#[test]
fn reference_the_default_tolerance_suffices_for_a_certificate() {
    for case in cases() {
        let reference = Reference::of(&case).expect("runs").found;
        let found = run(&case, &Settings::default(), false).expect("runs");
        let [e1, ..] = errors(&found, &reference, case.omega());
        assert!(e1 < 1e-9 * grown(&case), "{}: {e1:e}", case.name);
        assert_eq!(found.impacts, reference.impacts, "{}", case.name);
    }
}

#[test]
fn invariant_the_smallest_model_and_the_full_one_agree() {
    for saving in savings(&cases()).expect("runs") {
        let [small, full] = saving.e1_max;
        assert!((small / full - 1.0).abs() < 1e-11, "{}: {small} {full}", saving.label);
    }
}

/// The best runs of other programs in the committed table, all on the same scenes but Octave (the paper's six kinds of contact) and the law of a
/// restitution, which C and Python leave out, come to the reference.
#[test]
fn reference_other_programs_come_to_the_same_motion() {
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../results/accuracy/runs.csv");
    let (table, cases) = (fs::read_to_string(table).expect("the committed runs"), cases());
    let names: Vec<&'static str> = cases.iter().map(|case| case.name).collect();
    let rows = parse(&table, &names);
    for (program, level, scenes) in [
        ("Octave", 1e-6, 6),
        ("SciPy", 1e-6, 10),
        ("SUNDIALS", 1e-9, 10),
        ("ivp", 1e-6, 12),
        ("Moreau-Jean", 1e-4, 1),
    ] {
        let mut compared = 0;
        for case in &cases {
            let own = rows.iter().filter(|r| r.scene == case.name && r.program.starts_with(program));
            let e1 = own.filter_map(|row| Some(row.found.as_ref().ok()?.e1_max));
            let reference = Reference::of(case).expect("runs").found.e1_max;
            let Some(best) = e1.map(|e1| (e1 / reference - 1.0).abs()).reduce(f64::min) else { continue };
            compared += 1;
            assert!(best < level, "{program} on {}: {best:e}", case.name);
        }
        assert_eq!(compared, scenes, "{program}");
    }
}

/// Where no run can be predicted, the long-run statistics of two methods still agree.
#[test]
fn reference_statistics_of_a_chaotic_motion_do_not_depend_on_the_method() {
    let of = |method, rtol| statistics::of(settings(method, Contacts::Located, rtol)).expect("runs");
    let (a, b) = (of(Method::Hybrid, 1e-8), of(Method::Dop853, 1e-8));
    let error = a.error.hypot(b.error);
    assert!(
        error < 0.05 * a.mean && (a.mean - b.mean).abs() < 4.0 * error,
        "{} {} ± {error}",
        a.mean,
        b.mean
    );
    assert!((a.impacts / b.impacts - 1.0).abs() < 0.05, "{} {}", a.impacts, b.impacts);
}
