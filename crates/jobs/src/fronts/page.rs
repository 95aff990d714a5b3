//! The page of `fronts` and its answer in words, with the numbers of the tables.

use super::candidate::{Candidate, SAME, Under, at_most};
use super::designs::{Certified, Fronts, NEEDS};
use super::draw;
use crate::certify::Verdict;
use crate::{Error, pages};
use retune_model::{Design, Measure, Parameter};
use retune_report::document::{Block, Document};
use retune_report::table::{Shown, Table};
use retune_store::Directory;
use retune_study::{Sweep, design_words, joined, rounded, short};

/// Writes the page in both forms, and its figures.
pub(super) fn write(fronts: &Fronts, directory: &Directory) -> Result<(), Error> {
    let names: Vec<&str> = fronts.plan.dampers.iter().map(|(name, _)| name.as_str()).collect();
    let mut sections = Vec::new();
    for sweep in fronts.plan.sweeps() {
        let (file, id, title) = match sweep {
            Sweep::K2 => ("k2.svg", "k2", "k2 at most"),
            Sweep::Stroke => ("stroke.svg", "stroke", "Stroke at most"),
            Sweep::ContactForce => ("contact_force.svg", "contact-force", "Contact force at most"),
        };
        let caption = format!("The least E1max: {}", title.to_lowercase());
        let figure = Block::figure(file, draw::sweep(fronts, sweep), caption);
        let blocks = [figure, table(fronts, sweep), needs(fronts, sweep)];
        sections.push((id, title, blocks.into_iter().chain(reasons(fronts, sweep)).collect()));
    }
    let words = "Every design that was found. A line is the front of a damper in the two quantities of its chart: what lies above it is \
                 dominated. `front.csv` has the designs that no other dominates in all of E1max, stroke, contact force and k2.";
    let caption = "E1max against stroke, contact force and k2";
    let figure = Block::figure("front.svg", draw::front(fronts), caption);
    sections.push(("trade", "The trade", vec![Block::words(words), figure]));
    let certified: Vec<String> = fronts.certified.iter().map(|one| certificate(fronts, one)).collect();
    let mut certified = if certified.is_empty() {
        vec![Block::words(
            "No design that strikes a wall is better than the first damper under the same bound.",
        )]
    } else {
        vec![Block::words(MOTIONS), Block::List(certified)]
    };
    let certificates = fronts.certified.iter().map(|one| one.file.clone()).collect();
    certified.push(Block::Files(certificates));
    sections.push(("certified", "Certified", certified));
    let page = Document {
        title: format!("What the {} is good for", names.last().unwrap_or(&"")),
        command: "retune fronts",
        opening: vec![Block::words(made(fronts, &names)), Block::List(answer(fronts))],
        sections,
    };
    pages::write(&page, directory)
}

/// The meaning of the names of motions.
const MOTIONS: &str = "A motion T, 1, 0 repeats every period T of the force, with one impact on the structure and none on the obstacle.";

/// How the designs were found and compared.
fn made(fronts: &Fronts, names: &[&str]) -> String {
    let plan = &fronts.plan;
    let over = plan.dampers.last().map(|(_, study)| pages::over(study));
    let mut text = format!(
        "Dampers: {}. E1max is the {}. Searches look at the samples of their studies and keep 1 % below a limit of stroke or force; from each place that \
         they come to, and from the best design under a bound under those beside it, the slope is followed down by exact derivatives, on four \
         times the samples. Each design is looked at again on {} frequencies, and under each bound stands the best that keeps it, whichever \
         search found it: a looser bound is never worse. Of designs within 1 % the best is taken that no motion from other starts than rest \
         makes much worse.",
        names.join(", "),
        over.unwrap_or_default(),
        plan.said.samples
    );
    if plan.check() != plan.said.samples {
        text += &format!(
            " E1max on {} frequencies stands beside it, and designs are compared by it; those that rise there by more than 1 % are marked with ↑, and by a ring in the figures.",
            plan.check()
        );
    }
    if !plan.designs.is_empty() {
        text += " Designs that were known before stand among them, and descents begin at them, too.";
    }
    text += " Strokes (spring deflections |x2 - x1 - D|), forces and motions of the structure are the largest from rest on, each at its own frequency.";
    if plan.sweeps().iter().any(|sweep| *sweep != Sweep::K2) {
        text += " Verdict edge: an error of 1 % can break the bound; none: a motion that other starts than rest lead to breaks it.";
    }
    for (damper, name) in names.iter().enumerate() {
        if fronts.is_steady(damper) {
            text += &format!(
                " The {name} is taken in its steady motion, in closed form, and touches nothing; its stroke is that of this motion."
            );
        }
    }
    text
}

/// The first columns of a table along a bound.
fn along(table: &Table, sweep: Sweep) -> Vec<Shown<'_>> {
    let heading = format!("{} at most, {}", sweep.name(), sweep.unit());
    vec![table.exact(&table.columns[0].name).called(heading), table.exact("damper")]
}

/// The table along a bound.
fn table(fronts: &Fronts, sweep: Sweep) -> Block {
    let (table, parameters) = (fronts.table(sweep), fronts.parameters());
    let is_checked = fronts.plan.check() != fronts.plan.said.samples;
    let mut columns = along(&table, sweep);
    columns.push(table.show(Measure::Energy.name(), joule));
    if is_checked {
        let heading = format!("on {} frequencies", fronts.plan.check());
        columns.push(table.show("E1max_check", joule).called(heading));
    }
    columns.extend(parameters.iter().map(|parameter| table.show(parameter.symbol(), four).or("none")));
    columns.push(table.exact("verdict"));
    let (head, mut rows) = table.shown(&columns);
    for (cells, (_, design)) in rows.iter_mut().zip(fronts.rows(sweep)) {
        match design {
            None => {
                cells.truncate(2);
                cells.push("none that was found keeps it".to_owned());
                cells.resize(head.len(), String::new());
            }
            Some(design) if is_checked && design.rises() => cells[3] += " ↑",
            Some(_) => {}
        }
    }
    Block::table(format!("The best design of each damper with {} at most a bound.", sweep.name()), head, rows)
}

/// The needs of the designs of [`table`], and of the structure without a damper.
fn needs(fronts: &Fronts, sweep: Sweep) -> Block {
    let found = fronts.rows(sweep).into_iter().map(|(_, design)| design.is_some());
    let table = fronts.table(sweep).only(found);
    let mut columns = along(&table, sweep);
    columns.push(table.show(Measure::Stroke.name(), metre));
    let force = table.show(Measure::ContactForce.name(), |force| {
        if force < 100.0 { rounded(force, 3) } else { format!("{force:.0}") }
    });
    columns.push(force.called("contact force, N"));
    columns.extend(NEEDS.map(|measure| table.show(measure.name(), four)));
    let (head, mut rows) = table.shown(&columns);
    if let Some(none) = fronts.none {
        let mut cells = ["", "no damper", "", ""].map(str::to_owned).to_vec();
        cells.extend(NEEDS.map(|measure| four(none.value(measure))));
        rows.push(cells);
    }
    let steady = (0..fronts.plan.dampers.len()).any(|damper| fronts.is_steady(damper));
    let but =
        if steady { "; where the objective is steady, strokes are those of the steady motion" } else { "" };
    Block::table(
        format!("What they need and what the structure does: the largest from rest on{but}."),
        head,
        rows,
    )
}

/// The reasons for verdicts other than robust in [`table`], each once.
fn reasons(fronts: &Fronts, sweep: Sweep) -> Option<Block> {
    let mut listed: Vec<(String, Vec<String>)> = Vec::new();
    for (Under { bound, damper, .. }, design) in fronts.rows(sweep) {
        let has = |design: &&Candidate| !design.reason.is_empty() && design.verdict != Verdict::Robust.name();
        let Some(design) = design.filter(has) else { continue };
        let reason = format!("{} ({}): {}", fronts.name(damper), words(fronts, design), design.reason);
        match listed.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, bounds)) => bounds.push(bound.to_string()),
            None => listed.push((reason, vec![bound.to_string()])),
        }
    }
    let line =
        |(reason, bounds): (String, Vec<String>)| format!("{}, {reason}.", at_most(sweep, bounds.join(", ")));
    (!listed.is_empty()).then(|| Block::List(listed.into_iter().map(line).collect()))
}

/// The advantage of each damper over the first, in words.
pub(super) fn answer(fronts: &Fronts) -> Vec<String> {
    let mut words = Vec::new();
    for given in &fronts.given {
        words.push(format!(
            "The {} of the study (k2 = {} N/m) has {} J, with a stroke of {} m.",
            fronts.name(given.damper),
            short(given.at.get(Parameter::K2)),
            joule(given.known()),
            metre(given.stroke)
        ));
    }
    for damper in 1..fronts.plan.dampers.len() {
        for sweep in fronts.plan.sweeps() {
            words.push(compared(fronts, sweep, damper));
        }
    }
    words
}

/// A damper compared with the first along a bound, in words.
fn compared(fronts: &Fronts, sweep: Sweep, damper: usize) -> String {
    let (name, first, what) = (fronts.name(damper), fronts.name(0), sweep.name());
    let rows = fronts.rows(sweep).into_iter().filter(|(under, _)| under.damper == damper);
    let rows: Vec<(f64, Option<&Candidate>, Option<f64>)> =
        rows.map(|(under, design)| (under.bound, design, fronts.reference(under))).collect();
    let gains = rows.iter().filter_map(|(bound, design, reference)| {
        let (design, reference) = ((*design)?, (*reference)?);
        Some((design.known() / reference, bound, design))
    });
    let gains: Vec<(f64, &f64, &Candidate)> = gains.collect();
    let listed = |bounds: Vec<&f64>| joined(&bounds, ", ");
    let mut words = match gains.iter().min_by(|(one, ..), (other, ..)| one.total_cmp(other)) {
        Some((gain, bound, design)) if *gain < 1.0 - SAME => {
            let better = gains.iter().filter(|(share, ..)| *share < 1.0 - SAME);
            format!(
                "{}: the best {name} found has {} J, the best {first} {} J. There its advantage is largest; it is better by more than 1 % for {}.",
                at_most(sweep, bound),
                joule(design.known()),
                joule(design.known() / gain),
                at_most(sweep, listed(better.map(|(_, bound, _)| *bound).collect()))
            )
        }
        _ => format!("{what}: under no bound is the {name} better than the {first} by more than 1 %."),
    };
    let mut remark = |which: &dyn Fn(&Candidate, Option<f64>) -> bool, before: &str, after: &str| {
        let matching =
            rows.iter().filter(|(_, design, none)| design.is_some_and(|design| which(design, *none)));
        let bounds = listed(matching.map(|(bound, ..)| bound).collect());
        if !bounds.is_empty() {
            words += &format!(" {before} {}{after}", at_most(sweep, bounds));
        }
    };
    remark(&|_, reference| reference.is_none(), &format!("Only the {name} keeps"), ".");
    let single = |design: &Candidate, _| design.verdict == Verdict::SingleChaoticRealisation.name();
    let after = " it is a single chaotic realisation: practically equal designs have much more or less.";
    remark(&single, "For", after);
    let after =
        " other starts than rest lead it to much more, and no design as good was found that is free of this.";
    remark(&|design, _| design.is_unsafe(), "For", after);
    let after = format!(" the best {name} that was found touches nothing: it is a TMD.");
    remark(&|design, _| design.force == 0.0, "For", &after);
    words
}

/// A certified design in words.
fn certificate(fronts: &Fronts, Certified { under, design, certificate, .. }: &Certified) -> String {
    let reference = fronts.reference(*under);
    let lines: Vec<String> = certificate.lines();
    format!(
        "{}, {}: {} with {} J (best {} under the same bound: {}). {}",
        fronts.name(design.damper),
        at_most(under.sweep, under.bound),
        words(fronts, design),
        joule(design.known()),
        fronts.name(0),
        reference.map_or("none".to_owned(), |reference| format!("{} J", joule(reference))),
        lines.join("; "),
    )
}

/// A design in words, with the parameters that the tables have.
fn words(fronts: &Fronts, design: &Candidate) -> String {
    let shown = Design::try_from(design.at.only(&fronts.parameters())).unwrap_or(design.at);
    design_words(&shown, 4)
}

fn four(value: f64) -> String {
    rounded(value, 4)
}

fn joule(value: f64) -> String {
    if value < 10.0 { rounded(value, 4) } else { format!("{value:.1}") }
}

fn metre(value: f64) -> String {
    if value < 0.01 { rounded(value, 3) } else { format!("{value:.3}") }
}
