//! Limits, other objectives, a global search, a certificate, retention: from the study to the results.

mod common;

use common::{Answer, Desk, studies, tiny};
use serde_json::{Value, json};

/// The tiny study with a global search instead of its grid.
fn with(objective: Value, limits: Value) -> Value {
    let mut study = tiny();
    study["optimize"] = json!({
        "vary": ["k2", "c2", "D", "C"],
        "bounds": { "k2": [10, 1000], "c2": [1, 500], "D": [0, 0.5], "C": [0, 0.5] },
        "objective": objective,
        "limits": limits,
        "global": { "samples": 24, "searches": 2, "evaluations": 40 },
        "refine": { "starts": 2, "MaxFunEvals": 30 }
    });
    study
}

fn number(json: &Value, path: &str) -> f64 {
    json.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path}: {json}"))
}

#[test]
fn contract_a_global_search_is_the_same_at_any_number_of_threads_and_lists_its_basins() {
    let desk = Desk::new();
    desk.write_json("global.json", &with(json!({}), json!({})));
    let said = desk.good(&["optimize", "global.json", "--out", "1", "--threads", "1"]);
    desk.good(&["optimize", "global.json", "--out", "2", "--threads", "2", "--quiet"]);
    for name in desk.names("1") {
        assert_eq!(desk.read(&format!("1/{name}")), desk.read(&format!("2/{name}")), "{name}");
    }
    assert!(said.contains("global: 24 designs over the box of k2 c2 D C, then 2 CMA-ES searches"), "{said}");
    assert!(said.contains("that of the optimum was reached by "), "{said}");
    let optimum = desk.read_json("1/optimum.json");
    let csv = desk.read("1/basins.csv");
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0].join(","), "basin,searches,refinements,k2,c2,D,C,E1max");
    assert_eq!(rows[1][7].parse::<f64>().expect("a number"), number(&optimum, "/E1max"));
    let searches: u64 = rows[1..].iter().map(|row| row[1].parse::<u64>().expect("a count")).sum();
    assert_eq!(searches, 2);
    // The resolved study repeats it.
    desk.good(&["optimize", "1/study.json", "--out", "3", "--quiet"]);
    assert_eq!(desk.read("1/optimum.json"), desk.read("3/optimum.json"));
}

/// A limit that the unconstrained optimum breaks is kept and reported as active; one that cannot be kept is reported as broken.
#[test]
fn contract_limits_are_kept_and_reported() {
    let desk = Desk::new();
    desk.write_json("free.json", &with(json!({}), json!({ "stroke": 1e3, "force": 1e9 })));
    desk.good(&["optimize", "free.json", "--quiet"]);
    let free = desk.read_json("results/free/optimum.json");
    assert_eq!((&free["limits"]["active"], number(&free, "/limits/infeasible")), (&json!([]), 0.0));
    let stroke = 0.7 * number(&free, "/limits/stroke");
    desk.write_json("kept.json", &with(json!({}), json!({ "stroke": stroke })));
    let said = desk.good(&["optimize", "kept.json", "--quiet"]);
    let kept = desk.read_json("results/kept/optimum.json");
    assert!(number(&kept, "/limits/stroke") <= stroke && kept["limits"]["feasible"] == true);
    assert!(number(&kept, "/limits/infeasible") > 0.0 && said.contains("limits kept: stroke "), "{said}");
    assert!(number(&kept, "/E1max") >= number(&free, "/E1max"));
    let certificate = desk.read_json("results/kept/certificate.json");
    assert_ne!(certificate["verdict"], "robust", "1 % more breaks an active limit: {certificate}");
    let near = &certificate["limits"]["broken_near"][0];
    assert_eq!((&near["limit"], &certificate["limits"]["broken"]), (&json!("stroke"), &json!([])));
    let [reached, over] = ["reached", "over_percent"].map(|name| near[name].as_f64().expect("a number"));
    assert!(reached > stroke && (over - 100.0 * (reached / stroke - 1.0)).abs() < 1e-9, "{near}");
    let words = certificate["words"].as_str().expect("words");
    assert!(
        words.contains("on the edge of a limit: stroke is ") && words.contains(" % over its limit of "),
        "{words}"
    );
    assert!(said.contains(words), "{said}");
    desk.write_json("none.json", &with(json!({}), json!({ "stroke": 1e-6 })));
    let Answer { code, stdout: said, stderr } = desk.run(&["optimize", "none.json", "--quiet"]);
    assert!(said.contains("NO DESIGN KEEPS THE LIMITS; the nearest: stroke "), "{said}");
    let words = "no verdict, for the design breaks the limit of stroke: ";
    assert!(said.contains(&format!("certificate: {words}")), "{said}");
    assert_eq!(code, Some(3));
    assert!(stderr.starts_with(&format!("error: study none: the limits are not kept: {words}")), "{stderr}");
    let again = desk.run(&["optimize", "none.json", "--quiet", "--resume"]);
    assert_eq!(
        (again.code, again.stderr),
        (Some(3), stderr.clone()),
        "nor has it one when it is finished already"
    );
    let certified = desk.run(&["certify", "results/none"]);
    assert_eq!((certified.code, certified.stderr), (Some(3), stderr));
    let certificate = desk.read_json("results/none/certificate.json");
    assert_eq!(certificate["verdict"], Value::Null);
    assert_eq!(certificate["limits"]["broken"][0]["limit"], "stroke");
    let none = desk.read_json("results/none/optimum.json");
    assert_eq!(none["certificate"]["verdict"], Value::Null);
    assert!(number(&none, "/limits/violation") > 0.0 && none["limits"]["active"] == json!(["stroke"]));
    assert!(number(&none, "/E1max") < 1e4, "an energy, not a rank");
}

#[test]
fn contract_check_says_every_part_of_an_objective() {
    let desk = Desk::new();
    let robust = json!({
        "omega": { "from": 0.9, "to": 1.1, "samples": 3, "relative": true },
        "k1": { "set": [3e4, 4e4] },
        "ensemble": { "members": 4, "statistic": { "quantile": 0.9 } }
    });
    let sum = json!({ "sum": [{ "weight": 2, "objective": robust }, { "weight": 1, "objective": {} }] });
    desk.write_json("robust.json", &with(robust, json!({ "cavity": 0.4 })));
    let said = desk.good(&["check", "robust.json"]);
    for line in [
        "for the 0.9 quantile of 4 members (all phases, errors to 0.1 %), worst E1max over omega = 0.9 to 1.1 times √(k1/m1) \
         and k1 = 30000, 40000 N/m, in the window, on 3 samples",
        "under limits: cavity at most 0.4 m",
        "a global search (24 designs, 2 CMA-ES searches)",
    ] {
        assert!(said.contains(line), "{line}: {said}");
    }
    desk.write_json("sum.json", &with(sum, json!({})));
    let said = desk.good(&["check", "sum.json"]);
    assert!(said.contains("weighted sum of 2 objectives"), "{said}");
    assert!(said.contains("1 times E1max, omega = 6.28 rad/s"), "{said}");
}

#[test]
fn contract_a_robust_objective_is_tuned_and_its_worst_place_reported() {
    let desk = Desk::new();
    let objective = json!({
        "omega": { "from": 6.0, "to": 6.6, "samples": 2 },
        "k1": { "set": [3.9e4, 4.2e4] },
        "response": "settled",
        "settle": { "periods": 1, "blocks": 2, "tolerance": 0.5 },
        "ensemble": { "members": 2 }
    });
    let mut study = with(objective, json!({}));
    study["optimize"]["refine"]["starts"] = json!(1);
    study["optimize"]["global"] = json!({ "samples": 8, "searches": 1, "evaluations": 10 });
    desk.write_json("robust.json", &study);
    let said = desk.good(&["optimize", "robust.json", "--quiet"]);
    assert!(
        said.contains(
            "mean of 2 members (all phases, errors to 0.1 %), worst over omega = 6 to 6.6 rad/s and k1"
        ),
        "{said}"
    );
    let optimum = desk.read_json("results/robust/optimum.json");
    let k1 = number(&optimum, "/objective/worst_k1");
    assert!((k1 / 3.9e4 - 1.0).abs() < 1e-3 || (k1 / 4.2e4 - 1.0).abs() < 1e-3, "{k1}");
    assert!(number(&optimum, "/objective/runs") >= 8.0);
}

#[test]
fn contract_invalid_objectives_are_refused() {
    let desk = Desk::new();
    for (objective, message) in [
        (
            json!({ "k1": { "set": [] } }),
            "optimize.objective.k1.set: an empty list is not allowed here: give at least one",
        ),
        (
            json!({ "k1": { "range": { "from": 4e4, "to": 4e4, "samples": 3 } } }),
            "optimize.objective.k1.range: from = 40000 N/m is not below to = 40000 N/m: the band is empty",
        ),
        (json!({ "settle": { "blocks": 1 } }), "optimize.objective.settle.blocks: 1 is not allowed here"),
        (
            json!({ "ensemble": { "members": 0 } }),
            "optimize.objective.ensemble.members: 0 is not allowed here",
        ),
        (
            json!({ "ensemble": { "members": 2, "statistic": { "quantile": 1.5 } } }),
            "optimize.objective.ensemble.statistic.quantile: 1.5 is not allowed here: give a number above 0 and at most 1",
        ),
        (
            json!({ "response": "steady", "sum": [{ "weight": 1, "objective": {} }] }),
            "optimize.objective.sum: stands in the place of omega, k1, response, settle and ensemble",
        ),
        (
            json!({ "sum": [{ "weight": 1, "objective": { "omega": { "from": 8, "to": 5 } } }] }),
            "optimize.objective.sum[0].objective.omega: from = 8 rad/s is not below to = 5 rad/s",
        ),
    ] {
        desk.write_json("bad.json", &with(objective, json!({})));
        let Answer { code, stderr, .. } = desk.run(&["check", "bad.json"]);
        assert!(code == Some(2) && stderr.contains(message), "{message}: {stderr}");
    }
    let mut open = with(json!({}), json!({}));
    open["optimize"]["bounds"] = json!({});
    desk.write_json("bad.json", &open);
    let Answer { stderr, .. } = desk.run(&["check", "bad.json"]);
    assert!(
        stderr.contains("optimize.global.box.k2: missing, and optimize.bounds.k2 has no largest value"),
        "{stderr}"
    );
}

/// Table 2's SSVI NES: predictable by every method, and yet a single chaotic realisation; the TMD is robust.
#[test]
fn paper_table_2_is_certified() {
    let desk = Desk::new();
    for (name, verdict, regime) in
        [("ssvi", "single chaotic realisation", "chaotic"), ("tmd", "robust", "T, 0, 0")]
    {
        let study = studies().join(format!("{name}.json"));
        let said = desk.good(&["certify", study.to_str().expect("UTF-8")]);
        let certificate = desk.read_json(&format!("results/certify/{name}/certificate.json"));
        assert_eq!(certificate["verdict"], verdict, "{said}");
        assert_eq!(certificate["motion"]["regime"], regime);
        assert_eq!(certificate["predictable"], true);
        assert!(number(&certificate, "/error_bar") < 1e-5);
        // Methods that share nothing but the equations agree.
        let runs = certificate["convergence"].as_array().expect("runs");
        assert_eq!(runs.len(), 5);
        let value = number(&certificate, "/E1max");
        assert!(runs.iter().all(|run| (number(run, "/E1max") - value).abs() < 1e-5));
        assert!(said.contains("verdict ") && said.contains("rule ") && said.contains("c2 "), "{said}");
    }
    let tmd = desk.read_json("results/certify/tmd/certificate.json");
    // Without contacts C has no effect, and the slope in k2 is that of two runs.
    let row = |name: &str| {
        let rows = tmd["sensitivity"].as_array().expect("rows");
        rows.iter().find(|row| row["parameter"] == name).cloned().expect("a row")
    };
    assert_eq!(number(&row("C"), "/slope_per_percent"), 0.0);
    let at = |k2: f64| {
        let study = studies().join("tmd.json");
        let set = format!("k2={k2}");
        let said = desk.good(&["simulate", study.to_str().expect("UTF-8"), "--set", &set, "--json"]);
        number(&serde_json::from_str(&said).expect("JSON"), "/E1max")
    };
    let slope = (at(600.0 * 1.0025) - at(600.0 * 0.9975)) / 0.5;
    assert!((number(&row("k2"), "/slope_per_percent") - slope).abs() < 1e-6, "{slope}");
}

#[test]
fn contract_results_of_a_search_are_certified_in_place() {
    let desk = Desk::new();
    let mut study = with(json!({}), json!({}));
    study["optimize"]["global"] = Value::Null;
    desk.write_json("small.json", &study);
    desk.good(&["optimize", "small.json", "--quiet"]);
    let first = desk.read("results/small/certificate.json");
    for path in ["results/small", "results/small/optimum.json"] {
        std::fs::remove_file(desk.path("results/small/certificate.json")).expect("a certificate");
        desk.good(&["certify", path, "--quiet"]);
        assert_eq!(desk.read("results/small/certificate.json"), first, "{path}");
    }
    desk.good(&["certify", "results/small", "--out", "results/small", "--quiet"]);
    desk.good(&["verify", "results/small"]);
    let Answer { code, stderr, .. } = desk.run(&["certify", "small.json", "--out", "results/small"]);
    assert!(code == Some(2) && stderr.contains("the results of a search stand there"), "{code:?} {stderr}");
    let optimum = desk.read_json("results/small/optimum.json");
    let certificate = desk.read_json("results/small/certificate.json");
    assert_eq!(optimum["certificate"]["verdict"], certificate["verdict"]);
    assert_eq!(optimum["E1max"], certificate["E1max"]);
    let mut bare = study.clone();
    bare["scene"]["damper"] = Value::Null;
    bare["optimize"] = Value::Null;
    desk.write_json("bare.json", &bare);
    let Answer { code, stderr, .. } = desk.run(&["certify", "bare.json"]);
    assert!(
        code == Some(2) && stderr.contains("scene.damper: none is not allowed here: give a damper"),
        "{stderr}"
    );
    let Answer { code, stderr, .. } = desk.run(&["certify", "nothing.json"]);
    assert!(code == Some(2) && stderr.contains("nothing.json: cannot be read"), "{stderr}");
}

/// The curves of `retune`: at the nominal k1 the original tuning is the re-tuned one.
#[test]
fn contract_retention_begins_at_the_tuned_design() {
    let desk = Desk::new();
    let mut study =
        with(json!({ "omega": { "from": 0.9, "to": 1.1, "samples": 2, "relative": true } }), json!({}));
    study["optimize"]["global"] = json!({ "samples": 8, "searches": 1, "evaluations": 20 });
    desk.write_json("one.json", &study);
    let row = json!({ "damper": "SSVI NES", "study": "one.json", "paper": { "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 } });
    desk.write_json("retune.json", &json!({ "rows": [row] }));
    let said = desk.good(&["track", "3e4", "5e4", "--study", "retune.json", "--out", "out"]);
    assert!(
        said.contains(
            "worst over omega = 0.9 to 1.1 times √(k1/m1), and from the design of the k1 beside it"
        ),
        "{said}"
    );
    let csv = desk.read("out/retention.csv");
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0].join(","), "k1,none,SSVI NES tuned for 39500,SSVI NES re-tuned");
    let home = rows.iter().find(|row| row[0] == "39500").expect("its own k1");
    assert_eq!(home[2], home[3]);
    let tuned = rows[1..].iter().filter(|row| !row[3].is_empty()).map(|row| row[0]);
    assert_eq!(tuned.collect::<Vec<_>>(), ["30000", "39500", "50000"]);
    let at = |k1: &str| rows.iter().find(|row| row[0] == k1).expect("a row").clone();
    for k1 in ["30000", "50000"] {
        let [kept, anew] = [2, 3].map(|column| at(k1)[column].parse::<f64>().expect("a number"));
        assert!(anew <= kept, "{k1}: {anew} {kept}");
    }
    // The neighbour's design is one of the starts.
    let resolved = desk.read_json("out/k1-50000/one/study.json");
    let home = desk.read_json("out/k1-39500/one/optimum.json");
    assert_eq!(resolved["optimize"]["starts"][0]["k2"], home["k2"]);
    assert!(
        desk.read("out/retention.svg").contains("SSVI NES re-tuned")
            && desk.read("out/path.svg").contains("</svg>")
    );
}
