//! `table2`: several dampers, each from the paper's own design.

use crate::{request, resume};
use retune_jobs::table2::table2;
use retune_jobs::{Error, Silent};
use retune_store::Error as StoreError;
use retune_testkit::desk::Desk;
use retune_testkit::observers::{cut_off, good, refused};
use serde_json::json;

/// The studies of Table 2 with short runs and coarse grids.
fn desk(table: &str) -> Desk {
    Desk::with_table2(table, |study| {
        study["window"] = json!({ "t0": 1, "T": 4 });
        for axis in study["optimize"]["surf"].as_object_mut().expect("axes").values_mut() {
            axis["points"] = json!(2);
        }
        study["optimize"]["refine"] = json!({ "MaxFunEvals": 20 });
    })
}

#[test]
fn paper_table2_puts_our_rows_beside_the_papers() {
    let desk = desk("table2.json");
    good(table2(&request(&desk, "table2.json", "out"), &Silent));
    let csv = desk.rows("out/table2.csv");
    let needs = "stroke,contact_force,x1max,a1max,ground_force";
    let columns = format!("origin,damper,m2,k2,c2,D,C,E1max,E1max_printed,E1max_none,{needs},verdict");
    assert_eq!(csv[0].join(","), columns);
    // From rest on x1 is at least what the energy of the window needs, at the frequency of the scene.
    let need = |row: usize, column: usize| csv[row][column].parse::<f64>().expect("a number");
    assert!((1..5).all(|row| need(row, 12) >= 0.9 * (2.0 * need(row, 7) / 6.4e4).sqrt()), "{csv:?}");
    assert!(need(1, 11) > 0.0 && need(3, 11) == 0.0, "{csv:?}");
    let text = desk.read("out/table2.txt");
    assert!(
        text.contains("\nSSVI NES, paper: needs stroke ") && text.contains("\nTMD, re-optimised: needs "),
        "{text}"
    );
    let none = |row: usize| csv[row][9].parse::<f64>().expect("a number");
    assert!((1..5).all(|row| none(row) > 0.0) && csv[1][8] == "563" && csv[2][8].is_empty());
    assert_eq!(csv[1][..7], ["paper", "SSVI NES", "60", "215", "232", "0.06", "0.36"]);
    assert_eq!(csv[2][..2], ["re-optimised", "SSVI NES"]);
    assert_eq!(csv[3][..7], ["paper", "TMD", "60", "600", "262", "2.08", "4.7"]);
    let energy = |row: usize| csv[row][7].parse::<f64>().expect("a number");
    assert!(energy(2) <= energy(1) && energy(4) <= energy(3));
    let expected = ["manifest.json", "resolved.json", "ssvi", "table2.csv", "table2.txt", "tmd"];
    assert_eq!(desk.names("out"), expected);
    assert!(!desk.names("out/ssvi").contains(&"unfinished".to_owned()));
}

#[test]
fn contract_table2_resumes_where_it_was_cut_off() {
    let desk = desk("table2.json");
    good(table2(&request(&desk, "table2.json", "whole"), &Silent));
    // In the first search, and in the second.
    for (at, begun) in [(8, "out/ssvi"), (32, "out/tmd")] {
        cut_off(at, |watch| table2(&request(&desk, "table2.json", "out"), watch));
        assert!(desk.path(begun).join("unfinished/journal").exists(), "{at}");
        let error = refused(table2(&request(&desk, "table2.json", "out"), &Silent));
        assert!(
            matches!(
                error,
                Error::Store(StoreError::Unfinished { lines: 5.., damaged: 0, difference: None, .. })
            ),
            "{error}"
        );
        good(table2(&resume(&desk, "table2.json", "out"), &Silent));
        desk.assert_same("whole", "out");
        desk.remove("out");
    }
}
