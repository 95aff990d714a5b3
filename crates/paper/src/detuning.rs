//! The paper's statements on Figure 3: detuning of the dampers when the stiffness of the structure changes.

use super::family::{Family, SMOOTH};
use super::item::{Item, Verdict};
use super::plan::{Plan, stiffness};

const SSVI: usize = 1;
const TMD: usize = 2;
const DAMPERS: [usize; 2] = [SSVI, TMD];

/// Depths of the dip between two peaks for which peaks are counted: if the count is the same for all, it does not depend on the
/// depth. The scatter of a chaotic stretch from one frequency to the next is a few per cent, which sets the least.
const DEPTHS: [f64; 4] = [0.05, 0.1, 0.15, 0.2];

/// Checks the paper's statements one by one.
pub fn statements(plan: &Plan, families: &[Family], item: &mut Item) {
    let Some(tuned) = families.iter().find(|f| f.k1 == plan.tuned()) else {
        item.notes.push(
            "The tuned stiffness is not among those of the study, so no statement can be checked.".into(),
        );
        return;
    };
    let mut by_k1: Vec<&Family> = families.iter().collect();
    by_k1.sort_by(|a, b| a.k1.total_cmp(&b.k1));
    let (softer, stiffer): (Vec<&Family>, Vec<&Family>) =
        by_k1.iter().filter(|f| f.k1 != tuned.k1).partition(|f| f.k1 < tuned.k1);
    at_the_tuned_stiffness(tuned, &by_k1, item);
    if !stiffer.is_empty() && !softer.is_empty() {
        stiffer_structures(tuned, &softer, &stiffer, item);
    }
    if !softer.is_empty() {
        softer_structures(tuned, &softer, &by_k1, item);
    }
}

fn list(families: &[&Family], scene: usize) -> String {
    families.iter().map(|f| format!("{:.2}", f.reduction(scene))).collect::<Vec<_>>().join(", ")
}

fn at_the_tuned_stiffness(tuned: &Family, all: &[&Family], item: &mut Item) {
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
    let [none, ssvi, tmd] = [0, SSVI, TMD].map(|scene| tuned.highest(scene).energy);
    item.statement(
        "At the tuned stiffness the SSVI NES reduces vibrations in the resonance zone somewhat better than the TMD",
        "Holds if the highest point of its curve is the lower.",
        Verdict::of(ssvi < tmd),
        format!(
            "highest E1max {ssvi:.0} J against {tmd:.0} J, {:.0} % less, of {none:.0} J without damper",
            100.0 * (1.0 - ssvi / tmd)
        ),
    );
    let best = DAMPERS.map(|scene| all.iter().all(|f| f.reduction(scene) <= tuned.reduction(scene)));
    item.statement(
        "In the version corresponding to the tuning the oscillation suppression is achieved best",
        "Holds if no other stiffness has a larger reduction (highest E1max without damper over highest with it); in part if so for one damper.",
        Verdict::of_all(&best),
        format!("reduction, k1 rising: SSVI NES {}; TMD {}", list(all, SSVI), list(all, TMD)),
    );
}

fn stiffer_structures(tuned: &Family, softer: &[&Family], stiffer: &[&Family], item: &mut Item) {
    let change = |f: &&Family, scene: usize| (f.reduction(scene) / tuned.reduction(scene) - 1.0).abs();
    let most = |scene: usize| stiffer.iter().map(|f| change(f, scene)).fold(0.0, f64::max);
    let least = |scene: usize| softer.iter().map(|f| change(f, scene)).fold(f64::INFINITY, f64::min);
    let differ = |f: &Family| (f.reduction(SSVI) / f.reduction(TMD) - 1.0).abs();
    let apart = stiffer.iter().map(|f| differ(f)).fold(0.0, f64::max);
    let unchanged = DAMPERS.map(|scene| most(scene) < least(scene));
    item.statement(
        "With increasing k1 the reduction remains virtually unchanged and identical for SSVI NES and TMD",
        "The paper gives no number. Unchanged: with each damper the reduction changes less at every stiffer structure than at any softer one, where the paper sees it change. Identical: the dampers differ less at every stiffer structure than at the tuned one, where the paper calls them somewhat different.",
        Verdict::of_all(&[unchanged[0], unchanged[1], apart < differ(tuned)]),
        format!(
            "stiffer, the reduction changes by at most {:.0} % (SSVI NES) and {:.1} % (TMD), softer by at least {:.0} % and {:.1} %; the dampers differ by at most {:.0} %, at the tuned stiffness by {:.0} %",
            100.0 * most(SSVI),
            100.0 * most(TMD),
            100.0 * least(SSVI),
            100.0 * least(TMD),
            100.0 * apart,
            100.0 * differ(tuned)
        ),
    );
}

fn softer_structures(tuned: &Family, softer: &[&Family], all: &[&Family], item: &mut Item) {
    let worse = DAMPERS.map(|scene| softer.iter().all(|f| f.reduction(scene) < tuned.reduction(scene)));
    item.statement(
        "When k1 decreases the reduction worsens",
        "Holds if the reduction is smaller at every softer structure than at the tuned one, with both dampers; in part if with one.",
        Verdict::of_all(&worse),
        format!(
            "softer: SSVI NES {} (tuned {:.2}); TMD {} (tuned {:.2})",
            list(softer, SSVI),
            tuned.reduction(SSVI),
            list(softer, TMD),
            tuned.reduction(TMD)
        ),
    );
    let left = |f: &Family, scene: usize| f.reduction(scene) / tuned.reduction(scene);
    let places: Vec<String> = softer
        .iter()
        .map(|f| {
            format!(
                "k1 = {} N/m: {:.0} % of the tuned reduction is left to the SSVI NES, {:.0} % to the TMD",
                stiffness(f.k1),
                100.0 * left(f, SSVI),
                100.0 * left(f, TMD)
            )
        })
        .collect();
    item.statement(
        "This deterioration is greater for the SSVI NES; the TMD retains its tuning somewhat better",
        "Holds if at every softer structure less of the tuned reduction is left to the SSVI NES than to the TMD.",
        Verdict::of(softer.iter().all(|f| left(f, SSVI) < left(f, TMD))),
        places.join("; "),
    );
    let shifts = [0, SSVI, TMD]
        .map(|scene| all.windows(2).all(|pair| pair[0].highest(scene).omega < pair[1].highest(scene).omega));
    item.statement(
        "The resonance peak shifts to the left with falling k1",
        "Holds if the frequency of the highest point rises with k1 on all three curves.",
        Verdict::of_all(&shifts),
        "frequencies in the table".into(),
    );
    let low = all[0];
    item.statement(
        "The energy reduction is maintained even at a significantly low stiffness",
        "Holds if at the softest structure the highest energy is smaller with each damper than without.",
        Verdict::of_all(&DAMPERS.map(|scene| low.reduction(scene) > 1.0)),
        format!(
            "k1 = {} N/m: {:.2} times smaller with the SSVI NES, {:.2} times with the TMD",
            stiffness(low.k1),
            low.reduction(SSVI),
            low.reduction(TMD)
        ),
    );
}
