//! The paper's statements on Figure 3: detuning of the dampers when the stiffness of the structure changes. A verdict must hold on the
//! finest frequencies and among practically equal designs ([`super::ladder`]).

use super::family::{Family, SMOOTH};
use super::item::{Item, Verdict};
use super::ladder::{Ladder, RULE, decided, verdict};
use super::plan::{Plan, stiffness};

const NONE: usize = 0;
const SSVI: usize = 1;
const TMD: usize = 2;
const DAMPERS: [usize; 2] = [SSVI, TMD];

/// Depths of the dip between two peaks for which peaks are counted: if the count is the same for all, it does not depend on the
/// depth. The scatter of a chaotic stretch from one frequency to the next is a few per cent, which sets the least.
const DEPTHS: [f64; 4] = [0.05, 0.1, 0.15, 0.2];

/// The curves at one stiffness with the ladders of their highest points.
pub struct Detuned<'a> {
    /// The curves.
    pub family: &'a Family,
    /// Without damper, with SSVI NES, with TMD.
    pub ladders: [Ladder; 3],
}

/// One number of a ladder.
type Pick<'a> = &'a dyn Fn(&Ladder) -> f64;

impl Detuned<'_> {
    /// The factor by which the damper reduces the largest energy.
    fn reduction(&self, scene: usize, pick: Pick) -> f64 {
        pick(&self.ladders[NONE]) / pick(&self.ladders[scene])
    }

    /// The share of that of the tuned structure that is left.
    fn left(&self, tuned: &Self, scene: usize, pick: Pick) -> f64 {
        self.reduction(scene, pick) / tuned.reduction(scene, pick)
    }

    /// The same on the finest frequencies.
    pub fn finest(&self, scene: usize) -> f64 {
        self.reduction(scene, &Ladder::finest)
    }
}

/// Checks the paper's statements one by one.
pub fn statements(plan: &Plan, all: &[Detuned], item: &mut Item) {
    let Some(tuned) = all.iter().find(|f| f.family.k1 == plan.tuned()) else {
        item.notes.push(
            "The tuned stiffness is not among those of the study, so no statement can be checked.".into(),
        );
        return;
    };
    let mut by_k1: Vec<&Detuned> = all.iter().collect();
    by_k1.sort_by(|a, b| a.family.k1.total_cmp(&b.family.k1));
    let (softer, stiffer): (Vec<&Detuned>, Vec<&Detuned>) =
        by_k1.iter().filter(|f| f.family.k1 != tuned.family.k1).partition(|f| f.family.k1 < tuned.family.k1);
    peaks(tuned.family, item);
    at_the_tuned_stiffness(tuned, &by_k1, item);
    if !stiffer.is_empty() && !softer.is_empty() {
        stiffer_structures(tuned, &softer, &stiffer, item);
    }
    if !softer.is_empty() {
        softer_structures(tuned, &softer, &by_k1, item);
    }
}

/// Adds a statement whose parts are decided or not, under the rule of ladders.
fn decide(item: &mut Item, paper: &str, rule: &str, parts: &[Option<bool>], found: String) {
    item.statement(paper, &format!("{rule} {RULE}"), verdict(parts), found);
}

fn list(families: &[&Detuned], scene: usize) -> String {
    families.iter().map(|f| format!("{:.2}", f.finest(scene))).collect::<Vec<_>>().join(", ")
}

/// The reductions of some structures beside those of the tuned one.
fn beside(tuned: &Detuned, families: &[&Detuned]) -> String {
    let of = |scene: usize| format!("{} (tuned {:.2})", list(families, scene), tuned.finest(scene));
    format!("reduction, k1 rising: SSVI NES {}; TMD {}", of(SSVI), of(TMD))
}

fn peaks(tuned: &Family, item: &mut Item) {
    let counts = DEPTHS.map(|depth| tuned.humps(SSVI, depth).len());
    let places: Vec<String> = tuned
        .humps(SSVI, DEPTHS[0])
        .iter()
        .map(|p| format!("{:.0} J at ω = {:.2} rad/s", p.energy, p.omega))
        .collect();
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
            counts.map(|n| n.to_string()).join(", "),
            places.join(", ")
        ),
    );
}

fn at_the_tuned_stiffness(tuned: &Detuned, all: &[&Detuned], item: &mut Item) {
    let [ssvi, tmd] = DAMPERS.map(|scene| &tuned.ladders[scene]);
    let (below, of) = tuned.family.share_below(SSVI, TMD);
    // A damper that is higher on the finest frequencies is not the better one, whatever others near it are.
    let lower = if ssvi.finest() >= tmd.finest() {
        Some(false)
    } else {
        decided(|pick| pick(ssvi) < tmd.near.least.min(tmd.finest()))
    };
    decide(
        item,
        "At the tuned stiffness the SSVI NES reduces vibrations in the resonance zone somewhat better than the TMD",
        "Holds if the highest point of its curve is the lower; does not hold if it is the higher on the finest frequencies.",
        &[lower],
        format!(
            "highest E1max: SSVI NES {}; TMD {}; without damper {:.0} J. Within {of:.2} rad/s of resonance the SSVI NES has less on {:.0} % of the frequencies",
            ssvi.words(),
            tmd.words(),
            tuned.ladders[NONE].finest(),
            100.0 * below
        ),
    );
    let best = DAMPERS.map(|scene| {
        decided(|pick| all.iter().all(|f| f.reduction(scene, pick) <= tuned.reduction(scene, pick)))
    });
    let found = format!("reduction, k1 rising: SSVI NES {}; TMD {}", list(all, SSVI), list(all, TMD));
    decide(
        item,
        "In the version corresponding to the tuning the oscillation suppression is achieved best",
        "Holds if no other stiffness has a larger reduction (highest E1max without damper over highest with it); in part if so for one damper.",
        &best,
        found.clone(),
    );
    let least = DAMPERS.map(|scene| decided(|pick| all.iter().all(|f| f.reduction(scene, pick) >= 2.0)));
    decide(
        item,
        "The mitigation is quite good for both dampers at different stiffnesses",
        "The paper gives no number. Holds if the highest energy is at most half of that without damper at every stiffness, with both dampers; in part if with one.",
        &least,
        found,
    );
}

fn stiffer_structures(tuned: &Detuned, softer: &[&Detuned], stiffer: &[&Detuned], item: &mut Item) {
    let change = |f: &Detuned, scene: usize, pick: Pick| (f.left(tuned, scene, pick) - 1.0).abs();
    let most = |scene: usize, pick: Pick| stiffer.iter().map(|f| change(f, scene, pick)).fold(0.0, f64::max);
    let least = |scene: usize, pick: Pick| {
        softer.iter().map(|f| change(f, scene, pick)).fold(f64::INFINITY, f64::min)
    };
    let differ = |f: &Detuned, pick: Pick| (f.reduction(SSVI, pick) / f.reduction(TMD, pick) - 1.0).abs();
    let apart = |pick: Pick| stiffer.iter().map(|f| differ(f, pick)).fold(0.0, f64::max);
    let unchanged = DAMPERS.map(|scene| decided(|pick| most(scene, pick) < least(scene, pick)));
    let identical = decided(|pick| apart(pick) < differ(tuned, pick));
    let finest: Pick = &Ladder::finest;
    decide(
        item,
        "Both dampers maintain their vibration reduction performance when k1 increases (conclusions)",
        &format!(
            "The paper gives no number. Holds if at least {} of the tuned reduction is left at every stiffer structure, with both dampers; in part if with one.",
            percent(RETAINED)
        ),
        &DAMPERS.map(|scene| decided(|pick| stiffer.iter().all(|f| f.left(tuned, scene, pick) >= RETAINED))),
        beside(tuned, stiffer),
    );
    decide(
        item,
        "With increasing k1 the reduction remains virtually unchanged and identical for SSVI NES and TMD",
        "The paper gives no number. Unchanged: with each damper the reduction changes less at every stiffer structure than at any softer one, where the paper sees it change. Identical: the dampers differ less at every stiffer structure than at the tuned one, where the paper calls them somewhat different.",
        &[unchanged[0], unchanged[1], identical],
        format!(
            "stiffer, the reduction changes by at most {:.0} % (SSVI NES) and {:.1} % (TMD), softer by at least {:.0} % and {:.1} %; the dampers differ by at most {:.1} %, at the tuned stiffness by {:.1} %",
            100.0 * most(SSVI, finest),
            100.0 * most(TMD, finest),
            100.0 * least(SSVI, finest),
            100.0 * least(TMD, finest),
            100.0 * apart(finest),
            100.0 * differ(tuned, finest)
        ),
    );
}

fn softer_structures(tuned: &Detuned, softer: &[&Detuned], all: &[&Detuned], item: &mut Item) {
    let worse = DAMPERS.map(|scene| {
        decided(|pick| softer.iter().all(|f| f.reduction(scene, pick) < tuned.reduction(scene, pick)))
    });
    decide(
        item,
        "When k1 decreases the reduction worsens",
        "Holds if the reduction is smaller at every softer structure than at the tuned one, with both dampers; in part if with one.",
        &worse,
        beside(tuned, softer),
    );
    let places: Vec<String> = softer
        .iter()
        .map(|f| {
            format!(
                "k1 = {} N/m: {:.0} % of the tuned reduction is left to the SSVI NES, {:.0} % to the TMD",
                stiffness(f.family.k1),
                100.0 * f.left(tuned, SSVI, &Ladder::finest),
                100.0 * f.left(tuned, TMD, &Ladder::finest)
            )
        })
        .collect();
    let losses: Vec<String> = softer
        .iter()
        .map(|f| {
            let [ssvi, tmd] = DAMPERS.map(|scene| percent(1.0 - f.left(tuned, scene, &Ladder::finest)));
            format!(
                "at k1 = {} N/m the SSVI NES loses {ssvi} of its reduction, the TMD {tmd}",
                stiffness(f.family.k1)
            )
        })
        .collect();
    let more =
        |f: &&Detuned| f.left(tuned, TMD, &Ladder::finest) / f.left(tuned, SSVI, &Ladder::finest) - 1.0;
    let most = softer.iter().map(more).fold(f64::NEG_INFINITY, f64::max);
    let greater = decided(|pick| softer.iter().all(|f| f.left(tuned, SSVI, pick) < f.left(tuned, TMD, pick)));
    let similar = decided(|pick| {
        softer.iter().all(|f| (1.0 - f.left(tuned, SSVI, pick) / f.left(tuned, TMD, pick)).abs() <= SIMILAR)
    });
    decide(
        item,
        "This deterioration is greater for the SSVI NES; the TMD retains its tuning somewhat better",
        "Holds if at every softer structure less of the tuned reduction is left to the SSVI NES than to the TMD. The paper's TMD retains it because it is barely tuned: its spring is three times softer than that of the best TMD (docs/tuning.md).",
        &[greater],
        places.join("; "),
    );
    decide(
        item,
        "The deterioration is similar for both dampers, slightly greater for the SSVI NES (conclusions)",
        "The paper gives no number. Holds if less is left to the SSVI NES at every softer structure, but by no more than a tenth of what is left to the TMD; in part if only one of the two is so.",
        &[greater, similar],
        format!(
            "{}: the TMD is left with up to {:.0} % more, where similar means {}",
            losses.join("; "),
            100.0 * most,
            percent(SIMILAR)
        ),
    );
    let retained =
        DAMPERS.map(|scene| decided(|pick| all.iter().all(|f| f.left(tuned, scene, pick) >= RETAINED)));
    decide(
        item,
        "Both dampers retain their tuning",
        &format!(
            "The paper gives no number. Holds if at least {} of the tuned reduction is left at every stiffness, with both dampers; in part if with one.",
            percent(RETAINED)
        ),
        &retained,
        format!(
            "least share left: SSVI NES {:.0} %, TMD {:.0} %: with a threshold at the lower of the two it would hold, between them in part",
            100.0 * all.iter().map(|f| f.left(tuned, SSVI, &Ladder::finest)).fold(f64::INFINITY, f64::min),
            100.0 * all.iter().map(|f| f.left(tuned, TMD, &Ladder::finest)).fold(f64::INFINITY, f64::min)
        ),
    );
    let shifts = [NONE, SSVI, TMD].map(|scene| {
        all.windows(2).all(|pair| pair[0].family.highest(scene).omega < pair[1].family.highest(scene).omega)
    });
    item.statement(
        "The resonance peak shifts to the left with falling k1",
        "Holds if the frequency of the highest point rises with k1 on all three curves.",
        Verdict::of_all(&shifts),
        "frequencies in the table".into(),
    );
    let low = all[0];
    let kept = DAMPERS.map(|scene| decided(|pick| low.reduction(scene, pick) > 1.0));
    let more = DAMPERS.map(|scene| low.family.most_added(scene));
    decide(
        item,
        "The energy reduction is maintained even at a significantly low stiffness",
        "Holds if at the softest structure the highest energy is smaller with each damper than without, and no frequency within the half-power width of resonance has more energy with it; in part if only some of this is so.",
        &[kept[0], kept[1], Some(more.iter().all(|more| more.energy <= 1.0))],
        format!(
            "k1 = {} N/m: {:.2} times smaller with the SSVI NES, {:.2} times with the TMD; but the SSVI NES has up to {:.2} times the energy without damper (at ω = {:.2} rad/s), the TMD {:.2} times (at {:.2})",
            stiffness(low.family.k1),
            low.finest(SSVI),
            low.finest(TMD),
            more[0].energy,
            more[0].omega,
            more[1].energy,
            more[1].omega
        ),
    );
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// Shares of what is left that differ by no more than this are similar.
const SIMILAR: f64 = 0.1;
/// Share of the tuned reduction that must be left for a tuning to be retained.
const RETAINED: f64 = 0.9;
