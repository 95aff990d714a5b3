//! Every table and figure of the paper from end to end, on a plan of short runs and few points.

use retune_jobs::paper::reproduce;
use retune_jobs::{Error, Request, Silent};
use retune_store::Error as StoreError;
use retune_study::StudyError;
use retune_testkit::desk::{Desk, committed};
use retune_testkit::observers::{Record, good, refused};
use retune_testkit::verified;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// The paper's plan with windows of seconds and grids of a few points.
fn small() -> Desk {
    let desk = Desk::with_table2("table2.json", |study| {
        study["window"] = json!({ "t0": 5, "T": 10 });
        for axis in study["optimize"]["surf"].as_object_mut().expect("axes").values_mut() {
            axis["points"] = json!(4);
        }
    });
    let mut plan = committed("paper.json");
    plan["k1"] = json!([3.00e4, 3.95e4, 5.00e4]);
    plan["omega"] = json!({ "from": 4, "to": 9, "points": 11 });
    plan["k1_range"] = json!({ "from": 2.0e4, "to": 6.0e4, "points": 3 });
    plan["ladder"] = json!([5]);
    plan["motions"] = json!({ "from": 0.998, "to": 1.002, "points": 2 });
    desk.write_json("paper.json", &plan);
    desk
}

/// A request for the paper of the desk, into a directory of it.
fn request(desk: &Desk, out: &str) -> Request {
    Request { out: Some(desk.path(out)), ..Request::new(&desk.path("paper.json")) }
}

/// The targets of links and sources in an HTML page.
fn targets(page: &str) -> BTreeSet<String> {
    let after = |attribute: &str| {
        let parts = page.split(attribute).skip(1).filter_map(|rest| rest.split('"').next());
        parts.map(str::to_owned).collect::<Vec<_>>()
    };
    [after(" href=\""), after(" src=\"")].concat().into_iter().collect()
}

#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_reproduce_makes_one_page_that_needs_nothing_else() {
    let desk = small();
    let record = Record::default();
    good(reproduce(&Request { threads: Some(2), ..request(&desk, "one") }, None, &record));
    // With one thread the same, of what is quick.
    for item in ["figure3", "figure4", "table1"] {
        good(reproduce(&Request { threads: Some(1), ..request(&desk, item) }, Some(item), &Silent));
        let apart = ["manifest.json", "resolved.json", "study.json"];
        for name in desk.names(item).iter().filter(|name| !apart.contains(&name.as_str())) {
            assert_eq!(desk.read(&format!("{item}/{name}")), desk.read(&format!("one/{name}")), "{name}");
        }
    }
    let (mut names, said) = (desk.names("one"), record.results());
    names.retain(|name| name != "table2");

    let page = desk.read("one/index.html");
    let foreign = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for sign in ["http:", "https:", "<script", "<iframe", "@import", "url(", "//cdn"] {
        assert!(!foreign.contains(sign), "the page needs no network: {sign}");
    }
    let targets = targets(&page);
    for target in &targets {
        let there = match target.strip_prefix('#') {
            Some(id) => page.contains(&format!("id=\"{id}\"")),
            None => target == "data:," || names.contains(target),
        };
        assert!(there, "the page links to {target}");
    }
    for name in &names {
        let is_table = name.contains("-table-") || name.ends_with("-statements.json");
        assert!(is_table || name == "index.html" || targets.contains(name), "{name} is linked");
    }
    let pictures: Vec<&String> = names.iter().filter(|name| name.ends_with(".svg")).collect();
    let narrow = page.matches("<div class=\"narrow\"").count();
    assert_eq!(page.matches("<svg ").count(), pictures.len() + narrow);
    assert_eq!(narrow, pictures.iter().filter(|name| !name.starts_with("figure2")).count());
    for name in pictures {
        let svg = desk.read(&format!("one/{name}"));
        assert!(
            svg.contains("</svg>") && page.contains(&svg[svg.find("<svg").expect("a picture")..]),
            "{name}"
        );
    }

    for name in names.iter().filter(|name| name.ends_with(".svg") || name.ends_with(".csv")) {
        let text = desk.read(&format!("one/{name}"));
        let words = text.split(|c: char| !c.is_ascii_alphanumeric());
        let wrong: Vec<&str> =
            words.filter(|word| ["nan", "inf"].contains(&word.to_lowercase().as_str())).collect();
        assert!(wrong.is_empty(), "{name}: {wrong:?}");
    }

    let mut verdicts = 0;
    for name in names.iter().filter(|name| name.ends_with("-statements.json")) {
        for statement in desk.read_json(&format!("one/{name}")).as_array().expect("a list") {
            let [paper, rule, found] =
                ["paper", "rule", "found"].map(|key| statement[key].as_str().expect(key));
            assert!(!rule.is_empty() && !found.is_empty(), "{name}: {paper}");
            assert!(said.contains(paper), "{paper}");
            verdicts += 1;
        }
    }
    assert_eq!(page.matches("class=\"verdict\"").count(), verdicts);
    assert!(verdicts >= 20, "{verdicts}");
    let conjectures = page.matches("<b>Our conjecture: </b>").count();
    assert_eq!(conjectures, 2);
    assert!(page.contains(&format!("Of {} statements", verdicts - conjectures)), "conjectures do not count");
    let settings = desk.read("one/figures-table-1.csv");
    let head =
        "figure,statement,R = 0.1 m,R = 0.5 m,R = 2 m,R = 5 m,R = 10 m,0 to 10 s,2.5 to 10 s,e = 0.7\n";
    assert!(settings.starts_with(head) && settings.lines().count() > 20, "{settings}");
    assert!(said.trim_end().ends_with("table2-table-2.csv"), "{said}");
}

#[test]
fn contract_another_structure_than_the_papers_is_warned_of() {
    let desk = small();
    for row in desk.read_json("table2.json")["rows"].as_array().expect("rows") {
        let file = row["study"].as_str().expect("a file");
        let mut study = desk.read_json(file);
        study["scene"]["primary"]["m1"] = json!(1200);
        desk.write_json(file, &study);
    }
    let record = Record::default();
    good(reproduce(&request(&desk, "out"), Some("figure6"), &record));
    assert!(record.warnings().starts_with("the structure is not the paper's"), "{}", record.warnings());
}

#[test]
fn contract_one_figure_or_table_makes_its_own_files_only() {
    let desk = small();
    desk.write("out/figure6-old.csv", "of an earlier run");
    desk.write("out/figure5.svg", "of another figure");
    match refused(reproduce(&request(&desk, "out"), Some("figure6"), &Silent)) {
        Error::Store(StoreError::Standing { problem, .. }) => {
            assert!(
                problem.starts_with("figure6-old.csv is in the way: Retune did not make it"),
                "{problem}"
            );
        }
        other => panic!("{other}"),
    }
    for unknown in ["figure99", "Figure3", "table 1", ""] {
        let error = refused(reproduce(&request(&desk, "none"), Some(unknown), &Silent)).to_string();
        assert!(error.starts_with(&format!("only: \"{unknown}\" is no table or figure")), "{error}");
        assert!(error.contains("figure6, figure7"), "{error}");
    }
    assert_eq!(desk.read("out/figure6-old.csv"), "of an earlier run");
    let record = Record::default();
    good(reproduce(&Request { replace: true, ..request(&desk, "out") }, Some("figure6"), &record));
    assert!(record.results().starts_with("Figure 6. "), "{}", record.results());
    assert_eq!(record.warnings(), "");
    let names = [
        "figure5.svg",
        "figure6-statements.json",
        "figure6-table-1.csv",
        "figure6.csv",
        "figure6.svg",
        "manifest.json",
        "resolved.json",
        "study.json",
    ];
    assert_eq!(desk.names("out"), names);
    let rows = desk.read("out/figure6.csv");
    assert_eq!(rows.lines().next(), Some("t_s,E1_none_J,E1_SSVI_J,E2_SSVI_J,E1_TMD_J,E2_TMD_J"));
    assert_eq!(rows.lines().count(), 1 + 201, "10 s every 0.05 s");

    good(reproduce(&request(&desk, "tables"), Some("table2"), &Silent));
    let names = [
        "manifest.json",
        "resolved.json",
        "study.json",
        "table2",
        "table2-statements.json",
        "table2-table-1.csv",
        "table2-table-2.csv",
    ];
    assert_eq!(desk.names("tables"), names);
    let searches =
        ["ssvi-one-omega", "ssvi-stiffer", "ssvi-worst", "tmd-bounded", "tmd-one-omega", "tmd-worst"];
    assert_eq!(desk.names("tables/table2"), searches);
    // The searches stay those of the results when another item is made again.
    good(reproduce(&request(&desk, "tables"), Some("table1"), &Silent));
    assert_eq!(
        desk.read_json("tables/manifest.json")["parts"].as_object().map(serde_json::Map::len),
        Some(searches.len())
    );
    assert_eq!(desk.names("tables/table2"), searches);
    let table = desk.read("tables/table2-table-1.csv");
    assert!(table.contains("SSVI NES,the paper's,215,232,0.06,0.36,"), "{table}");
    assert!(table.contains("TMD,the paper's,600,262,2.08,4.7,"), "{table}");
}

/// What an item says is made again, from the designs of its searches, and a digit or a verdict that was changed is found.
#[test]
fn contract_items_are_made_again_and_a_change_is_found() {
    let desk = small();
    good(reproduce(&request(&desk, "out"), Some("figure6"), &Silent));
    let said = verified::holds(&desk, "out", 1);
    let line = "figure6-statements.json with its tables and data made again: the same to the last bit";
    assert!(said.contains(line), "{said}");
    for (name, from, to) in [
        ("figure6-statements.json", "\"verdict\": \"holds\"", "\"verdict\": \"fails\""),
        ("figure6-table-1.csv", "TMD", "TMB"),
        ("figure6.csv", "0,0,", "0,1,"),
    ] {
        let file = format!("out/{name}");
        let whole = desk.read(&file);
        assert!(whole.contains(from), "{name}: {whole}");
        desk.write(&file, whole.replacen(from, to, 1));
        let verified::End::Not(problem) = verified::look(&desk, "out", 1, 0.0).1 else {
            panic!("{name}: it holds")
        };
        assert!(problem.contains("figure6-statements.json, 1 differs"), "{problem}");
        desk.write(&file, whole);
    }
}

/// A figure that is made again keeps the others in the manifest.
#[test]
fn contract_figures_made_one_by_one_stay_retunes() {
    let desk = small();
    let make = |figure| reproduce(&request(&desk, "out"), Some(figure), &Silent);
    good(make("figure5"));
    desk.write("out/figure5-notes.txt", "mine");
    desk.write("out/notes.txt", "mine");
    match refused(make("figure5")) {
        Error::Store(StoreError::Standing { problem, .. }) => {
            assert!(problem.starts_with("figure5-notes.txt is in the way"), "{problem}");
        }
        other => panic!("{other}"),
    }
    desk.remove("out/figure5-notes.txt");
    good(make("figure3"));
    let manifest = desk.read_json("out/manifest.json");
    let files = manifest["files"].as_object().expect("files");
    assert!(files.contains_key("figure3.svg") && files.contains_key("figure5.svg"), "{files:?}");
    let mut plan = desk.read_json("paper.json");
    plan["omega"] = json!({ "from": 4, "to": 9, "points": 12 });
    desk.write_json("paper.json", &plan);
    good(make("figure5"));
    let manifest = desk.read_json("out/manifest.json");
    let earlier = manifest["earlier"].as_object().expect("earlier");
    assert!(earlier.contains_key("figure3.svg") && !earlier.contains_key("figure5.svg"), "{earlier:?}");
    good(make("figure3"));
    assert_eq!(desk.read_json("out/manifest.json").get("earlier"), None);
    assert!(desk.path("out/notes.txt").exists());
}

#[test]
fn contract_wrong_plans_are_refused_with_the_field() {
    let desk = small();
    let plan = desk.read_json("paper.json");
    let problem = |field: &str, value: Value| {
        let mut wrong = plan.clone();
        wrong[field] = value;
        desk.write_json("paper.json", &wrong);
        let error = refused(reproduce(&request(&desk, "out"), None, &Silent));
        assert!(!desk.path("out").exists(), "nothing may be left behind");
        match error {
            Error::Study(error) => error,
            other => panic!("{other}"),
        }
    };
    for (field, value, sentence) in [
        ("k1", json!([]), "k1: give at least one number above 0"),
        ("k1", json!([-1.0]), "k1: give at least one number above 0"),
        (
            "omega",
            json!({ "from": 9, "to": 4, "points": 31 }),
            "omega: give 0 < from < to and 2 to 100000 points",
        ),
        (
            "motions",
            json!({ "from": 0.9, "to": 1.1, "points": 1 }),
            "motions: give 0 < from < to and 2 to 100000 points",
        ),
    ] {
        match problem(field, value) {
            StudyError::Paper { problem, .. } => assert_eq!(problem, sentence),
            other => panic!("{other}"),
        }
    }
    match problem("table2", json!("none.json")) {
        StudyError::Unreadable { file, .. } => assert_eq!(file, desk.path("none.json").display().to_string()),
        other => panic!("{other}"),
    }
    match problem("k3", json!(1)) {
        StudyError::Field { problem, .. } => {
            assert!(problem.starts_with("unknown field `k3`; did you mean `k1`?"), "{problem}");
        }
        other => panic!("{other}"),
    }
}

/// The paper's damper begins to touch its wall at 5.265780 rad/s (`results/branches/paper`), 1.5e-4 rad/s before the period doubling of that
/// motion, and its motion of two periods begins at a period doubling. A motion that is followed three times over has no name of its own.
#[test]
fn exact_regimes_of_figure_4_end_at_the_events_of_their_branches() {
    let desk = small();
    let mut plan: Value = desk.read_json("paper.json");
    plan["motions"] = json!({ "from": 0.8, "to": 0.86, "points": 13 });
    desk.write_json("paper.json", &plan);
    good(reproduce(&request(&desk, "out"), Some("figure4"), &Silent));
    let table = desk.read("out/figure4-table-3.csv");
    let begins = "3.95e4,\"2T, 1, 0\",5.364462,5.405016,period doubling,the range,yes\n";
    for part in [",5.265780,the range,grazing,yes\n", begins] {
        assert!(table.contains(part), "{part} in {table}");
    }
    assert!(!table.contains("\"3T, 0, 0"), "{table}");
}
