//! The program from end to end, on studies of a few runs.

mod common;

use common::{Answer, Desk, studies, tiny};
use serde_json::{Value, json};
use std::process::{Child, Output, Stdio};

const RESULTS: [&str; 15] = [
    "certificate.json",
    "convergence.svg",
    "fminsearch-starts.csv",
    "fminsearch.csv",
    "fminsearch.txt",
    "manifest.json",
    "optimum.json",
    "study.json",
    "surf-D-C.svg",
    "surf-c2-C.svg",
    "surf-c2-D.svg",
    "surf-k2-C.svg",
    "surf-k2-D.svg",
    "surf-k2-c2.svg",
    "surf.csv",
];

fn columns(text: &str) -> Vec<Vec<&str>> {
    text.lines().map(|line| line.split(',').collect()).collect()
}

#[test]
fn contract_optimize_writes_every_result_with_its_columns() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    let screen = desk.good(&["optimize", "small.json"]);
    assert_eq!(desk.names("results/small"), RESULTS);
    assert!(screen.contains("Damper type             m2, kg    k2, N/m     c2, N·s/m     D, m        C, m"));
    assert!(screen.contains("TolX 1e-4 is absolute"));
    assert!(screen.trim_end().ends_with("surf.csv"));

    let surf = desk.read("results/small/surf.csv");
    let surf = columns(&surf);
    assert_eq!(surf[0], ["k2", "c2", "D", "C", "E1max"]);
    assert_eq!(surf.len(), 1 + 3 * 2 * 2 * 2);
    assert_eq!(surf[1][..4], ["100", "100", "0.05", "0.1"]);

    let log = desk.read("results/small/fminsearch.csv");
    let log = columns(&log);
    assert_eq!(log[0].join(","), "iteration,func_count,procedure,k2,c2,D,C,E1max");
    assert_eq!(log[1][..3], ["0", "1", ""]);
    assert_eq!(log[2][..3], ["1", "5", "initial simplex"]);
    let all = desk.read("results/small/fminsearch-starts.csv");
    assert!(all.starts_with("start,iteration,func_count,procedure,k2,c2,D,C,E1max\n1,0,1,,"));

    let optimum = desk.read_json("results/small/optimum.json");
    let last = log[log.len() - 1].iter().map(|field| (*field).to_owned()).collect::<Vec<_>>();
    for (field, name) in last[3..].iter().zip(["k2", "c2", "D", "C", "E1max"]) {
        assert_eq!(field.parse::<f64>().ok(), optimum[name].as_f64(), "{name}");
    }
    assert_eq!(optimum["refine"]["runs"].as_array().map(Vec::len), Some(2));
    assert_eq!(optimum["failures"]["count"], 0);
}

#[test]
fn paper_the_log_has_the_look_of_table_1() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    desk.good(&["optimize", "small.json", "--quiet"]);
    let text = desk.read("results/small/fminsearch.txt");
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows[0], "k2 opt N/m      c2 opt N·s/m    D opt m         C opt m         E1max J");
    let of_table_1 = |number: &str| {
        let shape: String = number.chars().map(|c| if c.is_ascii_digit() { '0' } else { c }).collect();
        shape == "0.000000E+000" || shape == "0.000000E-000"
    };
    for row in rows[1..].iter().take_while(|row| !row.is_empty()) {
        let numbers: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(numbers.len(), 5, "{row}");
        assert!(numbers.into_iter().all(of_table_1), "{row}");
    }
    assert!(text.trim_end().contains("study small, omega = 6.28 rad/s, t0 = 1 s, T = 4 s; Retune "));
}

#[test]
fn contract_results_are_the_same_bytes_with_one_thread_and_two() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    let one = desk.good(&["optimize", "small.json", "--threads", "1", "--out", "one"]);
    let two = desk.good(&["optimize", "small.json", "--threads", "2", "--out", "two"]);
    for name in RESULTS {
        assert_eq!(desk.read(&format!("one/{name}")), desk.read(&format!("two/{name}")), "{name}");
    }
    let log =
        |text: &str| text.lines().filter(|line| line.contains("E+0")).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(log(&one), log(&two));
}

#[test]
fn contract_the_resolved_study_repeats_its_results() {
    let desk = Desk::new();
    let mut study = tiny();
    study["name"] = json!("small");
    desk.write_json("first.json", &study);
    desk.good(&["optimize", "first.json", "--quiet"]);
    let before = RESULTS.map(|name| desk.read(&format!("results/small/{name}")));
    std::fs::rename(desk.path("results/small/study.json"), desk.path("again.json")).expect("a file");
    desk.good(&["optimize", "again.json", "--quiet"]);
    assert_eq!(RESULTS.map(|name| desk.read(&format!("results/small/{name}"))), before);
    let resolved = desk.read_json("results/small/study.json");
    assert_eq!(resolved["solver"]["method"], "hybrid");
    assert_eq!(resolved["optimize"]["bounds"]["C"], json!([0.0, null]));
    assert_eq!(resolved["optimize"]["refine"]["MaxIter"], 800);
    assert_eq!(resolved["optimize"]["refine"]["MaxFunEvals"], 30);
}

#[test]
fn contract_a_later_run_leaves_nothing_of_an_earlier_one() {
    let desk = Desk::new();
    desk.write_json("study.json", &tiny());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "out"]);
    desk.write("out/notes.txt", "mine");
    desk.write("out/unfinished/.fminsearch-starts.csv.4711.tmp", "what a killed run left");
    desk.write("out/.lock", "4711 what it left as well\n");
    desk.write("out/.notes.txt.tmp", "mine too");
    let mut study = tiny();
    study["optimize"] = json!({ "vary": ["c2"], "refine": { "scaled": true, "TolX": 0.01 } });
    desk.write_json("study.json", &study);
    let screen = desk.good(&["optimize", "study.json", "--quiet", "--out", "out"]);
    assert!(screen.contains("TolX 1e-2 is scaled"), "{screen}");
    let expected = [
        ".notes.txt.tmp",
        "certificate.json",
        "convergence.svg",
        "fminsearch.csv",
        "fminsearch.txt",
        "manifest.json",
        "notes.txt",
        "optimum.json",
        "study.json",
    ];
    assert_eq!(desk.names("out"), expected);
    let log = desk.read("out/fminsearch.csv");
    assert!(columns(&log)[1..].iter().all(|row| row[3] == "215" && row[5] == "0.06" && row[6] == "0.36"));
}

#[test]
fn contract_simulate_prints_one_object_with_the_promised_keys() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    let answer: Value =
        serde_json::from_str(&desk.good(&["simulate", "small.json", "--json"])).expect("JSON");
    for key in [
        "/E1max",
        "/t_E1max",
        "/E2max",
        "/R1",
        "/R2",
        "/impacts/primary",
        "/impacts/obstacle",
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
}

#[test]
fn contract_settings_and_options_reach_the_run() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    let json = |arguments: &[&str]| -> Value {
        let all = [&["simulate", "small.json", "--json"], arguments].concat();
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
    let answer = json(&["--solver", "ode23s", "--contacts", "stepped", "--rtol", "1e-5"]);
    assert_eq!(answer["solver"]["method"], "ode23s");
    assert_eq!(answer["solver"]["contacts"], "stepped");
    assert_eq!(answer["solver"]["rtol"], 1e-5);
}

#[test]
fn contract_the_trajectory_has_a_row_for_each_interval() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    desk.good(&["simulate", "small.json", "--trajectory", "motion.csv", "--interval", "0.5"]);
    let csv = desk.read("motion.csv");
    let csv = columns(&csv);
    assert_eq!(csv[0].join(","), "t,x1,v1,x2,v2,E1,E2,FconL,FconR,moment");
    let grid = csv[1..].iter().filter(|row| row[9] == "grid");
    let times: Vec<&str> = grid.map(|row| row[0]).collect();
    assert_eq!(times, ["1", "1.5", "2", "2.5", "3", "3.5", "4"]);
    let Answer { code, stderr, .. } =
        desk.run(&["simulate", "small.json", "--trajectory", "other.csv", "--interval", "1e-9"]);
    assert_eq!(code, Some(2));
    assert!(stderr.contains("--interval: 0.000000001 s is not allowed here"), "{stderr}");
    assert_eq!(desk.names("."), ["motion.csv", "small.json"]);
}

/// Table 2's studies with short runs.
fn short_table2(desk: &Desk) {
    for name in ["ssvi.json", "tmd.json"] {
        let text = std::fs::read_to_string(studies().join(name)).expect("a study");
        let mut study: Value = serde_json::from_str(&text).expect("JSON");
        study["window"] = json!({ "t0": 1, "T": 4 });
        for axis in study["optimize"]["surf"].as_object_mut().expect("axes").values_mut() {
            axis["points"] = json!(2);
        }
        study["optimize"]["refine"] = json!({ "MaxFunEvals": 20 });
        desk.write_json(name, &study);
    }
    desk.write("table2.json", std::fs::read_to_string(studies().join("table2.json")).expect("a table"));
}

#[test]
fn paper_table2_puts_our_rows_beside_the_papers() {
    let desk = Desk::new();
    short_table2(&desk);
    desk.good(&["table2", "table2.json", "--quiet"]);
    let csv = desk.read("results/table2/table2.csv");
    let csv = columns(&csv);
    assert_eq!(csv[0].join(","), "origin,damper,m2,k2,c2,D,C,E1max");
    assert_eq!(csv[1][..7], ["paper", "SSVI NES", "60", "215", "232", "0.06", "0.36"]);
    assert_eq!(csv[2][..2], ["re-optimised", "SSVI NES"]);
    assert_eq!(csv[3][..7], ["paper", "TMD", "60", "600", "262", "2.08", "4.7"]);
    let energy = |row: usize| csv[row][7].parse::<f64>().expect("a number");
    assert!(energy(2) <= energy(1) && energy(4) <= energy(3));
    assert_eq!(
        desk.names("results/table2"),
        ["manifest.json", "resolved.json", "ssvi", "table2.csv", "table2.txt", "tmd"]
    );
    assert!(!desk.names("results/table2/ssvi").contains(&"unfinished".to_owned()));
}

#[test]
fn contract_retune_tunes_both_dampers_for_each_stiffness() {
    let desk = Desk::new();
    short_table2(&desk);
    desk.good(&["track", "30000", "5e4", "--study", "table2.json", "--quiet"]);
    let csv = desk.read("results/table2/retune.csv");
    let rows: Vec<String> = columns(&csv)[1..].iter().map(|row| row[..3].join(",")).collect();
    let expected =
        ["30000", "39500", "50000"].map(|k1| [format!("{k1},SSVI NES,60"), format!("{k1},TMD,60")]);
    assert_eq!(rows, expected.concat());
    let resolved = desk.read_json("results/table2/k1-50000/tmd/study.json");
    assert_eq!(resolved["scene"]["primary"]["k1"], 5e4);
    let Answer { code, stderr, .. } = desk.run(&["track", "30000", "-1", "--study", "table2.json"]);
    let message = "error: command line: k1: -1 is not allowed here: give a finite number not below 0\n";
    assert_eq!((code, stderr.as_str()), (Some(2), message));
}

/// The pipe has no reader from the start, so the first byte written meets a broken pipe.
#[test]
fn contract_a_closed_pipe_is_no_error() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    for arguments in [["completions", "bash"].as_slice(), &["optimize", "small.json"]] {
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
    assert_eq!(desk.names("results/small"), RESULTS, "the work is finished all the same");
}

#[test]
fn contract_every_command_explains_itself() {
    let desk = Desk::new();
    for command in [
        "optimize",
        "certify",
        "simulate",
        "table2",
        "track",
        "reproduce",
        "figure",
        "table",
        "check",
        "schema",
        "completions",
    ] {
        assert!(desk.good(&["--help"]).contains(command));
        assert!(desk.good(&[command, "--help"]).contains("Usage: retune"));
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(desk.good(&["completions", shell]).contains("optimize"), "{shell}");
    }
    assert_eq!(desk.run(&["optimise"]).code, Some(2));
}
