//! `verify` of the results of `retention`, `fronts` and `table2`.

use crate::request;
use retune_jobs::Silent;
use retune_jobs::fronts::fronts;
use retune_jobs::retention::retention;
use retune_jobs::table2::table2;
use retune_model::Parameter;
use retune_study::Setting;
use retune_testkit::desk::Desk;
use retune_testkit::observers::good;
use retune_testkit::verified::{a_changed_digit_is_found, desk};
use serde_json::json;

fn retain(desk: &Desk) {
    good(retention(&request(desk, "table2.json", "retune"), &[Setting::new(Parameter::K1, 3e4)], &Silent));
    a_changed_digit_is_found(desk, "retune", &["retune.csv", "retention.csv", "range.csv", "force.csv"]);
}

#[test]
fn contract_results_are_verified_and_a_changed_digit_is_found() {
    let desk = desk();
    retain(&desk);
    good(fronts(&request(&desk, "fronts.json", "fronts"), &Silent));
    a_changed_digit_is_found(&desk, "fronts", &["k2.csv", "stroke.csv", "front.csv"]);
}

/// A study that varies the mass and the radius, too: they stand in every table of designs, for the damper of a row would be another one
/// without them, and on the pages.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_tables_have_a_column_for_whatever_is_varied() {
    let desk = desk();
    let mut study = desk.read_json("study.json");
    study["optimize"]["vary"] = json!(["k2", "c2", "m2", "R"]);
    study["optimize"]["bounds"] = json!({ "k2": [10, 1000], "m2": [10, 100], "R": [1, 3] });
    study["optimize"]["refine"] = json!({ "MaxFunEvals": 24 });
    desk.write_json("study.json", &study);
    let columns = |file: &str, mass: &str| {
        let rows = desk.rows(file);
        // The name of the damper has a comma, which the last columns do not see.
        let place = |name: &str| rows[0].len() - rows[0].iter().position(|other| other == name).expect(name);
        let other = |name: &str, own: &str| {
            let mut fields = rows[1..].iter().map(|row| row[row.len() - place(name)].as_str());
            fields.any(|field| ![own, ""].contains(&field))
        };
        assert!(other("m2", mass) && other("R", "2"), "{file}: {rows:?}");
    };
    good(table2(&request(&desk, "table2.json", "table2"), &Silent));
    a_changed_digit_is_found(&desk, "table2", &["table2.csv"]);
    columns("table2/table2.csv", "60");
    assert!(desk.read("table2/table2.txt").contains(", re-optimised: R = "));
    retain(&desk);
    columns("retune/retune.csv", "60");
    columns("retune/range.csv", "60");
    let page = desk.read("retune/README.md");
    assert!(page.contains(" | R, m | m2, kg | E1max, J | verdict |"), "{page}");
    assert!(page.contains("this TMD has the mass of the damper in the study"), "{page}");
    assert!(desk.read("retune/path.svg").contains("k2, c2, D, C, m2 and R of each damper, tuned anew"));
    good(fronts(&request(&desk, "fronts.json", "fronts"), &Silent));
    a_changed_digit_is_found(&desk, "fronts", &["k2.csv", "stroke.csv", "front.csv"]);
    columns("fronts/k2.csv", "60");
    columns("fronts/front.csv", "60");
    let page = desk.read("fronts/README.md");
    assert!(page.contains(" | m2, kg | R, m | verdict |"), "{page}");
}
