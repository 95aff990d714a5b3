//! Sweeps against closed form, and what they refuse.

use retune_jobs::Error;
use retune_jobs::rows::Rows;
use retune_jobs::sweep::{Options, Plan, Sweep, words};
use retune_model::Bare;
use retune_report::table::Table;
use retune_study::{Study, read::from_text};

const SCENE: &str = r#"{
    "scene": {
        "primary": { "m1": 1000, "c1": 452, "k1": 39500 },
        "forcing": { "P": 800, "omega": 6.28 },
        "damper": { "m2": 60, "k2": 600, "c2": 262, "D": 2.08, "C": 4.7,
            "contact": { "R": 2, "q": 0.318, "E1": 2.1e11, "nu1": 0.3, "E2": 2.21e7, "nu2": 0.4,
                "E3": 2.1e11, "nu3": 0.3, "E4": 2.05e7, "nu4": 0.4 } }
    },
    "window": { "t0": 200, "T": 220 }OPTIMIZE
}"#;
const BAND: &str = r#", "optimize": { "vary": ["k2"], "objective": { "omega": { "from": 5, "to": 8 }, "response": "steady" } }"#;

fn study(optimize: &str) -> Study {
    from_text(&SCENE.replace("OPTIMIZE", optimize), "tmd.json").expect("a study")
}

fn options(over: &str, from: &str, to: &str, points: usize) -> Options {
    Options { from: from.into(), to: to.into(), points, ..Options::over(over.parse().expect("a parameter")) }
}

fn sweep(options: &Options, optimize: &str) -> Result<Sweep, Error> {
    Sweep::new(Plan::read(options)?, study(optimize))
}

fn table(sweep: &Sweep) -> Table {
    let numbers: Vec<f64> = (0..sweep.len()).flat_map(|i| sweep.numbers(i).0).collect();
    sweep.table(&numbers)
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    table.column(name).unwrap_or_else(|| panic!("{name}"))
}

/// After 200 s the transient of the structure has died out, and the response is that of the closed form.
#[test]
fn exact_a_sweep_over_frequency_is_the_steady_response_of_the_structure() {
    let sweep = sweep(&options("omega", "0.8Hz", "1.2", 3), "");
    assert!(sweep.is_err(), "1.2 rad/s is below 0.8 Hz");
    let sweep = self::sweep(&Options { unit: Some("Hz".into()), ..options("omega", "0.8", "72rpm", 5) }, "")
        .expect("a sweep");
    let table = table(&sweep);
    assert!(column(&table, "f_Hz").iter().zip([0.8, 0.9, 1.0, 1.1, 1.2]).all(|(a, b)| (a - b).abs() < 1e-12));
    let scene = study("").scene;
    let bare = Bare::new(&scene.primary, &scene.forcing);
    let names = ["E1max_none", "ground_force_none", "transmissibility_none", "n_rpm"];
    let [energy, ground, share, rpm] = names.map(|name| column(&table, name));
    for (i, omega) in column(&table, "omega").into_iter().enumerate() {
        let steady = bare.steady_e1_max([omega; 2]).value;
        assert!((energy[i] / steady - 1.0).abs() < 1e-9, "{omega}: {} {steady}", energy[i]);
        assert_eq!(share[i].to_bits(), (ground[i] / 800.0).to_bits());
        assert!((rpm[i] - 30.0 * omega / std::f64::consts::PI).abs() < 1e-11);
    }
}

/// Every motion of a linear scene is proportional to the force, and its energy to the square of it.
#[test]
fn exact_a_linear_motion_is_proportional_to_the_force() {
    let table = table(&sweep(&Options { log: true, ..options("P", "100", "800", 4) }, "").expect("a sweep"));
    let force = column(&table, "P");
    assert!(force.windows(2).all(|pair| (pair[1] / pair[0] - 2.0).abs() < 1e-12), "{force:?}");
    for (name, power) in
        [("E1max", 2), ("x1max", 1), ("stroke", 1), ("transmissibility", 0), ("a1max_none", 1)]
    {
        let values = column(&table, name);
        for i in 1..4 {
            let expected = (force[i] / force[0]).powi(power);
            assert!((values[i] / values[0] / expected - 1.0).abs() < 1e-9, "{name}: {values:?}");
        }
    }
    assert_eq!(column(&table, "impacts"), [0.0; 4]);
}

/// The objective of the study itself, at its own value of the parameter and beside it.
#[test]
fn contract_a_point_of_the_objective_is_what_the_study_says() {
    let sweep = sweep(&Options { objective: true, ..options("k2", "500", "700", 3) }, BAND).expect("a sweep");
    let study = study(BAND);
    let table = table(&sweep);
    let (energy, none) = (column(&table, "E1max"), column(&table, "E1max_none"));
    assert_eq!(Some(energy[1]), study.energy(&study.scene));
    assert_eq!(none, [study.energy_without_damper(); 3]);
    assert!(energy[0] > energy[1] && energy[1] > energy[2], "a stiffer spring is better here: {energy:?}");
    assert!(column(&table, "omega_worst").iter().all(|omega| (5.0..=8.0).contains(omega)));
}

#[test]
fn contract_a_table_fits_the_screen_and_the_answer_comes_first() {
    let all = "E1max,x1max,v1max,a1max,ground_force,stroke,contact_force,transmissibility,impacts";
    let quantities: Vec<_> = all.split(',').map(|name| name.parse().expect("a quantity")).collect();
    for quantities in [Vec::new(), quantities] {
        for over in ["omega", "k1", "c2"] {
            let options = Options { quantities: quantities.clone(), ..options(over, "5", "8", 15) };
            let sweep = sweep(&options, "").expect("a sweep");
            let text = words::text(&sweep, &table(&sweep), &[], false);
            let wide: Vec<&str> =
                text.lines().filter(|line| line.chars().count() > 80 || line.ends_with(' ')).collect();
            assert!(wide.is_empty(), "{wide:#?}");
            // A mark names no quantity: of several rows none has one.
            assert_eq!(text.contains(" < largest"), quantities.is_empty(), "{text}");
            assert!(text.find("E1max: ") < text.find(" < largest").or(text.rfind('\n')), "{text}");
        }
    }
}

#[test]
fn contract_what_cannot_be_swept_is_refused_with_what_to_do() {
    let cases: [(Options, &str, &str); 8] = [
        (
            options("omega", "1kHz", "8", 3),
            "",
            "--from: \"1kHz\" is not a number in rad/s, nor one with its unit",
        ),
        (options("k1", "soft", "8", 3), "", "--from: \"soft\" is not a number in N/m, nor one with its unit"),
        (options("k1", "8", "3", 3), "", "--from, --to, --points: the range is empty"),
        (
            options("k1", "3", "8", 1),
            "",
            "--points: 1 is not allowed here: give a whole number from 2 to 100000",
        ),
        (options("m1", "0", "8", 3), "", "m1: 0 is not allowed here: give a finite number above 0"),
        (
            Options { log: true, ..options("D", "0", "1", 3) },
            "",
            "--from, --to, --points: `from` is 0: both ends of a log",
        ),
        (
            Options { objective: true, ..options("omega", "5", "8", 3) },
            BAND,
            "--over: omega: the objective takes its own",
        ),
        (Options { objective: true, ..options("k1", "5", "8", 3) }, "", "optimize: missing"),
    ];
    for (options, optimize, message) in cases {
        let error = sweep(&options, optimize).expect_err(message).to_string();
        let said = ["command line: ", "study tmd: "].into_iter().find_map(|place| error.strip_prefix(place));
        assert!(said.is_some_and(|said| said.starts_with(message)), "{error}");
    }
    let unit = |unit: &str| Options { unit: Some(unit.into()), ..options("k1", "3", "8", 3) };
    let said = sweep(&unit("kg"), "").expect_err("another unit").to_string();
    assert_eq!(
        said,
        "command line: --from: \"3kg\" is not a number in N/m, nor one with its unit: N/m, kN/m, MN/m, N/mm"
    );
    let ends = sweep(&unit("kN/m"), "").map(|sweep| [sweep.value(0), sweep.value(2)]);
    assert_eq!(ends.expect("ends"), [3e3, 8e3]);
}

/// A value at which nothing can be computed is a gap with its reason, not the end of the sweep.
#[test]
fn contract_a_point_without_a_value_is_a_gap_with_a_reason() {
    let sweep = sweep(&Options { objective: true, ..options("D", "0.01", "1", 2) }, BAND).expect("a sweep");
    let (numbers, reason) = sweep.numbers_at(0.01);
    assert!(numbers[0].is_infinite() && numbers[3].is_finite(), "{numbers:?}");
    let reason = reason.expect("a reason");
    assert!(reason.starts_with("the damper reaches a wall"), "{reason}");
    let table = table(&sweep);
    assert!(table.csv().lines().nth(1).is_some_and(|line| line.starts_with("0.01,,,,")), "{}", table.csv());
    assert!(table.json()["rows"][0]["E1max"].is_null());
    let text = words::text(&sweep, &table, &[(0.01, reason)], false);
    assert!(text.contains("1 point has no value; the first, D = 0.01 m: the damper reaches"), "{text}");
}
