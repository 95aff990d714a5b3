//! What a page writes down: studies, commands, runs, figures and reports.

use crate::session::{place, start};
use retune_explore::protocol::{Answer, DamperKind, Place, What, Write};
use retune_explore::start::Start;
use retune_explore::{Refused, texts};
use retune_jobs::simulate::simulate;
use retune_model::Measure;
use serde_json::Value;

/// A place written down.
fn written(
    start: &Start,
    place: &Place,
    what: What,
    pins: [Option<Place>; 2],
    quantity: Option<Measure>,
) -> Result<Answer, Refused> {
    texts::written(start, &Write { place: place.clone(), what, pins, quantity }, &|| false)
}

fn words(written: &Answer) -> String {
    written.get("text").and_then(Value::as_str).expect("text").to_owned()
}

pub fn text(start: &Start, place: &Place, what: What) -> String {
    words(&written(start, place, what, [None, None], None).expect("written"))
}

/// A saved study is a study file, with the numbers of the page, whichever damper hangs there.
#[test]
fn contract_a_saved_study_is_read_again() {
    for (damper, set) in [
        (DamperKind::Ssvi, &[("k2", 300.0), ("omega", 6.5)][..]),
        (DamperKind::Tmd, &[("k2", 450.0)][..]),
        (DamperKind::None, &[("P", 500.0)][..]),
    ] {
        let place = place(damper, set);
        let text = text(&start(), &place, What::Study);
        let text = text.as_str();
        let study = retune_study::read::from_text(text, "saved.json").expect("a study");
        assert_eq!(study.scene, start().at(&place).expect("a place").scene, "{damper:?}");
    }
    let outside =
        written(&start(), &place(DamperKind::Ssvi, &[("k2", -5.0)]), What::Study, [None, None], None);
    assert_eq!(outside.expect_err("refused").field.as_deref(), Some("k2"));
}

#[test]
fn contract_the_command_line_says_what_differs() {
    let named =
        Start::read(Some(std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src/study.json"))));
    let named = named.expect("a study");
    let here = place(DamperKind::Ssvi, &[("k2", 300.0), ("c2", 232.0)]);
    assert!(text(&named, &here, What::Command).ends_with("src/study.json --set k2=300"));
    assert!(text(&named, &here, What::Python).contains(".at(k2=300)\nrun = problem.simulate()"));
    let other = place(DamperKind::Tmd, &[("k2", 300.0)]);
    assert!(text(&named, &other, What::Command).starts_with("retune simulate study-explored.json  #"));
    assert!(text(&start(), &here, What::Motion).starts_with("t,x1,v1,x2,v2,E1,E2,FconL,FconR,moment\n50,"));
    for what in [What::Picture, What::Response] {
        assert!(text(&start(), &here, what).starts_with("<svg "));
    }
}

/// What is saved of a run is what `retune simulate --json` prints; the report has what the page shows.
#[test]
fn contract_the_run_and_a_report_are_saved() {
    let here = place(DamperKind::Ssvi, &[("k2", 300.0)]);
    let run = simulate(&start().file_at(&here).expect("a study"), None).expect("a run");
    let printed = retune_jobs::answer::text(&run).expect("JSON");
    assert_eq!(text(&start(), &here, What::Json), format!("{printed}\n"));
    let pins = [Some(place(DamperKind::Tmd, &[("k2", 500.0)])), None];
    let page = words(&written(&start(), &here, What::Report, pins, Some(Measure::Stroke)).expect("written"));
    let escaped = run.to_string().replace('<', "&lt;");
    for part in [
        escaped.as_str(),
        "stroke over frequency",
        "&quot;k2&quot;: 300.0",
        "A, worst",
        "<svg",
        "retune explore",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("B, worst") && !page.contains("<script"));
}

/// A figure of the response has what the page has: each curve, and which design it is.
#[test]
fn contract_a_figure_has_the_pinned_designs() {
    let pin = |k2: f64| Some(place(DamperKind::Ssvi, &[("k2", k2)]));
    let here = place(DamperKind::Ssvi, &[]);
    let text = |pins| words(&written(&start(), &here, What::Response, pins, None).expect("written"));
    let lines = |text: &str| text.matches("<path").count();
    let (alone, both) = (text([None, None]), text([pin(300.0), pin(450.0)]));
    assert!(lines(&both) >= lines(&alone) + 2, "{} {}", lines(&alone), lines(&both));
    for words in [" = 300 N/m", " = 450 N/m"] {
        assert!(both.contains(words) && !alone.contains(words), "{words}");
    }
    let second = text([None, pin(450.0)]);
    assert!(second.contains(">B<") && !second.contains(">A<"));
    let wrong = written(&start(), &here, What::Response, [pin(-1.0), None], None);
    assert_eq!(wrong.expect_err("refused").field.as_deref(), Some("k2"));
}
