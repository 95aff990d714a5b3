//! The messages of all errors, collected in `words.txt`. A new one is refused by the compiler until it is listed here; `RETUNE_WORDS=write
//! cargo test -p retune words` writes the file anew.

use super::*;
use crate::evaluate::LineError;
use retune_model::{Absent, OutOfRange, Positive};
use retune_optim::{AxisError, Bounds, GridError, Parameter};
use retune_solver::Remedy;
use retune_store::Error as StoreError;
use retune_study::{Kind, StudyError};
use std::io::ErrorKind;

/// Checks that there is a sample of each variant; the compiler checks that all variants are listed.
macro_rules! each {
    ($samples:expr, $kind:ident: $($variant:ident)*) => {{
        #[allow(dead_code, reason = "only the compiler reads it")]
        fn named(error: &$kind) -> &'static str {
            match error { $($kind::$variant { .. } => stringify!($variant),)* }
        }
        let seen: Vec<&str> = $samples.iter().map(named).collect();
        $(assert!(seen.contains(&stringify!($variant)), "no sample of {}", stringify!($variant));)*
        $samples.iter().map(|error| format!("{}::{}\n    {error}\n", stringify!($kind), named(error))).collect::<String>()
    }};
}

fn out_of_range() -> OutOfRange {
    Positive::new(-1.0).expect_err("no positive number")
}

fn rules() -> Vec<Rule> {
    let bounds = Bounds { lower: Some(10.0), upper: None };
    let (variable, value) = (Parameter::K2, -1.0);
    let name = "a/b".to_owned();
    vec![
        Rule::Name { name: name.clone() },
        Rule::EmptyWindow { t0: 4.0, end: 4.0 },
        Rule::NoDamper,
        Rule::NoOptimize,
        Rule::NoRestitutions,
        Rule::NoGrid,
        Rule::NothingVaried,
        Rule::VariedTwice { variable },
        Rule::EmptyBand { field: "optimize.objective.omega".into(), unit: " rad/s", from: 8.0, to: 5.0 },
        Rule::NotVaried { field: "bounds", variable },
        Rule::Axis { variable, source: AxisError::NotANumber { name: "from", value: f64::NAN } },
        Rule::Axis { variable, source: AxisError::NotPositive { name: "from", value: 0.0 } },
        Rule::Axis { variable, source: AxisError::Reversed { from: 3.0, to: 2.0 } },
        Rule::Axis { variable, source: AxisError::Points { points: 1, from: 2.0, to: 3.0 } },
        Rule::GridOutside { variable, from: 1.0, to: 2.0, bounds },
        Rule::Grid(GridError::NoAxes),
        Rule::Grid(GridError::TooLarge { points: 1_000_000_000_000, limit: 10_000_000 }),
        Rule::StartOutside { variable, value, bounds },
        Rule::NoRows,
        Rule::SameName { name },
        Rule::not_allowed("optimize.global.searches", 0, "a whole number above 0"),
        Rule::Record {
            listed: false,
            file: "quake.csv".into(),
            problem: "line 3: \"x\" is not a number".into(),
        },
        Rule::SumAndMore { path: "optimize.objective".into() },
        Rule::NoEnd { variable },
    ]
}

fn studies() -> Vec<StudyError> {
    let file = "study.json".to_owned();
    vec![
        StudyError::Unreadable { file: file.clone(), source: ErrorKind::NotFound.into() },
        StudyError::NotText { file: file.clone(), byte: 9 },
        StudyError::Field {
            file: file.clone(),
            line: 3,
            column: 5,
            problem: "scene.primary.k1: missing".into(),
        },
        StudyError::Kind { file: file.clone(), found: Kind::Fronts, wanted: Kind::Study },
        StudyError::Structure { file: "bridge.json".into() },
        StudyError::List { file: file.clone(), field: "window".into() },
        StudyError::Rule { file: file.clone(), rule: Rule::NoDamper },
        StudyError::Several { file: file.clone(), one: Some("results/retune/k1-30000/tmd".into()) },
        StudyError::NoResults {
            file: file.clone(),
            found: "a.json, notes.txt".into(),
            one: Some("study.json/a.json".into()),
        },
        StudyError::Paper { file, problem: "k1: give at least one number above 0".into() },
    ]
}

fn settings() -> Vec<SettingError> {
    let name = Parameter::K2;
    vec![
        SettingError::Form { text: "k1".into() },
        SettingError::Name { name: "k3".into() },
        SettingError::Number { name: name.into(), problem: "\"soft\" is not a number in N/m".into() },
        SettingError::OutOfRange { name: name.into(), source: out_of_range() },
        SettingError::Absent { name: Parameter::P, source: Absent::Forcing("base") },
        SettingError::Start { text: "1,2,3".into() },
        SettingError::Absent { name, source: Absent::NoDamper },
        SettingError::Absent { name: Parameter::D, source: Absent::NoWalls },
        SettingError::Rule(Rule::EmptyWindow { t0: 9.0, end: 4.0 }),
    ]
}

fn solvers() -> Vec<SolverError> {
    vec![
        SolverError::StepTooSmall { t: 1.5, h: 1e-17 },
        SolverError::TooFast { t: 100.0, h: 1e-17, remedy: Remedy::Slower("c2/m2") },
        SolverError::TooFast { t: 1e20, h: 0.1, remedy: Remedy::ShorterRun },
        SolverError::Contact { t: 1.5 },
        SolverError::TooManySteps { t: 1.5, limit: 1000, evaluations: None },
        SolverError::TooManySteps { t: 1.5, limit: 20_000_000, evaluations: Some(5_000_000) },
        SolverError::TooSlow {
            t: 1e-9,
            steps: 262_145,
            needed: 2.6e16,
            limit: 1000,
            remedy: Remedy::LessForce,
        },
        SolverError::TooSlow { t: 1e-9, steps: 262_145, needed: 2.6e16, limit: 1000, remedy: Remedy::Hybrid },
        SolverError::Unstable { t: 1.5 },
        SolverError::Implausible { t: 4.0, value: 1e87, time: 2.5, most: 320.0 },
        SolverError::Missed { t: 4.0, depth: 1e-6 },
        SolverError::RigidWalls { t: 0.0 },
        SolverError::Grazing { t: 1.5 },
        SolverError::NoPeriod { t: 0.0 },
        SolverError::NoDerivatives { t: 0.0 },
        SolverError::NonFinite { t: 1.5 },
    ]
}

fn failures() -> Failures {
    let source = out_of_range().into();
    Failures {
        count: 24,
        example: Some(Box::new((vec![100.0], Unusable::Value { parameter: Parameter::K2, source }))),
    }
}

fn unusable() -> Vec<Unusable> {
    vec![
        Unusable::Value { parameter: Parameter::K2, source: out_of_range().into() },
        Unusable::Frequency(out_of_range()),
        Unusable::Stiffness(out_of_range()),
        Unusable::Member(out_of_range()),
        Unusable::Run(SolverError::NonFinite { t: 1.5 }),
        Unusable::Stopped,
        Unusable::Motions(retune_dynamics::Error::NoPeriod),
        Unusable::NoDerivatives,
        Unusable::NotStationary,
        Unusable::NotDecayed { to: 12.0 },
        Unusable::Resonates { omega: 6.3 },
        Unusable::Touches { omega: 6.3, stroke: 0.4, room: 0.06 },
    ]
}

fn lines() -> Vec<LineError> {
    vec![
        LineError::Count { found: 1, wanted: vec![Parameter::K2, Parameter::C2] },
        LineError::Number { variable: Parameter::K2, text: "soft".into() },
        LineError::Long,
        LineError::Unusable(Unusable::Run(SolverError::NonFinite { t: 1.5 })),
    ]
}

fn stores() -> Vec<StoreError> {
    let path = PathBuf::from("results/ssvi");
    vec![
        StoreError::Output { path: path.clone(), source: ErrorKind::StorageFull.into() },
        StoreError::Output { path: path.clone(), source: ErrorKind::ReadOnlyFilesystem.into() },
        StoreError::Input { path: path.clone(), source: ErrorKind::NotFound.into() },
        StoreError::Busy { path: path.clone(), holder: Some(4711) },
        StoreError::Busy { path: path.clone(), holder: None },
        StoreError::Standing {
            path: path.clone(),
            problem: "surf.csv is in the way: Retune did not make it".into(),
        },
        StoreError::Protected {
            path: path.join("motion.csv"),
            problem: "it is an input of this command".into(),
        },
        StoreError::Journal { path: path.join("unfinished/journal"), problem: "its first line is damaged" },
        StoreError::Unfinished { path: path.clone(), lines: 321, damaged: 0, difference: None },
        StoreError::Unfinished { path: path.clone(), lines: 1, damaged: 1, difference: None },
        StoreError::Unfinished {
            path,
            lines: 321,
            damaged: 2,
            difference: Some("of Retune 0.0.9, this is 0.1.0".into()),
        },
    ]
}

fn errors() -> Vec<Error> {
    let path = PathBuf::from("results/ssvi");
    let full = || std::io::Error::from(ErrorKind::StorageFull);
    let threads = rayon::ThreadPoolBuilder::new().spawn_handler(|_| Err(full())).num_threads(1).build();
    vec![
        Error::Store(StoreError::Input { path: path.clone(), source: ErrorKind::NotFound.into() }),
        Error::Study(StudyError::List { file: "study.json".into(), field: "window".into() }),
        Error::Setting(SettingError::Absent { name: Parameter::K2, source: Absent::NoDamper }),
        Error::Rule { name: "ssvi".into(), rule: Rule::NoOptimize },
        Error::Requirement { place: "--mass".into(), problem: "missing: the mass of the damper".into() },
        Error::Argument { option: "--to", problem: "5 is not above --from 8".into() },
        Error::Interval { value: 0.0, most: 100 },
        Error::Part { path: path.clone(), problem: "it is damaged at number 23: make it again".into() },
        Error::MissingParts {
            points: "6 to 11".into(),
            len: 24,
            shards: Some("2/4".into()),
            command: "retune optimize study.json".into(),
            place: path.join("parts"),
        },
        Error::NotHeld { path: path.clone(), problem: "does not hold: surf.csv is missing".into() },
        Error::NotProven { name: "ssvi".into(), why: retune_proof::Failure::Sequence(1.5e-3).to_string() },
        Error::NotChecked { path: path.clone(), problem: "there is no manifest.json".into() },
        Error::Infeasible {
            name: "ssvi".into(),
            words: "no verdict, for the design breaks the limit of stroke: 0.3 of 0.2 m, 50 % over".into(),
        },
        Error::Lines { failed: 1, lines: 24 },
        Error::Threads(threads.expect_err("no threads")),
        Error::Run(SolverError::NonFinite { t: 1.5 }),
        Error::Motion(retune_dynamics::Error::NoPeriod),
        Error::Unusable(Unusable::Run(SolverError::NonFinite { t: 1.5 })),
        Error::NoStart(Failures::default()),
        Error::NoStart(failures()),
        Error::Search {
            source: retune_optim::Error::StartValue { value: f64::INFINITY },
            failures: failures(),
        },
        Error::Global { source: retune_optim::GlobalError::NoStart { samples: 64 }, failures: failures() },
        Error::Figure { name: "surf-k2-c2.svg".into(), problem: "no room".into() },
    ]
}

#[test]
fn regress_the_words_of_every_error() {
    let words = [
        each!(stores(), StoreError: Output Input Standing Protected Journal Busy Unfinished),
        each!(errors(), Error: Store Study Setting Rule Requirement Argument Interval Part MissingParts NotHeld NotChecked NotProven Infeasible Lines Threads Run Motion
            Unusable NoStart Global Search Figure),
        each!(studies(), StudyError: Unreadable NotText Field Kind Structure List Rule Several NoResults Paper),
        each!(settings(), SettingError: Form Name Number OutOfRange Absent Start Rule),
        each!(rules(), Rule: Name EmptyWindow NoDamper NoOptimize NoRestitutions NoGrid NothingVaried VariedTwice EmptyBand
            NotVaried Axis GridOutside Grid StartOutside NoRows SameName NotAllowed Record SumAndMore NoEnd),
        each!(unusable(), Unusable: Value Frequency Stiffness Member Run Stopped Motions NoDerivatives NotStationary NotDecayed Resonates Touches),
        each!(solvers(), SolverError: StepTooSmall TooFast Contact TooManySteps TooSlow Unstable Implausible Missed
            RigidWalls Grazing NoPeriod NoDerivatives NonFinite),
        each!(lines(), LineError: Count Number Long Unusable),
    ]
    .concat();
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/src/error/words.txt");
    if std::env::var("RETUNE_WORDS").is_ok_and(|what| what == "write") {
        std::fs::write(file, &words).expect("the file");
    }
    let expected = std::fs::read_to_string(file).expect("the file");
    for (found, expected) in words.lines().zip(expected.lines()) {
        assert_eq!(found, expected);
    }
    assert_eq!(words.lines().count(), expected.lines().count());
}
