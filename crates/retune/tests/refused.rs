//! Bad input: one clear message each, exit code 2, and no file left.

mod common;

use common::{Answer, Desk, tiny};
use serde_json::{Value, json};

/// Runs `optimize` on the tiny study with `value` at `pointer` and expects `message`.
#[track_caller]
fn refused(pointer: &str, value: Value, message: &str) {
    let mut study = tiny();
    *study.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}")) = value;
    refused_text(&study.to_string(), message);
}

/// Runs `optimize` on `text` and expects `message` after the file's name and, if any, the line and column.
#[track_caller]
fn refused_text(text: &str, message: &str) {
    let desk = Desk::new();
    desk.write("bad.json", text);
    let Answer { code, stdout, stderr } = desk.run(&["optimize", "bad.json", "--out", "out"]);
    let said = stderr.strip_prefix("error: bad.json:").unwrap_or_else(|| panic!("{stderr}"));
    let said = said.trim_start_matches(|c: char| c.is_ascii_digit() || c == ':').trim();
    assert_eq!((said, stdout.as_str(), code), (message, "", Some(2)));
    assert_eq!(desk.names("."), ["bad.json"], "nothing may be left behind");
}

#[test]
fn contract_unknown_fields_are_named_with_a_suggestion() {
    let mut study = tiny();
    study["scene"]["primary"]["k3"] = json!(1);
    refused_text(
        &study.to_string(),
        "scene.primary: unknown field `k3`; did you mean `k1`? allowed: m1, c1, k1",
    );
    let mut study = tiny();
    study["optimize"]["refine"]["tolx"] = json!(1);
    refused_text(
        &study.to_string(),
        "optimize.refine: unknown field `tolx`; did you mean `TolX`? \
         allowed: starts, apart, TolX, TolFun, scaled, MaxIter, MaxFunEvals",
    );
    refused(
        "/optimize/vary",
        json!(["c3"]),
        "optimize.vary[0]: \"c3\" is not allowed here; did you mean `c2`? allowed: k2, c2, D, C",
    );
}

#[test]
fn contract_missing_fields_are_named() {
    for (pointer, field, path) in [
        ("/scene/primary", "k1", "scene.primary.k1"),
        ("", "window", "window"),
        ("/scene/damper/contact", "R", "scene.damper.contact.R"),
        ("/optimize", "vary", "optimize.vary"),
    ] {
        let mut study = tiny();
        let parent = study.pointer_mut(pointer).and_then(Value::as_object_mut).expect(pointer);
        parent.remove(field).expect(field);
        refused_text(&study.to_string(), &format!("{path}: missing, and it has no default"));
    }
}

#[test]
fn contract_values_out_of_range_are_named_with_what_is_allowed() {
    refused(
        "/scene/primary/m1",
        json!(-1),
        "scene.primary.m1: -1 is not allowed here: give a finite number above 0",
    );
    refused(
        "/scene/damper/D",
        json!(-0.1),
        "scene.damper.D: -0.1 is not allowed here: give a finite number not below 0",
    );
    refused(
        "/scene/damper/C",
        json!(-1),
        "scene.damper.C: -1 is not allowed here: give a finite number not below 0",
    );
    refused(
        "/scene/damper/contact/nu2",
        json!(0.7),
        "scene.damper.contact.nu2: 0.7 is not allowed here: give a number above -1 and at most 0.5",
    );
    refused("/window/T", json!(0), "window.T: 0 is not allowed here: give a finite number above 0");
    refused("/window/t0", json!(4), "window: t0 = 4 s is not before T = 4 s: the window is empty");
    refused(
        "/optimize/refine/starts",
        json!(0),
        "optimize.refine.starts: 0 is not allowed here: give a whole number above 0",
    );
    let mut study = tiny();
    study["solver"] = json!({ "rtol": 0 });
    refused_text(
        &study.to_string(),
        "solver.rtol: 0 is not allowed here: give a number above 0 and at most 0.1",
    );
    study["solver"] = json!({ "method": "ode45s" });
    refused_text(
        &study.to_string(),
        "solver.method: \"ode45s\" is not allowed here; did you mean `ode45`? allowed: hybrid, ode23s, ode45, ode23, dop853, rk4, euler",
    );
}

#[test]
fn contract_wrong_types_are_named() {
    refused(
        "/scene/damper/k2",
        json!("215"),
        "scene.damper.k2: wrong type: string \"215\", expected a number",
    );
    refused("/scene/damper/k2", Value::Null, "scene.damper.k2: wrong type: null, expected a number");
    refused("/window", json!(100), "window: wrong type: number `100`, expected an object");
    refused("/window", json!([1, 4]), "window: wrong type: list, expected an object");
    refused(
        "/scene/primary",
        json!([1000, 452, 39500]),
        "scene.primary: wrong type: list, expected an object",
    );
    refused(
        "/optimize/surf/k2/points",
        json!(1.5),
        "optimize.surf.k2.points: wrong type: number `1.5`, expected a whole number not below 0",
    );
}

#[test]
fn contract_contradictions_in_a_search_are_named() {
    let from_to = |from: f64, to: f64, points: u64| json!({ "from": from, "to": to, "points": points });
    refused(
        "/optimize/surf/k2",
        from_to(300.0, 200.0, 3),
        "optimize.surf.k2: the range is empty: `from` 300 is above `to` 200",
    );
    refused(
        "/optimize/surf/k2",
        from_to(5.0, 200.0, 3),
        "optimize.surf.k2: from 5 to 200 leaves the bounds [10, 1000]",
    );
    refused(
        "/optimize/surf/k2/from",
        json!(0),
        "optimize.surf.k2: `from` is 0: both ends of a logarithmic axis must be above zero",
    );
    refused(
        "/optimize/bounds/k2",
        json!([400, 100]),
        "optimize.bounds.k2: [400, 100] is not allowed here: give [smallest, largest] with 0 <= smallest < largest",
    );
    refused("/optimize/vary", json!([]), "optimize.vary: empty: name at least one of k2, c2, D, C");
    refused("/optimize/vary", json!(["k2", "C", "k2"]), "optimize.vary: `k2` is named twice");
    refused(
        "/optimize/vary",
        json!(["k2", "c2", "D"]),
        "optimize.surf.C: `C` is not tuned: add it to `vary` or leave it out here",
    );
    refused("/scene/damper", Value::Null, "scene.damper: missing, but `optimize` tunes the damper");
    let mut study = tiny();
    study["optimize"]["surf"] = Value::Null;
    study["scene"]["damper"]["k2"] = json!(5);
    refused_text(
        &study.to_string(),
        "scene.damper.k2: 5 is where the refinement starts, but lies outside the bounds [10, 1000]",
    );
}

#[test]
fn contract_invalid_bands_are_refused() {
    let refused = |objective: Value, message: &str| {
        let mut study = tiny();
        study["optimize"]["objective"] = objective;
        refused_text(&study.to_string(), message);
    };
    refused(
        json!({ "omega": { "from": 8, "to": 5 } }),
        "optimize.objective.omega: from = 8 rad/s is not below to = 5 rad/s: the band is empty",
    );
    refused(
        json!({ "omega": { "from": 5, "to": 8, "samples": 1 } }),
        "optimize.objective.omega.samples: 1 is not allowed here: give a whole number from 2 to 10000",
    );
    refused(
        json!({ "omega": { "from": 0, "to": 8 } }),
        "optimize.objective.omega.from: 0 is not allowed here: give a finite number above 0",
    );
    refused(
        json!({ "omega": { "from": 5, "till": 8 } }),
        "optimize.objective.omega: unknown field `till`; allowed: from, to, samples, relative",
    );
    refused(json!({ "omega": { "from": 5 } }), "optimize.objective.omega.to: missing, and it has no default");
    refused(
        json!({ "omega": 6.5 }),
        "optimize.objective.omega: wrong type: number `6.5`, expected an object",
    );
    refused(
        json!({ "omga": { "from": 5, "to": 8 } }),
        "optimize.objective: unknown field `omga`; did you mean `omega`? allowed: omega, k1, response, settle, ensemble, sum",
    );
    refused(
        json!({ "response": "stead" }),
        "optimize.objective.response: \"stead\" is not allowed here; did you mean `steady`? allowed: window, steady, settled",
    );
}

#[test]
fn contract_a_million_million_points_are_refused_at_once() {
    let mut study = tiny();
    for axis in ["k2", "c2", "D", "C"] {
        study["optimize"]["surf"][axis]["points"] = json!(1000);
    }
    refused_text(&study.to_string(), "optimize.surf: the grid has 1e12 points: at most 10000000 are allowed");
}

#[test]
fn contract_text_that_is_not_json_is_refused() {
    let text = tiny().to_string();
    let number = |replacement: &str| text.replace("\"m1\":1000", replacement);
    refused_text(
        &number("\"m1\":NaN"),
        "not valid JSON at scene.primary.m1: expected a value (a number, \"text\", true, false, null, [...] or {...}; \
         JSON has no NaN or Infinity)",
    );
    refused_text(
        &number("\"m1\":1e999"),
        "not valid JSON at scene.primary.m1: number out of range: its magnitude must be below 1.8e308",
    );
    refused_text(&number("\"m1\":1000,\"m1\":3"), "scene.primary.m1: given twice");
    refused_text("", "not valid JSON: the text ends too early (EOF while parsing a value)");
    refused_text(&format!("{text}}}"), "not valid JSON: there is more text after the end of the study");
    let desk = Desk::new();
    desk.write("bad.json", b"{\"name\":\"\xe9\"}");
    assert_eq!(desk.run(&["check", "bad.json"]).stderr, "error: bad.json: not UTF-8 text (at byte 9)\n");
}

#[test]
fn contract_a_byte_order_mark_is_accepted() {
    let desk = Desk::new();
    desk.write("study.json", format!("\u{feff}{}", tiny()));
    desk.good(&["check", "study.json"]);
}

#[test]
fn contract_missing_files_and_places_that_cannot_be_written_are_named() {
    let desk = Desk::new();
    let Answer { code, stderr, .. } = desk.run(&["check", "none.json"]);
    assert_eq!(code, Some(2));
    assert!(stderr.starts_with("error: none.json: cannot be read: "), "{stderr}");

    desk.write_json("study.json", &tiny());
    desk.write("file", "");
    let Answer { code, stderr, .. } = desk.run(&["optimize", "study.json", "--out", "file/out"]);
    assert_eq!(code, Some(2));
    assert!(stderr.starts_with("error: file/out: cannot be written: "), "{stderr}");

    let Answer { code, stderr, .. } = desk.run(&["simulate", "study.json", "--trajectory", "none/t.csv"]);
    assert_eq!(code, Some(2));
    assert!(stderr.starts_with("error: none/t.csv: cannot be written: "), "{stderr}");
    assert_eq!(desk.names("."), ["file", "study.json"]);
}

#[test]
fn contract_settings_are_checked_like_the_file() {
    let desk = Desk::new();
    desk.write_json("study.json", &tiny());
    for (setting, message) in [
        ("m1=-1", "command line: m1: -1 is not allowed here: give a finite number above 0"),
        ("k2=nan", "command line: k2: NaN is not allowed here: give a finite number not below 0"),
        ("R=0", "command line: R: 0 is not allowed here: give a finite number above 0"),
        ("t0=9", "command line: window: t0 = 9 s is not before T = 4 s: the window is empty"),
    ] {
        let Answer { code, stderr, .. } = desk.run(&["simulate", "study.json", "--set", setting]);
        assert_eq!((code, stderr), (Some(2), format!("error: {message}\n")));
    }
    for (setting, part) in [
        (
            "k3=1",
            "unknown parameter `k3`; did you mean `k1`? allowed: m1, c1, k1, m2, k2, c2, D, C, P, omega, R, T, t0",
        ),
        ("k1", "\"k1\" is not of the form NAME=VALUE, for instance k1=30000"),
        ("k1=soft", "k1: \"soft\" is not a number"),
    ] {
        let Answer { code, stderr, .. } = desk.run(&["simulate", "study.json", "--set", setting]);
        assert_eq!(code, Some(2));
        assert!(stderr.contains(part), "{stderr}");
    }
    let mut bare = tiny();
    bare["scene"]["damper"] = Value::Null;
    bare["optimize"] = Value::Null;
    desk.write_json("bare.json", &bare);
    let Answer { stderr, .. } = desk.run(&["simulate", "bare.json", "--set", "k2=1"]);
    assert_eq!(stderr, "error: command line: k2: the scene has no damper\n");
}

#[test]
fn contract_a_failed_run_exits_with_1_not_2() {
    let mut study = tiny();
    study["solver"] = json!({ "max_steps": 3 });
    let desk = Desk::new();
    desk.write_json("study.json", &study);
    let Answer { code, stderr, .. } = desk.run(&["simulate", "study.json"]);
    assert_eq!(code, Some(1));
    assert!(stderr.starts_with("error: the run failed: the run needed more than 3 steps"), "{stderr}");
    let Answer { code, stderr, .. } = desk.run(&["optimize", "study.json", "--out", "out"]);
    assert_eq!(code, Some(1));
    let part = "no point of the grid could be computed (24 failed; at [100.0, 100.0, 0.05, 0.1]: the run needed more than";
    assert!(stderr.contains(part), "{stderr}");
    assert!(desk.names("out").is_empty(), "no half files, and nothing to go on with");
}

/// One cause and one remedy, immediately: a typing error must not start a run of a day.
#[test]
fn contract_values_that_nobody_means_are_told_with_what_helps() {
    let desk = Desk::new();
    let study = common::studies().join("ssvi.json");
    for (setting, cause, remedy) in [
        ("T=1e300", "lost to rounding at t = 1e300 s", "shorten T"),
        ("T=1e10", "and max_steps is 20000000", "shorten T"),
        (
            "omega=1e300",
            "the motion changes within 1.2e-300 s",
            "lower omega, which makes the motion this fast",
        ),
        ("R=1e-200", "a contact at t = 2.29", "check what it is made of: R, q, E1 to E4"),
        ("m2=1e-6", "at this rate it takes 9.3e9 steps", "lower c2/m2, which makes the motion this fast"),
        ("k1=1e20", "at this rate it takes 1.3e10 steps", "lower k1/m1, which makes the motion this fast"),
        ("P=1e150", "at this rate it takes 1.3e23 steps", "lower P: nearly all steps are those of contacts"),
    ] {
        let begin = std::time::Instant::now();
        let Answer { code, stdout, stderr } =
            desk.run(&["simulate", study.to_str().expect("a path"), "--set", setting]);
        assert!(begin.elapsed().as_secs() < 10, "{setting}: {:?}", begin.elapsed()); // a fraction of a second on an idle machine
        assert_eq!((code, stdout.as_str()), (Some(1), ""), "{setting}: {stderr}");
        assert!(
            stderr.starts_with("error: the run failed: ") && stderr.contains(cause),
            "{setting}: {stderr}"
        );
        assert!(stderr.ends_with(&format!("; {remedy}\n")), "{setting}: {stderr}");
        assert_eq!(stderr.matches(';').count(), 1, "{setting}: {stderr}");
    }
}
