//! Figure 3: the curves of the largest energy for several stiffnesses.

use super::detuning::{Detuned, statements};
use super::family::{Family, Peak};
use super::item::{Grid, Item, Verdict, numbers};
use super::ladder::{self, Ladder};
use super::plan::{Plan, stiffness};
use crate::Error;
use retune_report::colour::{BLUE, Colour, GREEN, ORANGE, PURPLE, SKY, VERMILION};
use retune_report::{Axis, Chart, Dash, Drawing, Key, Layer, Sheet, Stroke, Width, drawing};

const NAMES: [&str; 3] = ["without damper", "with SSVI NES", "with TMD"];
/// One colour and dash for each stiffness; the tuned one is red, as in the paper.
const OTHERS: [(Colour, Dash); 5] = [
    (BLUE, Dash::Solid),
    (SKY, Dash::Long),
    (GREEN, Dash::Short),
    (PURPLE, Dash::DashDot),
    (ORANGE, Dash::Dots),
];

/// Makes Figure 3.
///
/// # Errors
/// A run fails.
pub fn figure3(plan: &Plan) -> Result<Item, Error> {
    let families = Family::all(plan, "figure 3")?;
    let paper = "E1max against the frequency for several stiffnesses k1, dampers tuned at k1 = 3.95e4 N/m (red): without damper, with SSVI NES, with TMD.";
    let mut item = Item::new(
        "figure3",
        "Figure 3. Does a damper keep its tuning?",
        paper,
        plan.made_by("One run from rest at each frequency."),
    );
    item.picture(
        "figure3",
        picture(plan, &families),
        "Largest energy of the primary structure after the transient. The tuned stiffness is red.",
    );
    let header = "k1_N_per_m,omega_rad_per_s,E1max_none_J,E1max_SSVI_J,E1max_TMD_J,E2max_SSVI_J,E2max_TMD_J,impacts_PS,impacts_obstacle";
    let rows = families.iter().flat_map(|f| {
        (0..f.points[0].len()).map(move |i| {
            let [none, ssvi, tmd] = [0, 1, 2].map(|s| f.points[s][i]);
            let [ps, obstacle] = ssvi.impacts.map(|n| n as f64);
            vec![
                f.k1,
                none.value,
                none.e1_max,
                ssvi.e1_max,
                tmd.e1_max,
                ssvi.e2_max,
                tmd.e2_max,
                ps,
                obstacle,
            ]
        })
    });
    item.data.push(("figure3.csv".into(), numbers(header, rows)));
    let climb = |family| {
        let ladders = |family: &Family| family.scenes.map(|scene| Ladder::climb(plan, &scene));
        Detuned { family, ladders: ladders(family) }
    };
    let climbed: Vec<Detuned> = families.iter().map(climb).collect();
    item.grids.push(highest(&climbed));
    item.grids.push(ladders(plan, &climbed));
    statements(plan, &climbed, &mut item);
    never_touches(&families, &mut item);
    Ok(item)
}

fn picture(plan: &Plan, families: &[Family]) -> Drawing {
    let style = |i: usize, k1: f64| {
        let (colour, dash) = OTHERS[i % OTHERS.len()];
        if k1 == plan.tuned() {
            Stroke::new(VERMILION, 1.5, Dash::Solid)
        } else {
            Stroke::new(colour, 1.1, dash)
        }
    };
    let top = families.iter().map(|f| f.highest(0).energy).fold(0.0, f64::max) * 1.06;
    let chart = |scene: usize| Chart {
        title: format!("({}) {}", ["a", "b", "c"][scene], NAMES[scene]),
        x: Axis::linear("ω, rad/s", (plan.file.omega.from, plan.file.omega.to)),
        y: Axis::linear("E1max, J", (0.0, if scene == 0 { top } else { 0.7 * top })),
        layers: families
            .iter()
            .enumerate()
            .map(|(i, family)| Layer::Line {
                points: family.points[scene].iter().map(|p| (p.value, p.e1_max)).collect(),
                stroke: style(i, family.k1),
            })
            .collect(),
        height: 140.0,
    };
    let key = |(i, family): (usize, &Family)| {
        (Key::Line(style(i, family.k1)), format!("k1 = {} N/m", stiffness(family.k1)))
    };
    drawing(&Sheet {
        title: "E1max against the frequency".to_owned(),
        description: "E1max against ω for several stiffnesses k1: (a) without damper, (b) with the SSVI NES, (c) with the TMD.".to_owned(),
        width: Width::Page,
        charts: (0..3).map(chart).collect(),
        columns: 1,
        stacked: false,
        legend: families.iter().enumerate().map(key).collect(),
        caption: Vec::new(),
    })
}

fn never_touches(families: &[Family], item: &mut Item) {
    let touched: usize =
        families.iter().flat_map(|f| &f.points[2]).filter(|point| point.impacts != [0; 2]).count();
    let all: usize = families.iter().map(|f| f.points[2].len()).sum();
    item.statement(
        "Large values of C and D ensure that the TMD touches nothing",
        "Holds if the TMD touches no wall in the window of any run behind these curves.",
        Verdict::of(touched == 0),
        format!("{touched} of {all} runs with an impact"),
    );
}

/// What the highest points are worth.
fn ladders(plan: &Plan, climbed: &[Detuned]) -> Grid {
    let mut grid = ladder::grid(
        plan,
        "The highest points on ever finer frequencies, and of designs near",
        &["k1, N/m", "damper"],
    );
    for f in climbed {
        for (name, ladder) in ["none", "SSVI NES", "TMD"].into_iter().zip(&f.ladders) {
            let mut row = vec![stiffness(f.family.k1), name.to_owned()];
            row.extend(ladder.cells());
            grid.rows.push(row);
        }
    }
    grid
}

fn highest(climbed: &[Detuned]) -> Grid {
    let head = [
        "k1, N/m",
        "ω₀, rad/s",
        "no damper: E1max, J",
        "at ω",
        "SSVI NES: E1max, J",
        "at ω",
        "reduced",
        "TMD: E1max, J",
        "at ω",
        "reduced",
    ];
    let mut grid =
        Grid::new("Highest points of the curves, and the reduction on the finest frequencies", &head);
    for detuned in climbed {
        let f = detuned.family;
        let [none, ssvi, tmd] = [0, 1, 2].map(|scene| f.highest(scene));
        let pair = |p: Peak| [format!("{:.1}", p.energy), format!("{:.2}", p.omega)];
        let mut row = vec![stiffness(f.k1), format!("{:.3}", f.natural)];
        row.extend(pair(none));
        row.extend(pair(ssvi));
        row.push(format!("{:.2} ×", detuned.finest(1)));
        row.extend(pair(tmd));
        row.push(format!("{:.2} ×", detuned.finest(2)));
        grid.rows.push(row);
    }
    grid
}
