//! Figure 4: zones of impacts, and the motions in them.

use super::diagrams;
use super::family::Family;
use super::item::Item;
use super::motions::{Motions, RUNS, STARTS, begins};
use super::plan::{Plan, stiffness};
use crate::Error;
use retune_dynamics::sweep::zones;
use retune_dynamics::{Kind, Regime, Zone, attractor};
use retune_report::cells;
use retune_report::document::Verdict;
use retune_report::table::Table;
use retune_study::joined;
use std::collections::{BTreeMap, BTreeSet};

pub fn figure4(plan: &Plan) -> Result<Item, Error> {
    let families = Family::all(plan, "figure 4, curves")?;
    let count = families.len() * plan.file.motions.points * RUNS;
    let bar = plan.watch.progress("figure 4, motions", count as u64);
    let mut all = Vec::new();
    for family in families {
        let motions = Motions::compute(plan, &family.scenes[1], family.natural, &*bar)?;
        all.push((family, motions));
    }
    bar.finish();
    let mut item = Item::new(plan.made_by(
        "Zones and curves: one run from rest at each frequency. Names of motions: 1000 periods from rest, the last 500 judged. \
         Sweeps: 150 periods to settle at each frequency, the state carried over.",
    ));
    for (family, motions) in &all {
        let k1 = stiffness(family.k1);
        let caption = format!(
            "k₁ = {k1} N/m. Left: impact zones, energies and the natural frequency (upright line). Right: x₂ at the crests of the force; \
             the strip on top is coloured by the kind of motion reached from rest."
        );
        item.picture(&format!("figure4-k1-{k1}"), &diagrams::picture(family, motions), &caption);
    }
    let caption = "The motions from rest, as the frequency rises (windows of three frequencies or more)";
    item.table(caption, names(&all));
    item.table("Frequencies at which more than one motion was found", coexisting(&all));
    if !plan.is_brief {
        let caption = "Where periodic motions begin and end as the frequency rises, on their branches";
        item.table(caption, begins(plan, &all)?);
    }
    item.data("figure4-regimes", regimes(&all));
    item.data("figure4-orbits", orbits(&all));
    statements(&all, &mut item);
    item.notes.push(about_coexisting(&all));
    item.notes.push("Where periodic motions begin and end: the branches of the motions that runs from rest and from four other starts lead to. At a fold the motion vanishes; at a period doubling one of twice the period takes its place; at a grazing an impact begins or ends, and another name goes on; \"the range\" is an end of the figure. Ranges narrower than a step of the figure are left out.".into());
    item.notes.push("How motions are named stands under Figure 7. The paper does not say which coordinate its bifurcation diagrams show; ours show x2. Its regime labels are in the picture only, so they cannot be compared one by one.".into());
    Ok(item)
}

fn names(all: &[(Family, Motions)]) -> Table {
    let mut table = Table::headed("k1, N/m | ω, rad/s | motion | largest exponent, 1/s | confidence");
    for (family, motions) in all {
        for (label, from, to) in motions.windows().into_iter().filter(|(_, from, to)| to - from >= 2) {
            let part = &motions.regimes[from..=to];
            let mean = |f: fn(&Regime) -> f64| part.iter().map(f).sum::<f64>() / part.len() as f64;
            table.push(cells![
                stiffness(family.k1),
                format!("{:.3} – {:.3}", motions.omega[from], motions.omega[to]),
                label,
                format!("{:.3}", mean(|regime| regime.exponent.value)),
                format!("{:.2}", mean(|regime| regime.confidence)),
            ]);
        }
    }
    table
}

fn coexisting(all: &[(Family, Motions)]) -> Table {
    let mut table = Table::headed("k1, N/m | ω, rad/s | motions | reached first by | what they are");
    for (family, motions) in all {
        for here in &motions.coexisting {
            let name = |regime: &Regime| format!("{} ({:.2})", regime.label(), regime.confidence);
            let (starts, names): (Vec<&str>, Vec<String>) =
                here.motions.iter().map(|(start, regime)| (STARTS[*start], name(regime))).unzip();
            table.push(cells![
                stiffness(family.k1),
                format!("{:.3}", motions.omega[here.index]),
                here.motions.len(),
                joined(&starts, "; "),
                joined(&names, "; "),
            ]);
        }
    }
    table
}

/// Joins words on each stiffness.
fn of_each(all: &[(Family, Motions)], words: impl Fn(&Family, &Motions) -> Vec<String>) -> String {
    let one = |(family, motions): &(Family, Motions)| {
        format!("k1 = {}: {}", stiffness(family.k1), joined(&words(family, motions), ", "))
    };
    joined(&all.iter().map(one).collect::<Vec<_>>(), "; ")
}

fn frequencies(all: &[(Family, Motions)]) -> usize {
    all.first().map_or(0, |(_, motions)| motions.omega.len())
}

fn about_coexisting(all: &[(Family, Motions)]) -> String {
    let places = of_each(all, |_, motions| {
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        for here in &motions.coexisting {
            *counts.entry(here.motions.len()).or_default() += 1;
        }
        if counts.is_empty() {
            return vec!["none with more than one".to_owned()];
        }
        counts.iter().map(|(motions, places)| format!("{motions} motions at {places}")).collect()
    });
    format!(
        "Coexisting motions, of {} frequencies each: {places}. Counted are the distinct motions, periodic or not, reached from rest, on the way up and on the way down, each followed for 1000 more periods. Distinct means: the mean distance from the stroboscopic states of one to the nearest of the other is more than {} of the motion's size and more than {} times that between the two halves of either (so that chaos and slow settling do not count as two). The paper shows one motion at each frequency.",
        frequencies(all),
        attractor::APART,
        attractor::BEYOND
    )
}

fn regimes(all: &[(Family, Motions)]) -> Table {
    let mut table = Table::named(
        "k1_N_per_m,omega_rad_per_s,motion,n,m,k,exponent_per_s,exponent_error_per_s,laminar_share,chaos_until_s,confidence",
    );
    for (family, motions) in all {
        for (omega, regime) in motions.omega.iter().zip(&motions.regimes) {
            let [m, k] = regime.impacts;
            table.push(cells![
                family.k1,
                format!("{omega:.6}"),
                regime.label(),
                regime.period,
                m,
                k,
                format!("{:.5}", regime.exponent.value),
                format!("{:.5}", regime.exponent.error),
                format!("{:.3}", regime.laminar),
                regime.transient.map(|transient| format!("{:.1}", transient.until)),
                format!("{:.3}", regime.confidence),
            ]);
        }
    }
    table
}

fn orbits(all: &[(Family, Motions)]) -> Table {
    let mut table = Table::named("k1_N_per_m,start,omega_rad_per_s,x2_at_crests_mm");
    for (family, motions) in all {
        for (start, orbits) in STARTS.iter().zip(&motions.orbits) {
            for orbit in orbits {
                let tenths: BTreeSet<i64> =
                    orbit.samples.iter().map(|y| (1e4 * y[2]).round() as i64).collect();
                let list: Vec<f64> = tenths.iter().map(|x| *x as f64 / 10.0).collect();
                table.push(cells![family.k1, *start, format!("{:.6}", orbit.value), joined(&list, " ")]);
            }
        }
    }
    table
}

fn statements(all: &[(Family, Motions)], item: &mut Item) {
    let both = |family: &Family| {
        zones(&family.points[1]).into_iter().filter(|(zone, ..)| *zone == Zone::Bilateral).collect::<Vec<_>>()
    };
    let around =
        all.iter().all(|(f, _)| both(f).iter().any(|(_, from, to)| (*from..=*to).contains(&f.natural)));
    let beside = all.iter().all(|(f, _)| f.points[1].iter().any(|p| p.zone() == Zone::PrimaryOnly));
    let places =
        of_each(all, |f, _| both(f).iter().map(|(_, from, to)| format!("{from:.3}–{to:.3}")).collect());
    item.statement(
        "There are zones of bilateral impacts, around resonance, and zones of impacts on the PS only beside them",
        "Holds if at every stiffness the natural frequency lies in a bilateral zone and there is a zone of impacts on the PS only; in part if only one of the two is so. A frequency belongs to a zone by the walls struck in the window of the maximum.",
        Verdict::of_all(&[around, beside]),
        format!("bilateral over ω, rad/s: {places}"),
    );
    let count = |kind, all: &[&Motions]| all.iter().map(|motions| motions.count(kind)).sum::<usize>();
    let counts = |kinds: &[Kind], all: &[&Motions]| -> Vec<String> {
        kinds.iter().map(|&kind| format!("{} {}", count(kind, all), kind.words())).collect()
    };
    let kinds = [Kind::Periodic, Kind::Chaotic, Kind::AmplitudeModulated, Kind::Intermittent];
    let motions: Vec<&Motions> = all.iter().map(|(_, motions)| motions).collect();
    item.statement(
        "In all five graphs periodic regimes of different periodicity and numbers of impacts alternate with irregular ones",
        "Holds if at every stiffness there are periodic motions of at least two names nT, m, k, and an irregular one between two periodic ones.",
        Verdict::of_all(&motions.iter().map(|motions| alternates(motions)).collect::<Vec<_>>()),
        format!("of {} frequencies each: {}", frequencies(all), of_each(all, |_, m| counts(&kinds, &[m]))),
    );
    let irregular = &kinds[1..];
    item.statement(
        "The irregular regimes are chaotic, amplitude-modulated and intermittent",
        "Holds if each of the three is found at some frequency; in part if one or two are.",
        Verdict::of_all(&irregular.iter().map(|kind| count(*kind, &motions) > 0).collect::<Vec<_>>()),
        joined(&counts(irregular, &motions), ", "),
    );
}

/// Whether there are periodic motions with at least two labels, and an irregular one between periodic ones.
fn alternates(motions: &Motions) -> bool {
    let periodic = |i: &usize| motions.regimes[*i].kind == Kind::Periodic;
    let places: Vec<usize> = (0..motions.regimes.len()).filter(periodic).collect();
    let names: BTreeSet<String> = places.iter().map(|&i| motions.regimes[i].label()).collect();
    names.len() > 1 && places.windows(2).any(|pair| pair[1] > pair[0] + 1)
}
