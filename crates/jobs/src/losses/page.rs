//! The page of `losses` with its figures and its answer. Every number on it comes from the table beside it.

use super::points::{FILE, Losses, Point, Tuning};
use crate::Error;
use crate::pages::{self, figure};
use retune_model::Parameter;
use retune_report::colour::{BLACK, BLUE, GREEN, ORANGE, PURPLE, VERMILION};
use retune_report::document::{Block, Document};
use retune_report::{Axis, Chart, Dash, Drawing, Key, Layer, Mark, Scale, Shape, Sheet, Stroke};
use retune_store::Directory;
use retune_study::{design_words, joined, rounded};

/// Writes the page and its figures; returns the answer in words.
pub(super) fn write(losses: &Losses, directory: &Directory) -> Result<String, Error> {
    let answer = answer(losses);
    let caption = format!("Worst {} over the restitution", losses.study.quantity().name());
    let values = vec![Block::figure("losses.svg", draw_values(losses, &caption), caption), values(losses)];
    let caption = "The re-tuned dashpot over the restitution";
    let tuned = vec![Block::figure("dashpot.svg", draw_dashpot(losses), caption), designs(losses)];
    let caption = "Mean powers lost in the worst run of each damper";
    let energy = vec![Block::figure("powers.svg", draw_powers(losses), caption), Block::words(ENERGY)];
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

/// The answer, one sentence for each damper.
fn answer(losses: &Losses) -> Vec<String> {
    let unit = losses.study.quantity().unit();
    let value = |point: &Point| format!("{} {unit}", rounded(point.value, 4));
    let ends = |tuning: Tuning| losses.of(tuning).next().zip(losses.of(tuning).last());
    let from_to = |tuning: Tuning, what: &str| {
        let (first, last) = ends(tuning)?;
        let (high, low) = (first.restitution, last.restitution);
        Some(format!("{what}: {} at e = {high}, {} at e = {low}.", value(first), value(last)))
    };
    let dashpot = |point: &Point| rounded(point.design.get(Parameter::C2), 3);
    let anew = ends(Tuning::Anew).map(|(first, last)| {
        let [before, after] = [first, last].map(|point| point.design.get(Parameter::C2));
        let dashpots = match before == after {
            true => String::new(),
            false => format!(": its dashpot goes from {} to {} N·s/m", dashpot(first), dashpot(last)),
        };
        let why = if after < before { ", for what impacts lose the dashpot need not" } else { "" };
        format!("Re-tuned for each e it has {} and {}{dashpots}{why}.", value(first), value(last))
    });
    let most = losses.of(Tuning::Hedged).max_by(|a, b| a.value.total_cmp(&b.value));
    let hedged = most.map(|most| {
        let (words, value, e) = (design_words(&most.design, 4), value(most), most.restitution);
        let tuned: Vec<f64> =
            losses.study.objective().restitution.into_iter().flatten().map(|e| e.get()).collect();
        let which = joined(&tuned, ", ");
        let worst = if tuned.len() > 1 { "the worst of " } else { "" };
        let other = if tuned.contains(&e) { "" } else { ", for which it was not tuned" };
        format!("One damper tuned for {worst}e = {which} ({words}) has at most {value}, at e = {e}{other}.")
    });
    let lossless = from_to(Tuning::Lossless, "A damper tuned as if contacts lost nothing");
    let paper = from_to(Tuning::Paper, "The paper's damper");
    let study = from_to(Tuning::Study, "The damper of the study");
    [lossless, anew, hedged, paper, study].into_iter().flatten().collect()
}

fn values(losses: &Losses) -> Block {
    let quantity = losses.study.quantity();
    let tunings = losses.tunings();
    let head = ["e"].into_iter().chain(tunings.iter().map(|tuning| tuning.name()));
    let rows = losses.of(Tuning::Anew).map(|point| {
        let of = |tuning: &Tuning| {
            let same = losses.of(*tuning).find(|other| other.restitution == point.restitution);
            same.map_or(String::new(), |same| rounded(same.value, 4))
        };
        std::iter::once(point.restitution.to_string()).chain(tunings.iter().map(of)).collect()
    });
    Block::table(format!("Worst {}, {}", quantity.name(), quantity.unit()), head, rows.collect())
}

fn designs(losses: &Losses) -> Block {
    let head = ["e", "k2, N/m", "c2, N·s/m", "D, m", "C, m", "worst at, rad/s", "impacts at up to, m/s"];
    let rows = losses.of(Tuning::Anew).map(|Point { restitution, design, omega, impact_speed, .. }| {
        let numbers = Parameter::PAPER.map(|parameter| rounded(design.get(parameter), 4));
        let last = [rounded(*omega, 4), rounded(*impact_speed, 3)];
        std::iter::once(restitution.to_string()).chain(numbers).chain(last).collect()
    });
    Block::table("Re-tuned for each e", head, rows.collect())
}

const fn line(tuning: Tuning) -> Stroke {
    match tuning {
        Tuning::Paper | Tuning::Study => Stroke::new(PURPLE, 1.1, Dash::DashDot),
        Tuning::Lossless => Stroke::new(VERMILION, 1.3, Dash::Long),
        Tuning::Hedged => Stroke::solid(GREEN),
        Tuning::Anew => Stroke::new(BLUE, 1.3, Dash::Solid),
    }
}

const ANEW: Mark = Mark::new(Shape::Disc, BLUE, 4.0);

/// Points of a damper over the restitution.
fn points(losses: &Losses, tuning: Tuning, value: impl Fn(&Point) -> f64) -> Vec<(f64, f64)> {
    losses.of(tuning).map(|point| (point.restitution, value(point))).collect()
}

fn chart(losses: &Losses, y: Axis, layers: Vec<Layer>, height: f64) -> Chart {
    let all = || losses.points.iter().map(|(_, point)| point.restitution);
    let [low, high] = [f64::min, f64::max].map(|of| all().reduce(of).unwrap_or(1.0));
    Chart::of(Axis::new("restitution e", Scale::Linear, (low, high)), y, layers, height)
}

fn draw(
    losses: &Losses,
    title: &str,
    description: &str,
    legend: Vec<(Key, String)>,
    charts: Vec<Chart>,
) -> Drawing {
    let description = description.to_owned();
    figure(Sheet { description, legend, ..Sheet::of(title, charts) }, Some(&losses.study))
}

/// The value of each damper over the restitution.
fn draw_values(losses: &Losses, description: &str) -> Drawing {
    let quantity = losses.study.quantity();
    let all = losses.points.iter().map(|(_, point)| point.value);
    let y = Axis::around(format!("worst {}, {}", quantity.name(), quantity.unit()), Scale::Log, all);
    let tunings = losses.tunings();
    let layer = |tuning: &Tuning| Layer::line(points(losses, *tuning, |point| point.value), line(*tuning));
    let legend = tunings.iter().map(|tuning| (Key::Line(line(*tuning)), tuning.name().to_owned())).collect();
    let charts = vec![chart(losses, y, tunings.iter().map(layer).collect(), 220.0)];
    draw(losses, "Dampers whose contacts lose energy", description, legend, charts)
}

/// The dashpot of the re-tuned damper over the restitution.
fn draw_dashpot(losses: &Losses) -> Drawing {
    let points = points(losses, Tuning::Anew, |point| point.design.get(Parameter::C2));
    let values: Vec<f64> = points.iter().map(|(_, value)| *value).chain([0.0]).collect();
    let stroke = line(Tuning::Anew);
    let layers = vec![Layer::line(points.clone(), stroke), Layer::Marks { points, mark: ANEW }];
    let charts = vec![chart(losses, Axis::fitting("c2, N·s/m", &values), layers, 175.0)];
    let legend = vec![(Key::Marked(stroke, ANEW), Tuning::Anew.name().to_owned())];
    let title = "The dashpot of the re-tuned damper";
    draw(losses, title, title, legend, charts)
}

/// The powers of the worst run over the restitution, a chart for each damper.
fn draw_powers(losses: &Losses) -> Drawing {
    let parts = [
        ("dashpot of the structure", Stroke::new(BLACK, 1.1, Dash::Short)),
        ("dashpot of the damper", Stroke::new(BLUE, 1.3, Dash::Solid)),
        ("impacts", Stroke::new(ORANGE, 1.3, Dash::Long)),
    ];
    let all: Vec<f64> = losses.points.iter().flat_map(|(_, point)| point.powers).chain([0.0]).collect();
    let y = Axis::fitting("mean power, W", &all);
    let of = |tuning: Tuning| {
        let layer =
            |part: usize| Layer::line(points(losses, tuning, |point| point.powers[part]), parts[part].1);
        let chart = chart(losses, y.clone(), (0..3).map(layer).collect(), 150.0);
        Chart { title: tuning.name().to_owned(), ..chart }
    };
    let legend = parts.map(|(name, stroke)| (Key::Line(stroke), name.to_owned()));
    let title = "Where the energy of the worst run goes";
    draw(losses, title, title, legend.into(), losses.tunings().into_iter().map(of).collect())
}
