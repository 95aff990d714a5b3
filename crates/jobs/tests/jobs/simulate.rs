//! `simulate`: one run, its summary and its motion.

use crate::{read, request, search};
use retune_jobs::simulate::{Simulation, Trajectory, simulate};
use retune_jobs::table2::table2;
use retune_jobs::{Error, Silent};
use retune_model::{Measure, Parameter};
use retune_solver::{Remedy, SolverError};
use retune_store::Error as StoreError;
use retune_study::{Setting, Study};
use retune_testkit::desk::{Desk, studies, tiny};
use retune_testkit::observers::{good, refused};
use serde_json::json;
use std::f64::consts::PI;
use std::path::Path;

/// Writes the motion of the tiny study into a file of the desk.
fn motion(desk: &Desk, file: &str, interval: f64) -> Result<(), Error> {
    let (file, study) = (desk.path(file), desk.path("study.json"));
    let trajectory = Trajectory { file: &file, interval, inputs: &[&study] };
    simulate(&read(desk, "study.json"), Some(trajectory)).map(drop)
}

#[test]
fn contract_the_trajectory_has_a_row_for_each_interval() {
    let desk = Desk::with(&tiny());
    good(motion(&desk, "motion.csv", 0.5));
    let csv = desk.rows("motion.csv");
    assert_eq!(csv[0].join(","), "t,x1,v1,x2,v2,E1,E2,FconL,FconR,moment");
    let grid = csv[1..].iter().filter(|row| row[9] == "grid");
    let times: Vec<&String> = grid.map(|row| &row[0]).collect();
    assert_eq!(times, ["1", "1.5", "2", "2.5", "3", "3.5", "4"]);
    for interval in [1e-9, 0.0, -1.0, f64::NAN] {
        let error = refused(motion(&desk, "other.csv", interval));
        let Error::Interval { value, most } = error else { panic!("{error}") };
        assert_eq!((value.to_bits(), most), (interval.to_bits(), 100_000_000));
    }
    assert_eq!(desk.names("."), ["motion.csv", "study.json"]);
}

#[test]
fn contract_a_trajectory_replaces_only_trajectories() {
    let desk = Desk::with(&tiny());
    let before = desk.read("study.json");
    let protected = |file: &str, reason: &str| match refused(motion(&desk, file, 1.0)) {
        Error::Store(StoreError::Protected { path, problem }) => {
            assert_eq!(path, desk.path(file));
            assert!(problem.starts_with(reason), "{problem}");
        }
        other => panic!("{file}: {other}"),
    };
    for file in ["study.json", "./study.json"] {
        protected(file, "it is an input of this command");
    }
    desk.write("notes.csv", "t,x\n1,2\n");
    desk.write("surf.csv", "k2,c2,D,C,E1max\n");
    for file in ["notes.csv", "surf.csv"] {
        protected(file, "there is a file that Retune did not make");
    }
    assert_eq!([desk.read("study.json"), desk.read("notes.csv")], [before, "t,x\n1,2\n".to_owned()]);
    desk.write("empty.csv", "");
    for file in ["motion.csv", "motion.csv", "empty.csv"] {
        good(motion(&desk, file, 1.0));
        assert!(desk.read(file).starts_with("t,x1,v1,x2,v2,"));
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("motion.csv", desk.path("link.csv")).expect("a link");
        protected("link.csv", "it is a symbolic link");
        protected("/dev/null", "it is no plain file");
    }
}

/// One cause and one remedy, immediately: a typing error must not start a run of a day.
#[test]
fn contract_values_that_nobody_means_are_told_with_what_helps() {
    let study = retune_study::read(&studies().join("ssvi-resonance.json")).expect("a study");
    let too_fast = |error, what| matches!(error, SolverError::TooFast { remedy, .. } if remedy == what);
    let too_slow = |error, what| matches!(error, SolverError::TooSlow { remedy, .. } if remedy == what);
    type Expected<'a> = &'a dyn Fn(SolverError) -> bool;
    let cases: [(&str, f64, Expected, &str, &str); 7] = [
        (
            "T",
            1e300,
            &|error| too_fast(error, Remedy::ShorterRun),
            "lost to rounding at t = 1e300 s",
            "shorten T",
        ),
        ("T", 1e10, &|error| too_slow(error, Remedy::ShorterRun), "and max_steps is 20000000", "shorten T"),
        (
            "omega",
            1e300,
            &|error| too_fast(error, Remedy::Slower("omega")),
            "the motion changes within 1.2e-300 s",
            "lower omega, which makes the motion this fast",
        ),
        (
            "R",
            1e-200,
            &|error| matches!(error, SolverError::Contact { .. }),
            "a contact at t = 2.0",
            "check what it is made of: R, q, E1 to E4",
        ),
        (
            "m2",
            1e-6,
            &|error| too_slow(error, Remedy::Slower("c2/m2")),
            "at this rate it takes 9.3e9 steps",
            "lower c2/m2, which makes the motion this fast",
        ),
        (
            "k1",
            1e20,
            &|error| too_slow(error, Remedy::Slower("k1/m1")),
            "at this rate it takes 1.3e10 steps",
            "lower k1/m1, which makes the motion this fast",
        ),
        (
            "P",
            1e150,
            &|error| too_slow(error, Remedy::LessForce),
            "at this rate it takes 1.6e22 steps",
            "lower P: nearly all steps are those of contacts",
        ),
    ];
    for (name, value, expected, cause, remedy) in cases {
        let begin = std::time::Instant::now();
        let error = refused(simulate(
            &study.with(&[format!("{name}={value}").parse().expect("a setting")]).expect("a study"),
            None,
        ));
        assert!(begin.elapsed().as_secs() < 10, "{name}: {:?}", begin.elapsed()); // a fraction of a second on an idle machine
        let words = error.to_string();
        let Error::Run(error) = error else { panic!("{name}: {words}") };
        assert!(expected(error), "{name}: {error:?}");
        assert!(words.contains(cause) && words.ends_with(&format!("; {remedy}")), "{name}: {words}");
        assert_eq!(words.matches(';').count(), 1, "{name}: {words}");
    }
}

fn read_file(path: &Path) -> Result<Study, Error> {
    Ok(retune_study::read(path)?)
}

/// The results of a search stand for its study with the design that it found, wherever a study is read.
#[test]
fn contract_results_are_read_as_the_study_with_the_design_that_was_found() {
    let desk = Desk::with(&tiny());
    let found = search(&desk, "study.json", "out");
    let own = good(read_file(&desk.path("study.json")));
    let scene = own.scene_at(&found.damper.design).expect("a damper");
    for path in ["out", "out/optimum.json"] {
        let study = good(read_file(&desk.path(path)));
        assert_eq!((study.scene, study.name()), (scene, "study"), "{path}");
        let run = good(simulate(&study, None));
        assert_eq!(json!(run)["E1max"].as_f64(), Some(found.value()), "{path}");
    }
    // Of several searches one has to be named.
    let row = json!({ "damper": "NES", "study": "study.json", "reference": { "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 } });
    desk.write_json("table2.json", &json!({ "rows": [row] }));
    good(table2(&request(&desk, "table2.json", "table"), &Silent));
    let said = refused(read_file(&desk.path("table"))).to_string();
    assert!(
        said.contains("holds the designs of several searches") && said.ends_with("table/study"),
        "{said}"
    );
}

/// A directory that is none of Retune's is told with what is in it, and with what can be read in its place.
#[test]
fn contract_a_foreign_directory_is_told_with_what_is_in_it() {
    let desk = Desk::with(&tiny());
    std::fs::create_dir(desk.path("empty")).expect("a directory");
    let said = |path: &str| refused(read_file(&desk.path(path))).to_string();
    assert!(said("empty").ends_with("these are no results: there is no study.json in it, but nothing"));
    std::fs::create_dir(desk.path("mine")).expect("a directory");
    for name in ["a.txt", "b.json", "c.txt", "d.txt", "e.txt", "f.txt", "g.txt"] {
        desk.write_json(&format!("mine/{name}"), &json!({ "a": 1 }));
    }
    assert!(
        said("mine").ends_with("but a.txt, b.json, c.txt, d.txt, e.txt and 2 others"),
        "{}",
        said("mine")
    );
    std::fs::create_dir_all(desk.path("mine/inner/one")).expect("a directory");
    std::fs::write(desk.path("mine/inner/one/optimum.json"), "{}").expect("a file");
    assert!(said("mine").ends_with("/mine/inner/one"), "{}", said("mine"));
    std::fs::copy(desk.path("study.json"), desk.path("mine/z.json")).expect("a study");
    assert!(said("mine").ends_with("/mine/z.json"), "{}", said("mine"));
}

/// A strength and a density change no number of a run, and nothing is said while the contacts are elastic and quasi-static.
#[test]
fn contract_contacts_outside_what_hertzs_law_holds_for_are_told() {
    let study = retune_study::read(&studies().join("ssvi-resonance.json")).expect("a study");
    let study =
        study.with(&["t0=1", "T=8", "R=0.5"].map(|text| text.parse().expect("a setting"))).expect("a study");
    let numbers = |run: &Simulation| {
        let mut run = json!(run);
        run["parameters"]["damper"]["contact"] = json!(null);
        let warnings = run.as_object_mut().expect("an object").remove("warnings");
        (run, warnings)
    };
    let (plain, none) = numbers(&good(simulate(&study, None)));
    let structure = |name: &str| plain["contacts"]["structure"][name].as_f64().expect(name);
    let [pressure, shortest] = [structure("contact_pressure"), structure("shortest")];
    let warnings = |parameter: Parameter, value: f64| -> Vec<String> {
        let run = good(simulate(&study.with(&[Setting::new(parameter, value)]).expect("a study"), None));
        let (numbers, told) = numbers(&run);
        assert_eq!(numbers, plain, "{parameter}");
        let words = run.to_string();
        let shown: Vec<String> =
            words.lines().filter_map(|line| line.strip_prefix("warning     ").map(str::to_owned)).collect();
        assert_eq!(told, (!shown.is_empty()).then(|| json!(shown)));
        shown
    };
    assert_eq!(none, None);
    let strength = pressure / 1.6;
    assert_eq!(warnings(Parameter::Strength, 1.001 * strength), [""; 0]);
    // A wave passes the damper of 60 kg and the softer surface, of 22.1 MPa, and comes back in 2 m2^(1/3) ρ^(1/6) / √E.
    let density = (shortest / 10.0 * 2.21e7_f64.sqrt() / 60_f64.cbrt()).powi(6);
    assert_eq!(warnings(Parameter::Density, 0.99 * density), [""; 0]);
    let yields = |wall: &str, numbers: &str| {
        format!(
            "on the {wall} the pressure of {numbers}: at 1.6 times that, yield begins below the surface (Tresca and von Mises, nu = 0.3): Hertz's law holds for elastic contacts"
        )
    };
    let fast = |wall: &str, lasts: &str, wave: &str| {
        format!(
            "on the {wall} the shortest contact lasts {lasts} ms, less than 5 times the {wave} ms of a wave through the damper and back: Hertz's law holds for quasi-static contacts"
        )
    };
    assert_eq!(
        warnings(Parameter::Strength, 0.5 * strength),
        [
            yields("structure", "1.95 MPa is 3.2 times the yield strength of 609 kPa"),
            yields("obstacle", "1.68 MPa is 2.75 times the yield strength of 609 kPa")
        ]
    );
    assert_eq!(warnings(Parameter::Density, 1.01 * density), [fast("structure", "17.5", "3.5")]);
    assert_eq!(
        warnings(Parameter::Density, 8.0 * density),
        [fast("structure", "17.5", "4.95"), fast("obstacle", "18.8", "5.14")]
    );
}

/// Without a damper, once the transient has died out: √((1 + (2ζr)²) / ((1 - r²)² + (2ζr)²)) with r = ω/ω1.
#[test]
fn exact_transmissibility_and_frequency_are_those_of_a_linear_oscillator() {
    let mut study = retune_study::read(&studies().join("ssvi-resonance.json")).expect("a study");
    (study.scene.damper, study.optimize) = (None, None);
    let study = study.with(&["omega=1.2Hz", "t0=200", "T=300"].map(|text| text.parse().expect("a setting")));
    let study = study.expect("a study");
    let run = json!(good(simulate(&study, None)));
    let (omega, natural, zeta) =
        (2.4 * PI, 39_500_f64.sqrt() / 1000_f64.sqrt(), 452.0 / 2.0 / 3.95e7_f64.sqrt());
    let (r, damped) = (omega / natural, 2.0 * zeta * omega / natural);
    let expected = ((1.0 + damped * damped) / ((1.0 - r * r).powi(2) + damped * damped)).sqrt();
    let number = |name: &str| run[name].as_f64().expect(name);
    assert!((number("transmissibility") / expected - 1.0).abs() < 1e-9, "{run}");
    assert!((number("f_Hz") - 1.2).abs() < 1e-12 && (number("n_rpm") - 72.0).abs() < 1e-9, "{run}");
    assert!((number("omega") / omega - 1.0).abs() < 1e-15);
}

/// A structure without a force transmits none of it.
#[test]
fn contract_without_a_force_there_is_no_transmissibility() {
    let study = retune_study::read(&studies().join("ssvi-resonance.json")).expect("a study");
    let study = study.with(&[Setting::new(Parameter::P, 0.0)]).expect("a study");
    let run = good(simulate(&study, None));
    assert_eq!((run.summary.transmissibility(), &json!(run)["transmissibility"]), (None, &json!(null)));
    assert!(!run.to_string().contains("transmiss"));
    assert!(
        run.to_string().contains("\nR1, R2      none: nothing has energy")
            && !run.to_string().contains("NaN")
    );
}

/// Every value begins in one column, and those of a force a million times as small keep their digits.
#[test]
fn regress_values_stand_in_a_column_and_keep_their_digits() {
    let of = |name: &str| retune_study::read(&studies().join(name)).expect("a study");
    let small = of("tmd.json").with(&[Setting::new(Parameter::P, 8e-4)]).expect("a study");
    for study in [small.clone(), of("random-tmd.json")] {
        for line in good(simulate(&study, None)).to_string().lines().skip(1) {
            let letters: Vec<char> = line.chars().collect();
            assert!(letters[11] == ' ' && letters[12] != ' ', "{line}");
        }
    }
    let run = good(simulate(&small, None));
    let words = run.to_string();
    let said = words.lines().find_map(|line| line.strip_prefix("E1max       ")).expect("a line");
    let said: f64 = said.split(' ').next().and_then(|text| text.parse().ok()).expect("a number");
    assert!((said / run.summary.largest(Measure::Energy) - 1.0).abs() < 1e-7, "{words}");
}
