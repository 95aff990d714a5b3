//! The answer: the damper, what it does, how sure that is, and what to do next.

use super::findings::{Compared, Findings};
use super::numbers::{amount, compared, digits, four, frequency};
use crate::certify::Walls;
use crate::describe::forced;
use crate::needs::{Needs, sized};
use crate::summary::baseline;
use crate::tune::optimum::flags::Flag;
use maud::{Markup, html};
use retune_model::{Measure, Parameter};
use retune_optim::{Evaluation, Response, Unusable};
use retune_report::document::{Block, Section};
use retune_report::html::Table;
use retune_study::over;

/// The answer in a line.
pub fn title(findings: &Findings) -> String {
    let (kind, quantity) = (findings.optimum.damper_type, findings.quantity());
    let (name, value) = (quantity.name(), amount(findings.evaluation.value, quantity));
    if findings.evaluation.violation > 0.0 {
        return format!("none found that keeps the limits; the nearest, a {kind}, has {name} {value}");
    }
    format!("tuned {kind}, {name} {value}")
}

pub fn section(findings: &Findings, compared: &Compared, flags: &[Flag]) -> Section {
    let body = html! {
        (lead(findings))
        @for words in findings.optimum.needs.iter().flat_map(Needs::warnings) { p { strong { "Note: " (words) "." } } }
        @if !flags.is_empty() {
            ul.flags { @for flag in flags { li.flag data-flag=(flag.name) { (flag.words) } } }
        }
        (facts(findings, compared))
        (parameters(findings))
        @if let Some(table) = limits(findings) { (table.markup()) }
        (next(findings, flags))
    };
    ("answer", "The answer", vec![Block::Elements(body)])
}

/// The scope of the objective, in words.
pub fn objective(findings: &Findings) -> String {
    let objective = findings.study.objective();
    let omega = findings.study.scene.forcing.frequency.get();
    let window = findings.study.window;
    let window = format!("{} s to {} s of a run from rest", window.t0.get(), window.end.get());
    let how = |response| match response {
        _ if objective.is_stationary() => "of the stationary random motion under the spectrum".to_owned(),
        Response::Window => format!("in the window from {window}"),
        Response::Settled => "of the settled motion".to_owned(),
        Response::Motions => "of every stable motion that is found".to_owned(),
        Response::Steady => "of the steady motion, in closed form".to_owned(),
    };
    let mut hows: Vec<String> = objective.terms().iter().map(|(_, term)| how(term.response)).collect();
    hows.dedup();
    let over = over(&objective, omega);
    let over = if over.is_empty() { over } else { format!("{over}, ") };
    format!("{over}{}", hows.join(" and "))
}

fn lead(findings: &Findings) -> Markup {
    let (Evaluation { value: energy, .. }, quantity) = (findings.evaluation, findings.quantity());
    let touches = match findings.response.force_max.map(|force| force > 0.0) {
        [true, true] => "strikes both walls of its cavity",
        [true, false] => "strikes the structure, not the obstacle",
        [false, true] => "strikes the obstacle, not the structure",
        [false, false] => "touches neither wall of its cavity",
    };
    let several = findings.study.objective().terms().iter().any(|(_, term)| term.omega.is_some());
    html! {
        p.lead {
            "With this damper " (quantity.words()) ", " (quantity.name()) ", is " strong { (amount(*energy, quantity)) }
            " (" (objective(findings)) "). "
            @if findings.study.scene.forcing.is_transient() {
                "It is " (forced(&findings.study.scene.forcing)) "; the damper " (touches) "."
            } @else {
                @if several { "It is worst at" } @else { "The frequency is" }
                " ω = " strong { (frequency(findings.worst_omega())) } "; there the damper " (touches) "."
            }
        }
    }
}

/// Words and the frequency after them; nothing of a motion without one.
fn placed(words: &str, omega: f64) -> String {
    if omega > 0.0 { format!("{words}{}", frequency(omega)) } else { String::new() }
}

fn facts(findings: &Findings, beside: &Compared) -> Markup {
    let (energy, quantity) = (findings.evaluation.value, findings.quantity());
    let against = |other: &Result<Evaluation, Unusable>| match other {
        Ok(other) => {
            let words = compared(energy, other.value).unwrap_or_else(|| "–".to_owned());
            let worst = placed(", worst at ", other.worst.scene.forcing.frequency.get());
            (words, format!("{}{worst}", amount(other.value, quantity)))
        }
        Err(reason) => ("–".to_owned(), format!("it has no value: {reason}")),
    };
    let none = against(&beside.none);
    let study = against(&beside.study);
    let certificate = &findings.optimum.certificate;
    let verdict = certificate.judged.verdict.map_or("no verdict", |_| findings.optimum.verdict());
    let words = certificate
        .reason()
        .strip_prefix(verdict)
        .map_or(certificate.reason(), |rest| rest.trim_start_matches([':', ',', ' ']));
    let fact = |name: &str, value: &str, more: &str| {
        html! { div { dt { (name) } dd { strong { (value) } @if !more.is_empty() { span.more { (more) } } } } }
    };
    let span = findings.study.window;
    let window = format!("{} s to {} s", span.t0.get(), span.end.get());
    html! {
        dl.facts {
            (fact("Against no damper", &none.0, &none.1))
            (fact(&format!("Against {}", baseline(&findings.study.scene)), &study.0, &study.1))
            (fact("Certificate", verdict, &format!("{words}; methods differ by {} {}", digits(certificate.judged.error_bar, 2), quantity.unit())))
            @if let Some(records) = &certificate.records { (fact("Other records", records.words(), "Values, not bounds")) }
            @if let Some(walls) = &certificate.walls { (fact("Contacts", &contacts(walls, energy, quantity), walls.words())) }
            @if let Some(needs) = &findings.optimum.needs {
                @let say = |name: &str, measure: Measure, what: &str| fact(name, &needs.damper.sized(measure), &format!(
                    "{what}, from rest on{}{}{}", placed(", at ", needs.damper.omega(measure)), in_objective(needs, measure, &window), alternatives(needs, measure)
                ));
                (say("Stroke", Measure::Stroke, "largest spring deflection |x2 − x1 − D|"))
                (say("Contact force", Measure::ContactForce, "largest force on a wall"))
                (say("Displacement", Measure::Displacement, "largest |x1| of the structure"))
                (say("Acceleration", Measure::Acceleration, "largest |a1| of the structure"))
                (say("Force on the ground", Measure::GroundForce, "largest |k1 x1 + c1 v1|"))
            }
            (fact("Motion", &findings.measured().motion.regime, &format!("at the worst frequency it {}", findings.measured().motion.sentence)))
        }
    }
}

/// The worst value with other restitutions, in short.
fn contacts(walls: &Walls, nominal: f64, quantity: Measure) -> String {
    walls.worst().map_or("no value with a loss".to_owned(), |(e, worst)| {
        let percent = 100.0 * (worst.value / nominal - 1.0);
        let sign = if percent > 0.0 { "+" } else { "" };
        let change = digits(percent, 3);
        format!("{} at e = {e} ({sign}{change} %)", amount(worst.value, quantity))
    })
}

/// The value in the part of the response that the objective covers, where that is smaller.
fn in_objective(needs: &Needs, measure: Measure, window: &str) -> String {
    let value = needs.damper.own(measure);
    value.map_or(String::new(), |value| format!("; {} in the objective ({window})", sized(measure, value)))
}

/// The value without a damper and with the best TMD.
fn alternatives(needs: &Needs, measure: Measure) -> String {
    let linear =
        needs.linear.as_ref().map(|linear| format!("; {} with the best TMD", linear.needs.sized(measure)));
    let damper = measure.is_of_damper();
    let none = needs.none.as_ref().filter(|_| !damper);
    let none = none.map(|none| format!("; {} without a damper", none.sized(measure)));
    none.unwrap_or_default() + &linear.unwrap_or_default()
}

fn parameters(findings: &Findings) -> Markup {
    let Some(damper) = findings.tuned.damper else { return html! {} };
    let varied = &findings.search.variables;
    let baseline = baseline(&findings.study.scene);
    let mut table = Table::new("The damper", &format!("symbol | name | value | unit | {baseline} | tuned"));
    let mut shown = vec![Parameter::M2];
    shown.extend(Parameter::columns(varied).into_iter().filter(|one| *one != Parameter::M2));
    for parameter in shown {
        let Some(value) = parameter.of_damper(&damper) else { continue };
        let before = four(parameter.of(&findings.study.scene).unwrap_or(f64::NAN));
        let tuned = if varied.contains(&parameter) { "tuned" } else { "given" };
        table.row([parameter.symbol(), parameter.words(), &four(value), parameter.unit(), &before, tuned]);
    }
    table.markup()
}

fn limits(findings: &Findings) -> Option<Table> {
    let note = findings.optimum.limits.as_ref()?;
    let mut table = Table::new("Limits", "limit | largest in any run | allowed | unit | state");
    for &(limit, reached) in &note.reached {
        let Some(allowed) = note.allowed.get(limit) else { continue };
        let state = match (reached > allowed, note.active.contains(&limit)) {
            (true, _) => "broken",
            (_, true) => "kept, and it determines the design",
            _ => "kept",
        };
        table.row([limit.name(), &four(reached), &four(allowed), limit.unit(), state]);
    }
    Some(table)
}

/// The next steps: the changes that flags ask for, and checks before the design is built.
fn next(findings: &Findings, flags: &[Flag]) -> Markup {
    let changes: Vec<&str> = flags.iter().filter_map(|flag| flag.change.as_deref()).collect();
    let (omega, k1) = (findings.worst_omega(), findings.worst.primary.stiffness);
    let other = k1 != findings.study.scene.primary.stiffness;
    let k1 = if other { format!(" --set k1={}", k1.get()) } else { String::new() };
    let (at, set) = if omega > 0.0 {
        (" at the worst frequency", format!(" --set omega={omega}"))
    } else {
        ("", String::new())
    };
    let simulate = format!("retune simulate optimum.json{set}{k1} --trajectory motion.csv");
    html! {
        h3 { "What to do next" }
        @if !changes.is_empty() {
            p { "Give " code { "study.json" } " " (changes.join("; ")) ", and search again:" }
            pre { code { "retune optimize study.json --out again" } }
        }
        p { "Look at the motion" (at) ", row by row:" }
        pre { code { (simulate) } }
        p { "Compute a sample of these results again, on your machine:" }
        pre { code { "retune verify ." } }
        p.note { "All commands are for the directory of this page." }
    }
}
