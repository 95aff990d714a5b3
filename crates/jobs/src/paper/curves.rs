//! Figure 3: the curves of the largest energy for several stiffnesses.

use super::detuning::{Detuned, statements};
use super::family::Family;
use super::item::Item;
use super::measures::{Ladder, ladder_table};
use super::plan::{Plan, stiffness};
use crate::Error;
use retune_dynamics::Point;
use retune_report::colour::{BLUE, Colour, GREEN, ORANGE, PURPLE, SKY, VERMILION};
use retune_report::document::Verdict;
use retune_report::table::{Cell, Table};
use retune_report::{Axis, Chart, Dash, Key, Layer, Sheet, Stroke, cells};

const TITLES: [&str; 3] = ["(a) without damper", "(b) with SSVI NES", "(c) with TMD"];
/// One colour and dash for each stiffness; the tuned one is red, as in the paper.
const OTHERS: [(Colour, Dash); 5] = [
    (BLUE, Dash::Solid),
    (SKY, Dash::Long),
    (GREEN, Dash::Short),
    (PURPLE, Dash::DashDot),
    (ORANGE, Dash::Dots),
];

pub fn figure3(plan: &Plan) -> Result<Item, Error> {
    let families = Family::all(plan, "figure 3")?;
    let mut item = Item::new(plan.made_by("One run from rest at each frequency."));
    item.picture(
        "figure3",
        &picture(plan, &families),
        "Largest energy of the primary structure after the transient. The tuned stiffness is red.",
    );
    let mut data = Table::named(
        "k1_N_per_m,omega_rad_per_s,E1max_none_J,E1max_SSVI_J,E1max_TMD_J,E2max_SSVI_J,E2max_TMD_J,impacts_PS,impacts_obstacle",
    );
    for Family { k1, points: [none, ssvi, tmd], .. } in &families {
        for ((none, ssvi), tmd) in none.iter().zip(ssvi).zip(tmd) {
            let energies = [none.e1_max, ssvi.e1_max, tmd.e1_max, ssvi.e2_max, tmd.e2_max];
            let impacts = ssvi.impacts.map(Cell::from).into();
            data.push([cells![*k1, none.value], energies.map(Cell::from).into(), impacts].concat());
        }
    }
    item.data("figure3", data);
    let ladders = |family: &Family| family.scenes.map(|scene| Ladder::climb(plan, &scene));
    let all: Vec<Detuned> =
        families.iter().map(|family| Detuned { family, ladders: ladders(family) }).collect();
    item.table("Highest points of the curves, and the reduction on the finest frequencies", highest(&all));
    let mut table = ladder_table(plan, "k1, N/m | damper");
    for Detuned { family, ladders } in &all {
        for (name, ladder) in ["none", "SSVI NES", "TMD"].into_iter().zip(ladders) {
            table.push([cells![stiffness(family.k1), name], ladder.cells()].concat());
        }
    }
    item.table("The highest points on ever finer frequencies, and of designs near", table);
    statements(plan, &all, &mut item);
    let runs: Vec<&Point> = families.iter().flat_map(|family| &family.points[2]).collect();
    let touched = runs.iter().filter(|point| point.impacts != [0; 2]).count();
    item.statement(
        "Large values of C and D ensure that the TMD touches nothing",
        "Holds if the TMD touches no wall in the window of any run behind these curves.",
        Verdict::of(touched == 0),
        format!("{touched} of {} runs with an impact", runs.len()),
    );
    Ok(item)
}

fn picture(plan: &Plan, families: &[Family]) -> Sheet {
    let style = |i: usize, family: &Family| match OTHERS[i % OTHERS.len()] {
        _ if family.k1 == plan.tuned() => Stroke::new(VERMILION, 1.5, Dash::Solid),
        (colour, dash) => Stroke::new(colour, 1.1, dash),
    };
    let top = families.iter().map(|f| f.highest(0).energy).fold(0.0, f64::max) * 1.06;
    let chart = |scene: usize| {
        let x = Axis::linear("ω, rad/s", (plan.file.omega.from, plan.file.omega.to));
        let y = Axis::linear("E1max, J", (0.0, if scene == 0 { top } else { 0.7 * top }));
        let line = |(i, f): (usize, &Family)| {
            Layer::line(f.points[scene].iter().map(|p| (p.value, p.e1_max)), style(i, f))
        };
        let layers = families.iter().enumerate().map(line).collect();
        Chart { title: TITLES[scene].to_owned(), ..Chart::of(x, y, layers, 140.0) }
    };
    let key = |(i, family): (usize, &Family)| {
        (Key::Line(style(i, family)), format!("k1 = {} N/m", stiffness(family.k1)))
    };
    Sheet {
        legend: families.iter().enumerate().map(key).collect(),
        ..Sheet::page(
            "E1max against the frequency",
            "E1max against ω for several stiffnesses k1: (a) without damper, (b) with the SSVI NES, (c) with the TMD.",
            (0..3).map(chart).collect(),
        )
    }
}

fn highest(all: &[Detuned]) -> Table {
    let mut table = Table::headed(
        "k1, N/m | ω₀, rad/s | no damper: E1max, J | at ω | SSVI NES: E1max, J | at ω | reduced | TMD: E1max, J | at ω | reduced",
    );
    for detuned in all {
        let family = detuned.family;
        let mut row = cells![stiffness(family.k1), format!("{:.3}", family.natural)];
        for scene in 0..3 {
            let peak = family.highest(scene);
            row.extend(cells![format!("{:.1}", peak.energy), format!("{:.2}", peak.omega)]);
            if scene > 0 {
                row.extend(cells![format!("{:.2} ×", detuned.reduction(scene, Ladder::finest))]);
            }
        }
        table.push(row);
    }
    table
}
