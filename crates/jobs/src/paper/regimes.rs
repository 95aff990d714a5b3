//! Figure 4: zones of impacts, and the motions in them.

use super::begins::begins;
use super::diagrams;
use super::family::Family;
use super::item::{Grid, Item, Verdict};
use super::motions::{Motions, RUNS, STARTS};
use super::plan::{Plan, stiffness};
use crate::Error;
use retune_dynamics::sweep::zones;
use retune_dynamics::{Kind, Regime, Zone, attractor};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Makes Figure 4.
///
/// # Errors
/// A run fails.
pub fn figure4(plan: &Plan) -> Result<Item, Error> {
    let families = Family::all(plan, "figure 4, curves")?;
    let count = families.len() * plan.file.motions.points * RUNS;
    let bar = plan.watch.progress("figure 4, motions", count as u64);
    let mut all = Vec::new();
    for family in &families {
        all.push(Motions::compute(plan, &plan.scenes(family.k1)?[1], family.natural, &*bar)?);
    }
    bar.finish();
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
        let caption = format!(
            "k₁ = {} N/m. Left: impact zones, energies and the natural frequency (upright line). Right: x₂ at the crests of the force; \
             the strip on top is coloured by the kind of motion reached from rest.",
            stiffness(family.k1)
        );
        let name = format!("figure4-k1-{}", stiffness(family.k1));
        item.picture(&name, diagrams::picture(family, motions), &caption);
    }
    item.grids.push(names(&families, &all));
    item.grids.push(coexisting(&families, &all));
    if !plan.is_brief {
        item.grids.push(begins(plan, &families, &all)?);
    }
    item.data.push(("figure4-regimes.csv".into(), regimes_csv(&families, &all)));
    item.data.push(("figure4-orbits.csv".into(), orbits_csv(&families, &all)));
    statements(&families, &all, &mut item);
    item.notes.push(about_coexisting(&families, &all));
    item.notes.push("Where periodic motions begin and end: the branches of the motions that runs from rest and from four other starts lead to. At a fold the motion vanishes; at a period doubling one of twice the period takes its place; at a grazing an impact begins or ends, and another name goes on; \"the range\" is an end of the figure. Ranges narrower than a step of the figure are left out.".into());
    item.notes.push("How motions are named stands under Figure 7. The paper does not say which coordinate its bifurcation diagrams show; ours show x2. Its regime labels are in the picture only, so they cannot be compared one by one.".into());
    Ok(item)
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

fn coexisting(families: &[Family], all: &[Motions]) -> Grid {
    let head = ["k1, N/m", "ω, rad/s", "motions", "reached first by", "what they are"];
    let mut grid = Grid::new("Frequencies at which more than one motion was found", &head);
    for (family, motions) in families.iter().zip(all) {
        for here in &motions.coexisting {
            let list = |words: &dyn Fn(&(usize, Regime)) -> String| {
                here.motions.iter().map(words).collect::<Vec<_>>().join("; ")
            };
            grid.rows.push(vec![
                stiffness(family.k1),
                format!("{:.3}", motions.omega[here.index]),
                here.motions.len().to_string(),
                list(&|(start, _)| STARTS[*start].to_owned()),
                list(&|(_, regime)| format!("{} ({:.2})", regime.label(), regime.confidence)),
            ]);
        }
    }
    grid
}

fn about_coexisting(families: &[Family], all: &[Motions]) -> String {
    let places = families.iter().zip(all).map(|(family, motions)| {
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        for here in &motions.coexisting {
            *counts.entry(here.motions.len()).or_default() += 1;
        }
        let list: Vec<String> =
            counts.iter().map(|(motions, places)| format!("{motions} motions at {places}")).collect();
        let list = if list.is_empty() { "none with more than one".to_owned() } else { list.join(", ") };
        format!("k1 = {}: {list}", stiffness(family.k1))
    });
    format!(
        "Coexisting motions, of {} frequencies each: {}. Counted are the distinct motions, periodic or not, reached from rest, on the way up and on the way down, each followed for 1000 more periods. Distinct means: the mean distance from the stroboscopic states of one to the nearest of the other is more than {} of the motion's size and more than {} times that between the two halves of either (so that chaos and slow settling do not count as two). The paper shows one motion at each frequency.",
        all.first().map_or(0, |motions| motions.omega.len()),
        places.collect::<Vec<_>>().join("; "),
        attractor::APART,
        attractor::BEYOND
    )
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
    let beside = families.iter().all(|f| f.points[1].iter().any(|p| p.zone() == Zone::PrimaryOnly));
    let places = |family: &Family| {
        let list: Vec<String> =
            both(family).iter().map(|(_, from, to)| format!("{from:.3}–{to:.3}")).collect();
        format!("k1 = {}: {}", stiffness(family.k1), list.join(", "))
    };
    item.statement(
        "There are zones of bilateral impacts, around resonance, and zones of impacts on the PS only beside them",
        "Holds if at every stiffness the natural frequency lies in a bilateral zone and there is a zone of impacts on the PS only; in part if only one of the two is so. A frequency belongs to a zone by the walls struck in the window of the maximum.",
        Verdict::of_all(&[around, beside]),
        format!("bilateral over ω, rad/s: {}", families.iter().map(places).collect::<Vec<_>>().join("; ")),
    );
    let kinds = [Kind::Periodic, Kind::Chaotic, Kind::AmplitudeModulated, Kind::Intermittent];
    let alternate: Vec<bool> = all.iter().map(alternates).collect();
    let found = families.iter().zip(all).map(|(f, m)| {
        let list: Vec<String> =
            kinds.iter().map(|&kind| format!("{} {}", m.count(kind), kind.words())).collect();
        format!("k1 = {}: {}", stiffness(f.k1), list.join(", "))
    });
    let found = found.collect::<Vec<_>>().join("; ");
    item.statement(
        "In all five graphs periodic regimes of different periodicity and numbers of impacts alternate with irregular ones",
        "Holds if at every stiffness there are periodic motions of at least two names nT, m, k, and an irregular one between two periodic ones.",
        Verdict::of_all(&alternate),
        format!("of {} frequencies each: {found}", all.first().map_or(0, |m| m.omega.len())),
    );
    let irregular: Vec<(Kind, usize)> =
        kinds[1..].iter().map(|&kind| (kind, all.iter().map(|m| m.count(kind)).sum())).collect();
    item.statement(
        "The irregular regimes are chaotic, amplitude-modulated and intermittent",
        "Holds if each of the three is found at some frequency; in part if one or two are.",
        Verdict::of_all(&irregular.iter().map(|(_, count)| *count > 0).collect::<Vec<_>>()),
        irregular
            .iter()
            .map(|(kind, count)| format!("{count} {}", kind.words()))
            .collect::<Vec<_>>()
            .join(", "),
    );
}

/// Whether periodic motions of two names or more have an irregular one between them.
fn alternates(motions: &Motions) -> bool {
    let periodic = |i: &usize| motions.regimes[*i].kind == Kind::Periodic;
    let places: Vec<usize> = (0..motions.regimes.len()).filter(periodic).collect();
    let names: BTreeSet<String> = places.iter().map(|&i| motions.regimes[i].label()).collect();
    names.len() > 1 && places.windows(2).any(|pair| pair[1] > pair[0] + 1)
}
