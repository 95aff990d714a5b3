//! Where motions cross a section: a wall, the end of a contact, or a crest of the force.

use crate::Interval;
use crate::equations::{Equations, Mode};
use crate::number::State;
use crate::small::{Matrix, times};
use crate::step::{States, derivatives_within, enclosure};

/// Attempts to enclose the time of a crossing.
const ATTEMPTS: usize = 12;

/// Motions on a section.
#[derive(Clone, Debug)]
pub struct Crossing {
    /// The motion from the centre.
    pub centre: State,
    /// The derivatives of the state on the section by the first state.
    pub by: Matrix,
    /// All motions, from where they were to where they cross.
    pub near: State,
    /// The independent variable until they cross.
    pub delay: Interval,
}

/// A section: where a coordinate has a value, and comes there rising or falling.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// The coordinate.
    pub index: usize,
    /// The value.
    pub value: Interval,
    /// Whether it rises.
    pub is_rising: bool,
}

/// The crossing by all states, which are near the section. None if a motion may come to it too slowly.
pub fn cross(equations: &Equations, mode: Mode, states: &States, section: &Section) -> Option<Crossing> {
    let start = states.centre();
    let (delay, _, slopes) = reach(equations, mode, &start, section)?;
    let mut centre: State = std::array::from_fn(|i| start[i] + delay * slopes[i]);
    centre[section.index] = section.value;

    let (delay, near, slopes) = reach(equations, mode, &states.all(), section)?;
    let within = derivatives_within(equations, mode, &near, delay.hull(Interval::ZERO))?;
    let by = times(&within, &states.by);
    // The time of crossing changes by minus the change of the coordinate over its slope.
    let on = |i: usize, j: usize| {
        if i == section.index {
            Interval::ZERO
        } else {
            by[i][j] - slopes[i] / slopes[section.index] * by[section.index][j]
        }
    };
    let by = std::array::from_fn(|i| std::array::from_fn(|j| on(i, j)));
    Some(Crossing { centre, by, near, delay })
}

/// The independent variable until all states of a box cross a section, where they are until then, and how they change there.
///
/// By the mean value theorem a coordinate `g` that is `g(0)` off its value is there after `-g(0)/g'` for some `g'` on the way (interval
/// Newton); if that is in the stretch for which the way was enclosed, each motion crosses in it, and once, as `g'` has one sign.
fn reach(
    equations: &Equations,
    mode: Mode,
    start: &State,
    section: &Section,
) -> Option<(Interval, State, State)> {
    let off = start[section.index] - section.value;
    let is_right =
        |slope: Interval| if section.is_rising { slope.is_positive() } else { slope.is_negative() };
    let newton = |slopes: &State| {
        let slope = slopes[section.index];
        is_right(slope).then(|| -(off / slope))
    };
    let mut delay = newton(&equations.derivative(mode, start))?;
    for _ in 0..ATTEMPTS {
        let tried = delay.wider(0.1 * delay.width() + f64::MIN_POSITIVE);
        let near = enclosure(equations, mode, start, tried.hull(Interval::ZERO))?;
        let slopes = equations.derivative(mode, &near);
        let next = newton(&slopes)?;
        if next.is_in(tried) {
            return Some((next, near, slopes));
        }
        delay = next.hull(tried);
    }
    None
}
