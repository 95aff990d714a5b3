//! The page of `branches`, and its answer in words. Every number on it comes from the tables beside it.

use crate::branches::draw;
use crate::branches::motions::{Margin, Motions, Settled, energy, joule, kind, most_irregular, settled};
use crate::branches::tables::{ATTRACTORS, BIFURCATIONS, BRANCHES, STARTS, STATES, bifurcations};
use crate::columns::column;
use crate::summary::TunedDamper;
use crate::{Error, pages};
use retune_dynamics::periodic::trace::trace;
use retune_dynamics::periodic::{Basins, Branch, End, EventKind, Orbit, Sample};
use retune_model::{Bare, Measure, Parameter};
use retune_report::document::{Block, Document};
use retune_store::Directory;
use retune_study::{counted, rounded, short};

/// Most rows of a table on the page; the files hold all.
const MOST: usize = 40;

pub fn write(motions: &Motions, directory: &Directory) -> Result<(), Error> {
    let symbol = motions.over().symbol();
    let caption = format!("E1max and stroke of the periodic motions against {symbol}");
    let figure = Block::figure("branches.svg", draw::draw(motions), caption);
    let files =
        [BRANCHES, BIFURCATIONS, ATTRACTORS, STATES, "branches.json", "resolved.json", "manifest.json"];
    let mut sections = vec![
        ("motions", "Periodic motions", vec![figure, branches(motions)]),
        ("bifurcations", "Where they begin and end", vec![Block::words(EVENTS), events(motions)]),
        ("coexisting", "What runs settle on", vec![Block::words(starts(motions)), attractors(motions)]),
        ("data", "Data", vec![Block::files(&files)]),
    ];
    if let Some(own) = &motions.basins {
        sections.insert(3, ("basins", "Where starts end", basins(motions, own)));
    }
    let page = Document {
        title: format!("{}: periodic motions along {symbol}", motions.study.name()),
        command: "retune branches",
        opening: vec![Block::words(plan_words(motions)), Block::List(answer(motions))],
        sections,
    };
    pages::write(&page, directory)
}

const EVENTS: &str = "At a fold a branch turns back: stable and unstable motions meet and vanish. At a branch point another branch crosses. At a \
    period doubling a motion of twice the period branches off, at a Neimark-Sacker bifurcation amplitude-modulated ones. At a grazing an impact \
    begins or ends, at no speed; a Hertz contact is soft enough for the branch to go on.";

fn plan_words(motions: &Motions) -> String {
    let plan = &motions.branches.plan;
    let (symbol, unit, [from, to]) = (plan.parameter.symbol(), plan.parameter.unit(), plan.range);
    let words = |damper| TunedDamper::of(&damper, motions.study.varied()).words(|_| 5);
    let damper = motions.study.scene.damper.map_or(String::new(), words);
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

/// The answer: one line for each finding.
pub fn answer(motions: &Motions) -> Vec<String> {
    let (all, [from, to]) = (&motions.branches, motions.branches.plan.range);
    let (symbol, unit) = (motions.over().symbol(), motions.over().unit());
    let [stable, irregular] = all.stable_and_irregular();
    // An empty sum is -0.
    let covered = stable.iter().map(|[from, to]| to - from).sum::<f64>() + 0.0;
    let share = 100.0 * covered / (to - from);
    let mut words = Vec::new();
    let largest = motions.largest.iter().enumerate();
    let mut most: Vec<(usize, &Orbit)> =
        largest.filter_map(|(i, orbit)| Some((i, orbit.as_ref()?))).collect();
    most.sort_by(|a, b| energy(b.1).total_cmp(&energy(a.1)));
    let reached = |(number, orbit): &(usize, &Orbit)| {
        let (energy, place) = (joule(energy(orbit)), motions.at(orbit.value, 6));
        format!("{energy} J at {place}, on branch {number} ({})", kind(orbit))
    };
    words.extend(
        most.first()
            .map(|first| format!("The largest E1max of all stable motions found: {}.", reached(first))),
    );
    if let Some((number, first)) = most.first().filter(|(number, _)| !all.is_reached_from_rest(*number)) {
        let usual = most.iter().find(|(other, _)| all.is_reached_from_rest(*other)).map(reached);
        words.extend(usual.map(|usual| format!("No run from rest that was made ends on it. The largest on branches that runs from rest end on: {usual}.")));
        let remedy = |parameter| remedy(&all.branches[*number], first, parameter);
        let ways: Vec<String> = TRIED.into_iter().chain(Parameter::AMPLITUDES).filter_map(remedy).collect();
        if !ways.is_empty() {
            let (place, ways) = (motions.at(first.value, 6), ways.join("; "));
            words.push(format!(
                "What removes that motion (another may remain), at {place} and all else as it is: {ways}."
            ));
        }
    }
    words.extend(all.branches.iter().enumerate().filter_map(|(i, branch)| isola(motions, i, branch)));
    words.extend(motions.margin.as_ref().map(Margin::words));
    words.push(format!(
        "Stable periodic motions, of {}, cover {} % of the range.",
        counted(all.branches.len() as u64, "branch"),
        rounded(share, 4)
    ));
    if motions.study.scene.damper.is_some_and(|damper| damper.is_floating()) {
        words.push(
            "Without a spring (k2 = 0) a damper that touches no wall repeats wherever it floats: such motions stand here as the one about its place of rest."
                .to_owned(),
        );
    }
    if all.ended {
        let count = all.branches.len();
        words.push(format!("The search ended after {count} branches: there may be more, and the largest of all may be on one of them."));
    }
    let width = to - from;
    for [from, to] in irregular.iter().filter(|[from, to]| to - from > 1e-3 * width) {
        let within = |sample: &&Sample| sample.value >= *from && sample.value <= *to;
        let most = all.samples.iter().filter(within).map(most_irregular).fold(0.0, f64::max);
        let seen = if most > 0.0 { format!("; runs there reach {} J", joule(most)) } else { String::new() };
        let [from, to] = [from, to].map(|end| rounded(*end, 6));
        words
            .push(format!("From {symbol} = {from} to {to} {unit} no stable periodic motion is known{seen}."));
    }
    words
}

fn isola(motions: &Motions, number: usize, branch: &Branch) -> Option<String> {
    if branch.ends != [End::Closed; 2] {
        return None;
    }
    let ([low, high], symbol, unit) = (span(branch), motions.over().symbol(), motions.over().unit());
    let most = motions.largest[number].as_ref()?;
    let share = motions.branches.share(number);
    let reached = format!("{} of {} starts there end on it", share.ends, share.starts);
    Some(format!(
        "Branch {number} is an isola: it exists from {symbol} = {} to {} {unit} only, apart from all others ({}); up to {} J; {reached}.",
        rounded(low, 8),
        rounded(high, 8),
        kind(most),
        joule(energy(most))
    ))
}

/// The least and the largest value of the parameter on a branch.
fn span(branch: &Branch) -> [f64; 2] {
    let values = || branch.points.iter().map(|orbit| orbit.value);
    [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
}

fn branches(motions: &Motions) -> Block {
    let rows = motions.branches.branches.iter().enumerate().take(MOST).map(|(number, branch)| {
        let stable = (0..branch.points.len()).filter(|i| branch.is_stable_at(*i)).count();
        let most = motions.largest[number].as_ref();
        let [low, high] = span(branch);
        let [first, last] = branch.ends.map(End::words);
        vec![
            number.to_string(),
            branch.shooting.periods.to_string(),
            format!("{} to {}", rounded(low, 6), rounded(high, 6)),
            format!("{stable} of {}", branch.points.len()),
            most.map_or("-".to_owned(), |orbit| joule(energy(orbit))),
            most.map_or(String::new(), |orbit| rounded(orbit.value, 6)),
            most.map_or(String::new(), |orbit| orbit.seen.impacts.clone()),
            if first == last { first.to_owned() } else { format!("{first}; {last}") },
        ]
    });
    let head = [
        "branch",
        "periods",
        &column(motions.over().symbol()).heading(),
        "stable motions",
        "largest E1max of them, J",
        &format!("at {}", motions.over().symbol()),
        "impacts there",
        "ends",
    ];
    let words = "The branches. Impacts: S on the structure, O on the obstacle, in their order.";
    Block::table(words, head, rows.collect())
}

/// The events at stable motions, and all folds.
fn events(motions: &Motions) -> Block {
    let matters = |branch: &Branch, place: usize| {
        let near = [place.checked_sub(1), Some(place + 1)].into_iter().flatten();
        near.filter_map(|i| branch.points.get(i)).any(Orbit::is_stable)
    };
    let shown = motions.branches.branches.iter().flat_map(|branch| {
        branch.events.iter().map(move |event| event.kind == EventKind::Fold || matters(branch, event.place))
    });
    let mut table = bifurcations(motions).only(shown);
    let words = match table.rows.len() {
        more if more > MOST => {
            format!("The first {MOST} of {more} events at stable motions and folds; {BIFURCATIONS} has all.")
        }
        _ => format!("Events at stable motions, and all folds; {BIFURCATIONS} has all."),
    };
    table.rows.truncate(MOST);
    let columns = [
        table.exact("branch"),
        table.exact("kind").called("event"),
        table.show(motions.over().symbol(), |value| format!("{value:.8}")),
        table.exact("periods"),
        table.exact("impacts"),
        table.show(Measure::Energy.name(), joule),
    ];
    let (head, rows) = table.shown(&columns);
    Block::table(words, head, rows)
}

fn starts(motions: &Motions) -> String {
    format!(
        "The starts are spread evenly over the range and the states that the force can reach somewhere in it (one Sobol sequence of {}). A run that \
         repeats to 1e-4 of its size within 480 periods settles on a periodic motion; any other is irregular.",
        motions.branches.plan.others()
    )
}

/// The outcomes of runs that settle on a motion which no run from rest leads to, or on no periodic motion.
fn attractors(motions: &Motions) -> Block {
    let is_usual =
        |one: &Settled| one.branch.is_some_and(|branch| motions.branches.is_reached_from_rest(branch));
    let row = |Settled { sample, on, branch, starts, from_rest, energy }: Settled| {
        vec![
            rounded(sample.value, 6),
            branch.map_or("-".to_owned(), |branch| branch.to_string()),
            on.map_or("irregular".to_owned(), kind),
            joule(energy),
            format!("{starts} of {}", sample.starts),
            if from_rest { "yes" } else { "no" }.to_owned(),
        ]
    };
    let rows: Vec<Vec<String>> = settled(motions).filter(|one| !is_usual(one)).map(row).collect();
    let head =
        [&*column(motions.over().symbol()).heading(), "branch", "motion", "E1max, J", "starts", "from rest"];
    if rows.is_empty() {
        return Block::words("All starts end on branches that runs from rest lead to.");
    }
    let words = format!(
        "Where starts end on motions that no run from rest leads to, or on none that repeats; {ATTRACTORS} has all."
    );
    Block::table(words, head, rows)
}

/// The parameters for which the page says how far each can be changed before a motion vanishes, besides [`Parameter::AMPLITUDES`]: the
/// gaps, the dashpot, the spring.
const TRIED: [Parameter; 4] = [Parameter::D, Parameter::C, Parameter::C2, Parameter::K2];
/// Range over which a parameter is changed, as multiples of its value.
const REACH: [f64; 2] = [0.3, 3.0];

/// The change of a parameter that removes a motion, up to the fold where it vanishes, in words: "D above 0.636 m (28.4 mm more)". None if
/// there is no fold in range.
fn remedy(branch: &Branch, orbit: &Orbit, parameter: Parameter) -> Option<String> {
    let nominal = parameter.of(&branch.shooting.forced.scene).filter(|nominal| *nominal > 0.0)?;
    let shooting = branch.shooting.along(orbit.value, parameter, nominal).ok()?;
    let seed = shooting.correct_at_value(&shooting.unknowns(&orbit.states, nominal))?;
    let along = trace(&shooting, &seed, REACH.map(|share| share * nominal), &|| true)?;
    let seed = along.points.iter().position(|point| point.value == nominal)?;
    let folds = || along.events.iter().filter(|event| event.kind == EventKind::Fold);
    // The branch is traced towards larger values first; a closed branch comes back from the other side.
    let closed = along.ends == [End::Closed; 2];
    let below = folds().rfind(|event| event.place < seed || closed).map(|event| event.orbit.value);
    let above = folds().find(|event| event.place > seed).map(|event| event.orbit.value);
    let way = |end: f64, side: &str, more: &str| {
        let (unit, change) = (parameter.unit(), (end - nominal).abs());
        let change = match unit {
            "m" => format!("{:.1} mm", 1e3 * change),
            _ => format!("{} {unit}", rounded(change, 3)),
        };
        format!("{} {side} {} {unit} ({change} {more})", parameter.symbol(), rounded(end, 4))
    };
    let above = above.filter(|end| *end > nominal).map(|end| way(end, "above", "more"));
    let below = below.filter(|end| *end < nominal).map(|end| way(end, "below", "less"));
    let ways: Vec<String> = above.into_iter().chain(below).collect();
    (!ways.is_empty()).then(|| ways.join(" or "))
}

/// The basins at one value of the parameter.
fn basins(motions: &Motions, basins: &Basins) -> Vec<Block> {
    let place = motions.at(basins.sample.value, 6);
    let words = format!(
        "{} at {place}: at a crest of the force the structure is displaced by x1 and has the speed v1, with the damper at rest in it. Each run is \
         followed until it is within 1e-4 of a motion on which runs from other starts settle there, for 480 periods at most. The last column is \
         the least E1 of these starts: how hard the structure must be pushed to get there.",
        counted(basins.ends.len() as u64, "start")
    );
    let known = (0..basins.sample.attractors.len()).map(Some);
    let others = basins.ends.contains(&None).then_some(None);
    let rows = known.chain(others).map(|motion| ends_on(motions, basins, motion)).collect();
    let head = ["motion", "branch", "what it is", "E1max, J", "starts", "least E1 of them, J"];
    let heading = format!("Where the starts of the plane end; {STARTS} has each.");
    let caption = format!("The motion on which each start ends, at {place}");
    let figure = Block::figure("basins.svg", draw::basins(motions, basins), caption);
    vec![Block::words(words), figure, Block::table(heading, head, rows)]
}

/// The starts that end on a motion, or on none of those that are known.
fn ends_on(motions: &Motions, basins: &Basins, motion: Option<usize>) -> Vec<String> {
    let one = motion.map(|number| &basins.sample.attractors[number]);
    let starts = || basins.starts().filter(|(_, end)| *end == motion).map(|(start, _)| start);
    let bare = Bare::new(&motions.study.scene.primary, &motions.study.scene.forcing);
    let push = starts().map(|[x1, v1]| bare.primary_energy(x1, v1)).fold(f64::INFINITY, f64::min);
    let or_none = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    vec![
        or_none(motion.map(|number| number.to_string())),
        or_none(one.and_then(|one| one.branch).map(|branch| branch.to_string())),
        one.map_or("irregular, or none of these".to_owned(), |one| kind(&one.orbit)),
        or_none(one.map(|one| joule(energy(&one.orbit)))),
        format!("{} %", rounded(100.0 * starts().count() as f64 / basins.ends.len() as f64, 3)),
        or_none(push.is_finite().then(|| rounded(push, 3))),
    ]
}
