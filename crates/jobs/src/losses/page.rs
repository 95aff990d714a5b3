//! The page of `losses`, which begins with its answer. Every number on it is one of the table beside it.

use super::compared::{FILE, Losses, Point, Tuning};
use super::draw;
use crate::{Error, pages};
use retune_model::Parameter;
use retune_report::document::{Block, Document};
use retune_store::Directory;
use retune_study::{design_words, rounded};

/// Writes the page and its figures; returns the answer in words.
///
/// # Errors
/// A file cannot be written.
pub(super) fn write(losses: &Losses, directory: &Directory) -> Result<String, Error> {
    let answer = answer(losses);
    let quantity = losses.study.quantity();
    let values = vec![
        Block::figure(
            "losses.svg",
            draw::values(losses),
            format!("Worst {} over the restitution", quantity.name()),
        ),
        values(losses),
    ];
    let tuned = vec![
        Block::figure("dashpot.svg", draw::dashpot(losses), "The re-tuned dashpot over the restitution"),
        designs(losses),
    ];
    let energy = vec![
        Block::figure("powers.svg", draw::powers(losses), "Mean powers lost in the worst run of each damper"),
        Block::words(ENERGY),
    ];
    let page = Document {
        title: "Contacts that lose energy".to_owned(),
        command: "retune losses",
        opening: vec![Block::List(answer.clone()), Block::words(LAW)],
        sections: vec![
            ("values", "What each damper is worth", values),
            ("designs", "What is built for each restitution", tuned),
            ("energy", "Where the energy goes", energy),
            ("data", "Data", vec![Block::files(&[FILE, "resolved.json", "manifest.json"])]),
        ],
    };
    pages::write(&page, directory)?;
    Ok(answer.join("\n"))
}

const LAW: &str = "The restitution e is the speed after over the speed before an undisturbed collision, the same at every speed; with e = 1 contacts \
                   lose nothing, as in the paper. Where a motion is irregular a value is that of the window alone: a longer one may show more. `retune verify` computes each number again.";
const ENERGY: &str = "At the frequency that is worst for the damper at each restitution, over the window of the study. In a motion that repeats, the sum is \
                      the mean power of the force.";

/// The answer, a sentence for each statement.
fn answer(losses: &Losses) -> Vec<String> {
    let quantity = losses.study.quantity();
    let value = |point: &Point| format!("{} {}", rounded(point.worth.value, 4), quantity.unit());
    let ends = |tuning: Tuning| {
        let all: Vec<&Point> = losses.of(tuning).collect();
        Some((*all.first()?, *all.last()?))
    };
    let from_to = |tuning: Tuning, what: &str| {
        let (first, last) = ends(tuning)?;
        let (high, low) = (first.restitution, last.restitution);
        Some(format!("{what}: {} at e = {high}, {} at e = {low}.", value(first), value(last)))
    };
    let dashpot = |point: &Point| rounded(point.design.get(Parameter::C2), 3);
    let anew = ends(Tuning::Anew).map(|(first, last)| {
        format!(
            "Re-tuned for each e it has {} and {}: its dashpot goes from {} to {} N·s/m, for what impacts lose the dashpot need not.",
            value(first),
            value(last),
            dashpot(first),
            dashpot(last)
        )
    });
    let most = losses.of(Tuning::Hedged).max_by(|a, b| a.worth.value.total_cmp(&b.worth.value));
    let hedged = most.map(|most| {
        format!(
            "One damper for all e ({}) has at most {}, at e = {}.",
            design_words(&most.design, 4),
            value(most),
            most.restitution
        )
    });
    [
        from_to(Tuning::Lossless, "A damper tuned as if contacts lost nothing has the worst"),
        anew,
        hedged,
        from_to(Tuning::Paper, "The paper's damper"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The values as a table.
fn values(losses: &Losses) -> Block {
    let quantity = losses.study.quantity();
    let head = std::iter::once("e".to_owned()).chain(Tuning::ALL.map(|tuning| tuning.name().to_owned()));
    let rows = losses.of(Tuning::Anew).map(|point| {
        let of = |tuning: Tuning| {
            let same = losses.of(tuning).find(|other| other.restitution == point.restitution);
            same.map_or(String::new(), |same| rounded(same.worth.value, 4))
        };
        std::iter::once(point.restitution.to_string()).chain(Tuning::ALL.map(of)).collect()
    });
    Block::Table(format!("Worst {}, {}", quantity.name(), quantity.unit()), head.collect(), rows.collect())
}

/// The re-tuned designs as a table.
fn designs(losses: &Losses) -> Block {
    let head = ["e", "k2, N/m", "c2, N·s/m", "D, m", "C, m", "worst at, rad/s", "impacts at up to, m/s"];
    let rows = losses.of(Tuning::Anew).map(|Point { restitution, design, worth, .. }| {
        let numbers = Parameter::PAPER.map(|parameter| rounded(design.get(parameter), 4));
        let last = [rounded(worth.omega, 4), rounded(worth.impact_speed, 3)];
        std::iter::once(restitution.to_string()).chain(numbers).chain(last).collect()
    });
    Block::Table("Re-tuned for each e".to_owned(), head.map(str::to_owned).into(), rows.collect())
}
