//! Compares settled responses with much longer runs.

use super::Hunt;
use crate::scenes::{Numbers, SSVI, Spread};
use retune_model::Scene;
use retune_solver::{Also, Ask, Extremes, Settings, Settle, Window, extremes, settled};

/// Asks for the extremes of the settled motion alone.
fn of_settled() -> Ask {
    Ask { also: Some(Also::walls(f64::INFINITY)), ..Ask::default() }
}

/// The extremes of the settled motion; none if it does not settle in 400 s or has a closed form.
pub fn rest(scene: &Scene) -> Option<Extremes> {
    let window = Window { from: 50.0, to: 400.0 };
    let found = settled(scene, window, Settle::default(), &Settings::default(), of_settled()).expect("a run");
    (found.settled && found.largest.time < window.to).then_some(found)
}

/// The extremes at the end of a run five times as long.
pub fn late(scene: &Scene) -> Extremes {
    let window = Window { from: 1900.0, to: 2000.0 };
    let ask = Ask { also: Some(Also::walls(window.from)), ..Ask::default() };
    extremes(scene, window, &Settings::default(), ask).expect("a run")
}

/// Their differences relative to those allowed: a thousandth of E1max and of the stroke, a hundredth of the force or 0.1 N.
pub fn difference(found: Extremes, late: Extremes) -> [f64; 3] {
    let share = |a: f64, b: f64, most: f64| (a - b).abs() / most;
    [
        share(found.largest.value, late.largest.value, 1e-3 * late.largest.value),
        share(found.stroke(), late.stroke(), 1e-3 * late.stroke()),
        share(found.force(), late.force(), (1e-2 * late.force()).max(0.1)),
    ]
}

/// Dampers that creep for up to minutes (c2/k2) and touch one wall, two or none, near the structure's resonance.
pub fn settled_stays(scenes: usize) -> Hunt {
    let mut spread = Spread::new(13);
    let (mut looked_at, mut off, mut worst) = (0, [0; 3], [0.0_f64; 3]);
    let mut hunt = Hunt::default();
    for _ in 0..scenes {
        let mut between = |low, high| spread.logarithmic(low, high);
        let numbers = Numbers {
            k1: between(2e4, 6e4),
            omega: between(4.0, 9.0),
            m2: between(10.0, 300.0),
            k2: between(3.0, 3000.0),
            c2: between(3.0, 400.0),
            d: between(0.005, 0.5),
            c: between(0.005, 0.7),
            ..SSVI
        };
        let scene = numbers.scene();
        let Some(found) = rest(&scene) else { continue };
        let difference = difference(found, late(&scene));
        looked_at += 1;
        for (i, difference) in difference.into_iter().enumerate() {
            off[i] += u32::from(difference > 1.0);
            worst[i] = worst[i].max(difference);
        }
        let holds = difference.iter().all(|difference| *difference <= 1.0);
        hunt.check(holds, || format!("{numbers:?}: {found:?}, differences {difference:?}"));
    }
    hunt.row(format!(
        "{scenes} scenes, {looked_at} settled; off: E1max {}, stroke {}, force {}; worst differences as shares of those allowed {worst:?}",
        off[0], off[1], off[2]
    ));
    hunt.check(2 * looked_at > scenes, || format!("{looked_at} of {scenes} have settled"));
    hunt
}
