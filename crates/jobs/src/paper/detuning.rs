//! The paper's statements on Figure 3: detuning of the dampers when the stiffness of the structure changes. A verdict must hold on the
//! finest frequencies and among practically equal designs ([`Ladder`]).

use super::family::{Family, SMOOTH};
use super::item::Item;
use super::measures::{Ladder, Pick, RULE, decided, ends, verdict};
use super::plan::{Plan, stiffness};
use retune_report::document::Verdict;
use retune_study::joined;
use std::ops::Range;

const NONE: usize = 0;
const SSVI: usize = 1;
const TMD: usize = 2;
const DAMPERS: [usize; 2] = [SSVI, TMD];
/// The number of a ladder that is reported.
const FINEST: Pick = Ladder::finest;

/// Depths of the dip between peaks at which peaks are counted: a count equal for all does not depend on the depth. The scatter of a chaotic
/// range from one frequency to the next, a few per cent, sets the smallest.
const DEPTHS: [f64; 4] = [0.05, 0.1, 0.15, 0.2];
/// Remaining reductions that differ by at most this share are similar; the rules below state it in words.
const SIMILAR: f64 = 0.1;
/// Share of the tuned reduction that must remain for a tuning to be retained; the rules below state it in words.
const RETAINED: f64 = 0.9;

/// The curves at one stiffness with the ladders of their highest points.
pub struct Detuned<'a> {
    pub family: &'a Family,
    /// Without damper, with SSVI NES, with TMD.
    pub ladders: [Ladder; 3],
}

impl Detuned<'_> {
    /// The factor by which the damper reduces the largest energy.
    pub fn reduction(&self, scene: usize, pick: Pick) -> f64 {
        pick(&self.ladders[NONE]) / pick(&self.ladders[scene])
    }
}

/// The structures by rising stiffness, and the index of the tuned one.
struct Structures<'a> {
    all: Vec<&'a Detuned<'a>>,
    tuned: usize,
}

impl Structures<'_> {
    /// The reduction as a share of that of the tuned structure.
    fn remaining(&self, i: usize, scene: usize, pick: Pick) -> f64 {
        self.all[i].reduction(scene, pick) / self.all[self.tuned].reduction(scene, pick)
    }

    /// The relative difference of the reductions of the two dampers.
    fn difference(&self, i: usize, pick: Pick) -> f64 {
        (self.all[i].reduction(SSVI, pick) / self.all[i].reduction(TMD, pick) - 1.0).abs()
    }

    fn words(&self, of: Range<usize>, tuned: impl Fn(usize) -> String) -> String {
        let [ssvi, tmd] = DAMPERS.map(|scene| {
            let all = self.all[of.clone()].iter().map(|one| format!("{:.2}", one.reduction(scene, FINEST)));
            joined(&all.collect::<Vec<_>>(), ", ") + &tuned(scene)
        });
        format!("reduction, k1 rising: SSVI NES {ssvi}; TMD {tmd}")
    }

    /// The reductions in words, with those at the tuned stiffness.
    fn words_with_tuned(&self, of: Range<usize>) -> String {
        self.words(of, |scene| format!(" (tuned {:.2})", self.all[self.tuned].reduction(scene, FINEST)))
    }
}

/// Whether a condition holds for all structures of a range, for each damper.
fn with_each(of: &Range<usize>, holds: impl Fn(usize, usize, Pick) -> bool) -> [Option<bool>; 2] {
    DAMPERS.map(|scene| decided(|pick| of.clone().all(|i| holds(i, scene, pick))))
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

fn tenths(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// Adds a statement with the verdict on its parts, under the rule of ladders.
fn decide(item: &mut Item, paper: &str, rule: &str, parts: &[Option<bool>], found: String) {
    item.statement(paper, &format!("{rule} {RULE}"), verdict(parts), found);
}

pub fn statements(plan: &Plan, all: &[Detuned], item: &mut Item) {
    let mut by_k1: Vec<&Detuned> = all.iter().collect();
    by_k1.sort_by(|a, b| a.family.k1.total_cmp(&b.family.k1));
    let Some(tuned) = by_k1.iter().position(|one| one.family.k1 == plan.tuned()) else {
        let note = "The tuned stiffness is not among those of the study, so no statement can be checked.";
        item.notes.push(note.to_owned());
        return;
    };
    let (softer, stiffer) = (0..tuned, tuned + 1..by_k1.len());
    let structures = Structures { all: by_k1, tuned };
    peaks(structures.all[tuned].family, item);
    at_the_tuned_stiffness(&structures, item);
    if !stiffer.is_empty() && !softer.is_empty() {
        stiffer_structures(&structures, &softer, stiffer, item);
    }
    if !softer.is_empty() {
        softer_structures(&structures, softer, item);
        all_structures(&structures, item);
    }
}

fn peaks(tuned: &Family, item: &mut Item) {
    let counts = DEPTHS.map(|depth| tuned.humps(SSVI, depth).len());
    let peaks = tuned.humps(SSVI, DEPTHS[0]);
    let places = peaks.iter().map(|p| format!("{:.0} J at ω = {:.2} rad/s", p.energy, p.omega));
    let exact = tuned.maxima(SSVI);
    item.statement(
        "The SSVI NES provides two resonant peaks",
        &format!("Holds if the curve has two maxima; in part if its running median over {SMOOTH} frequencies has (a fifth of the width of the resonance), whether the dip between peaks must be 5, 10, 15 or 20 % deep."),
        match (exact, counts) {
            (2, _) => Verdict::Holds,
            (_, [2, 2, 2, 2]) => Verdict::Partly,
            _ => Verdict::Fails,
        },
        format!(
            "peaks of the running median at these depths: {}; they are {}. The curve itself has {exact} maxima, for the motion of the second peak is chaotic and its energy jumps from one frequency to the next",
            joined(&counts, ", "),
            joined(&places.collect::<Vec<_>>(), ", ")
        ),
    );
}

fn at_the_tuned_stiffness(structures: &Structures, item: &mut Item) {
    let Structures { all, tuned } = structures;
    let every = 0..all.len();
    let tuned = all[*tuned];
    let [none, ssvi, tmd] = &tuned.ladders;
    let (below, of) = tuned.family.share_below(SSVI, TMD);
    // A damper that is higher on the finest frequencies is not better, whatever the designs near it.
    let is_lower = || decided(|pick| pick(ssvi) < tmd.near.least.min(tmd.finest()));
    decide(
        item,
        "At the tuned stiffness the SSVI NES reduces vibrations in the resonance zone somewhat better than the TMD",
        "Holds if the highest point of its curve is the lower; does not hold if it is the higher on the finest frequencies.",
        &[if ssvi.finest() >= tmd.finest() { Some(false) } else { is_lower() }],
        format!(
            "highest E1max: SSVI NES {}; TMD {}; without damper {:.0} J. Within {of:.2} rad/s of resonance the SSVI NES has less on {} of the frequencies",
            ssvi.words(),
            tmd.words(),
            none.finest(),
            percent(below)
        ),
    );
    let found = structures.words(every.clone(), |_| String::new());
    decide(
        item,
        "In the version corresponding to the tuning the oscillation suppression is achieved best",
        "Holds if no other stiffness has a larger reduction (highest E1max without damper over highest with it); in part if so for one damper.",
        &with_each(&every, |i, scene, pick| all[i].reduction(scene, pick) <= tuned.reduction(scene, pick)),
        found.clone(),
    );
    decide(
        item,
        "The mitigation is quite good for both dampers at different stiffnesses",
        "The paper gives no number. Holds if the highest energy is at most half of that without damper at every stiffness, with both dampers; in part if with one.",
        &with_each(&every, |i, scene, pick| all[i].reduction(scene, pick) >= 2.0),
        found,
    );
}

fn stiffer_structures(
    structures: &Structures,
    softer: &Range<usize>,
    stiffer: Range<usize>,
    item: &mut Item,
) {
    let changes = |of: &Range<usize>, scene, pick| {
        ends(of.clone().map(|i| (structures.remaining(i, scene, pick) - 1.0).abs()))
    };
    let most = |scene, pick| changes(&stiffer, scene, pick)[1];
    let least = |scene, pick| changes(softer, scene, pick)[0];
    let apart = |pick| ends(stiffer.clone().map(|i| structures.difference(i, pick)))[1];
    let apart_tuned = |pick| structures.difference(structures.tuned, pick);
    let [ssvi, tmd] = DAMPERS.map(|scene| decided(|pick| most(scene, pick) < least(scene, pick)));
    decide(
        item,
        "Both dampers maintain their vibration reduction performance when k1 increases (conclusions)",
        "The paper gives no number. Holds if at least 90 % of the tuned reduction is left at every stiffer structure, with both dampers; in part if with one.",
        &with_each(&stiffer, |i, scene, pick| structures.remaining(i, scene, pick) >= RETAINED),
        structures.words_with_tuned(stiffer.clone()),
    );
    decide(
        item,
        "With increasing k1 the reduction remains virtually unchanged and identical for SSVI NES and TMD",
        "The paper gives no number. Unchanged: with each damper the reduction changes less at every stiffer structure than at any softer one, where the paper sees it change. Identical: the dampers differ less at every stiffer structure than at the tuned one, where the paper calls them somewhat different.",
        &[ssvi, tmd, decided(|pick| apart(pick) < apart_tuned(pick))],
        format!(
            "stiffer, the reduction changes by at most {} (SSVI NES) and {} (TMD), softer by at least {} and {}; the dampers differ by at most {}, at the tuned stiffness by {}",
            percent(most(SSVI, FINEST)),
            tenths(most(TMD, FINEST)),
            percent(least(SSVI, FINEST)),
            tenths(least(TMD, FINEST)),
            tenths(apart(FINEST)),
            tenths(apart_tuned(FINEST))
        ),
    );
}

fn softer_structures(structures: &Structures, softer: Range<usize>, item: &mut Item) {
    let remaining = |i, pick| DAMPERS.map(|scene| structures.remaining(i, scene, pick));
    decide(
        item,
        "When k1 decreases the reduction worsens",
        "Holds if the reduction is smaller at every softer structure than at the tuned one, with both dampers; in part if with one.",
        &with_each(&softer, |i, scene, pick| structures.remaining(i, scene, pick) < 1.0),
        structures.words_with_tuned(softer.clone()),
    );
    let (mut places, mut losses) = (Vec::new(), Vec::new());
    for i in softer.clone() {
        let (k1, shares) = (stiffness(structures.all[i].family.k1), remaining(i, FINEST));
        let [ssvi, tmd] = shares.map(percent);
        places.push(format!(
            "k1 = {k1} N/m: {ssvi} of the tuned reduction is left to the SSVI NES, {tmd} to the TMD"
        ));
        let [ssvi, tmd] = shares.map(|share| percent(1.0 - share));
        losses.push(format!("at k1 = {k1} N/m the SSVI NES loses {ssvi} of its reduction, the TMD {tmd}"));
    }
    let is_each =
        |holds: fn([f64; 2]) -> bool| decided(|pick| softer.clone().all(|i| holds(remaining(i, pick))));
    let greater = is_each(|[ssvi, tmd]| ssvi < tmd);
    let similar = is_each(|[ssvi, tmd]| (1.0 - ssvi / tmd).abs() <= SIMILAR);
    decide(
        item,
        "This deterioration is greater for the SSVI NES; the TMD retains its tuning somewhat better",
        "Holds if at every softer structure less of the tuned reduction is left to the SSVI NES than to the TMD. The paper's TMD retains it because it is barely tuned: its spring is three times softer than that of the best TMD (docs/tuning.md).",
        &[greater],
        joined(&places, "; "),
    );
    let [_, most] = ends(softer.clone().map(|i| remaining(i, FINEST)).map(|[ssvi, tmd]| tmd / ssvi - 1.0));
    decide(
        item,
        "The deterioration is similar for both dampers, slightly greater for the SSVI NES (conclusions)",
        "The paper gives no number. Holds if less is left to the SSVI NES at every softer structure, but by no more than a tenth of what is left to the TMD; in part if only one of the two is so.",
        &[greater, similar],
        format!(
            "{}: the TMD is left with up to {} more, where similar means 10 %",
            joined(&losses, "; "),
            percent(most)
        ),
    );
}

fn all_structures(structures: &Structures, item: &mut Item) {
    let Structures { all, .. } = structures;
    let every = 0..all.len();
    let [least, least_tmd] = DAMPERS.map(|scene| {
        let [least, _] = ends(every.clone().map(|i| structures.remaining(i, scene, FINEST)));
        percent(least)
    });
    decide(
        item,
        "Both dampers retain their tuning",
        "The paper gives no number. Holds if at least 90 % of the tuned reduction is left at every stiffness, with both dampers; in part if with one.",
        &with_each(&every, |i, scene, pick| structures.remaining(i, scene, pick) >= RETAINED),
        format!(
            "least share left: SSVI NES {least}, TMD {least_tmd}: with a threshold at the lower of the two it would hold, between them in part"
        ),
    );
    let rises =
        |scene| all.is_sorted_by(|a, b| a.family.highest(scene).omega < b.family.highest(scene).omega);
    item.statement(
        "The resonance peak shifts to the left with falling k1",
        "Holds if the frequency of the highest point rises with k1 on all three curves.",
        Verdict::of_all(&[NONE, SSVI, TMD].map(rises)),
        "frequencies in the table".into(),
    );
    let low = all[0];
    let [kept, kept_tmd] = with_each(&(0..1), |_, scene, pick| low.reduction(scene, pick) > 1.0);
    let [times, times_tmd] = DAMPERS.map(|scene| low.reduction(scene, FINEST));
    let [ssvi, tmd] = DAMPERS.map(|scene| low.family.most_added(scene));
    decide(
        item,
        "The energy reduction is maintained even at a significantly low stiffness",
        "Holds if at the softest structure the highest energy is smaller with each damper than without, and no frequency within the half-power width of resonance has more energy with it; in part if only some of this is so.",
        &[kept, kept_tmd, Some(ssvi.energy <= 1.0 && tmd.energy <= 1.0)],
        format!(
            "k1 = {} N/m: {times:.2} times smaller with the SSVI NES, {times_tmd:.2} times with the TMD; but the SSVI NES has up to {:.2} times the energy without damper (at ω = {:.2} rad/s), the TMD {:.2} times (at {:.2})",
            stiffness(low.family.k1),
            ssvi.energy,
            ssvi.omega,
            tmd.energy,
            tmd.omega
        ),
    );
}
