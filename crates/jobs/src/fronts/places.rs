//! Points near a design where descents start or that are evaluated.

use retune_model::{Design, Parameter, PerVariable};
use retune_study::{Optimize, clipped};

/// The bounds of a parameter.
fn bounds(optimize: &Optimize, variable: Parameter) -> (f64, Option<f64>) {
    optimize.bounds.get(variable).unwrap_or((0.0, None))
}

/// The design itself, and copies with one gap at its lower bound if it is close to it.
pub(super) fn starts(at: &Design, optimize: &Optimize) -> Vec<PerVariable<f64>> {
    const NEAR: f64 = 0.05;
    let design = clipped(at, optimize);
    let at_bound = |variable: Parameter| {
        let value = design.get(variable)?;
        let (low, high) = bounds(optimize, variable);
        let is_near = value > low && value - low < NEAR * (high.unwrap_or(f64::INFINITY) - low).min(1.0);
        let mut start = design;
        start.set(variable, Some(low));
        is_near.then_some(start)
    };
    [design].into_iter().chain([Parameter::D, Parameter::C].into_iter().filter_map(at_bound)).collect()
}

/// A parameter moved by a share of the width of its bounds, or of its value without an upper bound.
fn moved(at: &Design, optimize: &Optimize, variable: Parameter, share: f64) -> f64 {
    let value = at.get(variable);
    let (low, high) = bounds(optimize, variable);
    let side = high.map_or(value, |high| (high - low).min(value.max(1.0)));
    (value + share * side).max(low)
}

/// The design moved along each parameter by a twentieth of the width of its bounds, both ways.
pub(super) fn about(at: &Design, optimize: &Optimize) -> Vec<Design> {
    const FAR: f64 = 0.05;
    let moved = |variable: Parameter, share: f64| {
        let value = moved(at, optimize, variable, share);
        Design::new(|other| if other == variable { value } else { at.get(other) }).ok()
    };
    optimize
        .vary
        .iter()
        .flat_map(|&variable| [-FAR, FAR].map(|share| moved(variable, share)))
        .flatten()
        .collect()
}

/// Points scattered by up to a tenth of the width of each parameter's bounds; a gap at its lower bound stays there. Where motions are
/// irregular, E1max jumps from design to design, and no descent leads to the better ones.
pub(super) fn scattered(at: &Design, optimize: &Optimize) -> Vec<PerVariable<f64>> {
    const FAR: f64 = 0.1;
    const PLACES: u32 = 128;
    let value = |i: u32, variable: Parameter| {
        let is_closed = variable.is_gap() && at.get(variable) <= bounds(optimize, variable).0;
        if !optimize.vary.contains(&variable) || is_closed {
            return at.get(variable);
        }
        moved(at, optimize, variable, FAR * (2.0 * sobol(i, variable as u32) - 1.0))
    };
    let places = (0..PLACES).filter_map(|i| Design::new(|variable| value(i, variable)).ok());
    places.map(|at| clipped(&at, optimize)).collect()
}

/// Points on the sides of the box where one gap is at its lower bound and the spring at its upper bound: good designs lie there that a
/// search of the whole box misses.
pub(super) fn on_sides(at: &Design, optimize: &Optimize) -> Vec<PerVariable<f64>> {
    const PLACES: u32 = 320;
    /// Smallest dashpot, as a share of its upper bound.
    const SMALL: f64 = 0.02;
    let box_of = |variable: Parameter| match optimize.bounds.get(variable) {
        Some((low, Some(high))) if optimize.vary.contains(&variable) => Some((low, high)),
        _ => None,
    };
    let [Some((_, k2)), Some((_, c2))] = [Parameter::K2, Parameter::C2].map(box_of) else {
        return Vec::new();
    };
    let gaps = [(Parameter::D, Parameter::C), (Parameter::C, Parameter::D)];
    let sides =
        gaps.into_iter().filter_map(|(closed, open)| Some((closed, box_of(closed)?.0, open, box_of(open)?)));
    let places = sides.flat_map(|(closed, rest, open, (low, high))| {
        (0..PLACES).filter_map(move |i| {
            let value = |variable| match variable {
                Parameter::K2 => k2,
                Parameter::C2 => c2 * SMALL.powf(sobol(i, 0)),
                _ if variable == closed => rest,
                _ if variable == open => low + (high - low) * sobol(i, 1),
                _ => at.get(variable),
            };
            Design::new(value).ok()
        })
    });
    places.map(|at| clipped(&at, optimize)).collect()
}

/// A coordinate of a point of a Sobol sequence, from 0 to 1.
fn sobol(point: u32, dimension: u32) -> f64 {
    f64::from(sobol_burley::sample(point, dimension, 0))
}
