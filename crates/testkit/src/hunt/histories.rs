//! Scenes under pulses and records for the hunts of `largest`.

use crate::histories::{noise, pulse};
use crate::scenes::{Numbers, Spread};
use retune_model::{Of, Scene, Shape};

/// The scene of these numbers under a pulse, or under noise with samples of 2 ms to half a second, equidistant or not; a force, or an
/// acceleration of the base.
pub(super) fn given(numbers: Numbers, draw: &mut Spread) -> Scene {
    let size = draw.logarithmic(300.0, 6000.0);
    let (of, size) =
        if draw.unit() < 0.5 { (Of::Force, size) } else { (Of::BaseAcceleration, size / numbers.m1) };
    let kind = draw.unit();
    let history = if kind < 0.15 {
        pulse(of, Shape::HalfSine, 3.0 * size, draw.logarithmic(0.03, 2.0))
    } else if kind < 0.3 {
        pulse(of, Shape::Rectangle, 3.0 * size, draw.logarithmic(0.03, 2.0))
    } else {
        let step = draw.logarithmic(0.002, 0.5);
        let count = ((15.0 / step) as usize).min(4000);
        noise(of, size, (step, count, kind < 0.7), draw)
    };
    numbers.under(history)
}
