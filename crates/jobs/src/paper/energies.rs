//! Figure 6: the energies over time at resonance.

use super::item::{Grid, Item, Verdict, numbers};
use super::measures::{best_tmd, tmd_words};
use super::plan::Plan;
use crate::Error;
use retune_model::Scene;
use retune_report::colour::{BLACK, ORANGE, VERMILION};
use retune_report::{Axis, Chart, Dash, Key, Layer, Sheet, Stroke, Width, drawing};
use retune_solver::{Rows, Sample, Window, simulate, trajectory};

const INTERVAL: f64 = 0.05;

/// Makes Figure 6.
///
/// # Errors
/// A run fails.
pub fn figure6(plan: &Plan) -> Result<Item, Error> {
    let scenes = plan.scenes(plan.tuned())?;
    let window = Window { from: 0.0, to: plan.window().to };
    let omega = scenes[1].forcing.frequency.get();
    let record = |scene: &Scene| -> Result<Vec<Sample>, Error> {
        let mut samples = Vec::new();
        trajectory(scene, window, &plan.settings(), Rows::every(INTERVAL), &mut |sample| {
            samples.push(*sample)
        })?;
        Ok(samples)
    };
    let [none, ssvi, tmd] = [record(&scenes[0])?, record(&scenes[1])?, record(&scenes[2])?];
    let mut item = Item::new(
        "figure6",
        "Figure 6. Energies over time at resonance",
        "E1(t) of the structure without damper and with a damper, and E2(t) of the damper, at ω = 6.28 rad/s: (a) SSVI NES, (b) TMD.",
        plan.made_by(&format!("ω = {omega} rad/s, from rest, shown every {INTERVAL} s.")),
    );
    let top = none.iter().map(|s| s.e1).fold(0.0, f64::max) * 1.05;
    const LINES: [(Stroke, &str); 3] = [
        (Stroke::new(BLACK, 0.5, Dash::Solid), "E1, PS without damper"),
        (Stroke::new(VERMILION, 0.7, Dash::Solid), "E1, PS with damper"),
        (Stroke::new(ORANGE, 0.7, Dash::Solid), "E2, damper"),
    ];
    let charts = [("(a) SSVI NES", &ssvi), ("(b) TMD", &tmd)].map(|(title, damper)| {
        let line = |samples: &[Sample], energy: fn(&Sample) -> f64, i: usize| Layer::Line {
            points: samples.iter().map(|s| (s.t, energy(s))).collect(),
            stroke: LINES[i].0,
        };
        Chart {
            title: title.to_owned(),
            x: Axis::linear("t, s", (0.0, window.to)),
            y: Axis::linear("E, J", (0.0, top)),
            layers: vec![line(&none, |s| s.e1, 0), line(damper, |s| s.e1, 1), line(damper, |s| s.e2, 2)],
            height: 150.0,
        }
    });
    let sheet = Sheet {
        title: "Energies over time at resonance".to_owned(),
        description: "E1 of the structure without damper and with one, and E2 of the damper, from rest: (a) SSVI NES, (b) TMD.".to_owned(),
        width: Width::Page,
        charts: charts.to_vec(),
        columns: 1,
        stacked: false,
        legend: LINES.map(|(stroke, words)| (Key::Line(stroke), words.to_owned())).to_vec(),
        caption: Vec::new(),
    };
    item.picture("figure6", drawing(&sheet), "Energies from rest.");
    let rows = none
        .iter()
        .zip(&ssvi)
        .zip(&tmd)
        .map(|((n, s), t)| vec![(n.t * 1e6).round() / 1e6, n.e1, s.e1, s.e2, t.e1, t.e2]);
    item.data
        .push(("figure6.csv".into(), numbers("t_s,E1_none_J,E1_SSVI_J,E2_SSVI_J,E1_TMD_J,E2_TMD_J", rows)));
    // The exact maxima, not those of the rows that are drawn.
    let late = |scene: &Scene| simulate(scene, plan.window(), &plan.settings());
    let [bare, ssvi, tmd] = [late(&scenes[0])?, late(&scenes[1])?, late(&scenes[2])?];
    let e1 = [bare.e1_max.value, ssvi.e1_max.value, tmd.e1_max.value];
    let e2 = [ssvi.e2_max.value, tmd.e2_max.value];
    let share = |e1: f64, e2: f64| retune_model::energy_ratios(e1, e2)[1];
    let tuned = best_tmd(plan)?;
    let best = late(&tuned)?;
    let best = [best.e1_max.value, best.e2_max.value];
    let mut grid = Grid::new(
        "Largest energies after the transient, and the damper's R2, beside the TMD that is tuned (k2 and c2 free, least worst case over 5 to 8 rad/s)",
        &["damper", "E1max, J", "E2max, J", "R2"],
    );
    let dampers = [
        ("SSVI NES, the paper's".to_owned(), [e1[1], e2[0]]),
        ("TMD, the paper's".to_owned(), [e1[2], e2[1]]),
        (format!("TMD, {}", tmd_words(&tuned)), best),
    ];
    for (name, [e1, e2]) in dampers {
        grid.rows.push(vec![name, format!("{e1:.1}"), format!("{e2:.1}"), format!("{:.3}", share(e1, e2))]);
    }
    item.grids.push(grid);
    item.statement(
        "Both dampers effectively reduce the maximum energy of the PS at resonance",
        "The paper gives no number. Holds if the largest energy after the transient is at most half of that without damper, with each damper.",
        Verdict::of_all(&[e1[1] < 0.5 * e1[0], e1[2] < 0.5 * e1[0]]),
        format!(
            "after the transient {:.0} J without damper, {:.0} J with the SSVI NES, {:.0} J with the TMD",
            e1[0], e1[1], e1[2]
        ),
    );
    item.statement(
        "The SSVI NES takes energy from the PS somewhat better than the TMD",
        "Holds if after the transient E1max is the smaller and R2 the larger with the SSVI NES than with the paper's TMD; in part if only one is.",
        Verdict::of_all(&[e1[1] < e1[2], share(e1[1], e2[0]) > share(e1[2], e2[1])]),
        format!(
            "largest E1 {:.0} J against {:.0} J, largest E2 {:.0} J against {:.0} J, R2 {:.2} against {:.2}. But the paper's TMD is mistuned: the best one ({}) has E1 {:.0} J and R2 {:.3}",
            e1[1],
            e1[2],
            e2[0],
            e2[1],
            share(e1[1], e2[0]),
            share(e1[2], e2[1]),
            tmd_words(&tuned),
            best[0],
            share(best[0], best[1])
        ),
    );
    Ok(item)
}
