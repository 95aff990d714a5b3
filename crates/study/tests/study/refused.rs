//! Wrong studies: one clear message each, which names the field and what is allowed.

use retune_model::{Absent, Parameter};
use retune_study::read::from_text;
use retune_study::{Rule, Setting, SettingError, StudyError};
use retune_testkit::desk::{Desk, tiny};
use serde_json::{Value, json};

/// What is wrong with this study, without the place in its file.
#[track_caller]
pub fn problem(text: &str) -> String {
    match from_text(text, "bad.json").expect_err("a wrong study") {
        StudyError::Field { file, line, column, problem } => {
            assert!(file == "bad.json" && line > 0, "{file}:{line}:{column}");
            problem
        }
        StudyError::List { file, field } => {
            assert_eq!(file, "bad.json");
            format!("{field}: wrong type: list, expected an object")
        }
        StudyError::Rule { file, rule } => {
            assert_eq!(file, "bad.json");
            rule.to_string()
        }
        other => panic!("{other}"),
    }
}

#[track_caller]
pub fn refused_text(text: &str, message: &str) {
    assert_eq!(problem(text), message);
}

/// The tiny study with `value` at `pointer`.
#[track_caller]
pub fn refused(pointer: &str, value: Value, message: &str) {
    let mut study = tiny();
    *study.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}")) = value;
    refused_text(&study.to_string(), message);
}

/// The walls have one law, and what rigid ones cannot have is refused with what to do.
#[test]
fn contract_wrong_rigid_walls_are_named_with_what_is_allowed() {
    let rigid = |change: &dyn Fn(&mut Value), message: &str| {
        let mut study = tiny();
        study["scene"]["damper"]["contact"] = json!({ "rigid": { "restitution": 0.7 } });
        change(&mut study);
        let found = problem(&study.to_string());
        assert!(found.starts_with(message), "{found}");
    };
    rigid(
        &|study| study["scene"]["damper"]["contact"]["R"] = json!(2),
        "scene.damper.contact: two laws: `rigid` and `R`: give `rigid` alone, or Hertz's surfaces",
    );
    rigid(
        &|study| study["scene"]["damper"]["contact"]["density"] = json!(1200),
        "scene.damper.contact: two laws: `rigid` and `density`: give `rigid` alone, or Hertz's surfaces",
    );
    rigid(
        &|study| study["scene"]["damper"]["contact"]["rigid"]["restitution"] = json!(1.1),
        "scene.damper.contact.rigid.restitution: 1.1 is not allowed here: give a number from 0 to 1",
    );
    rigid(
        &|study| study["solver"] = json!({ "method": "ode23s" }),
        "solver.method: ode23s is not allowed here: give hybrid: the walls are rigid",
    );
    rigid(
        &|study| study["optimize"] = json!({ "vary": ["k2"], "limits": { "contact_force": 1e4 } }),
        "optimize.limits.contact_force: 10000 is not allowed here: give no contact force or pressure: that of an impact with a rigid wall",
    );
    rigid(
        &|study| study["optimize"] = json!({ "vary": ["k2"], "objective": { "quantity": "contact_force" } }),
        "optimize.objective.quantity: contact_force is not allowed here: give no contact force",
    );
    rigid(
        &|study| study["optimize"] = json!({ "vary": ["R"] }),
        "optimize.vary: R is not allowed here: give what the damper has: its walls are rigid, without surfaces",
    );
    rigid(
        &|study| study["scene"]["forcing"]["start"] = json!({ "x1": 0, "v1": 0, "x2": -0.1, "v2": 0 }),
        "scene.forcing.start.x2: -0.1 is not allowed here: give a place from x1 to x1 + D + C",
    );
}

/// A loss is given as a factor, or as a restitution, at one speed or at all.
#[test]
fn contract_wrong_losses_are_named_with_what_is_allowed() {
    let loss = |value: Value, message: &str| {
        let mut study = tiny();
        study["scene"]["damper"]["contact"]["loss"] = value;
        assert_eq!(problem(&study.to_string()), format!("scene.damper.contact.loss{message}"));
    };
    loss(json!({ "lambda": -0.1 }), ".lambda: -0.1 is not allowed here: give a finite number not below 0");
    loss(
        json!({ "restitution": 1.2, "at": 1 }),
        ".restitution: 1.2 is not allowed here: give a number above 0 and at most 1",
    );
    loss(
        json!({ "restitution": 0, "at": 1 }),
        ".restitution: 0 is not allowed here: give a number above 0 and at most 1",
    );
    loss(json!({ "restitution": 0.7, "at": 0 }), ".at: 0 is not allowed here: give a finite number above 0");
    loss(
        json!({ "at": 0.7 }),
        ".restitution: missing: speed after over speed before a collision at the speed `at`",
    );
    loss(
        json!({ "lambda": 1, "restitution": 0.7, "at": 1 }),
        ": give `lambda` (s/m) or `restitution`, not both",
    );
    loss(
        json!({}),
        ": empty: give `lambda` (s/m), or `restitution`, which holds at every speed or at the impact speed `at` (m/s)",
    );
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
        "optimize.vary[0]: \"c3\" is not allowed here; did you mean `c2`? allowed: k2, c2, D, C, m2, R",
    );
}

#[test]
fn contract_missing_fields_are_named() {
    let required = ", and it has no default";
    let walls = ": a damper in a cavity has D, C and contact, one without walls has none of them";
    let hertz = ": give all of R, q, E1, nu1 to E4, nu4 (Hertz's surfaces), or `rigid` alone";
    for (pointer, field, path, rule) in [
        ("/scene/primary", "k1", "scene.primary.k1", required),
        ("", "window", "window", required),
        ("/scene/damper", "C", "scene.damper.C", walls),
        ("/scene/damper", "contact", "scene.damper.contact", walls),
        ("/scene/damper/contact", "R", "scene.damper.contact.R", hertz),
        ("/optimize", "vary", "optimize.vary", required),
    ] {
        let mut study = tiny();
        let parent = study.pointer_mut(pointer).and_then(Value::as_object_mut).expect(pointer);
        parent.remove(field).expect(field);
        refused_text(&study.to_string(), &format!("{path}: missing{rule}"));
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
    for field in ["strength", "density"] {
        let mut study = tiny();
        study["scene"]["damper"]["contact"][field] = json!(0);
        refused_text(
            &study.to_string(),
            &format!("scene.damper.contact.{field}: 0 is not allowed here: give a finite number above 0"),
        );
    }
    refused("/window/T", json!(0), "window.T: 0 is not allowed here: give a finite number above 0");
    refused("/window/t0", json!(4), "window: t0 = 4 s is not before T = 4 s: the window is empty");
    // Once the stroke was lost to rounding, and a linear motion called irregular.
    refused(
        "/scene/damper/D",
        json!(1e9),
        "scene.damper.D: 1000000000 is not allowed here: give at most 1e6 m, beyond which rounding loses the motion; or leave `contact` out: then there is no wall",
    );
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
    study["solver"] = json!({ "search_rtol": 0.2 });
    refused_text(
        &study.to_string(),
        "solver.search_rtol: 0.2 is not allowed here: give a number above 0 and at most 0.1",
    );
    study["solver"] = json!({});
    study["optimize"]["coarse"] = json!({ "rtol": 0.0 });
    refused_text(
        &study.to_string(),
        "optimize.coarse.rtol: 0 is not allowed here: give a number above 0 and at most 0.1",
    );
    study["optimize"]["coarse"] = json!({ "most": 0.0 });
    refused_text(
        &study.to_string(),
        "optimize.coarse.most: 0 is not allowed here: give a finite number above 0",
    );
    study["optimize"]["coarse"] = json!({});
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
    let error = retune_study::read(&desk.path("bad.json")).expect_err("no text");
    assert!(matches!(error, StudyError::NotText { byte: 9, .. }), "{error}");
}

#[test]
fn contract_a_byte_order_mark_is_accepted() {
    let desk = Desk::new();
    desk.write("study.json", format!("\u{feff}{}", tiny()));
    let study = retune_study::read(&desk.path("study.json")).expect("a study");
    assert_eq!(study, from_text(&tiny().to_string(), "study.json").expect("a study"));
}

#[test]
fn contract_a_missing_file_is_named() {
    let desk = Desk::new();
    let path = desk.path("none.json");
    match retune_study::read(&path).expect_err("no file") {
        StudyError::Unreadable { file, source } => {
            assert_eq!((file, source.kind()), (path.display().to_string(), std::io::ErrorKind::NotFound));
        }
        other => panic!("{other}"),
    }
}

#[test]
fn contract_settings_are_checked_like_the_file() {
    let study = from_text(&tiny().to_string(), "study.json").expect("a study");
    for (setting, message) in [
        ("m1=-1", "m1: -1 is not allowed here: give a finite number above 0"),
        ("k2=nan", "k2: NaN is not allowed here: give a finite number not below 0"),
        ("R=0", "R: 0 is not allowed here: give a finite number above 0"),
        ("lambda=-0.3", "lambda: -0.3 is not allowed here: give a finite number not below 0"),
        ("t0=9", "window: t0 = 9 s is not before T = 4 s: the window is empty"),
    ] {
        let setting: Setting = setting.parse().expect("a setting");
        let error = study.with(std::slice::from_ref(&setting)).expect_err("a wrong value");
        assert_eq!(error.to_string(), message);
        assert_eq!(
            matches!(error, SettingError::Rule(Rule::EmptyWindow { .. })),
            message.starts_with("window")
        );
    }
    for (text, error) in [
        ("k3=1", SettingError::Name { name: "k3".into() }),
        ("k1", SettingError::Form { text: "k1".into() }),
        (
            "omega=1kHz",
            SettingError::Number {
                name: Parameter::Omega.into(),
                problem: "\"1kHz\" is not a number in rad/s, nor one with its unit: rad/s, Hz, rpm".into(),
            },
        ),
        (
            "k1=soft",
            SettingError::Number {
                name: Parameter::K1.into(),
                problem: "\"soft\" is not a number in N/m, nor one with its unit: N/m, kN/m, MN/m, N/mm"
                    .into(),
            },
        ),
    ] {
        assert_eq!(text.parse::<Setting>(), Err(error));
    }
    let mut bare = tiny();
    bare["scene"]["damper"] = Value::Null;
    bare["optimize"] = Value::Null;
    let bare = from_text(&bare.to_string(), "study.json").expect("a study");
    assert_eq!(
        bare.with(&[Setting::new(Parameter::K2, 1.0)]),
        Err(SettingError::Absent { name: Parameter::K2, source: Absent::NoDamper })
    );
}
