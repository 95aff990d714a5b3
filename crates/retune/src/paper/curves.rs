//! Figure 3: how far a damper keeps its tuning when the stiffness of the structure changes.

use super::item::{Item, Verdict, numbers};
use super::plan::{Plan, natural, stiffness};
use crate::error::Error;
use crate::figure::sheet::{BLUE, Chart, GREEN, Key, Layer, ORANGE, PURPLE, SKY, VERMILION, sheet};
use indicatif::ProgressBar;
use retune_atlas::{Parameter, Point, fresh};

/// The responses at one stiffness over all frequencies: without damper, with SSVI NES, with TMD.
pub struct Family {
    /// Stiffness, N/m.
    pub k1: f64,
    /// Natural frequency, rad/s.
    pub natural: f64,
    /// Without damper, with SSVI NES, with TMD.
    pub points: [Vec<Point>; 3],
}

/// A peak of a curve.
#[derive(Clone, Copy)]
pub struct Peak {
    /// Frequency, rad/s.
    pub omega: f64,
    /// Energy, J.
    pub energy: f64,
}

impl Family {
    /// Computes all three curves at `k1`.
    pub fn compute(plan: &Plan, k1: f64, bar: &ProgressBar) -> Result<Self, Error> {
        let scenes = plan.scenes(k1)?;
        let omega = plan.file.omega.values();
        let mut points = [Vec::new(), Vec::new(), Vec::new()];
        for (scene, place) in scenes.iter().zip(&mut points) {
            *place = fresh(scene, Parameter::Omega, &omega, plan.window(), &plan.settings(), || bar.inc(1))?;
        }
        Ok(Self { k1, natural: natural(&scenes[0]), points })
    }

    /// All families of the plan.
    pub fn all(plan: &Plan, what: &'static str) -> Result<Vec<Self>, Error> {
        let bar = plan.screen.progress(what, (3 * plan.file.k1.len() * plan.file.omega.points) as u64);
        let families = plan.file.k1.iter().map(|&k1| Self::compute(plan, k1, &bar)).collect();
        bar.finish_and_clear();
        families
    }

    /// The highest point of a curve.
    pub fn highest(&self, scene: usize) -> Peak {
        let best = self.points[scene].iter().max_by(|a, b| a.e1_max.total_cmp(&b.e1_max));
        best.map_or(Peak { omega: f64::NAN, energy: f64::NAN }, |p| Peak { omega: p.value, energy: p.e1_max })
    }

    /// How many times smaller the damper makes the highest energy.
    pub fn reduction(&self, scene: usize) -> f64 {
        self.highest(0).energy / self.highest(scene).energy
    }

    /// Humps of a curve: maxima of its running median over [`SMOOTH`] frequencies with a dip of `depth` (a share) between them.
    /// The median takes away the jumps from one frequency to the next where the motion is chaotic.
    pub fn humps(&self, scene: usize, depth: f64) -> Vec<Peak> {
        let median = |part: &[Point]| {
            let mut energies: Vec<f64> = part.iter().map(|p| p.e1_max).collect();
            energies.sort_by(f64::total_cmp);
            Peak { omega: part[part.len() / 2].value, energy: energies[energies.len() / 2] }
        };
        let mut humps: Vec<Peak> = Vec::new();
        let mut dip = f64::INFINITY;
        let mut rising = true;
        for here in self.points[scene].windows(SMOOTH).map(median) {
            match humps.last_mut() {
                Some(_) if !rising && here.energy > dip / (1.0 - depth) => {
                    humps.push(here);
                    (rising, dip) = (true, f64::INFINITY);
                }
                Some(hump) if rising && here.energy > hump.energy => *hump = here,
                Some(hump) if here.energy < (1.0 - depth) * hump.energy => {
                    rising = false;
                    dip = dip.min(here.energy);
                }
                Some(_) => {}
                None => humps.push(here),
            }
        }
        humps
    }
}

/// Frequencies of the running median of [`Family::humps`].
const SMOOTH: usize = 9;

const NAMES: [&str; 3] = ["without damper", "with SSVI NES", "with TMD"];
/// One colour and dash for each stiffness; the tuned one is red, as in the paper.
const OTHERS: [(&str, &str); 5] =
    [(BLUE, ""), (SKY, "18 8"), (GREEN, "6 6"), (PURPLE, "22 6 6 6"), (ORANGE, "12 6")];

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
    item.grids.push(highest(&families));
    statements(plan, &families, &mut item);
    Ok(item)
}

fn picture(plan: &Plan, families: &[Family]) -> String {
    let style =
        |i: usize, k1: f64| if k1 == plan.tuned() { (VERMILION, "") } else { OTHERS[i % OTHERS.len()] };
    let top = families.iter().map(|f| f.highest(0).energy).fold(0.0, f64::max) * 1.06;
    let charts: Vec<Chart> = (0..3)
        .map(|scene| Chart {
            title: format!("({}) {}", ["a", "b", "c"][scene], NAMES[scene]),
            labels: ["ω, rad/s".into(), "E₁max, J".into()],
            ranges: [
                (plan.file.omega.from, plan.file.omega.to),
                (0.0, if scene == 0 { top } else { 0.7 * top }),
            ],
            log: false,
            layers: families
                .iter()
                .enumerate()
                .map(|(i, family)| {
                    let (colour, dash) = style(i, family.k1);
                    let points = family.points[scene].iter().map(|p| (p.value, p.e1_max)).collect();
                    Layer::Line { points, colour, width: if colour == VERMILION { 5.0 } else { 3.5 }, dash }
                })
                .collect(),
        })
        .collect();
    let words: Vec<String> = families.iter().map(|f| format!("k₁ = {} N/m", stiffness(f.k1))).collect();
    let legend: Vec<(Key, &str)> = words
        .iter()
        .enumerate()
        .map(|(i, words)| {
            let (colour, dash) = style(i, families[i].k1);
            (Key::Line(colour, dash), words.as_str())
        })
        .collect();
    sheet(&charts, 1, 480.0, &legend)
}

fn highest(families: &[Family]) -> super::item::Grid {
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
    let mut grid = super::item::Grid::new("Highest points of the curves", &head);
    for f in families {
        let [none, ssvi, tmd] = [0, 1, 2].map(|scene| f.highest(scene));
        let pair = |p: Peak| [format!("{:.1}", p.energy), format!("{:.2}", p.omega)];
        let mut row = vec![stiffness(f.k1), format!("{:.3}", f.natural)];
        row.extend(pair(none));
        row.extend(pair(ssvi));
        row.push(format!("{:.2} ×", f.reduction(1)));
        row.extend(pair(tmd));
        row.push(format!("{:.2} ×", f.reduction(2)));
        grid.rows.push(row);
    }
    grid
}

fn statements(plan: &Plan, families: &[Family], item: &mut Item) {
    let Some(tuned) = families.iter().find(|f| f.k1 == plan.tuned()) else {
        item.notes.push(
            "The tuned stiffness is not among those of the study, so no statement can be checked.".into(),
        );
        return;
    };
    let softer: Vec<&Family> = families.iter().filter(|f| f.k1 < tuned.k1).collect();
    let stiffer: Vec<&Family> = families.iter().filter(|f| f.k1 > tuned.k1).collect();
    let list = |families: &[&Family], scene: usize| {
        families.iter().map(|f| format!("{:.2}", f.reduction(scene))).collect::<Vec<_>>().join(", ")
    };
    let humps = tuned.humps(1, 0.05);
    let place = humps
        .iter()
        .map(|p| format!("{:.0} J at ω = {:.2}", p.energy, p.omega))
        .collect::<Vec<_>>()
        .join(", ");
    item.statement(
        "The SSVI NES provides two resonant peaks",
        if humps.len() == 2 { Verdict::Partly } else { Verdict::Fails },
        format!("in the running median over {SMOOTH} frequencies with a dip of 5 % or more between peaks: {place}; the curve itself has more maxima, for the motion of the second peak is chaotic and its energy jumps from one frequency to the next"),
    );
    let (ssvi, tmd) = (tuned.highest(1).energy, tuned.highest(2).energy);
    item.statement(
        "At the tuned stiffness the SSVI NES reduces vibrations in the resonance zone somewhat better than the TMD",
        Verdict::of(ssvi < tmd),
        format!("highest E1max {ssvi:.0} J against {tmd:.0} J, of {:.0} J without damper", tuned.highest(0).energy),
    );
    let best =
        |scene: usize| families.iter().all(|f| f.reduction(scene) <= tuned.reduction(scene) * (1.0 + 1e-9));
    item.statement(
        "In the version corresponding to the tuning the oscillation suppression is achieved best",
        if best(1) && best(2) {
            Verdict::Holds
        } else if best(1) || best(2) {
            Verdict::Partly
        } else {
            Verdict::Fails
        },
        format!(
            "reduction of the highest energy, k1 rising: SSVI NES {}; TMD {}",
            list(&families.iter().collect::<Vec<_>>(), 1),
            list(&families.iter().collect::<Vec<_>>(), 2)
        ),
    );
    let kept = |f: &&Family, scene: usize| (f.reduction(scene) / tuned.reduction(scene) - 1.0).abs();
    let change = stiffer.iter().flat_map(|f| [kept(f, 1), kept(f, 2)]).fold(0.0, f64::max);
    let differ = stiffer.iter().map(|f| (f.reduction(1) / f.reduction(2) - 1.0).abs()).fold(0.0, f64::max);
    item.statement(
        "With increasing k1 the reduction remains virtually unchanged and identical for SSVI NES and TMD",
        if change < 0.12 && differ < 0.06 {
            Verdict::Holds
        } else if change < 0.25 {
            Verdict::Partly
        } else {
            Verdict::Fails
        },
        format!(
            "it changes by at most {:.0} %, and the two dampers differ by at most {:.0} %",
            100.0 * change,
            100.0 * differ
        ),
    );
    let worse = |scene: usize| softer.iter().all(|f| f.reduction(scene) < tuned.reduction(scene));
    item.statement(
        "When k1 decreases the reduction worsens",
        if worse(1) && worse(2) {
            Verdict::Holds
        } else if worse(1) || worse(2) {
            Verdict::Partly
        } else {
            Verdict::Fails
        },
        format!(
            "softer: SSVI NES {} (tuned {:.2}); TMD {} (tuned {:.2})",
            list(&softer, 1),
            tuned.reduction(1),
            list(&softer, 2),
            tuned.reduction(2)
        ),
    );
    let loss = |f: &&Family, scene: usize| f.reduction(scene) / tuned.reduction(scene);
    let more = softer.iter().all(|f| loss(f, 1) < loss(f, 2));
    item.statement(
        "This deterioration is greater for the SSVI NES; the TMD retains its tuning somewhat better",
        Verdict::of(more),
        softer
            .iter()
            .map(|f| {
                format!(
                    "k1 = {}: {:.0} % of the tuned reduction is left to the SSVI NES, {:.0} % to the TMD",
                    stiffness(f.k1),
                    100.0 * loss(f, 1),
                    100.0 * loss(f, 2)
                )
            })
            .collect::<Vec<_>>()
            .join("; "),
    );
    let mut by_k1: Vec<&Family> = families.iter().collect();
    by_k1.sort_by(|a, b| a.k1.total_cmp(&b.k1));
    let left = by_k1
        .windows(2)
        .all(|pair| (0..3).all(|scene| pair[0].highest(scene).omega < pair[1].highest(scene).omega));
    item.statement(
        "The resonance peak shifts to the left with falling k1",
        Verdict::of(left),
        "the frequency of the highest point rises with k1 on all three curves (table)".into(),
    );
    let low = by_k1[0];
    item.statement(
        "The energy reduction is maintained even at a significantly low stiffness",
        Verdict::of(low.reduction(1) > 1.0 && low.reduction(2) > 1.0),
        format!(
            "k1 = {}: {:.2} times smaller with the SSVI NES, {:.2} times with the TMD",
            stiffness(low.k1),
            low.reduction(1),
            low.reduction(2)
        ),
    );
}
