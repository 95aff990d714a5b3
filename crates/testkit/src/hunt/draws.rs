//! Scenes for the hunt for missed largest values: over practical ranges, and where methods have difficulties.

use super::histories::given;
use crate::scenes::{Numbers, SSVI, Spread};
use retune_model::Scene;

/// A practical scene: every number within its usual range, some of them at its ends.
fn anywhere(draw: &mut Spread) -> Numbers {
    let mut within = |low: f64, high: f64| low + (high - low) * draw.unit();
    let mut numbers = Numbers {
        m2: 0.0,
        k1: within(1e4, 1e5),
        k2: within(0.0, 3500.0),
        c2: within(0.0, 400.0),
        d: within(0.0, 0.2),
        c: within(0.0, 0.7),
        r: within(0.2, 5.0),
        omega: within(3.0, 10.0),
        ..SSVI
    };
    numbers.m2 = draw.logarithmic(1.0, 3000.0);
    // Optimised designs often lie on their bounds: no gap, no spring, no dashpot.
    for value in [&mut numbers.d, &mut numbers.c, &mut numbers.k2, &mut numbers.c2] {
        if draw.unit() < 0.05 {
            *value = 0.0;
        }
    }
    if draw.unit() < 0.3 {
        numbers.c2 = draw.logarithmic(0.1, 400.0);
    }
    numbers
}

/// Where two maxima in one step are common.
fn dense(draw: &mut Spread) -> Numbers {
    let mut about = |value: f64| value * (1.0 + 0.15 * draw.signed());
    Numbers { k1: about(6e4), k2: about(2500.0), c2: about(20.0), omega: about(7.6), ..anywhere_masses(draw) }
}

fn anywhere_masses(draw: &mut Spread) -> Numbers {
    let numbers = anywhere(draw);
    Numbers { m2: draw.logarithmic(50.0, 1500.0), ..numbers }
}

/// Any scene whose contacts lose energy, from a thousandth to nearly all: half by the law of Hunt and Crossley; of the others, half have
/// another restitution at the obstacle.
fn lossy(draw: &mut Spread) -> Numbers {
    let numbers = anywhere(draw);
    if draw.unit() < 0.5 {
        return Numbers { lambda: draw.logarithmic(1e-3, 100.0), ..numbers };
    }
    let mut restitution = || 0.05 + 0.95 * draw.unit();
    let (e, other) = (restitution(), restitution());
    Numbers { e, e_obstacle: (draw.unit() < 0.5).then_some(other), ..numbers }
}

/// A damper held to a wall for half of each period by its spring, up to 3000 times as stiff as is practical; one in three with λ, and one
/// in nine with a dashpot up to 2500 times as strong. One in three has walls as soft as rubber or softer, and a force that may reverse
/// faster than they can reverse the damper.
fn held(draw: &mut Spread) -> Numbers {
    let mut numbers = Numbers {
        k2: draw.logarithmic(1e3, 1e7),
        c2: draw.logarithmic(0.1, 1e3),
        d: if draw.unit() < 0.7 { 0.0 } else { draw.logarithmic(1e-6, 1e-2) },
        ..anywhere(draw)
    };
    if draw.unit() < 1.0 / 3.0 {
        let soft = draw.logarithmic(1e-5, 1.0);
        numbers.young = numbers.young.map(|modulus| soft * modulus);
        numbers.omega = draw.logarithmic(3.0, 300.0);
        numbers.k2 = draw.logarithmic(1.0, 1e4);
        numbers.p = draw.logarithmic(1e-2, 800.0);
    }
    if draw.unit() < 1.0 / 3.0 {
        Numbers { lambda: draw.logarithmic(1e-3, 100.0), ..numbers }
    } else if draw.unit() < 1.0 / 6.0 {
        Numbers { c2: draw.logarithmic(1e4, 1e6), ..numbers }
    } else {
        numbers
    }
}

/// Any scene under a pulse or a record, one in five with contacts that lose energy.
pub(super) fn under_history(draw: &mut Spread) -> Scene {
    let numbers = if draw.unit() < 0.2 { lossy(draw) } else { anywhere(draw) };
    given(numbers, draw)
}

/// A function that draws a scene.
pub(super) type Draw = fn(&mut Spread) -> Scene;

pub(super) const ANYWHERE: Draw = |draw| anywhere(draw).scene();
pub(super) const DENSE: Draw = |draw| dense(draw).scene();
pub(super) const LOSSY: Draw = |draw| lossy(draw).scene();
pub(super) const HELD: Draw = |draw| held(draw).scene();

/// The kind of scenes to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scenes {
    /// Any; beside DOP853 one in three is of [`Self::TwoMaxima`].
    Any,
    /// Scenes that often have two maxima in one step.
    TwoMaxima,
    /// Any, with contacts that lose energy.
    Lossy,
    /// Dampers that a stiff spring holds to a wall.
    Held,
    /// Any, under a pulse or a record.
    Histories,
}

/// Scene `number`, with the beginning of its window and its tolerance.
pub(super) fn drawn(number: u64, scene: Draw) -> (Scene, f64, f64) {
    let mut draw = Spread::new(number + 1);
    let scene = scene(&mut draw);
    let from = if draw.unit() < 0.5 { 0.0 } else { 15.0 * draw.unit() };
    (scene, from, if number.is_multiple_of(2) { 1e-6 } else { 1e-10 })
}
