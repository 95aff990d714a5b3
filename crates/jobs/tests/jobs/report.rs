//! The page of a search: whole, true to the files beside it, and with the flags that they call for.

use crate::band::ssvi_band;
use crate::search;
use retune_model::Parameter;
use retune_testkit::desk::{Desk, committed, few_starts, global, number, tiny};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Elements without an end.
const VOID: [&str; 2] = ["meta", "link"];

/// All values of an attribute.
fn values(page: &str, attribute: &str) -> Vec<String> {
    let begins = format!(" {attribute}=\"");
    let parts = page.split(&begins).skip(1);
    parts.filter_map(|rest| rest.split('"').next()).map(str::to_owned).collect()
}

/// Every element ends where it should, and so do the attributes of its tag.
#[track_caller]
fn assert_nested(page: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in page.split('<').skip(1) {
        let (tag, _) = tag.split_once('>').unwrap_or_else(|| panic!("an open tag: {tag:.60}"));
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        let name = tag.trim_start_matches('/').split([' ', '\n', '/']).next().unwrap_or_default();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "{tag}");
        } else if !(tag.starts_with('!') || tag.ends_with('/') || VOID.contains(&name)) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

/// The text between tags, without style sheets.
fn text(page: &str) -> String {
    let without_styles: String = page
        .split("<style>")
        .map(|part| part.split_once("</style>").map_or(part, |(_, rest)| rest))
        .collect();
    let texts = without_styles.split('<').filter_map(|part| Some(part.split_once('>')?.1));
    format!("|{}|", texts.filter(|text| !text.is_empty()).collect::<Vec<_>>().join("|"))
}

#[track_caller]
fn assert_whole(desk: &Desk, out: &str) {
    let page = desk.read(&format!("{out}/report.html"));
    assert!(page.len() < 400_000, "{}", page.len());
    assert!(page.starts_with("<!DOCTYPE html><html lang=\"en\">"));
    assert_nested(&page);
    let foreign = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for sign in ["http:", "https:", "<script", "<iframe", "@import", "url(", "src=", " onload"] {
        assert!(!foreign.contains(sign), "the page needs nothing else: {sign}");
    }
    let ids = values(&page, "id");
    assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len(), "{ids:?}");
    let names = desk.names(out);
    let links: BTreeSet<String> = values(&page, "href").into_iter().collect();
    for link in &links {
        let there = match link.strip_prefix('#') {
            Some(id) => ids.iter().any(|other| other == id),
            None => link == "data:," || names.contains(link),
        };
        assert!(there, "{link}");
    }
    for name in names.iter().filter(|name| *name != "report.html") {
        assert!(links.contains(name), "{name} is not linked");
    }
    for target in ["aria-labelledby", "aria-describedby"].iter().flat_map(|name| values(&page, name)) {
        assert!(target.split(' ').all(|id| ids.iter().any(|other| other == id)), "{target}");
    }
    let said = text(&page);
    let words = said.split(|c: char| !c.is_ascii_alphanumeric()).map(str::to_lowercase);
    let wrong: Vec<String> =
        words.filter(|word| ["nan", "inf", "infinity", "null"].contains(&word.as_str())).collect();
    assert!(wrong.is_empty(), "{out}: {wrong:?}: {}", said.split_once("inf").map_or("", |(_, rest)| rest));
    assert_eq!(page.matches("<h1>").count(), 1);
    assert_eq!(page.matches("<section ").count(), 7);
    assert_eq!(page.matches("<h2 ").count(), 7);
    assert_eq!(page.matches("<table").count(), page.matches("<caption>").count());
    assert_eq!(
        page.matches("<th").count() - page.matches("<thead").count(),
        page.matches(" scope=\"").count()
    );
    assert_eq!(page.matches("<figure>").count(), page.matches("<figcaption>").count());
    assert_eq!(page.matches("<svg ").count(), page.matches("<title id=").count());
}

/// To four significant digits, as pages print numbers.
fn four(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().expect("a number");
    rounded.to_string().replace('-', "−")
}

/// A search of some study: its name, what it is, and its results in the directory of that name.
fn searches() -> (Desk, Vec<&'static str>) {
    let desk = Desk::new();
    let mut settled = tiny();
    settled["optimize"]["objective"] = json!({ "response": "settled", "starts": 1 });
    let mut touching = committed("tmd-free.json");
    touching["scene"]["damper"]["D"] = json!(0.25);
    touching["optimize"]["surf"]["k2"]["points"] = json!(9);
    touching["optimize"]["surf"]["c2"]["points"] = json!(9);
    let mut calm = committed("tmd-free.json");
    calm["optimize"]["bounds"]["c2"] = json!([0, 5000]);
    // The design of the paper, hardly searched about.
    let mut paper = committed("ssvi.json");
    paper["optimize"] =
        json!({ "vary": ["c2"], "bounds": { "c2": [231.9, 232.1] }, "refine": { "MaxFunEvals": 3 } });
    few_starts(&mut paper);
    let limited = |stroke: f64| global(json!({}), json!({ "stroke": stroke }));
    let studies: [(&str, Value); 9] = [
        ("tiny", tiny()),
        ("band", ssvi_band()),
        ("settled", settled),
        ("touching", touching),
        ("calm", calm),
        ("paper", paper),
        ("broken", limited(1e-4)),
        ("kept", limited(0.2)),
        ("edge", global(json!({}), json!({ "cavity": 0.2 }))),
    ];
    for (name, study) in &studies {
        desk.write_json(&format!("{name}.json"), study);
        search(&desk, &format!("{name}.json"), name);
    }
    (desk, studies.map(|(name, _)| name).to_vec())
}

/// The flags that the files beside a page call for.
fn called_for(desk: &Desk, out: &str) -> BTreeMap<&'static str, bool> {
    let [optimum, certificate, study] =
        ["optimum", "certificate", "study"].map(|name| desk.read_json(&format!("{out}/{name}.json")));
    let winner = optimum["refine"]["winner"].as_u64().expect("a number") as usize - 1;
    let run = &optimum["refine"]["runs"][winner];
    let at_end = |(name, axis): (&String, &Value)| {
        // The first run begins at the best point of the grid.
        let start = number(&optimum, &format!("/refine/runs/0/start/{name}"));
        let end = |which: &str| (number(axis, which) / start - 1.0).abs() < 1e-9;
        end("/from") || end("/to")
    };
    let grid = study["optimize"]["surf"].as_object();
    let feasible = optimum["limits"]["feasible"].as_bool();
    let near = certificate["limits"]["broken_near"].as_array().is_some_and(|near| !near.is_empty());
    BTreeMap::from([
        ("on-bound", optimum["on_bound"].as_array().is_some_and(|met| !met.is_empty())),
        ("grid-edge", grid.is_some_and(|axes| axes.iter().filter(|(_, axis)| axis.is_object()).any(at_end))),
        ("irregular", certificate["motion"]["irregular"] == true),
        ("not-predictable", certificate["predictable"] == false),
        ("unsettled", optimum["objective"]["unsettled"].as_u64().is_some_and(|count| count > 0)),
        ("failures", number(&optimum, "/failures/count") > 0.0),
        ("not-converged", run["stop"] != "Converged"),
        ("limits-broken", feasible == Some(false)),
        ("near-a-limit", feasible == Some(true) && near),
    ])
}

#[test]
fn contract_a_page_is_whole_and_says_what_the_files_beside_it_say() {
    let (desk, names) = searches();
    let mut seen: BTreeMap<&str, BTreeSet<bool>> = BTreeMap::new();
    for name in names {
        assert_whole(&desk, name);
        let page = desk.read(&format!("{name}/report.html"));
        let flags: BTreeSet<String> = values(&page, "data-flag")
            .into_iter()
            .filter(|flag| page.contains(&format!("<li class=\"flag\" data-flag=\"{flag}\">")))
            .collect();
        for (flag, wanted) in called_for(&desk, name) {
            assert_eq!(flags.contains(flag), wanted, "{name}: {flag} of {flags:?}");
            seen.entry(flag).or_default().insert(wanted);
        }
        assert_numbers(&desk, name, &text(&page));
    }
    for (flag, seen) in seen {
        let both = flag == "not-predictable" || seen.len() == 2;
        assert!(both, "{flag} is always {seen:?} here");
    }
}

/// The numbers of the page are those of `optimum.json` and `certificate.json`.
#[track_caller]
fn assert_numbers(desk: &Desk, out: &str, said: &str) {
    let [optimum, certificate] =
        ["optimum", "certificate"].map(|name| desk.read_json(&format!("{out}/{name}.json")));
    let holds = |words: String| assert!(said.contains(&words), "{out}: {words}");
    let [e1_max, omega] = ["/E1max", "/simulation/omega"].map(|path| number(&optimum, path));
    holds(format!("E1max, is |{} J|", four(e1_max)));
    holds(format!("{} rad/s ({} Hz)", four(omega), four(0.5 / std::f64::consts::PI * omega)));
    holds(format!("--set omega={omega}"));
    for parameter in [Parameter::M2].into_iter().chain(Parameter::PAPER) {
        let value = four(number(&optimum, &format!("/{parameter}")));
        holds(format!("|{parameter}|{}|{value}|", parameter.words()));
    }
    holds(format!("|stroke|{} mm|", four(1e3 * number(&optimum, "/simulation/spring_deflection_max"))));
    for (side, wall) in [("primary", "structure"), ("obstacle", "obstacle")] {
        let force = number(&optimum, &format!("/simulation/force_max/{side}"));
        holds(format!("|force on the {wall}|{} N|", four(force)));
    }
    let near = |name: &str| {
        let value = certificate["neighbourhood"][name].as_f64();
        value.map_or("no value (it cannot be computed)".to_owned(), |value| format!("{} J", four(value)))
    };
    let [low, median, high] = ["low", "median", "high"].map(near);
    holds(format!("E1max from {low} to {high}, and half have less than {median}. The design itself"));
    for one in certificate["sensitivity"].as_array().expect("a list") {
        let name = one["parameter"].as_str().expect("a name");
        let worst = one["worst"].as_f64().map_or("–".to_owned(), four);
        let row = said.split_once(&format!("|{name}|{}|", four(number(one, "/value")))).expect("a row").1;
        assert_eq!(row.split('|').nth(1), Some(worst.as_str()), "{out}: {name}");
    }
    let regime = certificate["motion"]["regime"].as_str().expect("words");
    holds(format!("|kind|{regime}|"));
}
