//! `tune`: from a study to its results.

use crate::{found, read, request, search};
use retune_jobs::Request;
use retune_jobs::tune::tune;
use retune_model::Parameter;
use retune_study::Setting;
use retune_testkit::desk::{Desk, RESULTS, flat, global, number, tiny};
use retune_testkit::observers::{Record, good};
use retune_testkit::verified;
use serde_json::json;

#[test]
fn contract_optimize_writes_every_result_with_its_columns() {
    let desk = Desk::with(&tiny());
    let optimum = search(&desk, "study.json", "out");
    assert_eq!(desk.names("out"), RESULTS);
    assert!(optimum.search().contains("TolX 1e-4 is absolute"), "{}", optimum.search());
    // The answer: the damper, beside none and that of the study, in lines that fit a terminal.
    let (report, json) = (optimum.report(), desk.read_json("out/optimum.json"));
    assert!(report.lines().all(|line| line.chars().count() <= 80), "{report}");
    let said = flat(&report);
    for (name, words) in [
        ("E1max", "E1max {} J at omega"),
        ("E1max_none", "instead {} J ("),
        ("E1max_study", "damper, {} J ("),
    ] {
        let value = retune_study::rounded(number(&json, &format!("/{name}")), 4);
        assert!(said.contains(&words.replace("{}", &value)), "{name}: {said}");
    }
    let k2 = retune_study::rounded(number(&json, "/k2"), 4);
    assert!(said.contains(&format!("k2 = {k2} N/m, c2 = ")), "{said}");

    let surf = desk.rows("out/surf.csv");
    assert_eq!(surf[0], ["k2", "c2", "D", "C", "E1max"]);
    assert_eq!(surf.len(), 1 + 3 * 2 * 2 * 2);
    assert_eq!(surf[1][..4], ["100", "100", "0.05", "0.1"]);

    let log = desk.rows("out/fminsearch.csv");
    assert_eq!(log[0].join(","), "iteration,func_count,procedure,k2,c2,D,C,E1max");
    assert_eq!(log[1][..3], ["0", "1", ""]);
    assert_eq!(log[2][..3], ["1", "5", "initial simplex"]);
    let all = desk.read("out/fminsearch-starts.csv");
    assert!(all.starts_with("start,iteration,func_count,procedure,k2,c2,D,C,E1max\n1,0,1,,"));

    let optimum = desk.read_json("out/optimum.json");
    let last = log.last().expect("a row");
    // A descent went on from the last row.
    let winner = optimum["refine"]["winner"].as_u64().expect("a number") as usize - 1;
    let before = optimum["refine"]["runs"][winner]["descent"]["E1max_before"].as_f64();
    assert_eq!(last[7].parse::<f64>().ok(), before, "{optimum}");
    assert!(optimum["E1max"].as_f64() < before);
    // That of each start, one from the best TMD, and, as so few evaluations do not converge, three from lower places beside the best end.
    assert_eq!(optimum["refine"]["runs"].as_array().map(Vec::len), Some(6));
    assert_eq!(optimum["failures"]["count"], 0);
}

#[test]
fn paper_the_log_has_the_look_of_table_1() {
    let desk = Desk::new();
    desk.write_json("small.json", &tiny());
    search(&desk, "small.json", "out");
    let text = desk.read("out/fminsearch.txt");
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
fn contract_results_are_the_same_bytes_with_one_thread_and_two_and_each_stage_tells_its_progress() {
    let desk = Desk::with(&tiny());
    let logs = [1, 2].map(|threads| {
        let record = Record::default();
        let request = request(&desk, "study.json", &threads.to_string());
        good(tune(&Request { threads: Some(threads), ..request }, &record));
        // Three times a lower place is found beside the best end.
        let again = "fminsearch 1\n".repeat(3);
        let stages = format!("surf 24\nfminsearch 2\ndescents 3\n{again}certificates 1\n");
        assert_eq!(record.stages(), stages);
        let said = record.all();
        said.lines().filter(|line| line.contains("E+0")).map(str::to_owned).collect::<Vec<_>>()
    });
    assert_eq!(desk.names("1"), RESULTS);
    desk.assert_same("1", "2");
    assert!(logs[0].len() > 20 && logs[0] == logs[1], "{logs:?}");
}

#[test]
fn contract_the_resolved_study_repeats_its_results() {
    let mut study = tiny();
    study["name"] = json!("small");
    let desk = Desk::with(&study);
    search(&desk, "study.json", "out");
    let before = RESULTS.map(|name| desk.read(&format!("out/{name}")));
    std::fs::rename(desk.path("out/study.json"), desk.path("again.json")).expect("a file");
    search(&desk, "again.json", "out");
    assert_eq!(RESULTS.map(|name| desk.read(&format!("out/{name}"))), before);
    let resolved = desk.read_json("out/study.json");
    assert_eq!(resolved["solver"]["method"], "hybrid");
    assert_eq!(resolved["optimize"]["bounds"]["C"], json!([0.0, null]));
    assert_eq!(resolved["optimize"]["refine"]["MaxIter"], 800);
    assert_eq!(resolved["optimize"]["refine"]["MaxFunEvals"], 30);
}

#[test]
fn contract_a_later_run_leaves_nothing_of_an_earlier_one() {
    let desk = Desk::with(&tiny());
    search(&desk, "study.json", "out");
    desk.write("out/notes.txt", "mine");
    desk.write("out/unfinished/.fminsearch-starts.csv.4711.tmp", "what a killed run left");
    desk.write("out/.lock", "4711 what it left as well\n");
    desk.write("out/.notes.txt.tmp", "mine too");
    let mut study = tiny();
    study["optimize"] = json!({ "vary": ["c2"], "refine": { "scaled": true, "TolX": 0.01 } });
    desk.write_json("study.json", &study);
    search(&desk, "study.json", "out");
    assert_eq!(desk.read_json("out/optimum.json")["refine"]["TolX_mode"], "scaled");
    let expected = [
        ".notes.txt.tmp",
        "certificate.json",
        "convergence.svg",
        "fminsearch.csv",
        "fminsearch.txt",
        "manifest.json",
        "notes.txt",
        "optimum.json",
        "report.html",
        "study.json",
    ];
    assert_eq!(desk.names("out"), expected);
    let log = desk.rows("out/fminsearch.csv");
    assert!(log[1..].iter().all(|row| row[3] == "215" && row[5] == "0.06" && row[6] == "0.36"));
}

#[test]
fn contract_a_global_search_is_the_same_at_any_number_of_threads_and_lists_its_basins() {
    let desk = Desk::with(&global(json!({}), json!({})));
    let record = Record::default();
    for (threads, out) in [(1, "1"), (2, "2")] {
        let request = request(&desk, "study.json", out);
        found(good(tune(&Request { threads: Some(threads), ..request }, &record)));
    }
    desk.assert_same("1", "2");
    let said = record.all();
    assert!(said.contains("global: 24 designs over the box of k2 c2 D C, then 2 CMA-ES searches"), "{said}");
    assert!(said.contains("that of the optimum was reached by "), "{said}");
    let optimum = desk.read_json("1/optimum.json");
    let rows = desk.rows("1/basins.csv");
    assert_eq!(rows[0].join(","), "basin,searches,refinements,k2,c2,D,C,E1max");
    assert_eq!(rows[1][7].parse::<f64>().expect("a number"), number(&optimum, "/E1max"));
    let searches: u64 = rows[1..].iter().map(|row| row[1].parse::<u64>().expect("a count")).sum();
    assert_eq!(searches, 2);
    // The resolved study repeats it.
    search(&desk, "1/study.json", "3");
    assert_eq!(desk.read("1/optimum.json"), desk.read("3/optimum.json"));
}

#[test]
fn contract_a_robust_objective_is_tuned_and_its_worst_place_reported() {
    let objective = json!({
        "omega": { "from": 7.2, "to": 7.8, "samples": 2 },
        "k1": { "set": [3.9e4, 4.2e4] },
        "response": "settled",
        "settle": { "periods": 1, "blocks": 2, "tolerance": 0.5 },
        "ensemble": { "members": 2 }
    });
    let mut study = global(objective, json!({}));
    study["optimize"]["refine"]["starts"] = json!(1);
    study["optimize"]["global"] = json!({ "samples": 8, "searches": 1, "evaluations": 10 });
    let desk = Desk::with(&study);
    let report = flat(&search(&desk, "study.json", "out").report());
    let words = "mean of 2 members (all phases, errors to 0.1 %), worst over omega = 7.2 to 7.8 rad/s and k1";
    assert!(report.contains(words), "{report}");
    let optimum = desk.read_json("out/optimum.json");
    let k1 = number(&optimum, "/objective/worst_k1");
    assert!((k1 / 3.9e4 - 1.0).abs() < 1e-3 || (k1 / 4.2e4 - 1.0).abs() < 1e-3, "{k1}");
    assert!(number(&optimum, "/objective/runs") >= 8.0);
    let certificate = desk.read_json("out/certificate.json");
    assert_eq!(certificate["motions"]["members_not_looked_at"], true, "{certificate}");
}

/// The grid at its own tolerance, the search at its own; what it finds, at that of the results.
#[test]
fn contract_a_grid_and_a_search_have_tolerances_of_their_own() {
    let mut study = tiny();
    study["solver"] = json!({ "rtol": 1e-9, "search_rtol": 1e-3 });
    study["optimize"]["coarse"] = json!({ "rtol": 1e-2 });
    let desk = Desk::with(&study);
    search(&desk, "study.json", "out");
    let optimum = desk.read_json("out/optimum.json");
    assert_eq!(number(&optimum, "/simulation/solver/search_rtol"), 1e-3);
    let value = |row: &[String], rtol: f64| {
        let settings = Parameter::PAPER.into_iter().zip(row);
        let settings: Vec<Setting> =
            settings.map(|(name, value)| Setting::new(name, value.parse().expect("a number"))).collect();
        let mut study = read(&desk, "study.json").with(&settings).expect("a study");
        (study.solver.rtol, study.solver.search_rtol) = (rtol, None);
        study.energy(&study.scene).expect("a value")
    };
    let said = |field: &String| field.parse::<f64>().expect("a number");
    let surf = desk.rows("out/surf.csv");
    let values = |rtol: f64| surf[1..].iter().all(|row| value(&row[..4], rtol) == said(&row[4]));
    assert!(values(1e-2) && !values(1e-3));
    let best = ["k2", "c2", "D", "C"].map(|name| number(&optimum, &format!("/surf/best/{name}")).to_string());
    assert_eq!(value(&best, 1e-3), number(&optimum, "/surf/E1max"));
    let log = desk.rows("out/fminsearch.csv");
    let last = &log.last().expect("a row")[3..];
    assert_eq!(value(&last[..4], 1e-3), said(&last[4]));
    let found = ["k2", "c2", "D", "C"].map(|name| number(&optimum, &format!("/{name}")).to_string());
    assert_eq!(value(&found, 1e-9), number(&optimum, "/E1max"));
    verified::holds(&desk, "out", 7);
}

/// The grid on its samples alone and at its own tolerance; refinements start where they would without that, and say what is there.
#[test]
fn contract_a_coarse_grid_leads_to_the_starts_of_an_exact_one() {
    let mut study = tiny();
    // Walls out of reach: linear motions, whose certificates are quick.
    (study["scene"]["damper"]["D"], study["scene"]["damper"]["C"]) = (json!(2.08), json!(4.7));
    study["optimize"] = json!({
        "vary": ["k2", "c2"],
        "objective": { "omega": { "from": 5, "to": 8, "samples": 7 } },
        "surf": { "k2": { "from": 100, "to": 4000, "points": 6, "scale": "log" }, "c2": { "from": 20, "to": 600, "points": 5 } },
        "refine": { "starts": 2, "apart": 1, "MaxFunEvals": 30 }
    });
    let desk = Desk::with(&study);
    search(&desk, "study.json", "exact");
    study["optimize"]["coarse"] = json!({ "rtol": 1e-4, "peaks": false, "most": 300 });
    desk.write_json("study.json", &study);
    search(&desk, "study.json", "out");
    let values = |place: &str| -> Vec<f64> {
        desk.rows(&format!("{place}/surf.csv"))[1..]
            .iter()
            .map(|row| row[4].parse().expect("a number"))
            .collect()
    };
    let (exact, coarse) = (values("exact"), values("out"));
    assert!(exact.iter().zip(&coarse).all(|(exact, coarse)| *coarse <= exact * (1.0 + 1e-4)));
    assert!(
        exact.iter().zip(&coarse).any(|(exact, coarse)| *coarse < 0.99 * exact.min(300.0)),
        "no peak was left out"
    );
    assert_eq!(coarse.iter().copied().fold(0.0, f64::max), 300.0, "no value was left out");
    assert_eq!(desk.read("exact/fminsearch-starts.csv"), desk.read("out/fminsearch-starts.csv"));
    let best = |place: &str| desk.read_json(&format!("{place}/optimum.json"))["surf"].clone();
    assert_eq!(best("exact"), best("out"));
    assert!(desk.read("out/surf-k2-c2.svg").contains("at rtol 1e-4, on the samples of the band alone"));
    assert!(desk.read("out/surf-k2-c2.svg").contains("Grey: none below 300 J."));
    verified::holds(&desk, "out", 7);
}

/// Once a search ended far above the damper of its study, within all bounds, because its grid was elsewhere.
#[test]
fn contract_no_answer_is_above_the_damper_of_the_study() {
    let desk = Desk::with(&tiny());
    search(&desk, "study.json", "best");
    let best = desk.read_json("best/optimum.json");
    let mut study = tiny();
    for name in ["k2", "c2", "D", "C"] {
        study["scene"]["damper"][name] = best[name].clone();
        study["optimize"]["surf"][name] = json!({ "from": 0.5, "to": 0.6, "points": 2 });
    }
    study["optimize"]["surf"]["k2"] = json!({ "from": 900, "to": 990, "points": 2 });
    study["optimize"]["surf"]["c2"] = json!({ "from": 900, "to": 990, "points": 2 });
    study["optimize"]["refine"]["MaxFunEvals"] = json!(6);
    study["optimize"]["objective"]["quantity"] = json!("x1max");
    desk.write_json("far.json", &study);
    let record = Record::default();
    good(tune(&request(&desk, "far.json", "far"), &record));
    let far = desk.read_json("far/optimum.json");
    let [found, own] = ["x1max", "x1max_study"].map(|name| number(&far, &format!("/{name}")));
    assert!(found <= own, "{found} {own}");
    let words = "the damper of the study is better than the ends of all starts: the search goes on from it";
    assert!(record.all().contains(words), "{}", record.all());
}

/// Once "flat" was said of the gap D from 0 on, where the value at 0 was far lower: what is looked at about the answer counts.
#[test]
fn contract_a_lower_place_beside_the_answer_is_taken() {
    let mut study = tiny();
    study["scene"]["damper"]["contact"]["R"] = json!(0.05);
    study["scene"] = json!({
        "primary": { "m1": "40 t", "c1": "5 kN·s/m", "k1": "6.3 MN/m" },
        "forcing": { "P": 280, "omega": "2 Hz" },
        "damper": {
            "m2": 800, "k2": 80000, "c2": 3800, "D": 0.05, "C": 0.1,
            "contact": study["scene"]["damper"]["contact"]
        }
    });
    study["window"] = json!({ "t0": 10, "T": 20 });
    study["optimize"] = json!({
        "vary": ["D"],
        "bounds": { "D": [0, 0.05] },
        "objective": { "omega": { "from": 12, "to": 13, "samples": 2 } }
    });
    let desk = Desk::with(&study);
    let record = Record::default();
    good(tune(&request(&desk, "study.json", "out"), &record));
    assert!(
        record.all().contains("\nfminsearch, from a lower place beside the best end: "),
        "{}",
        record.all()
    );
    let answer = desk.read_json("out/optimum.json");
    let [found, gap, own] = ["E1max", "D", "E1max_study"].map(|name| number(&answer, &format!("/{name}")));
    assert!(found < 0.45 * own && gap < 0.001, "{found} {gap} {own}");
}
