//! The page of `branches`, and its answer in words. Every number on it is one of the tables beside it.

use crate::Error;
use crate::branches::basins;
use crate::branches::draw::draw;
use crate::branches::found::{Found, Margin};
use crate::branches::remedy::{Remedy, remedies};
use crate::branches::tables::{ATTRACTORS, BIFURCATIONS, BRANCHES, STATES};
use crate::branches::words::{joule, kind};
use crate::summary::TunedDamper;
use retune_dynamics::periodic::Attractor;
use retune_dynamics::periodic::{Branch, End, EventKind, Orbit, Sample};
use retune_report::document::{Block, Document};
use retune_store::Directory;
use retune_study::{counted, rounded, short};

/// Most rows of a table on the page; the files hold all.
const MOST: usize = 40;

/// Writes the page in both forms, and its figure.
///
/// # Errors
/// A file cannot be written.
pub fn write(found: &Found, directory: &Directory) -> Result<(), Error> {
    let figure = draw(found);
    directory.write("branches.svg", &figure.wide)?;
    let symbol = found.branches.plan.parameter.symbol();
    let caption = format!("E1max and stroke of the periodic motions against {symbol}");
    let files =
        [BRANCHES, BIFURCATIONS, ATTRACTORS, STATES, "branches.json", "resolved.json", "manifest.json"];
    let mut sections = vec![
        (
            "motions",
            "Periodic motions",
            vec![Block::Figure("branches.svg", figure, caption), branches(found)],
        ),
        ("bifurcations", "Where they begin and end", vec![Block::Words(EVENTS.to_owned()), events(found)]),
        ("coexisting", "What runs settle on", vec![Block::Words(starts(found)), attractors(found)]),
        ("data", "Data", vec![Block::Files(files.map(str::to_owned).to_vec())]),
    ];
    if let Some(own) = &found.basins {
        directory.write("basins.svg", &basins::draw(found, own))?;
        sections.insert(3, ("basins", "Where starts end", basins::blocks(found, own)));
    }
    let document = Document {
        title: format!("{}: periodic motions along {symbol}", found.study.name()),
        command: "retune branches",
        opening: vec![Block::Words(plan_words(found)), Block::List(answer(found))],
        sections,
    };
    directory.write("README.md", &document.markdown())?;
    Ok(directory.write("report.html", &document.html())?)
}

const EVENTS: &str = "At a fold a branch turns back: stable and unstable motions meet and vanish. At a branch point another branch crosses. At a \
    period doubling a motion of twice the period branches off, at a Neimark-Sacker bifurcation amplitude-modulated ones. At a grazing an impact \
    begins or ends, at no speed; a Hertz contact is soft enough for the branch to go on.";

/// What was done.
fn plan_words(found: &Found) -> String {
    let plan = &found.branches.plan;
    let (symbol, unit, [from, to]) = (plan.parameter.symbol(), plan.parameter.unit(), plan.range);
    let damper = found
        .study
        .scene
        .damper
        .map_or(String::new(), |damper| TunedDamper::of(&damper, found.study.varied()).words(|_| 5));
    let more = [
        (plan.fine, "value", " A run from rest at each of # leads to the branches that this has missed."),
        (plan.apart, "run", " From # at each of the former, Newton's iteration looks for other motions."),
    ];
    let more = more.iter().filter(|(count, ..)| *count > 0);
    let more: String =
        more.map(|(count, what, words)| words.replace('#', &counted(*count as u64, what))).collect();
    format!(
        "The damper: {damper}. Runs from rest at {} of {symbol} from {} to {} {unit}, and from {} over all of them, are followed until they repeat, and more where \
         no stable motion is known; the branch of each motion that they settle on is followed to both sides, and from each period doubling at \
         which it gains or loses stability.{more}",
        counted(plan.samples as u64, "value"),
        short(from),
        short(to),
        counted(plan.others() as u64, "other start"),
    )
}

/// The answer: one line for each thing to know.
pub fn answer(found: &Found) -> Vec<String> {
    let plan = &found.branches.plan;
    let (symbol, unit) = (plan.parameter.symbol(), plan.parameter.unit());
    let [stable, irregular] = found.branches.stable_and_irregular();
    let covered: f64 = stable.iter().map(|[from, to]| to - from).sum();
    let share = 100.0 * covered / (plan.range[1] - plan.range[0]);
    let mut words = Vec::new();
    let all = found.largest.iter().enumerate();
    let mut most: Vec<(usize, &Orbit)> = all.filter_map(|(i, orbit)| Some((i, orbit.as_ref()?))).collect();
    most.sort_by(|a, b| b.1.seen.e1_max.total_cmp(&a.1.seen.e1_max));
    if let Some((number, orbit)) = most.first() {
        words.push(format!(
            "The largest E1max of all stable motions: {} J at {symbol} = {} {unit}, on branch {number} ({}).",
            joule(orbit.seen.e1_max),
            rounded(orbit.value, 6),
            kind(orbit)
        ));
        if !found.branches.is_reached_from_rest(*number) {
            let ways = remedies(&found.branches.branches[*number], orbit);
            let reached = most.iter().find(|(other, _)| found.branches.is_reached_from_rest(*other));
            words.extend(reached.map(|(other, orbit)| {
                format!(
                    "No run from rest that was made ends on it. The largest on branches that runs from rest end on: {} J at {symbol} = {} \
                     {unit}, on branch {other} ({}).",
                    joule(orbit.seen.e1_max),
                    rounded(orbit.value, 6),
                    kind(orbit)
                )
            }));
            if !ways.is_empty() {
                let ways: Vec<String> = ways.iter().map(Remedy::words).collect();
                words.push(format!(
                    "What removes that motion, at {symbol} = {} {unit} and all else as it is: {}.",
                    rounded(orbit.value, 6),
                    ways.join("; ")
                ));
            }
        }
    }
    words
        .extend(found.branches.branches.iter().enumerate().filter_map(|(i, branch)| isola(found, i, branch)));
    words.extend(found.margin.as_ref().map(Margin::words));
    words.push(format!(
        "Stable periodic motions, of {}, cover {} % of the range.",
        counted(found.branches.branches.len() as u64, "branch"),
        rounded(share, 4)
    ));
    if found.branches.ended {
        let count = found.branches.branches.len();
        words.push(format!("The search ended after {count} branches: there may be more, and the largest of all may be on one of them."));
    }
    for [from, to] in irregular.iter().filter(|[from, to]| to - from > 1e-3 * (plan.range[1] - plan.range[0]))
    {
        let within = |sample: &&Sample| sample.value >= *from && sample.value <= *to;
        let energies = found.branches.samples.iter().filter(within).flat_map(|sample| &sample.irregular);
        let most = energies.map(|seen| seen.e1_max).fold(0.0, f64::max);
        let seen = if most > 0.0 { format!("; runs there reach {} J", joule(most)) } else { String::new() };
        words.push(format!(
            "From {symbol} = {} to {} {unit} no stable periodic motion is known{seen}.",
            rounded(*from, 6),
            rounded(*to, 6)
        ));
    }
    words
}

/// A closed branch in words.
fn isola(found: &Found, number: usize, branch: &Branch) -> Option<String> {
    if branch.ends != [End::Closed; 2] {
        return None;
    }
    let plan = &found.branches.plan;
    let [low, high] = span(branch);
    let most = found.largest[number].as_ref()?;
    let share = found.branches.share(number);
    let reached = format!("{} of {} starts there end on it", share.ends, share.starts);
    Some(format!(
        "Branch {number} is an isola: it exists from {} = {} to {} {} only, apart from all others ({}); up to {} J; {reached}.",
        plan.parameter.symbol(),
        rounded(low, 8),
        rounded(high, 8),
        plan.parameter.unit(),
        kind(most),
        joule(most.seen.e1_max)
    ))
}

/// The least and the largest value of the parameter on a branch.
fn span(branch: &Branch) -> [f64; 2] {
    let values = || branch.points.iter().map(|orbit| orbit.value);
    [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
}

/// The branches.
fn branches(found: &Found) -> Block {
    let plan = &found.branches.plan;
    let rows = found.branches.branches.iter().enumerate().take(MOST).map(|(number, branch)| {
        let stable = (0..branch.points.len()).filter(|i| branch.is_stable_at(*i)).count();
        let most = found.largest[number].as_ref();
        let [low, high] = span(branch);
        let [first, last] = branch.ends.map(End::words);
        vec![
            number.to_string(),
            branch.shooting.periods.to_string(),
            format!("{} to {}", rounded(low, 6), rounded(high, 6)),
            format!("{stable} of {}", branch.points.len()),
            most.map_or("-".to_owned(), |orbit| joule(orbit.seen.e1_max)),
            most.map_or(String::new(), |orbit| rounded(orbit.value, 6)),
            most.map_or(String::new(), |orbit| orbit.seen.impacts.clone()),
            if first == last { first.to_owned() } else { format!("{first}; {last}") },
        ]
    });
    let symbol = plan.parameter.symbol();
    let head = [
        "branch".to_owned(),
        "periods".to_owned(),
        format!("{symbol}, {}", plan.parameter.unit()),
        "stable motions".to_owned(),
        "largest E1max of them, J".to_owned(),
        format!("at {symbol}"),
        "impacts there".to_owned(),
        "ends".to_owned(),
    ];
    let words = "The branches. Impacts: S on the structure, O on the obstacle, in their order.".to_owned();
    Block::Table(words, head.to_vec(), rows.collect())
}

/// The events, those of stable motions first.
fn events(found: &Found) -> Block {
    let plan = &found.branches.plan;
    let mut all: Vec<(usize, &Branch, &retune_dynamics::periodic::Event)> = Vec::new();
    for (number, branch) in found.branches.branches.iter().enumerate() {
        all.extend(branch.events.iter().map(|event| (number, branch, event)));
    }
    let matters = |branch: &Branch, place: usize| {
        let near = [place.checked_sub(1), Some(place + 1)].into_iter().flatten();
        near.filter_map(|i| branch.points.get(i)).any(Orbit::is_stable)
    };
    all.retain(|(_, branch, event)| event.kind == EventKind::Fold || matters(branch, event.place));
    let rows = all.iter().take(MOST).map(|(number, _, event)| {
        vec![
            number.to_string(),
            event.kind.name().to_owned(),
            format!("{:.8}", event.orbit.value),
            event.orbit.periods.to_string(),
            event.orbit.seen.impacts.clone(),
            joule(event.orbit.seen.e1_max),
        ]
    });
    let (symbol, unit) = (plan.parameter.symbol(), plan.parameter.unit());
    let head = ["branch", "event", &format!("{symbol}, {unit}"), "periods", "impacts", "E1max, J"];
    let words = match all.len() {
        more if more > MOST => {
            format!("The first {MOST} of {more} events at stable motions and folds; {BIFURCATIONS} has all.")
        }
        _ => format!("Events at stable motions, and all folds; {BIFURCATIONS} has all."),
    };
    Block::Table(words, head.map(str::to_owned).to_vec(), rows.collect())
}

fn starts(found: &Found) -> String {
    format!(
        "The starts are spread evenly over the range and the states that the force can reach somewhere in it (one Sobol sequence of {}). A run that \
         repeats to 1e-4 of its size within 480 periods settles on a periodic motion; any other is irregular.",
        found.branches.plan.others()
    )
}

/// What runs settle on, where it is a motion that no run from rest leads to, or none that repeats.
fn attractors(found: &Found) -> Block {
    let plan = &found.branches.plan;
    let mut rows = Vec::new();
    for sample in &found.branches.samples {
        let is_usual =
            |one: &Attractor| one.branch.is_some_and(|branch| found.branches.is_reached_from_rest(branch));
        for one in sample.attractors.iter().filter(|one| !is_usual(one)) {
            rows.push(vec![
                rounded(sample.value, 6),
                one.branch.map_or("-".to_owned(), |branch| branch.to_string()),
                kind(&one.orbit),
                joule(one.orbit.seen.e1_max),
                format!("{} of {}", one.starts, sample.starts),
                if one.from_rest { "yes" } else { "no" }.to_owned(),
            ]);
        }
        if !sample.irregular.is_empty() {
            rows.push(vec![
                rounded(sample.value, 6),
                "-".to_owned(),
                "irregular".to_owned(),
                joule(sample.irregular.iter().map(|seen| seen.e1_max).fold(0.0, f64::max)),
                format!("{} of {}", sample.irregular.len(), sample.starts),
                if sample.rest_is_irregular { "yes" } else { "no" }.to_owned(),
            ]);
        }
    }
    let head = [
        format!("{}, {}", plan.parameter.symbol(), plan.parameter.unit()),
        "branch".to_owned(),
        "motion".to_owned(),
        "E1max, J".to_owned(),
        "starts".to_owned(),
        "from rest".to_owned(),
    ];
    let words = if rows.is_empty() {
        "All starts end on branches that runs from rest lead to.".to_owned()
    } else {
        format!(
            "Where starts end on motions that no run from rest leads to, or on none that repeats; {ATTRACTORS} has all."
        )
    };
    Block::Table(words, head.to_vec(), rows)
}
