//! One validated step of the motions from a set of states, with their derivatives by the initial state.

use crate::equations::{Flow, Mode, at};
use crate::number::{
    Family, Frame, Gradient, Matrix, STATE, State, identity, matrix, plus, times, times_vector, width,
};
use crate::{Interval, Number, Taylor};
use std::array;

/// Terms of a Taylor polynomial: the first omitted power.
pub const ORDER: usize = 20;
/// Least size of a coordinate for relative errors, in SI units.
const SMALL: f64 = 1e-6;
/// Attempts to find an enclosure of a step.
const ATTEMPTS: usize = 24;
/// Widening of a box that is too small, as a share of its width.
const WIDER: f64 = 0.1;

/// The states of all motions from initial states `x` in a box around the centre `x̂`; for a family for each value of its parameter.
///
/// The motion from `x̂` is in `middle + frame · spread`, and any other one differs from it by `by · (x - x̂)`, by the mean value theorem
/// with the derivatives over the whole box.
#[derive(Clone, Debug)]
pub struct States {
    /// Polynomials without rest.
    middle: Family,
    frame: Frame,
    spread: State,
    /// Derivatives by the first state.
    pub by: Matrix<Taylor>,
    /// `x - x̂`.
    away: State,
}

impl States {
    /// The initial states: `x̂` in `centre`, the differences from it in `away`, which contains zero, and the derivatives `by`.
    pub fn first(centre: &Family, away: State, by: Matrix<Taylor>) -> Self {
        let middle = centre.map(Taylor::polynomial);
        Self { middle, frame: Frame::identity(), spread: centre.map(Taylor::rest), by, away }
    }

    /// The state of the motion from `x̂`.
    pub fn centre(&self) -> Family {
        plus(&self.middle, &times_vector(&self.frame.matrix(), &self.spread).map(Taylor::from))
    }

    /// An enclosure of the states of all motions.
    pub fn all(&self) -> Family {
        let moved = |i: usize| {
            (0..STATE).fold(Taylor::ZERO, |sum, j| sum + self.by[i][j] * Taylor::from(self.away[j]))
        };
        plus(&self.centre(), &array::from_fn(moved))
    }

    /// The largest width of [`Self::all`].
    pub fn width(&self) -> f64 {
        width(&self.all().map(Taylor::hull))
    }
}

/// Enclosures of all motions during a step, as series in its elapsed share, from 0 to 1.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The mode of the damper.
    pub mode: Mode,
    /// Taylor coefficients at the beginning, times powers of the step length.
    pub at_start: Vec<Family>,
    /// Taylor coefficients anywhere in the step, with one power more than `at_start`: the last one bounds the truncation error.
    pub anywhere: Vec<State>,
}

/// An enclosure of the motions from all states of `start` while the independent variable changes by any of `h`, which contains zero.
///
/// If `start + h f(E)` is in `E`, the motions are in `E` (Picard and Lindelöf): up to the moment a motion first left `E` it would be in
/// `E`, so its change would be in `h f(E)`.
pub fn enclosure(flow: Flow<'_>, start: &State, h: Interval) -> Option<State> {
    let reached = |e: &State| {
        let slopes = flow.derivative(e);
        array::from_fn(|i| start[i] + h * slopes[i])
    };
    self_contained(reached(start), reached)
}

/// A box that contains its own image under a map, from an initial guess.
fn self_contained(guess: State, map: impl Fn(&State) -> State) -> Option<State> {
    let mut e = guess;
    for _ in 0..ATTEMPTS {
        e = e.map(|x| x.wider(WIDER * x.width() + f64::MIN_POSITIVE));
        let next = map(&e);
        if (0..STATE).all(|i| next[i].is_in(e[i])) {
            return Some(next);
        }
        if !next.iter().all(|x| x.is_bounded()) {
            return None;
        }
        e = next;
    }
    None
}

/// The derivatives anywhere in a step by the state at its beginning, where the motions are in `e`: `W` with `I + h f'(e) W` in `W`.
pub fn derivatives_within(flow: Flow<'_>, e: &State, h: Interval) -> Option<Matrix> {
    let slopes = flow.derivative(&Gradient::coordinates(e)).map(|slope| slope.by);
    let mut within = identity();
    for j in 0..STATE {
        let unit: State = array::from_fn(|i| within[i][j]);
        let change = |column: &State| times_vector(&slopes, column).map(|slope| h * slope);
        let column = self_contained(plus(&unit, &change(&unit)), |column| plus(&unit, &change(column)))?;
        (0..STATE).for_each(|i| within[i][j] = column[i]);
    }
    Some(within)
}

/// A step of length `h` with `order` terms: the states after it, and the enclosures during it. None if no enclosure was found.
pub fn step(flow: Flow<'_>, states: &States, h: Taylor, order: usize) -> Option<(States, Piece)> {
    let length = h.hull();
    if !length.is_positive() {
        return None;
    }
    let during = Interval::new(0.0, length.hi());
    let all = states.all();
    let e = enclosure(flow, &all.map(Taylor::hull), during)?;
    let within = derivatives_within(flow, &e, during)?;
    let rough = flow.series(&Gradient::coordinates(&e), order);
    let (anywhere, power) = in_shares(&rough, length);
    let by_left_out = times(&rough[order].map(|c| c.by.map(|by| by * power)), &within);

    let series = flow.series(&Gradient::coordinates(&all), order - 1);
    let step: Matrix<Taylor> =
        matrix(|i, j| at(series.iter().map(|c| c[i].by[j]), h) + Taylor::from(by_left_out[i][j]));

    // The motion from the centre: the motion from the middle of its box, and the image of the box.
    let from_middle = flow.series(&states.middle, order - 1);
    let reached = |i: usize| at(from_middle.iter().map(|c| c[i]), h) + Taylor::from(anywhere[order][i]);
    let reached: Family = array::from_fn(reached);
    let turned = times(&step.map(|row| row.map(Taylor::hull)), &states.frame.matrix());
    let frame = Frame::along(&turned, &states.spread.map(Interval::magnitude), flow.equations.scales);
    let mut spread = frame.coordinates(&reached.map(Taylor::rest))?;
    for j in 0..STATE {
        let column = frame.coordinates(&turned.map(|row| row[j]))?;
        (0..STATE).for_each(|i| spread[i] = spread[i] + column[i] * states.spread[j]);
    }
    let by = times(&step, &states.by);
    let next = States { middle: reached.map(Taylor::polynomial), frame, spread, by, away: states.away };
    Some((next, Piece { mode: flow.mode, at_start: in_shares(&series, h).0, anywhere }))
}

/// The terms of a series times powers of the step length, and the last of these powers.
fn in_shares<T: Number>(series: &[[Gradient<T>; STATE]], h: T) -> (Vec<[T; STATE]>, T) {
    let mut power = T::constant(Interval::ONE);
    let scaled = series.iter().enumerate().map(|(k, c)| {
        power = if k == 0 { power } else { power * h };
        c.map(|c| c.value * power)
    });
    (scaled.collect(), power)
}

impl Piece {
    /// The largest truncation error of the polynomials, relative to the size of a coordinate, or to [`SMALL`] if that is larger.
    pub fn left_out(&self) -> f64 {
        let share = |i: usize| {
            let size: f64 = self.at_start.iter().map(|c| c[i].mid().abs()).sum();
            self.anywhere[self.at_start.len()][i].magnitude() / size.max(SMALL)
        };
        (0..STATE).map(share).fold(0.0, f64::max)
    }

    /// The Taylor series of a quantity over the step: the coefficients at its beginning, and the last one anywhere in it.
    pub fn series_of(&self, quantity: &impl Quantity) -> Vec<Taylor> {
        let mut series = quantity.series(self.mode, &self.at_start);
        series.extend(quantity.series(self.mode, &self.anywhere).pop().map(Taylor::from));
        series
    }
}

/// A quantity of a motion.
pub trait Quantity {
    /// Its series, from that of the motion.
    fn series<T: Number>(&self, mode: Mode, motion: &[[T; STATE]]) -> Vec<T>;
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::equations::{Equations, product};
    use crate::range::Range;
    use retune_model::{Scene, Side};

    pub(crate) const SURFACES: &str = r#"{ "R": 2, "q": 0.318, "E1": 2.1e11, "nu1": 0.3, "E2": 2.21e7, "nu2": 0.4,
        "E3": 2.1e11, "nu3": 0.3, "E4": 2.05e7, "nu4": 0.4 }"#;

    /// The paper's structure with a damper.
    pub(crate) fn scene_with(damper: &str) -> Scene {
        let text = format!(
            r#"{{ "primary": {{ "m1": 1000, "c1": 452, "k1": 39500 }}, "forcing": {{ "P": 800, "omega": 6.28 }}, "damper": {{ {damper} }} }}"#
        );
        serde_json::from_str(&text).expect("a scene")
    }

    /// The paper's tuned damper.
    pub(crate) fn scene() -> Equations {
        let damper =
            format!(r#""m2": 60, "k2": 215, "c2": 232, "D": 0.06, "C": 0.36, "contact": {SURFACES}"#);
        Equations::new(&scene_with(&damper)).expect("equations")
    }

    /// The states from one state after `n` equal steps, and the enclosures between.
    fn after(order: usize, flow: Flow<'_>, start: [f64; STATE], h: f64, n: usize) -> (States, f64) {
        let mut states = States::first(&start.map(Taylor::point), [Interval::ZERO; STATE], identity());
        let mut left_out = 0.0;
        for _ in 0..n {
            let (next, piece) = step(flow, &states, Taylor::point(h / n as f64), order)
                .unwrap_or_else(|| panic!("no step: {:?} {n}", flow.mode));
            left_out = f64::max(left_out, piece.left_out());
            states = next;
        }
        (states, left_out)
    }

    const STARTS: [(Mode, [f64; STATE], f64); 3] = [
        (Mode::Flight, [0.2, -1.0, 0.05, 0.3, 1.0, 0.0], 0.07),
        (Mode::Contact(Side::Primary), [0.05, 0.8, 0.05, 0.3, 1.0, 0.0], 0.02),
        (Mode::Contact(Side::Obstacle), [0.06, -0.3, 0.05, 0.3, 2.0, 0.0], 0.02),
    ];

    /// One step with a polynomial of degree five has a truncation error far above rounding, sixteen steps of order twenty have none. Both
    /// enclose the same motion and the same derivatives.
    #[test]
    fn invariant_one_long_step_holds_what_many_short_ones_say() {
        for (mode, start, h) in STARTS {
            let flow = Flow { equations: &scene(), mode };
            let (one, rough) = after(6, flow, start, h, 1);
            let (many, sharp) = after(ORDER, flow, start, h, 16);
            assert!(rough > 1e-10 && sharp < 1e-18, "{mode:?}: {rough:e} {sharp:e}");
            for i in 0..STATE {
                let (wide, narrow) = (one.centre()[i].hull(), many.centre()[i].hull());
                assert!(narrow.is_in(wide.wider(narrow.width())), "{mode:?} {i}: {narrow} {wide}");
                assert!(narrow.width() < 1e-13, "{mode:?} {i}: {narrow}");
                for j in 0..STATE {
                    let (wide, narrow) = (one.by[i][j].hull(), many.by[i][j].hull());
                    assert!(wide.meet(narrow).is_some(), "{mode:?} {i} {j}: {narrow} {wide}");
                }
            }
        }
    }

    /// Motions from the corners of a box stay in its enclosures.
    #[test]
    fn invariant_a_box_holds_the_motions_from_its_corners() {
        for (mode, start, h) in STARTS {
            let flow = Flow { equations: &scene(), mode };
            let r = 1e-5;
            let mut states =
                States::first(&start.map(Taylor::point), [Interval::around_zero(r); STATE], identity());
            for _ in 0..8 {
                states = step(flow, &states, Taylor::point(h / 8.0), ORDER).expect("a step").0;
            }
            for corner in 0..1 << STATE {
                let from = array::from_fn(|i| start[i] + if corner >> i & 1 == 0 { -r } else { r });
                let (own, _) = after(ORDER, flow, from, h, 8);
                for i in 0..STATE {
                    let (own, all) = (own.centre()[i].hull(), states.all()[i].hull());
                    assert!(own.is_in(all.wider(own.width())), "{mode:?} {corner} {i}: {own} {all}");
                    assert!(all.width() < 100.0 * r, "{mode:?} {i}: {all}");
                }
            }
        }
    }

    /// The square of a coordinate.
    struct Square(usize);

    impl Quantity for Square {
        fn series<T: Number>(&self, _: Mode, motion: &[[T; STATE]]) -> Vec<T> {
            let of = |k: usize| motion[k][self.0];
            (0..motion.len()).map(|k| product(k, of, of)).collect()
        }
    }

    /// The truncation error of a quantity in a step of degree five is far above rounding, too: its values during the step and at the end
    /// contain those by many sharp steps.
    #[test]
    fn invariant_the_range_of_a_quantity_holds_its_values_by_sharp_steps() {
        for (mode, start, h) in STARTS {
            let flow = Flow { equations: &scene(), mode };
            let first = States::first(&start.map(Taylor::point), [Interval::ZERO; STATE], identity());
            let (_, piece) = step(flow, &first, Taylor::point(h), 6).expect("a step");
            for share in [0.5, 0.75, 1.0] {
                let sharp = after(ORDER, flow, start, share * h, 16).0.centre();
                for i in 0..STATE {
                    let (own, series) = (sharp[i].hull().square(), piece.series_of(&Square(i)));
                    let range = Range::new(series).at(Taylor::point(share)).hull();
                    assert!(range.meet(own).is_some(), "{mode:?} {i} {share}: {own} {range}");
                }
            }
        }
    }

    /// A box that motions leave during a step is not an enclosure.
    #[test]
    fn contract_no_box_is_found_for_too_long_a_step() {
        for (mode, start, _) in STARTS {
            let start = start.map(Interval::point);
            let flow = Flow { equations: &scene(), mode };
            assert_eq!(enclosure(flow, &start, Interval::new(0.0, 3.0)), None, "{mode:?}");
        }
    }
}
