//! The page of a design: the answer, all candidates over the band, the damper to scale, what was asked.

use super::answer::{build, findings, rows};
use super::candidate::{Candidate, What};
use super::comparison::Comparison;
use super::requirements::Requirements;
use super::words::asked;
use super::words::{parameters, sized, tuning};
use super::{curves, drawing};
use retune_report::document::{Block, Document};

pub(super) fn page(requirements: &Requirements, compared: &Comparison) -> Document {
    let names: Vec<&str> = compared.all().map(|of| of.what.name()).collect();
    let head: Vec<String> =
        std::iter::once("largest over the band, where").chain(names).map(str::to_owned).collect();
    let rows: Vec<Vec<String>> = rows(requirements, compared);
    let damper = |of: &Candidate| {
        let row = [of.what.name().to_owned(), parameters(of), tuning(of, requirements)];
        row.to_vec()
    };
    let answer = build(requirements, compared).into_iter().map(|line| Block::words(line.trim().to_owned()));
    let sure = findings(requirements, compared);
    let mut opening: Vec<Block> = answer.collect();
    opening.extend(asked(requirements).into_iter().map(Block::words));
    let limits: Vec<Vec<String>> = compared
        .costs
        .iter()
        .map(|cost| {
            let allowed = sized(requirements.allowed(cost.wish), cost.wish.unit());
            let value =
                |of: Option<&Candidate>| of.map_or("-".to_owned(), |of| sized(of.goal, compared.goal.unit()));
            let own = [Some(&compared.tmd), Some(&cost.tmd), compared.ssvi.as_ref(), cost.ssvi.as_ref()];
            [format!("{} at most {allowed}", cost.wish.name())].into_iter().chain(own.map(value)).collect()
        })
        .collect();
    let mut compare = vec![
        Block::table(
            "The largest value of each quantity in the steady motion, and its frequency",
            head,
            rows,
        ),
        Block::table(
            "The dampers",
            ["damper", "parameters", "alone, on a rigid support"],
            compared.dampers().map(damper).collect(),
        ),
    ];
    if !limits.is_empty() {
        let goal = compared.goal.name();
        let head = [
            "limit".to_owned(),
            format!("{goal} of the TMD"),
            "without it".to_owned(),
            format!("{goal} of the SSVI NES"),
            "without it".to_owned(),
        ];
        compare.push(Block::table("What each limit costs", head, limits));
    }
    let chosen = compared.chosen().unwrap_or(&compared.tmd);
    let kind = if chosen.what == What::Ssvi { "The SSVI NES in its cavity" } else { "The TMD" };
    Document {
        title: match compared.choice {
            Some(what) => format!("Build the {}", what.name()),
            None => "No damper keeps the limits".to_owned(),
        },
        command: "retune design",
        opening,
        sections: vec![
            ("compare", "Comparison", compare),
            (
                "band",
                "Over the band",
                vec![Block::figure(
                    "band.svg",
                    curves::curves(requirements, compared),
                    "Each quantity against frequency, once the motion is steady. Grey: what a limit forbids.",
                )],
            ),
            (
                "damper",
                "The damper to scale",
                vec![Block::figure(
                    "damper.svg",
                    drawing::drawing(chosen),
                    format!("{kind}: positions relative to the structure, in mm."),
                )],
            ),
            ("sure", "How sure, and what limits cost", vec![Block::List(sure)]),
            ("files", "Files", vec![Block::files(&["comparison.csv", "design.json", "answer.txt"])]),
        ],
    }
}
