//! `verify`: results are run again, and what does not hold is said.

mod common;

use common::{Answer, Desk, altered, tiny};
use serde_json::json;

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write_json("study.json", &tiny());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "out"]);
    desk
}

#[test]
fn exact_results_hold_to_the_last_bit() {
    let desk = desk();
    let said = desk.good(&["verify", "out", "--sample", "7"]);
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines[0], "  14 files as they were made");
    assert_eq!(lines[1], "  surf.csv               7 of 24 rows run again: the same to the last bit");
    assert!(lines[2].starts_with("  fminsearch.csv         7 of "), "{said}");
    assert!(lines[3].starts_with("  fminsearch-starts.csv  7 of "), "{said}");
    assert_eq!(lines[4], "  optimum.json           its design run again: the same to the last bit");
    assert_eq!(lines[5], "all that was looked at holds");
    let all = desk.good(&["verify", "out", "--sample", "1000"]);
    assert!(all.contains("  surf.csv               24 of 24 rows run again: the same"), "{all}");
}

#[test]
fn exact_a_changed_row_is_found_twice() {
    let desk = desk();
    let surf = desk.read("out/surf.csv");
    let row = surf.lines().nth(5).expect("a row");
    let (design, energy) = row.rsplit_once(',').expect("a value");
    let other = energy.parse::<f64>().expect("a number") * (1.0 + 1e-6);
    desk.write("out/surf.csv", surf.replace(row, &format!("{design},{other}")));
    let Answer { code, stdout, stderr } = desk.run(&["verify", "out", "--sample", "24"]);
    assert_eq!(code, Some(1));
    assert!(
        stdout.contains(
            "  surf.csv               24 of 24 rows run again: 1 differ, by at most 1.0e-6 of their value"
        ),
        "{stdout}"
    );
    assert_eq!(
        stderr,
        "error: out: does not hold: surf.csv is not as it was made; surf.csv, 1 differ, by at most 1.0e-6 of their value\n"
    );
    let Answer { stderr, .. } = desk.run(&["verify", "out", "--sample", "24", "--within", "1e-5"]);
    assert_eq!(stderr, "error: out: does not hold: surf.csv is not as it was made\n");
}

#[test]
fn exact_another_study_beside_results_is_found() {
    let desk = desk();
    let study = desk.read("out/study.json").replace("\"k1\": 39500.0", "\"k1\": 39501.0");
    desk.write("out/study.json", study);
    std::fs::remove_file(desk.path("out/convergence.svg")).expect("a file");
    let Answer { code, stderr, .. } = desk.run(&["verify", "out"]);
    assert_eq!(code, Some(1));
    let words = "error: out: does not hold: convergence.svg is missing; study.json is not as it was made; \
                 study.json is not the study that made these results; surf.csv, ";
    assert!(stderr.starts_with(words), "{stderr}");
}

#[test]
fn exact_a_band_and_a_table_are_run_again_too() {
    let desk = Desk::new();
    let mut study = tiny();
    study["optimize"]["objective"] = json!({ "omega": { "from": 6.0, "to": 6.6, "samples": 5 } });
    desk.write_json("band.json", &study);
    desk.good(&["optimize", "band.json", "--quiet", "--out", "all/band"]);
    desk.write_json("study.json", &tiny());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "all/inner/one"]);
    let said = desk.good(&["verify", "all", "--sample", "4"]);
    assert!(said.starts_with("all/band:\n"), "{said}");
    assert!(said.contains("\n  band.csv               4 of 17 rows run again: the same"), "{said}");
    assert!(said.contains("\nall/inner/one:\n"), "{said}");
}

#[test]
fn exact_what_is_no_result_is_refused() {
    let desk = Desk::new();
    desk.write("none/a.txt", "");
    let Answer { code, stderr, .. } = desk.run(&["verify", "none"]);
    let words = "error: none: cannot be read: there is no manifest.json and no study.json in it: these are no results\n";
    assert_eq!((code, stderr.as_str()), (Some(2), words));
    let Answer { code, stderr, .. } = desk.run(&["verify", "nowhere"]);
    assert!(code == Some(2) && stderr.starts_with("error: nowhere: cannot be read: "), "{stderr}");
}

/// `certify`, `fronts` and `retune` say of their own results, too, what made them, and have their rows run again.
#[test]
fn exact_results_of_several_studies_and_certificates_hold_and_a_changed_digit_is_found() {
    let desk = Desk::new();
    let mut study = tiny();
    study["optimize"]["surf"] = json!(null);
    study["optimize"]["vary"] = json!(["k2", "c2"]);
    study["optimize"]["refine"] = json!({ "MaxFunEvals": 8 });
    study["optimize"]["objective"] = json!({ "omega": { "from": 6.0, "to": 6.6, "samples": 2 } });
    desk.write_json("one.json", &study);
    let damper = json!({ "damper": "NES, \"single-sided\"", "study": "one.json" });
    let mut row = damper.clone();
    row["paper"] = json!({ "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 });
    desk.write_json("table2.json", &json!({ "rows": [row] }));
    desk.write_json(
        "fronts.json",
        &json!({ "dampers": [damper], "k2": [300], "stroke": [0.9], "samples": 5 }),
    );
    for (arguments, tables) in [
        (["certify", "one.json"].as_slice(), ["certificate.json"].as_slice()),
        (&["table2", "table2.json"], &["table2.csv"]),
        (&["retune", "3e4", "--study", "table2.json"], &["retune.csv", "retention.csv"]),
        (&["fronts", "fronts.json"], &["k2.csv", "stroke.csv", "front.csv"]),
    ] {
        let out = arguments[0];
        desk.good(&[arguments, &["--quiet", "--out", out]].concat());
        let said = desk.good(&["verify", out]);
        assert!(said.contains("files as they were made\n"), "{said}");
        for table in tables {
            let line = said.lines().find(|line| line.starts_with(&format!("  {table} "))).expect(table);
            assert!(line.ends_with(" run again: the same to the last bit"), "{line}");
            assert!(!line.contains(" 0 of "), "{line}");
            let file = format!("{out}/{table}");
            let whole = desk.read(&file);
            desk.write(&file, altered(&whole));
            let Answer { code, stderr, .. } = desk.run(&["verify", out, "--sample", "1000"]);
            assert_eq!(code, Some(1), "{table}: {stderr}");
            assert!(stderr.contains(&format!("{table} is not as it was made; ")), "{stderr}");
            assert!(stderr.contains(&format!("{table}, 1 differ, by at most ")), "{stderr}");
            desk.write(&file, whole);
        }
    }
}
