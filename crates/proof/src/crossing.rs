//! Crossings of a section: a wall, the end of a contact, or a crest of the force.

use crate::equations::Flow;
use crate::number::{Family, Matrix, matrix, times};
use crate::step::{States, derivatives_within, enclosure};
use crate::{Event, Interval, Number, Taylor};
use std::array;

/// Attempts to enclose the time of a crossing.
const ATTEMPTS: usize = 12;

/// Motions on a section.
#[derive(Clone, Debug)]
pub struct Crossing {
    /// The motion from the centre.
    pub centre: Family,
    /// The derivatives of the state on the section by the first state.
    pub by: Matrix<Taylor>,
    /// All motions, up to where they cross.
    pub near: Family,
    /// The change of the independent variable until they cross.
    pub delay: Interval,
}

/// A section: where a coordinate has the value of an event.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// The event.
    pub event: Event,
    /// The value.
    pub value: Interval,
}

impl Section {
    /// Whether a change of the coordinate leads towards the section.
    pub fn is_towards(&self, change: Interval) -> bool {
        if self.event.is_rising() { change.is_positive() } else { change.is_negative() }
    }
}

/// The crossing by all states, which are near the section. None if a motion may reach it too slowly.
pub fn cross(flow: Flow<'_>, states: &States, section: &Section) -> Option<Crossing> {
    let (start, fixed) = (states.centre(), section.event.fixed());
    let (delay, _, slopes) = reach(flow, &start, section)?;
    let mut centre: Family = array::from_fn(|i| start[i] + delay * slopes[i]);
    centre[fixed] = Taylor::from(section.value);

    let (delay, near, slopes) = reach(flow, &states.all(), section)?;
    let delay = delay.hull();
    let within = derivatives_within(flow, &near.map(Taylor::hull), delay.hull(Interval::ZERO))?;
    let by = times(&within.map(|row| row.map(Taylor::from)), &states.by);
    // The time of crossing changes by minus the change of the coordinate over its slope.
    let per_slope = slopes[fixed].reciprocal();
    let on = |i: usize, j: usize| by[i][j] - slopes[i] * per_slope * by[fixed][j];
    let by = matrix(|i, j| if i == fixed { Taylor::ZERO } else { on(i, j) });
    Some(Crossing { centre, by, near, delay })
}

/// The change of the independent variable until all states of a box cross a section, an enclosure of the states until then, and their
/// slopes.
///
/// By the mean value theorem a coordinate `g` that is `g(0)` off its value reaches it after `-g(0)/g'` for some `g'` on the way (interval
/// Newton). If that is within the range over which the way was enclosed, each motion crosses in it, and only once, as `g'` has one sign.
fn reach(flow: Flow<'_>, start: &Family, section: &Section) -> Option<(Taylor, Family, Family)> {
    let off = start[section.event.fixed()] - Taylor::from(section.value);
    let newton = |slopes: &Family| {
        let slope = slopes[section.event.fixed()];
        section.is_towards(slope.hull()).then(|| -(off * slope.reciprocal()))
    };
    let mut delay = newton(&flow.derivative(start))?.hull();
    for _ in 0..ATTEMPTS {
        let tried = delay.wider(0.1 * delay.width() + f64::MIN_POSITIVE);
        let way = tried.hull(Interval::ZERO);
        // First an enclosure over the whole family, then for each of its motions.
        let rough = flow.derivative(&enclosure(flow, &start.map(Taylor::hull), way)?);
        let near: Family = array::from_fn(|i| start[i] + Taylor::from(way * rough[i]));
        let slopes = flow.derivative(&near);
        let next = newton(&slopes)?;
        if next.hull().is_in(tried) {
            return Some((next, near, slopes));
        }
        delay = next.hull().hull(tried);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equations::Mode;
    use crate::number::{SPEED, STATE, identity};
    use crate::step::{ORDER, step};
    use retune_model::Side;

    /// A wall is reached from inside the cavity: with the opposite sign of the speed, or both signs in one box, nothing is proven.
    #[test]
    fn contract_a_crossing_has_a_slope_of_the_right_sign() {
        let equations = crate::step::tests::scene();
        for (side, sign) in [(Side::Obstacle, 1.0), (Side::Primary, -1.0)] {
            let value = equations.walls[side as usize];
            let (section, flow) = (
                Section { event: Event::Touch(side), value },
                Flow { equations: &equations, mode: Mode::Flight },
            );
            for (speed, away, is_crossed) in [(0.5, 1e-3, true), (-0.5, 1e-3, false), (0.5, 0.6, false)] {
                let mut box_of = [Interval::ZERO; STATE];
                box_of[1] = Interval::around_zero(away);
                let start = [value.mid() - sign * 1e-9, sign * speed, 0.05, 0.3, 1.0, 0.0].map(Taylor::point);
                let states = States::first(&start, box_of, identity());
                let found = cross(flow, &states, &section);
                assert_eq!(found.is_some(), is_crossed, "{side:?} {speed} {away}");
                // Still to come: 1 nm at 0.5 m/s.
                assert!(found.is_none_or(|found| (found.delay.mid() - 2e-9).abs() < 1e-11), "{side:?}");
            }
        }
    }

    /// The damper slows down at 20 m/s²: it needs 7 % longer for the last millimetre than at its initial speed. After 2.6 ms, by a step, it
    /// is still before the wall, so the enclosure up to the crossing contains its state.
    #[test]
    fn invariant_all_of_the_way_to_a_crossing_is_enclosed() {
        let equations = crate::step::tests::scene();
        let value = equations.walls[Side::Obstacle as usize];
        let section = Section { event: Event::Touch(Side::Obstacle), value };
        let flow = Flow { equations: &equations, mode: Mode::Flight };
        let start = [value.mid() - 1e-3, 0.4, -0.5, 0.0, 1.0, 0.0].map(Taylor::point);
        let states = States::first(&start, [Interval::ZERO; STATE], identity());
        let found = cross(flow, &states, &section).expect("a crossing");
        let before = step(flow, &states, Taylor::point(2.6e-3), ORDER).expect("a step").0.all();
        assert!(before[0].hull().hi() < value.lo(), "{}", before[0].hull());
        for i in 0..SPEED {
            let (before, near) = (before[i].hull(), found.near[i].hull());
            assert!(before.is_in(near), "{i}: {before} {near}");
        }
        assert!(found.delay.lo() < 2.7e-3 && found.delay.hi() > 2.6e-3, "{}", found.delay);
    }
}
