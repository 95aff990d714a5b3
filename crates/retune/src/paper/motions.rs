//! Figure 4: where the damper strikes what, and what motions there are.

use super::curves::Family;
use super::item::{Grid, Item, Verdict};
use super::plan::{Plan, stiffness};
use crate::error::Error;
use crate::figure::sheet::{BLACK, BLUE, Chart, GREEN, Key, Layer, ORANGE, PURPLE, SKY, VERMILION, sheet};
use indicatif::ProgressBar;
use rayon::prelude::*;
use retune_atlas::strobe::Periods;
use retune_atlas::sweep::zones;
use retune_atlas::{Kind, Orbit, Parameter, Regime, Stretch, Zone, carried, classify, follow, fresh_orbits};
use retune_model::Scene;
use std::collections::BTreeSet;
use std::fmt::Write;

/// The motions at one stiffness over the frequencies around its resonance.
struct Motions {
    omega: Vec<f64>,
    regimes: Vec<Regime>,
    /// From rest; carried upwards; carried downwards.
    orbits: [Vec<Orbit>; 3],
}

const STARTS: [&str; 3] = ["rest", "up", "down"];
const RECORD: usize = 40;

impl Motions {
    fn compute(plan: &Plan, scene: &Scene, natural: f64, bar: &ProgressBar) -> Result<Self, Error> {
        let omega: Vec<f64> = plan.file.motions.values().into_iter().map(|ratio| ratio * natural).collect();
        let down: Vec<f64> = omega.iter().rev().copied().collect();
        let settings = plan.settings();
        let regime = |&value: &f64| -> Result<Regime, retune_atlas::Error> {
            let record = follow(&Parameter::Omega.at(*scene, value)?, None, Stretch::default(), &settings)?;
            bar.inc(1);
            Ok(classify(&record))
        };
        let regimes: Vec<Result<Regime, retune_atlas::Error>> = omega.par_iter().map(regime).collect();
        let sweep = |values: &[f64]| {
            let periods = Periods { settle: 150, record: RECORD };
            carried(scene, Parameter::Omega, values, periods, &settings, || bar.inc(1))
        };
        let (up, back) = rayon::join(|| sweep(&omega), || sweep(&down));
        let mut back = back?;
        back.reverse();
        let periods = Periods { settle: 400, record: RECORD };
        let rest = fresh_orbits(scene, Parameter::Omega, &omega, periods, &settings, || bar.inc(1))?;
        Ok(Self { omega, regimes: regimes.into_iter().collect::<Result<_, _>>()?, orbits: [rest, up?, back] })
    }

    /// Neighbouring frequencies with the same name: `(label, first, last)`.
    fn windows(&self) -> Vec<(String, usize, usize)> {
        let mut found: Vec<(String, usize, usize)> = Vec::new();
        for (i, regime) in self.regimes.iter().enumerate() {
            let label = regime.label();
            match found.last_mut() {
                Some((last, _, to)) if *last == label => *to = i,
                _ => found.push((label, i, i)),
            }
        }
        found
    }

    /// Frequencies at which the motion kept on the way up is another than that on the way down.
    fn coexisting(&self) -> usize {
        let pairs = self.orbits[1].iter().zip(&self.orbits[2]).zip(&self.regimes);
        let regular = |regime: &Regime| regime.kind == Kind::Periodic;
        pairs
            .filter(|((up, down), regime)| regular(regime) && (up.e1_max / down.e1_max - 1.0).abs() > 0.02)
            .count()
    }
}

/// The colour of a kind of motion.
fn colour(kind: Kind) -> &'static str {
    match kind {
        Kind::Periodic => SKY,
        Kind::AmplitudeModulated => ORANGE,
        Kind::Chaotic => VERMILION,
        Kind::Intermittent => PURPLE,
        Kind::Settling => BLACK,
    }
}

/// Makes Figure 4.
///
/// # Errors
/// A run fails.
pub fn figure4(plan: &Plan) -> Result<Item, Error> {
    let families = Family::all(plan, "figure 4, curves")?;
    let count = families.len() * plan.file.motions.points * 4;
    let bar = plan.screen.progress("figure 4, motions", count as u64);
    let mut all = Vec::new();
    for family in &families {
        all.push(Motions::compute(plan, &plan.scenes(family.k1)?[1], family.natural, &bar)?);
    }
    bar.finish_and_clear();
    let mut item = Item::new(
        "figure4",
        "Figure 4. Impact zones and motions",
        "For five stiffnesses: zones of impacts on both walls (pink) and on the structure only (blue), E1max of all three scenes, E2max, and bifurcation diagrams with regimes nT, m, k.",
        plan.made_by(
            "Zones and curves: one run from rest at each frequency. Names of motions: 1000 periods from rest, the last 500 judged. \
             Sweeps: 150 periods to settle at each frequency, the state carried over.",
        ),
    );
    for (family, motions) in families.iter().zip(&all) {
        let charts = [zone_chart(family), orbit_chart(family, motions)];
        let svg = sheet(&charts, 2, 560.0, &legend());
        let caption = format!(
            "k₁ = {} N/m. Left: impact zones, energies and the natural frequency (upright line). Right: x₂ at the crests of the force; \
             the strip on top is coloured by the kind of motion reached from rest.",
            stiffness(family.k1)
        );
        item.picture(&format!("figure4-k1-{}", stiffness(family.k1)), svg, &caption);
    }
    item.grids.push(names(&families, &all));
    item.data.push(("figure4-regimes.csv".into(), regimes_csv(&families, &all)));
    item.data.push(("figure4-orbits.csv".into(), orbits_csv(&families, &all)));
    statements(&families, &all, &mut item);
    Ok(item)
}

fn legend() -> Vec<(Key, &'static str)> {
    vec![
        (Key::Area(PURPLE, 0.35), "both walls struck"),
        (Key::Area(SKY, 0.35), "PS only"),
        (Key::Line(BLACK, "12 8"), "E₁max, no damper"),
        (Key::Line(VERMILION, "3 5"), "E₁max, SSVI NES"),
        (Key::Line(GREEN, ""), "E₁max, TMD"),
        (Key::Line(ORANGE, ""), "E₂max, SSVI NES"),
        (Key::Dot(BLACK), "from rest"),
        (Key::Dot(BLUE), "sweep up"),
        (Key::Dot(ORANGE), "sweep down"),
        (Key::Area(SKY, 1.0), "periodic"),
        (Key::Area(ORANGE, 1.0), "amplitude-modulated"),
        (Key::Area(VERMILION, 1.0), "chaotic"),
        (Key::Area(PURPLE, 1.0), "intermittent"),
        (Key::Area(BLACK, 1.0), "still settling"),
    ]
}

fn zone_chart(family: &Family) -> Chart {
    let mut layers: Vec<Layer> = zones(&family.points[1])
        .into_iter()
        .filter_map(|(zone, from, to)| {
            let colour = match zone {
                Zone::Bilateral => PURPLE,
                Zone::PrimaryOnly => SKY,
                Zone::ObstacleOnly | Zone::None => return None,
            };
            Some(Layer::Band { from, to, colour, opacity: 0.35, height: (0.0, 1.0) })
        })
        .collect();
    layers.push(Layer::Upright { x: family.natural });
    let curve = |scene: usize, damper: bool| {
        family.points[scene].iter().map(|p| (p.value, if damper { p.e2_max } else { p.e1_max })).collect()
    };
    layers.push(Layer::Line { points: curve(0, false), colour: BLACK, width: 3.0, dash: "12 8" });
    layers.push(Layer::Line { points: curve(2, false), colour: GREEN, width: 4.0, dash: "" });
    layers.push(Layer::Line { points: curve(1, true), colour: ORANGE, width: 3.5, dash: "" });
    layers.push(Layer::Line { points: curve(1, false), colour: VERMILION, width: 5.0, dash: "3 5" });
    let top = family.highest(0).energy.max(family.highest(1).energy);
    Chart {
        title: format!("k₁ = {} N/m: impact zones, energies", stiffness(family.k1)),
        labels: ["ω, rad/s".into(), "E, J".into()],
        ranges: [(0.7 * family.natural, 1.3 * family.natural), (0.0, 1.05 * top)],
        log: false,
        layers,
    }
}

fn orbit_chart(family: &Family, motions: &Motions) -> Chart {
    let dots = |start: usize, colour, size| Layer::Dots {
        points: motions.orbits[start]
            .iter()
            .flat_map(|o| o.samples.iter().map(|y| (o.value, y[2])))
            .collect(),
        colour,
        size,
    };
    let half = |i: usize| {
        0.5 * (motions.omega[(i + 1).min(motions.omega.len() - 1)] - motions.omega[i.saturating_sub(1)]) * 0.5
    };
    let mut layers: Vec<Layer> = motions
        .regimes
        .iter()
        .enumerate()
        .map(|(i, regime)| {
            let (omega, half) = (motions.omega[i], half(i));
            Layer::Band {
                from: omega - half,
                to: omega + half,
                colour: colour(regime.kind),
                opacity: 1.0,
                height: (0.95, 1.0),
            }
        })
        .collect();
    layers.extend([dots(0, BLACK, 6.0), dots(2, ORANGE, 4.5), dots(1, BLUE, 3.0)]);
    let mut widest = motions.windows();
    widest.retain(|(label, ..)| label.contains(','));
    widest.sort_by_key(|(_, from, to)| std::cmp::Reverse(to - from));
    let step = motions.omega.len() as f64;
    for (label, from, to) in widest
        .into_iter()
        .filter(|(label, from, to)| (to - from) as f64 > 0.011 * step * label.chars().count() as f64)
    {
        layers.push(Layer::Words {
            x: 0.5 * (motions.omega[from] + motions.omega[to]),
            share: 0.89,
            text: label,
        });
    }
    let values = motions.orbits.iter().flatten().flat_map(|o| o.samples.iter().map(|y| y[2]));
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    Chart {
        title: "x₂ at the crests of the force".into(),
        labels: ["ω, rad/s".into(), "x₂, m".into()],
        ranges: [
            (motions.omega[0], motions.omega[motions.omega.len() - 1]),
            (low - 0.05 * (high - low), high + 0.25 * (high - low)),
        ],
        log: false,
        layers: {
            layers.push(Layer::Upright { x: family.natural });
            layers
        },
    }
}

fn names(families: &[Family], all: &[Motions]) -> Grid {
    let head = ["k1, N/m", "ω, rad/s", "motion", "largest exponent, 1/s", "confidence"];
    let mut grid = Grid::new(
        "The motions from rest, as the frequency rises (windows of three frequencies or more)",
        &head,
    );
    for (family, motions) in families.iter().zip(all) {
        for (label, from, to) in motions.windows().into_iter().filter(|(_, from, to)| to - from >= 2) {
            let part = &motions.regimes[from..=to];
            let mean = |f: fn(&Regime) -> f64| part.iter().map(f).sum::<f64>() / part.len() as f64;
            grid.rows.push(vec![
                stiffness(family.k1),
                format!("{:.3} – {:.3}", motions.omega[from], motions.omega[to]),
                label,
                format!("{:.3}", mean(|regime| regime.exponent.value)),
                format!("{:.2}", mean(|regime| regime.confidence)),
            ]);
        }
    }
    grid
}

fn regimes_csv(families: &[Family], all: &[Motions]) -> String {
    let mut text = "k1_N_per_m,omega_rad_per_s,motion,n,m,k,exponent_per_s,exponent_error_per_s,laminar_share,chaos_until_s,confidence\n".to_owned();
    for (family, motions) in families.iter().zip(all) {
        for (omega, r) in motions.omega.iter().zip(&motions.regimes) {
            let n = r.period.map_or(String::new(), |n| n.to_string());
            let until = r.transient.map_or(String::new(), |t| format!("{:.1}", t.until));
            let ([m, k], exponent) = (r.impacts, r.exponent);
            let _ = writeln!(
                text,
                "{},{omega:.6},\"{}\",{n},{m},{k},{:.5},{:.5},{:.3},{until},{:.3}",
                family.k1,
                r.label(),
                exponent.value,
                exponent.error,
                r.laminar,
                r.confidence
            );
        }
    }
    text
}

fn orbits_csv(families: &[Family], all: &[Motions]) -> String {
    let mut text = "k1_N_per_m,start,omega_rad_per_s,x2_at_crests_mm\n".to_owned();
    for (family, motions) in families.iter().zip(all) {
        for (start, orbits) in STARTS.iter().zip(&motions.orbits) {
            for orbit in orbits {
                let distinct: BTreeSet<i64> =
                    orbit.samples.iter().map(|y| (1e4 * y[2]).round() as i64).collect();
                let list: Vec<String> = distinct.iter().map(|x| format!("{}", *x as f64 / 10.0)).collect();
                let _ = writeln!(text, "{},{start},{:.6},{}", family.k1, orbit.value, list.join(" "));
            }
        }
    }
    text
}

fn statements(families: &[Family], all: &[Motions], item: &mut Item) {
    let both = |family: &Family| {
        zones(&family.points[1]).into_iter().filter(|(zone, ..)| *zone == Zone::Bilateral).collect::<Vec<_>>()
    };
    let around =
        families.iter().all(|f| both(f).iter().any(|(_, from, to)| (*from..=*to).contains(&f.natural)));
    let places = |family: &Family| {
        let list: Vec<String> =
            both(family).iter().map(|(_, from, to)| format!("{from:.2}–{to:.2}")).collect();
        format!("k1 = {}: {}", stiffness(family.k1), list.join(", "))
    };
    item.statement(
        "There are zones of bilateral impacts, around resonance, and zones of impacts on the PS only beside them",
        Verdict::of(around && families.iter().all(|f| f.points[1].iter().any(|p| p.zone() == Zone::PrimaryOnly))),
        format!("bilateral over ω = {}", families.iter().map(places).collect::<Vec<_>>().join("; ")),
    );
    let kinds = [Kind::Periodic, Kind::Chaotic, Kind::AmplitudeModulated, Kind::Intermittent];
    let count = |motions: &Motions, kind: Kind| motions.regimes.iter().filter(|r| r.kind == kind).count();
    let alternate = all
        .iter()
        .all(|m| count(m, Kind::Periodic) > 0 && m.regimes.iter().any(|r| r.kind != Kind::Periodic));
    let found = families.iter().zip(all).map(|(f, m)| {
        let list: Vec<String> =
            kinds.iter().map(|&kind| format!("{} {}", count(m, kind), kind.words())).collect();
        format!("k1 = {}: {}", stiffness(f.k1), list.join(", "))
    });
    let found = found.collect::<Vec<_>>().join("; ");
    item.statement(
        "In all five graphs periodic regimes of different periodicity and numbers of impacts alternate with irregular ones",
        Verdict::of(alternate),
        format!("of {} frequencies each: {found}", all.first().map_or(0, |m| m.omega.len())),
    );
    let seen = |kind: Kind| all.iter().map(|m| count(m, kind)).sum::<usize>();
    let missing: Vec<&str> =
        kinds[1..].iter().filter(|&&kind| seen(kind) == 0).map(|kind| kind.words()).collect();
    item.statement(
        "The irregular regimes are chaotic, amplitude-modulated and intermittent",
        if missing.is_empty() { Verdict::Holds } else { Verdict::Partly },
        format!(
            "{} chaotic, {} amplitude-modulated, {} intermittent{}",
            seen(kinds[1]),
            seen(kinds[2]),
            seen(kinds[3]),
            if missing.is_empty() { String::new() } else { format!("; not seen: {}", missing.join(", ")) }
        ),
    );
    let list: Vec<String> = families
        .iter()
        .zip(all)
        .map(|(f, m)| format!("{} at k1 = {}", m.coexisting(), stiffness(f.k1)))
        .collect();
    item.notes.push(format!(
        "Coexisting motions: frequencies at which the sweep up and the sweep down end in motions whose E1max differ by more than 2 %: {}. The paper shows one motion at each frequency.",
        list.join(", ")
    ));
    item.notes.push("The paper does not say which coordinate its bifurcation diagrams show; ours show x2. Its regime labels are in the picture only, so they cannot be compared one by one.".into());
}
