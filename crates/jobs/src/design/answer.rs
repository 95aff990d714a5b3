//! The answer of `design` in words, on screen and on its page. Lines on screen fit 80 columns.

use super::Formula;
use super::candidate::{Candidate, OtherSign, What};
use super::comparison::Comparison;
use super::requirements::{Constraint, Dampers, Requirements};
use super::ssvi::is_lossy;
use super::words::{alike, frequency, legible, limit, parameters, percent, sized, tuning, wrap_at_spaces};
use crate::summary::as_much;
use retune_model::Measure;
use retune_optim::{Limit, Need};
use retune_study::{counted, rounded};
use std::path::Path;

/// A transient value that exceeds a limit by more than this share is reported.
const ABOVE: f64 = 1e-3;

pub(super) fn answer(requirements: &Requirements, compared: &Comparison, out: &Path) -> String {
    let broken = wrap_at_spaces();
    let fill = |line: String| textwrap::fill(&line, &broken);
    let words = build(requirements, compared).into_iter().chain(findings(requirements, compared));
    let out = out.display();
    let words: Vec<String> = words.map(fill).collect();
    let next = format!("Open {out}/report.html. Go on:\n  `retune explore {out}/{}`", next(compared));
    format!("{}\n\n{}\n{next}", table(requirements, compared), words.join("\n"))
}

/// The study file to continue with.
fn next(compared: &Comparison) -> String {
    format!("studies-{}.json", compared.chosen().unwrap_or(&compared.tmd).study.name())
}

/// The rows of the comparison: a quantity with its limit, then the value of each candidate and its frequency.
pub(super) fn rows(requirements: &Requirements, compared: &Comparison) -> Vec<Vec<String>> {
    // Under a shock or a record limits apply from rest on, even if largest values count only later.
    let later = is_later(requirements);
    let allowed = |measure: Measure| {
        let constraint = Constraint::Of(Limit::Of(measure));
        let allowed = requirements.allowed(constraint);
        if allowed.is_nan() { String::new() } else { format!(" <= {}", sized(allowed, constraint.unit())) }
    };
    let row = |measure: Measure| {
        let allowed = if later { String::new() } else { allowed(measure) };
        let first = format!("{}{allowed}", measure.name().replace('_', " "));
        let values: Vec<f64> = compared.all().map(|of| of.value(measure)).collect();
        let cell = |(of, value): (&Candidate, String)| {
            let Need { value: steady, omega, .. } = of.steady.get(measure);
            match steady {
                0.0 => "-".to_owned(),
                _ if !steady.is_finite() || of.is_transient() => value,
                _ => format!("{value}, {}", frequency(omega, requirements.frequencies)),
            }
        };
        std::iter::once(first).chain(compared.all().zip(alike(&values, measure.unit())).map(cell)).collect()
    };
    let from_rest = |measure: Measure| {
        let first = format!("from rest: {}{}", measure.name().replace('_', " "), allowed(measure));
        let values: Vec<f64> = compared.all().map(|of| of.most().get(measure).value).collect();
        let cell = |(value, text): (&f64, String)| if *value == 0.0 { "-".to_owned() } else { text };
        std::iter::once(first).chain(values.iter().zip(alike(&values, measure.unit())).map(cell)).collect()
    };
    let reported = || compared.measures().filter(|measure| is_reported(requirements, compared, *measure));
    let mut rows: Vec<Vec<String>> = reported().map(row).collect();
    if later {
        let matters = |measure: &Measure| {
            Measure::OF_DAMPER.contains(measure) || measure.is_of_walls() || requirements.is_limited(*measure)
        };
        rows.extend(reported().filter(matters).map(from_rest));
    }
    if let Some(error) = requirements.k1_error {
        let off = ["-", "+"].map(|sign| format!("{sign}{}", percent(error)));
        for (place, k1) in std::iter::once("as given".to_owned()).chain(off).enumerate() {
            let first = format!("{}, k1 {k1}", compared.goal.name());
            let values = compared.detuned.iter().map(|values| sized(values[place], compared.goal.unit()));
            rows.push(std::iter::once(first).chain(values).collect());
        }
    }
    rows
}

/// Whether largest values count only from some time on after a shock or in a record.
fn is_later(requirements: &Requirements) -> bool {
    requirements.run().is_some_and(|run| run.from > 0.0)
}

fn table(requirements: &Requirements, compared: &Comparison) -> String {
    let first = if compared.none.is_transient() { "largest" } else { "largest, where" };
    let head: Vec<String> =
        std::iter::once(first.to_owned()).chain(compared.all().map(|of| of.what.name().to_owned())).collect();
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(rows(requirements, compared)).collect();
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let wide = |i: usize| {
        rows.iter().filter_map(|row| row.get(i)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(wide).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().enumerate().map(|(i, cell)| {
            let width = widths[i];
            if i == 0 { format!("{cell:<width$}") } else { format!("  {cell:>width$}") }
        });
        cells.collect::<String>().trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Whether a quantity is reported: those of wall contacts only if a candidate strikes a wall or the quantity is limited.
pub(super) fn is_reported(requirements: &Requirements, compared: &Comparison, measure: Measure) -> bool {
    let most =
        |of: &Candidate| if of.is_transient() { of.most().get(measure).value } else { of.value(measure) };
    let felt = || compared.all().any(|of| most(of) != 0.0);
    !measure.is_of_walls() || requirements.is_limited(measure) || felt()
}

/// Which damper to build, and why.
pub(super) fn build(requirements: &Requirements, compared: &Comparison) -> Vec<String> {
    let Some(chosen) = compared.chosen() else { return infeasible(requirements, compared) };
    if compared.is_in_vain() {
        return in_vain(compared, chosen);
    }
    let goal = compared.goal;
    let with_unit = |goal_of: f64| sized(goal_of, goal.unit());
    let (name, tuned) = (goal.name(), with_unit(chosen.goal));
    let times = compared.none.goal / chosen.goal;
    let reduction = if times.is_finite() {
        let none = with_unit(compared.none.goal);
        let less = if times < 1.1 {
            format!("{} less", percent(1.0 - 1.0 / times))
        } else {
            format!("{} times less", rounded(times, 3))
        };
        format!("{name} falls from {none} to {tuned}, {less}")
    } else {
        format!("{name} is {tuned}, and has no bound without a damper")
    };
    let why = match (chosen.what, &compared.ssvi, requirements.dampers) {
        (_, _, Dampers::Tmd) => String::new(),
        (What::Tmd, Some(ssvi), _) if !ssvi.feasible => {
            "; no SSVI NES was found that keeps the limits".to_owned()
        }
        (What::Tmd, Some(ssvi), _) if ssvi.goal < chosen.goal => {
            let has = format!("; an SSVI NES has {}", with_unit(ssvi.goal));
            let other = compared.other_sign.as_ref().filter(|_| requirements.driving.has_either_sign());
            match (&compared.ssvi_certificate, other) {
                (Some(_), Some(OtherSign { goal: other, .. })) if *other > chosen.goal => {
                    format!("{has}, but {} with the other sign of the record", with_unit(*other))
                }
                (Some(_), Some(OtherSign { broken, .. })) if !broken.is_empty() => {
                    format!("{has}, but breaks a limit with the other sign of the record")
                }
                (Some(certificate), _) => {
                    format!("{has}, but cannot be trusted: {}", legible(certificate.reason()))
                }
                (None, _) => {
                    let share = 1.0 - ssvi.goal / chosen.goal;
                    let less =
                        if share < 1e-4 { "as much".to_owned() } else { format!("{} less", percent(share)) };
                    format!("{has}, {less}, for which alone walls are not worth it")
                }
            }
        }
        (What::Tmd, Some(ssvi), _) => {
            let (has, as_much) = (with_unit(ssvi.goal), as_much(ssvi.goal / chosen.goal));
            let (steady, most) = (ssvi.value(Measure::ContactForce), ssvi.most().get(Measure::ContactForce));
            let strikes = if steady > 0.0 {
                format!("strikes its walls with {}", sized(steady, "N"))
            } else {
                format!("strikes its walls only on the way from rest, with {}", sized(most.value, "N"))
            };
            format!("; the best SSVI NES that was found has {has}, {as_much}, and {strikes}")
        }
        (What::Tmd, None, _) => {
            "; of the SSVI NES that were tried, none that strikes its walls comes near".to_owned()
        }
        (_, _, Dampers::Ssvi) => format!("; the best TMD has {}", with_unit(compared.tmd.goal)),
        _ if compared.tmd.feasible => {
            let (has, as_much) = (with_unit(compared.tmd.goal), as_much(compared.tmd.goal / chosen.goal));
            format!("; the best TMD has {has}, {as_much}")
        }
        _ => "; no TMD of this mass was found that keeps the limits".to_owned(),
    };
    let mut lines = vec![
        format!("Build the {}: {}.", chosen.what.name(), parameters(chosen)),
        format!("  Alone, on a rigid support, it has {}. {reduction}{why}.", tuning(chosen, requirements)),
    ];
    if chosen.what == What::Tmd {
        lines.extend(compared.formulas.iter().map(|formula| beside(formula, chosen.goal, goal)));
    }
    lines
}

/// Words that no damper lowers the goal notably.
fn in_vain(compared: &Comparison, best: &Candidate) -> Vec<String> {
    let (goal, what) = (compared.goal, best.what.name());
    let [none, tuned] = [compared.none.goal, best.goal].map(|value| sized(value, goal.unit()));
    let words = format!(
        "  {} is {none} without a damper and {tuned} with the best {what} that was found. Look at the other rows: another --goal may fall, or take more --mass.",
        goal.name()
    );
    vec![format!("Build no damper for this: none was found that lowers {} by 0.1 %.", goal.name()), words]
}

/// The TMD of a formula compared with the best TMD, in words.
fn beside((formula, tmd): &(Formula, Candidate), best: f64, goal: Measure) -> String {
    let more = tmd.goal / best - 1.0;
    let beside = match tmd.feasible {
        false => ", but breaks a limit".to_owned(),
        true if more > 5e-4 => format!(", {} more", percent(more)),
        true => String::new(),
    };
    let Formula { name, k2, c2 } = *formula;
    let (k2, c2, has) = (sized(k2, "N/m"), sized(c2, "N·s/m"), sized(tmd.goal, goal.unit()));
    format!("  {name} (k2 = {k2}, c2 = {c2}) gives {has}{beside}.")
}

/// Words that no design keeps the limits, and the mass that would.
fn infeasible(requirements: &Requirements, compared: &Comparison) -> Vec<String> {
    let broken = |of: &Candidate| {
        let all = of.binding.iter().filter(|(limit, value)| {
            of.study.goal().limits.get(*limit).is_some_and(|allowed| *value > allowed)
        });
        let words = all.map(|(limit, value)| format!("{} {}", limit.name(), sized(*value, limit.unit())));
        format!("{} has {}", of.what.name(), words.collect::<Vec<_>>().join(" and "))
    };
    let nearest: Vec<String> = compared.dampers().map(broken).collect();
    let mut lines = vec![format!(
        "None was found that keeps the limits. The nearest {}.",
        nearest.join("; the nearest ")
    )];
    let share = |mass: f64| percent(mass / requirements.m1);
    lines.push(match compared.lightest {
        Some(mass) => format!(
            "  A TMD of {} ({}) keeps them: give --mass {}.",
            sized(mass, "kg"),
            share(mass),
            share(mass * 1.01).replace(' ', "")
        ),
        None => "  Nor was a TMD of up to 30 % of the structure found that does: loosen a limit.".to_owned(),
    });
    lines
}

/// The cost of each limit, the certainty of the answer, and the assumptions.
pub(super) fn findings(requirements: &Requirements, compared: &Comparison) -> Vec<String> {
    let mut lines: Vec<String> = costs(requirements, compared);
    lines.extend(from_rest(requirements, compared));
    if let Some(certificate) = compared.certificate.as_ref().filter(|_| !compared.is_in_vain()) {
        let words = legible(certificate.reason().trim_end_matches("; other starts not looked at"));
        let name = compared.chosen().map_or("", |chosen| chosen.what.name());
        let further = compared.chosen().is_some_and(|chosen| is_lossy(&chosen.study.scene));
        let further = if further { " `retune certify` looks at more starts, and at more force." } else { "" };
        lines.push(format!("How sure: the {name} is {words}.{further}"));
        let walls = certificate.walls.as_ref();
        lines.extend(walls.map(|walls| format!("Other walls: {}.", legible(walls.facts()))));
    }
    let unsettled = compared.ssvi.as_ref().filter(|ssvi| ssvi.study.unsettled().is_some());
    if let Some(held) = unsettled.and_then(|ssvi| ssvi.study.transient()) {
        lines.push(format!("Not settled: of the SSVI NES, {held}."));
    }
    lines.extend(
        compared.warnings.iter().map(|warning| format!("Walls of the SSVI NES: {}.", legible(warning))),
    );
    if let (Some(OtherSign { goal: other, broken }), Some(What::Ssvi)) =
        (&compared.other_sign, compared.choice)
    {
        let other = *other;
        let (name, unit, tmd) = (compared.goal.name(), compared.goal.unit(), &compared.tmd);
        let breaks = |(limit, value): &(Limit, f64)| {
            let (name, has) = (limit.name().replace('_', " "), sized(*value, limit.unit()));
            format!("; it breaks the limit of {name}: {has}")
        };
        let broken: String = broken.iter().map(breaks).collect();
        let more = if tmd.feasible && other > tmd.goal {
            format!(
                ", more than the {} of the TMD with either: build it where the sign is known",
                sized(tmd.goal, unit)
            )
        } else {
            String::new()
        };
        lines.push(format!(
            "With the other sign of the shock or record it has {name} {}{more}{broken}.",
            sized(other, unit)
        ));
    }
    if let Some(tried) = compared.tried {
        let tried = counted(tried as u64, "design");
        let walls = requirements.contact().map(|contact| contact.stiffness().map(|k| format!("{k:.2e}")));
        let [k1, k3] = walls.unwrap_or_default();
        let origin = requirements.wall.map_or(
            "not given (--wall): the paper's, scaled to mass, frequency and displacement".to_owned(),
            |wall| {
                let (radius, modulus) = (sized(wall.radius, "m"), sized(wall.modulus, "Pa"));
                let loss =
                    wall.restitution.map_or(String::new(), |e| format!(", restitution {}", rounded(e, 4)));
                format!("as given, R = {radius}, E = {modulus}{loss}, against steel")
            },
        );
        lines.push(format!(
            "Walls of the SSVI NES: {origin}, K = {k1} and {k3} N/m^1.5. {tried} with walls evaluated; `retune optimize` of the study looks further."
        ));
    }
    lines
}

fn costs(requirements: &Requirements, compared: &Comparison) -> Vec<String> {
    let goal = compared.goal;
    let goal_of = |of: &Candidate| sized(of.goal, goal.unit());
    let cost = |limited: &Candidate, free: &Candidate| {
        let (more, name) = (limited.goal / free.goal - 1.0, limited.what.name());
        // Without the limit the SSVI NES was searched only from the design with it.
        let least = if limited.what == What::Ssvi { "at least " } else { "" };
        let instead = format!("({} instead of {})", goal_of(limited), goal_of(free));
        if more >= 1.0 {
            format!(
                "makes {} of the {name} {least}{} times as large {instead}",
                goal.name(),
                rounded(1.0 + more, 3)
            )
        } else if more > 1e-6 {
            format!("costs the {name} {least}{} {instead}", percent(more))
        } else if least.is_empty() {
            format!("costs the {name} nothing")
        } else {
            format!("costs the {name} nothing that was found")
        }
    };
    let line = |of: &super::comparison::Cost| {
        let mut words = Vec::new();
        if compared.tmd.feasible {
            words.push(cost(&compared.tmd, &of.tmd));
        } else if of.tmd.feasible {
            let (name, has) = (goal.name(), goal_of(&of.tmd));
            let others = if compared.costs.len() > 1 { " with the others" } else { "" };
            words.push(format!(
                "is one that no TMD of this mass was found to keep{others}: without it {name} is {has}"
            ));
        }
        if let Some(limited) = compared.chosen().filter(|chosen| chosen.what == What::Ssvi) {
            let stays = || "the SSVI NES stays below it".to_owned();
            words.push(of.ssvi.as_ref().map_or_else(stays, |free| cost(limited, free)));
        }
        let name = limit(requirements, of.constraint);
        (!words.is_empty()).then(|| format!("The limit {name} {}.", words.join("; ")))
    };
    compared.costs.iter().filter_map(line).collect()
}

/// Limits that the transient from rest exceeds.
fn from_rest(requirements: &Requirements, compared: &Comparison) -> Option<String> {
    // Under a shock or a record limits apply from rest on.
    let chosen = compared.chosen().filter(|chosen| !chosen.is_transient())?;
    let above = requirements.limits.set().filter_map(|limit| {
        let Limit::Of(measure) = limit else { return None };
        let (value, allowed) = (chosen.most().get(measure).value, requirements.limits.get(limit)?);
        (value > (1.0 + ABOVE) * allowed)
            .then(|| format!("{} {}", measure.name().replace('_', " "), sized(value, measure.unit())))
    });
    let above: Vec<String> = above.collect();
    let words = "Limits hold for the steady motion; just after the force sets in, from rest";
    (!above.is_empty()).then(|| format!("{words}: {}.", above.join(", ")))
}
