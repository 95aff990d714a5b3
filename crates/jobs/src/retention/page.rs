//! The page of `retention`. It begins with the answer, as on screen: which damper stays effective, at equal performance at the nominal k1,
//! under the same bound on k2, and under a smaller force. Every number comes from the tables beside the page.

use super::curves::{Curve, cliffs};
use super::draw;
use super::force::{Forced, GAPS, HALF, amplitude};
use super::range::Range;
use super::retained::{EQUAL, Retained};
use super::trade::Point;
use super::tuned::{CURVES, DESIGNS, FORCES, OWN, RANGES, STILL, Tuning};
use crate::designs::Row;
use crate::fronts::SAME;
use crate::{Error, pages};
use retune_model::{Design, Measure, Parameter};
use retune_report::document::{Block, Document};
use retune_store::Directory;
use retune_study::{SpringBounds, design_words, rounded, short};

pub(super) fn write(retained: &Retained, directory: &Directory) -> Result<(), Error> {
    let words = "E1max, worst over each structure's own band, against its stiffness";
    let mut energy = vec![
        Block::figure("retention.svg", draw::retention(retained, OWN), words),
        worst(retained),
        jumps(retained),
    ];
    if retained.curves.iter().any(|curve| curve.band == STILL) {
        let words = "The same with the band of frequencies where it is at the nominal k1";
        energy.push(Block::figure("still.svg", draw::retention(retained, STILL), words));
    }
    let words = "The least E1max at the nominal k1 against the retention range";
    let range = vec![
        Block::figure("range.svg", draw::range(retained), words),
        Block::words(RULE.to_owned() + if retained.varies_mass() { MASS } else { "" }),
        ranges(retained),
        Block::List(retained.shown().into_iter().map(|damper| traded(retained, damper)).collect()),
    ];
    let words = "E1max of the nominal designs as a share of that without a damper";
    let mut force = vec![Block::figure("force.svg", draw::force(retained), words), forces(retained)];
    if retained.forced.is_empty() {
        force = vec![Block::words("What moves the structure has no amplitude that could be smaller.")];
    }
    let words = "The re-tuned designs against k1";
    let designs = vec![designs(retained), Block::figure("path.svg", draw::path(retained), words)];
    let files = [DESIGNS, CURVES, RANGES, FORCES, "resolved.json", "manifest.json"];
    let page = Document {
        title: "How long a tuning lasts".to_owned(),
        command: "retune retention",
        opening: vec![Block::List(answer(retained)), Block::words(compared(retained))],
        sections: vec![
            ("range", "Retention range", range),
            ("force", "A smaller force", force),
            ("energy", "E1max along k1", energy),
            ("designs", "Designs", designs),
            ("data", "Data", vec![Block::files(&files)]),
        ],
    };
    pages::write(&page, directory)
}

const RULE: &str = "A damper does its work at a stiffness k1 if its reduction, 10 lg(E1max without damper / E1max), is at least half of that of the \
    best TMD of the same mass for that k1, with k2 and c2 free. It keeps its work over its retention range, the interval about the nominal k1 in \
    which it does. The range is looked for in steps of 2 % from 0.2 to 5 times the nominal k1; where it reaches so far its end is marked with >. It is \
    counted by the factor by which k1 may rise and fall, the smaller of its two sides.";

/// Added where the mass is varied.
const MASS: &str = " Where m2 is varied, this TMD has the mass of the damper in the study.";

fn compared(Retained { dampers, bounds, .. }: &Retained) -> String {
    let Some(first) = dampers.first() else { return String::new() };
    let samples = first.samples.map(|samples| format!(" on {samples} frequencies")).unwrap_or_default();
    format!(
        "Each design is compared by its E1max, {}{samples}, at each stiffness k1 of the structure. The nominal k1 is {} N/m; a k1-robust design is \
         tuned for the worst over {} N/m, a re-tuned one for each of them, with bounds on k2 {}.",
        pages::over(first.study()),
        short(first.nominal()),
        retune_study::joined(&first.anew.iter().map(|(k1, _)| short(*k1)).collect::<Vec<_>>(), ", "),
        match bounds {
            SpringBounds::Scaled => "in proportion to k1",
            SpringBounds::Fixed => "that stay as they are",
        }
    )
}

/// The answer: the comparisons of all dampers first, then a line for each damper.
pub(super) fn answer(retained: &Retained) -> Vec<String> {
    let shown = retained.shown();
    let first = [home(retained, &shown), robust(retained, &shown), smaller_force(retained, &shown)];
    let mut words: Vec<String> = first.into_iter().flatten().collect();
    words.extend(shown.iter().map(|&damper| one(retained, damper)));
    words.extend(retained.same().into_iter().map(|(damper, other)| {
        format!(
            "{}: every tuning ends at E1max of the {} within {} %, so that one stands for both on this page.",
            retained.name(damper),
            retained.name(other),
            100.0 * EQUAL
        )
    }));
    words
}

/// The retention ranges at equal performance at the nominal k1: at most the largest E1max there of the nominal designs that have a range.
fn home(retained: &Retained, shown: &[usize]) -> Option<String> {
    let nominal = |damper: &usize| {
        let is_nominal = |point: &&Point| point.damper == *damper && point.tuning == Tuning::Nominal;
        retained.kept.iter().find(is_nominal).filter(|point| point.range().is_some())
    };
    let home = shown.iter().filter_map(nominal).map(|point| point.e1_max).reduce(f64::max)?;
    let widest = |damper: &usize| {
        let as_good = |point: &&Point| point.e1_max <= (1.0 + SAME) * home;
        retained.front(*damper).into_iter().rfind(as_good)
    };
    let mut all: Vec<&Point> = shown.iter().filter_map(widest).collect();
    all.sort_by(|a, b| b.factor().total_cmp(&a.factor()));
    let words: Vec<String> = all.iter().map(|point| keeps(retained, point)).collect();
    let none: Vec<&str> = shown
        .iter()
        .filter(|damper| all.iter().all(|point| point.damper != **damper))
        .map(|damper| retained.name(*damper))
        .collect();
    let none = if none.is_empty() {
        String::new()
    } else {
        format!("; none of the designs that were found as {} does its work at home", none.join(" or "))
    };
    Some(format!(
        "At equal performance at home (at most {} J at the nominal k1, to 1 %) a damper keeps its work while k1 changes by a factor of {}{none}.",
        rounded(home, 3),
        words.join(", ")
    ))
}

fn keeps(retained: &Retained, point: &Point) -> String {
    let still = point.ranges[STILL].map_or(String::new(), |range| {
        let factor = rounded(range.factor(), 3);
        format!("; {factor} where the band of frequencies stays as it is at the nominal k1")
    });
    format!(
        "{}: {} ({} J, {}{still})",
        rounded(point.factor(), 3),
        retained.name(point.damper),
        rounded(point.e1_max, 4),
        design_words(&point.at, 4)
    )
}

/// The k1-robust designs, grouped by their bound on k2.
fn robust(retained: &Retained, shown: &[usize]) -> Option<String> {
    let worst = |damper: &usize| {
        let (of, name) = (&retained.dampers[*damper], Tuning::Robust.name());
        let row = retained.table.rows.iter().find(|row| row.damper == of.name && row.label == name)?;
        let optimize = of.study().optimize.as_ref();
        let stiffest = optimize.and_then(|optimize| optimize.bounds.get(Parameter::K2)?.1);
        Some((stiffest.unwrap_or(f64::INFINITY), row.e1_max, of.name.as_str()))
    };
    let mut all: Vec<(f64, f64, &str)> = shown.iter().filter_map(worst).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let parts = all.chunk_by(|a, b| a.0 == b.0).map(|same| {
        let list: Vec<String> =
            same.iter().map(|(_, worst, name)| format!("{} J ({name})", rounded(*worst, 4))).collect();
        let most = Some(same[0].0).filter(|most| most.is_finite());
        let bound =
            most.map_or("with k2 free".to_owned(), |most| format!("with k2 at most {} N/m", short(most)));
        format!("{bound} {}", list.join(" against "))
    });
    let parts: Vec<String> = parts.collect();
    let k1 = retained.dampers.first()?.anew.len();
    (!parts.is_empty()).then(|| {
        format!("Tuned for the worst over all {k1} k1 (k1-robust), E1max is at worst: {}.", parts.join("; "))
    })
}

/// The effect of halving the force on the nominal designs.
fn smaller_force(retained: &Retained, shown: &[usize]) -> Option<String> {
    let name = |of: &Forced| retained.name(of.damper);
    let unit = retained.study().and_then(amplitude).map_or("", Parameter::unit);
    let words = retained.forced.iter().filter(|of| shown.contains(&of.damper)).map(|of| {
        let gaps = if of.proportional { " with D and C in proportion to the force" } else { "" };
        if of.is_constant() {
            return format!("{}{gaps} {} under any force", name(of), rounded(of.share(0), 3));
        }
        let halves = (0..3).map(|half| {
            let step = half * HALF;
            let force = of.points.get(step).map_or(f64::NAN, |(force, _)| *force);
            // Removes the rounding errors of the powers of two.
            format!("{} at {} {unit}", rounded(of.share(step), 3), short((force * 1e6).round() / 1e6))
        });
        format!("{}{gaps} {}", name(of), halves.collect::<Vec<_>>().join(", "))
    });
    let words: Vec<String> = words.collect();
    let words = words.join("; ");
    (!words.is_empty())
        .then(|| format!("Of E1max without a damper the nominal designs leave at the nominal k1: {words}."))
}

/// The results of a damper along k1, in words.
fn one(retained: &Retained, number: usize) -> String {
    let damper = &retained.dampers[number];
    let nominal = damper.nominal();
    let worst = |tuning: Tuning| {
        let matches =
            |curve: &&Curve| curve.damper == Some(number) && curve.tuning == tuning && curve.band == OWN;
        retained.curves.iter().find(matches).and_then(Curve::worst)
    };
    let mut words = format!("{}: ", damper.name);
    let tuned = format!("tuned for k1 = {} N/m it has", short(nominal));
    for (tuning, begin) in [(Tuning::Nominal, tuned.as_str()), (Tuning::Robust, "; k1-robust it has")] {
        if let (Some((k1, most)), Some(at)) = (worst(tuning), damper.of(tuning)) {
            let (home, most, k1) = (joule(damper.energy(&at, nominal)), joule(most), rounded(k1, 4));
            words += &format!("{begin} {home} J there and at worst {most} J, at {k1} N/m");
        }
    }
    if let Some((_, anew)) = worst(Tuning::Anew) {
        words += &format!("; re-tuned for each k1 at most {} J", joule(anew));
    }
    words + "."
}

fn joule(value: f64) -> String {
    if value.is_finite() { rounded(value, 4) } else { "-".to_owned() }
}

/// The values at the stiffnesses tuned for.
fn worst(retained: &Retained) -> Block {
    let mut rows = Vec::new();
    for number in retained.shown() {
        let damper = &retained.dampers[number];
        let mut add = |tuning: Tuning, design: &dyn Fn(Design) -> Design| {
            let energies = damper.anew.iter().map(|(k1, at)| joule(damper.energy(&design(*at), *k1)));
            let first = [damper.name.clone(), tuning.name().to_owned()];
            rows.push(first.into_iter().chain(energies).collect());
        };
        for (tuning, at) in damper.kept.iter().filter(|(tuning, _)| retained.is_new(number, *tuning)) {
            add(*tuning, &|_| *at);
        }
        add(Tuning::Anew, &|own| own);
    }
    let k1 = retained.dampers.iter().take(1).flat_map(|damper| damper.anew.iter().map(|(k1, _)| short(*k1)));
    let k1: Vec<String> = k1.collect();
    let caption = format!("E1max, J, at k1 = {} N/m.", k1.join(", "));
    Block::table(caption, ["damper", "tuning"].into_iter().map(str::to_owned).chain(k1), rows)
}

fn jumps(retained: &Retained) -> Block {
    let (mut lines, shown) = (Vec::new(), retained.shown());
    for Curve { damper, tuning, band, points } in &retained.curves {
        let Some(number) = damper.filter(|damper| shown.contains(damper)) else { continue };
        let side = |(k1, energy): (f64, f64)| format!("{} J at {} N/m", joule(energy), rounded(k1, 6));
        let found: Vec<String> =
            cliffs(points).map(|[from, to]| format!("from {} to {}", side(from), side(to))).collect();
        if !found.is_empty() && *tuning != Tuning::Anew {
            let (name, tuning, found) = (retained.name(number), tuning.name(), found.join("; "));
            let band = if *band == STILL { ", in the band of the nominal k1" } else { "" };
            lines.push(format!("Cliffs of the {name}, {tuning}{band}: {found}."));
        }
    }
    if lines.is_empty() { Block::words("No cliffs.") } else { Block::List(lines) }
}

/// The ranges of the kept designs.
fn ranges(retained: &Retained) -> Block {
    let cells = |range: Option<Range>| match range {
        None => ["none", "", ""].map(str::to_owned),
        Some(range) => {
            let [low, high] = range.open.map(|open| if open { "> " } else { "" });
            let [from, to] =
                [(low, range.from), (high, range.to)].map(|(open, end)| format!("{open}{}", rounded(end, 4)));
            [from, to, rounded(range.factor(), 3)]
        }
    };
    let still = retained.kept.iter().any(|point| point.ranges[STILL].is_some());
    let row = |point: &Point| {
        let mut row = [retained.name(point.damper), point.tuning.name()].map(str::to_owned).to_vec();
        row.push(joule(point.e1_max));
        row.extend(point.ranges[..=usize::from(still)].iter().flat_map(|range| cells(*range)));
        row
    };
    let mut head = vec!["damper", "tuning", "E1max at the nominal k1, J", "from, N/m", "to, N/m", "factor"];
    if still {
        head.extend(["band kept: from, N/m", "to, N/m", "factor"]);
    }
    let caption = "The retention range of the designs that are kept; on the right with the band of frequencies where it is at the nominal k1.";
    let rows = retained.shown_kept().into_iter().map(row).collect();
    Block::table(caption, head, rows)
}

/// The shares of the nominal designs under successively halved forces.
fn forces(retained: &Retained) -> Block {
    let shown = retained.shown();
    let row = |of: &Forced| {
        let mut row =
            vec![retained.name(of.damper).to_owned(), GAPS[usize::from(of.proportional)].to_owned()];
        row.extend((0..of.points.len()).step_by(HALF).map(|step| rounded(of.share(step), 3)));
        row
    };
    let mut head = vec!["damper".to_owned(), "D and C".to_owned()];
    if let Some(first) = retained.forced.first() {
        let unit = retained.study().and_then(amplitude).map_or("", Parameter::unit);
        head.extend(
            first.points.iter().step_by(HALF).map(|(force, _)| format!("{} {unit}", rounded(*force, 4))),
        );
    }
    let caption =
        "E1max of the nominal designs at the nominal k1 as a share of that without a damper, by the force.";
    let rows = retained.forced.iter().filter(|of| shown.contains(&of.damper)).map(row).collect();
    Block::table(caption, head, rows)
}

fn traded(retained: &Retained, damper: usize) -> String {
    let (name, front) = (retained.name(damper), retained.front(damper));
    let (Some(least), Some(widest)) = (front.first(), front.last()) else {
        return format!("{name}: no design that was found does half of the work even at the nominal k1.");
    };
    let design_text = |point: &Point| {
        let ends = point.range().map_or(String::new(), |range| {
            format!("{} to {} N/m", rounded(range.from, 4), rounded(range.to, 4))
        });
        format!(
            "{ends} (a factor of {}) with {} J ({})",
            rounded(point.factor(), 3),
            joule(point.e1_max),
            design_words(&point.at, 4)
        )
    };
    format!("{name}: from {}, to {}.", design_text(least), design_text(widest))
}

fn designs(retained: &Retained) -> Block {
    let shown = retained.shown();
    let is_shown = |row: &Row| {
        let damper = shown.iter().find(|damper| retained.name(**damper) == row.damper);
        let given = Tuning::GIVEN.into_iter().find(|given| row.label == given.name());
        damper.is_some_and(|damper| given.is_none_or(|given| retained.is_new(*damper, given)))
    };
    let table = retained.table.table().only(retained.table.rows.iter().map(is_shown));
    let mut parameters = retained.table.parameters();
    if retained.varies_mass() {
        parameters.push(Parameter::M2);
    }
    let mut columns = ["damper", "tuning"].map(|name| table.exact(name)).to_vec();
    let four = |value| rounded(value, 4);
    columns.extend(parameters.iter().map(|parameter| table.show(parameter.symbol(), four).or("none")));
    columns.extend([table.show(Measure::Energy.name(), joule).or("-"), table.exact("verdict")]);
    let (head, rows) = table.shown(&columns);
    let caption =
        "All designs, each with its E1max for what it was tuned for (one that is given: for the nominal k1).";
    Block::table(caption, head, rows)
}
