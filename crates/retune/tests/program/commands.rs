//! Each command from its arguments to the screen, on studies of a few runs.

use crate::common::{Desk, Program};
use retune_testkit::desk::{RESULTS, committed, global, tiny};
use serde_json::{Value, json};
use std::process::{Child, Output, Stdio};

#[test]
fn contract_optimize_shows_the_design_and_where_the_results_are() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    let screen = desk.good(&["optimize", "small.json", "--verbose"]);
    assert_eq!(desk.names("results/small"), RESULTS);
    assert!(screen.starts_with("surf: 3 x 2 x 2 x 2 = 24 points over k2 c2 D C\n"), "{screen}");
    assert!(screen.contains("\nSSVI NES: E1max ") && screen.contains("\n  build    m2 = 60 kg, k2 = "));
    assert!(screen.contains("TolX 1e-4 is absolute"));
    assert!(screen.trim_end().ends_with(&format!("results in results/small: {}", RESULTS.join(" "))));
    let quiet = desk.good(&["optimize", "small.json", "--quiet", "--threads", "1", "--out", "results/quiet"]);
    let answer = quiet.replace("results/quiet", "results/small");
    assert!(!quiet.contains("surf: ") && screen.ends_with(&answer), "{quiet}");
    desk.assert_same("results/quiet", "results/small");
}

#[test]
fn contract_certify_shows_the_certificate_and_where_it_is() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    let screen = desk.good(&["certify", "small.json"]);
    let certificate = desk.read_json("results/certify/small/certificate.json");
    assert!(screen.contains(certificate["words"].as_str().expect("words")), "{screen}");
    assert!(
        screen.ends_with("results in results/certify/small: certificate.json manifest.json study.json\n"),
        "{screen}"
    );
}

/// The results of several studies are named after the file that names them.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_tables_and_fronts_show_what_they_found_and_where_it_is() {
    let mut study = global(json!({ "omega": { "from": 7.5, "to": 7.8, "samples": 2 } }), json!({}));
    study["optimize"]["global"] = json!({ "samples": 8, "searches": 1, "evaluations": 10 });
    study["optimize"]["refine"] = json!({ "MaxFunEvals": 8 });
    let desk = Desk::with(&study);
    let damper = json!({ "damper": "NES", "study": "study.json" });
    let mut row = damper.clone();
    row["reference"] = json!({ "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 });
    desk.write_json("mine.json", &json!({ "rows": [row] }));
    desk.write_json(
        "fronts.json",
        &json!({ "dampers": [damper], "k2": [300], "stroke": [0.9], "samples": 5 }),
    );
    let screen = desk.good(&["table2", "mine.json", "--quiet"]);
    assert!(
        screen.contains("\nre-optimised  NES ") && screen.contains("\nresults in results/mine: "),
        "{screen}"
    );
    let screen = desk.good(&["retention", "30000", "5e4", "--study", "mine.json", "--quiet", "--replace"]);
    assert!(
        screen.contains("\nk1 = 50000    NES ") && screen.contains("\nresults in results/mine: "),
        "{screen}"
    );
    let screen = desk.good(&["fronts", "fronts.json", "--quiet"]);
    assert!(screen.contains("\nresults in results/fronts: README.md "), "{screen}");
    assert!(desk.read("results/fronts/README.md").starts_with("# What the NES is good for\n"));
}

#[test]
fn contract_figures_and_tables_of_the_paper_are_made_by_number() {
    let desk = Desk::with_table2("table2.json", |study| study["window"] = json!({ "t0": 5, "T": 10 }));
    desk.write_json("paper.json", &committed("paper.json"));
    let screen = desk.good(&["figure", "6", "--study", "paper.json"]);
    assert!(screen.starts_with("Figure 6. ") && screen.contains("\nresults in results/paper: "), "{screen}");
    let screen = desk.good(&["table", "2", "--study", "paper.json", "--quiet", "--out", "tables"]);
    assert!(screen.starts_with("Table 2. ") && screen.contains("table2-table-1.csv"), "{screen}");
}

#[test]
fn contract_check_describes_a_study_and_calls_it_good() {
    let desk = Desk::with(&tiny());
    let said = desk.good(&["check", "study.json"]);
    let first = "study study: k1 = 39500 N/m, forced by P = 800 N at omega = 6.28 rad/s; maxima from t0 = 1 s to T = 4 s\n";
    assert!(said.starts_with(first) && said.ends_with("\nstudy.json: good\n"), "{said}");
    assert!(said.contains("\n  tunes k2, c2, D, C from a grid of 24 points over k2, c2, D, C\n"), "{said}");
}

#[test]
fn contract_simulate_prints_one_object_with_the_promised_keys() {
    let desk = Desk::with(&tiny());
    let answer: Value =
        serde_json::from_str(&desk.good(&["simulate", "study.json", "--json"])).expect("JSON");
    for key in [
        "/E1max",
        "/t_E1max",
        "/E2max",
        "/R1",
        "/R2",
        "/impacts/primary",
        "/impacts/obstacle",
        "/x1max",
        "/t_x1max",
        "/v1max",
        "/t_v1max",
        "/a1max",
        "/t_a1max",
        "/ground_force_max",
        "/t_ground_force_max",
        "/relative_displacement_max",
        "/spring_deflection_max",
        "/force_max/primary",
        "/force_max/obstacle",
        "/evaluations",
        "/solver/rtol",
    ] {
        assert!(answer.pointer(key).is_some_and(Value::is_number), "{key}");
    }
    assert_eq!((&answer["scene"], &answer["solver"]["method"]), (&json!("contact"), &json!("hybrid")));
    let [r1, r2] = ["R1", "R2"].map(|key| answer[key].as_f64().expect("a ratio"));
    assert!((r1 + r2 - 1.0).abs() < 1e-15);
    let words = desk.good(&["simulate", "study.json", "--trajectory", "motion.csv", "--interval", "0.5"]);
    assert!(words.contains("\nE1max       ") && words.contains("\nmodel       with contacts\n"), "{words}");
    assert!(desk.read("motion.csv").starts_with("t,x1,v1,x2,v2,E1,E2,FconL,FconR,moment\n"));
}

#[test]
fn contract_settings_and_options_reach_the_run() {
    let desk = Desk::with(&tiny());
    let json = |arguments: &[&str]| -> Value {
        let all = [&["simulate", "study.json", "--json"], arguments].concat();
        serde_json::from_str(&desk.good(&all)).expect("JSON")
    };
    for (name, pointer) in [
        ("m1", "/parameters/primary/m1"),
        ("c1", "/parameters/primary/c1"),
        ("k1", "/parameters/primary/k1"),
        ("P", "/parameters/forcing/P"),
        ("omega", "/parameters/forcing/omega"),
        ("m2", "/parameters/damper/m2"),
        ("k2", "/parameters/damper/k2"),
        ("c2", "/parameters/damper/c2"),
        ("D", "/parameters/damper/D"),
        ("C", "/parameters/damper/C"),
        ("R", "/parameters/damper/contact/R"),
        ("T", "/window/T"),
        ("t0", "/window/t0"),
    ] {
        let value = if name == "t0" { 2.5 } else { 7.25 };
        let setting = format!("{name}={value}");
        assert_eq!(json(&["--set", &setting]).pointer(pointer), Some(&json!(value)), "{name}");
    }
    let answer = json(&["--from", "-0.1,0.5,0.02,-2", "--set", "t0=0"]);
    let start = json!({ "x1": -0.1, "v1": 0.5, "x2": 0.02, "v2": -2.0 });
    assert_eq!(answer.pointer("/parameters/forcing/start"), Some(&start));
    assert!(answer["E1max"].as_f64().expect("J") >= 0.5 * (1000.0 * 0.25 + 39500.0 * 0.01));
    let answer = json(&["--solver", "ode23s", "--contacts", "stepped", "--rtol", "1e-5"]);
    assert_eq!(answer["solver"]["method"], "ode23s");
    assert_eq!(answer["solver"]["contacts"], "stepped");
    assert_eq!(answer["solver"]["rtol"], 1e-5);
}

/// The pipe has no reader from the start, so the first byte written meets a broken pipe.
#[test]
fn contract_a_closed_pipe_is_no_error() {
    let desk = Desk::with(&tiny());
    for arguments in [["completions", "bash"].as_slice(), &["optimize", "study.json"]] {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let Output { status, stderr, .. } = desk
            .command(arguments)
            .stdout(writer)
            .stderr(Stdio::piped())
            .spawn()
            .and_then(Child::wait_with_output)
            .expect("the program");
        assert_eq!((status.code(), String::from_utf8_lossy(&stderr).as_ref()), (Some(0), ""));
    }
    assert_eq!(desk.names("results/study"), RESULTS, "the work is finished all the same");
}

#[test]
fn contract_every_command_explains_itself() {
    let desk = Desk::new();
    let help = desk.good(&["--help"]);
    for command in [
        "optimize",
        "merge",
        "verify",
        "certify",
        "simulate",
        "evaluate",
        "table2",
        "retention",
        "fronts",
        "reproduce",
        "figure",
        "table",
        "check",
        "schema",
        "completions",
    ] {
        assert!(help.contains(command));
        assert!(desk.good(&[command, "--help"]).contains("Usage: retune"));
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(desk.good(&["completions", shell]).contains("optimize"), "{shell}");
    }
    assert_eq!(desk.run(&["optimise"]).code, Some(2));
}
