//! `reproduce`, `figure` and `table` from end to end, on a plan of short runs and few points.

mod common;

use common::{Answer, Desk, studies};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// The paper's plan with windows of seconds and grids of a few points.
fn small_plan(desk: &Desk) -> Value {
    for name in ["ssvi.json", "tmd.json", "table2.json", "paper.json"] {
        let mut study = read(name);
        if study.get("window").is_some() {
            study["window"] = json!({ "t0": 5, "T": 10 });
        }
        desk.write_json(name, &study);
    }
    let mut plan = read("paper.json");
    plan["k1"] = json!([3.00e4, 3.95e4, 5.00e4]);
    plan["omega"] = json!({ "from": 4, "to": 9, "points": 31 });
    plan["k1_range"] = json!({ "from": 2.0e4, "to": 6.0e4, "points": 3 });
    plan["motions"] = json!({ "from": 0.9, "to": 1.1, "points": 4 });
    desk.write_json("paper.json", &plan);
    plan
}

fn read(name: &str) -> Value {
    let text = std::fs::read_to_string(studies().join(name)).expect(name);
    serde_json::from_str(&text).expect("JSON")
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
fn contract_reproduce_makes_one_page_that_needs_nothing_else() {
    let desk = Desk::new();
    small_plan(&desk);
    let screen = desk.good(&["reproduce", "--study", "paper.json", "--threads", "1", "--out", "one"]);
    desk.good(&["reproduce", "--study", "paper.json", "--threads", "2", "--out", "two", "--quiet"]);
    let mut names = desk.names("one");
    assert_eq!(names, desk.names("two"));
    names.retain(|name| name != "table2");
    for search in desk.names("one/table2") {
        for name in desk.names(&format!("one/table2/{search}")) {
            let [one, two] = ["one", "two"].map(|run| desk.read(&format!("{run}/table2/{search}/{name}")));
            assert_eq!(one, two, "{search}/{name}: threads");
        }
    }
    for name in &names {
        assert_eq!(desk.read(&format!("one/{name}")), desk.read(&format!("two/{name}")), "{name}: threads");
    }

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
            assert!(screen.contains(paper), "{paper}");
            verdicts += 1;
        }
    }
    assert_eq!(page.matches("class=\"verdict\"").count(), verdicts);
    assert!(verdicts >= 20, "{verdicts}");
    assert!(screen.trim_end().ends_with("table2-table-1.csv"), "{screen}");
}

#[test]
fn contract_one_figure_or_table_makes_its_own_files_only() {
    let desk = Desk::new();
    small_plan(&desk);
    desk.write("out/figure6-old.csv", "of an earlier run");
    desk.write("out/figure5.svg", "of another figure");
    let run = ["figure", "6", "--study", "paper.json", "--out", "out"];
    let Answer { code, stderr, .. } = desk.run(&run);
    assert_eq!(code, Some(2));
    assert!(stderr.contains("figure6-old.csv stands here, which Retune did not make"), "{stderr}");
    assert_eq!(desk.read("out/figure6-old.csv"), "of an earlier run");
    let screen = desk.good(&[&run[..], &["--replace"]].concat());
    assert!(screen.starts_with("Figure 6. "), "{screen}");
    let names = [
        "figure5.svg",
        "figure6-statements.json",
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

    desk.good(&["table", "2", "--study", "paper.json", "--out", "tables", "--quiet"]);
    let names = [
        "manifest.json",
        "resolved.json",
        "study.json",
        "table2",
        "table2-statements.json",
        "table2-table-1.csv",
    ];
    assert_eq!(desk.names("tables"), names);
    let searches =
        ["ssvi-one-omega", "ssvi-stiffer", "ssvi-worst", "tmd-bounded", "tmd-one-omega", "tmd-worst"];
    assert_eq!(desk.names("tables/table2"), searches);
    // The searches stay those of the results when another item is made again.
    desk.good(&["table", "1", "--study", "paper.json", "--out", "tables", "--quiet"]);
    assert_eq!(
        desk.read_json("tables/manifest.json")["parts"].as_array().map(Vec::len),
        Some(searches.len())
    );
    assert_eq!(desk.names("tables/table2"), searches);
    let table = desk.read("tables/table2-table-1.csv");
    assert!(table.contains("SSVI NES,the paper's,215,232,0.06,0.36,"), "{table}");
    assert!(table.contains("TMD,the paper's,600,262,2.08,4.7,"), "{table}");
}

#[test]
fn contract_figures_and_tables_that_the_paper_does_not_have_are_refused() {
    let desk = Desk::new();
    for (arguments, sentence) in [
        (["figure", "8"], "invalid value '8' for '<NUMBER>': 8 is not in 2..=7"),
        (["figure", "1"], "invalid value '1' for '<NUMBER>': 1 is not in 2..=7"),
        (["figure", "two"], "invalid value 'two' for '<NUMBER>': invalid digit found in string"),
        (["table", "3"], "invalid value '3' for '<NUMBER>': 3 is not in 1..=2"),
    ] {
        let Answer { code, stdout, stderr } = desk.run(&arguments);
        assert_eq!((code, stdout.as_str()), (Some(2), ""), "{arguments:?}");
        assert!(stderr.contains(sentence), "{stderr}");
    }
    assert!(desk.names(".").is_empty(), "nothing may be left behind");
}

#[test]
fn contract_wrong_plans_are_refused_with_the_field() {
    let desk = Desk::new();
    let plan = small_plan(&desk);
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
        ("table2", json!("none.json"), "none.json: cannot be read: "),
        ("k3", json!(1), "unknown field `k3`; did you mean `k1`?"),
    ] {
        let mut wrong = plan.clone();
        wrong[field] = value;
        desk.write_json("wrong.json", &wrong);
        let Answer { code, stdout, stderr } =
            desk.run(&["reproduce", "--study", "wrong.json", "--out", "out"]);
        assert_eq!((code, stdout.as_str()), (Some(2), ""), "{stderr}");
        assert!(stderr.starts_with("error: ") && stderr.contains(sentence), "{stderr}");
        assert!(!desk.path("out").exists(), "nothing may be left behind");
    }
    let Answer { code, stderr, .. } = desk.run(&["figure", "6"]);
    assert_eq!(code, Some(2));
    assert!(stderr.starts_with("error: studies/paper.json: cannot be read: "), "{stderr}");
}
