//! The basins at one value of the parameter: their table, figure and words.

use crate::branches::motions::{Motions, joule, kind};
use crate::branches::tables::STARTS;
use retune_dynamics::periodic::Basins;
use retune_model::{Bare, Measure};
use retune_report::document::Block;
use retune_report::{Nodes, Place, Scale, Sheet, heat_map, svg};
use retune_study::{counted, rounded};

/// The words, the figure and the list of motions.
pub fn blocks(motions: &Motions, basins: &Basins) -> Vec<Block> {
    let place = motions.at(basins.sample.value, 6);
    let words = format!(
        "{} at {place}: at a crest of the force the structure is displaced by x1 and has the speed v1, with the damper at rest in it. Each run is \
         followed until it is within 1e-4 of a motion on which runs from other starts settle there, for 480 periods at most. The last column is \
         the least E1 of these starts: how hard the structure must be pushed to get there.",
        counted(basins.ends.len() as u64, "start")
    );
    let mut rows: Vec<Vec<String>> =
        (0..basins.sample.attractors.len()).map(|number| row(motions, basins, Some(number))).collect();
    if basins.ends.contains(&None) {
        rows.push(row(motions, basins, None));
    }
    let head = ["motion", "branch", "what it is", "E1max, J", "starts", "least E1 of them, J"];
    let said = format!("Where the starts of the plane end; {STARTS} has each.");
    let caption = format!("E1max of the motion on which each start ends, at {place}");
    vec![
        Block::words(words),
        Block::figure("basins.svg", draw(motions, basins), caption),
        Block::table(said, head, rows),
    ]
}

/// A motion in the list, or none of those that are known.
fn row(motions: &Motions, basins: &Basins, motion: Option<usize>) -> Vec<String> {
    let one = motion.map(|number| &basins.sample.attractors[number]);
    let own = || basins.starts().filter(|(_, end)| *end == motion).map(|(start, _)| start);
    let bare = Bare::new(&motions.study.scene.primary, &motions.study.scene.forcing);
    let push = own().map(|[x1, v1]| bare.primary_energy(x1, v1)).fold(f64::INFINITY, f64::min);
    let or_none = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    vec![
        or_none(motion.map(|number| number.to_string())),
        or_none(one.and_then(|one| one.branch).map(|branch| branch.to_string())),
        one.map_or("irregular, or none of these".to_owned(), |one| kind(&one.orbit)),
        or_none(one.map(|one| joule(one.orbit.seen.largest(Measure::Energy)))),
        format!("{} %", rounded(100.0 * own().count() as f64 / basins.ends.len() as f64, 3)),
        or_none(push.is_finite().then(|| rounded(push, 3))),
    ]
}

/// The figure.
fn draw(motions: &Motions, basins: &Basins) -> String {
    let place = motions.at(basins.sample.value, 6);
    let side = |label: &str, values: &[f64]| Nodes {
        label: label.to_owned(),
        scale: Scale::Linear,
        values: values.to_vec(),
    };
    let sides =
        [side("x1 at the start, m", &basins.sides[0]), side("v1 at the start, m/s", &basins.sides[1])];
    let energy = |end: &Option<usize>| {
        end.map_or(f64::NAN, |end| basins.sample.attractors[end].orbit.seen.largest(Measure::Energy))
    };
    let energies: Vec<f64> = basins.ends.iter().map(energy).collect();
    let places = [Place { at: (0.0, 0.0), label: "from rest".to_owned() }];
    let (chart, legend) = heat_map(&sides, &energies, "E1max, J", &places);
    let irregular =
        if basins.ends.contains(&None) { "; grey: none of the motions that are known" } else { "" };
    let what = format!("E1max of the motion on which each start ends, at {place}{irregular}.");
    let description = format!("{what} Marked: the start from rest.");
    let sheet = Sheet::of(format!("Basins at {place}"), vec![chart]);
    svg(&Sheet { description, legend, caption: vec![what, motions.made_by()], ..sheet })
}
