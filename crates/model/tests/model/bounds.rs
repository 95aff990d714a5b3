//! Bounds on the motion in contact against the series that they stand for, and against motions.

use retune_model::{Change, Coupled, Growth, ORDERS, RegularisedContact, RegularisedState, Side};
use retune_testkit::scenes::{LOSSY, Numbers, ROW1, SSVI, Spread, TWO_SIDED, advance};

pub const T: f64 = 1.21;

pub fn growth(equations: &RegularisedContact, h: f64, ends: [&RegularisedState; 2]) -> Growth<ORDERS> {
    equations.growth(ends, &equations.change(h, ends))
}

pub fn growth_of_rates(
    equations: &RegularisedContact,
    h: f64,
    ends: [&RegularisedState; 2],
) -> [Growth<ORDERS>; 2] {
    equations.growth_of_rates(ends, &equations.change(h, ends))
}

/// Terms 0 to 6 of a series.
type Series = [f64; 7];

fn times(a: &Series, b: &Series) -> Series {
    std::array::from_fn(|k| (0..=k).map(|i| a[i] * b[k - i]).sum())
}

fn sum(terms: &[(f64, &Series)]) -> Series {
    std::array::from_fn(|k| terms.iter().map(|(factor, series)| factor * series[k]).sum())
}

fn integral(start: f64, slope: &Series) -> Series {
    std::array::from_fn(|k| if k == 0 { start } else { slope[k - 1] / k as f64 })
}

/// Accelerations of the structure and of both bodies towards each other by a unit of force between them: `1/m1`, `1/m1 + 1/m2`.
pub fn lightness(n: &Numbers) -> [f64; 2] {
    [1.0 / n.m1, 1.0 / n.m1 + 1.0 / n.m2]
}

/// Picard's iteration of the equations in contact with every term taken by its size but the first of `a1` and `dw/dt`, which are known, from
/// `[q, w, x1, v1]`: the series in `θ` of `x1`, `v1`, the spring's stretch and `w`, and those of their rates in time.
fn picard(n: &Numbers, system: &Coupled, side: Side, start: [f64; 4], known: [f64; 2]) -> [[Series; 4]; 2] {
    let constant = |value: f64| integral(value, &[0.0; 7]);
    let one = constant(1.0);
    let ([mut q, mut w, mut x, mut v], mut p) = (start.map(constant), constant(n.p));
    let beyond = (system.wall(side) - n.d).abs();
    let stretch = |q: &Series| sum(&[(1.0, &times(q, q)), (beyond, &one)]);
    let mut rates = [[0.0; 7]; 2];
    for _ in 0..9 {
        let (cube, stretch) = (times(&q, &times(&q, &q)), stretch(&q));
        let cube = sum(&[(1.0, &cube), (n.lambda, &times(&cube, &w))]);
        let outside = sum(&[(1.0 / n.m1, &p), (n.c1 / n.m1, &v), (n.k1 / n.m1, &x)]);
        rates = lightness(n).map(|by| {
            let push = sum(&[(system.hertz(side), &cube), (n.c2, &w), (n.k2, &stretch)]);
            sum(&[(1.0, &outside), (by, &push)])
        });
        (rates[0][0], rates[1][0]) = (known[0], known[1]);
        let accelerations = rates.map(|rate| times(&q, &rate));
        let (dx, dp) = (times(&q, &v), sum(&[(n.omega, &times(&q, &p))]));
        q = integral(start[0], &sum(&[(0.5, &w)]));
        [v, w] = [integral(start[3], &accelerations[0]), integral(start[1], &accelerations[1])];
        (x, p) = (integral(start[2], &dx), integral(n.p, &dp));
    }
    [[x, v, stretch(&q), w], [v, rates[0], w, rates[1]]]
}

#[test]
fn exact_bounds_on_a_piece_are_the_series_with_every_term_by_its_size() {
    let mut spread = Spread::new(17);
    // The force is next to nothing in a contact of these: only a fast and strong one shows.
    let driven = Numbers { p: 8e6, omega: 900.0, ..SSVI };
    for numbers in [SSVI, ROW1, TWO_SIDED, LOSSY, driven] {
        let system = numbers.coupled();
        for side in Side::BOTH {
            let mut equations = system.regularised_contact(side);
            equations.set_excitation(0.0, system.excitation(T));
            let [q, w, x, v] = [0.05, 0.8, 0.1, 0.6].map(|size| size * spread.logarithmic(0.3, 1.0));
            let state = [q, -w, x, -v, 0.0];
            let known = |y: &RegularisedState| {
                [equations.derivative(y)[3] / y[0], equations.acceleration(y)].map(f64::abs)
            };
            let [expected, expected_rates] = picard(&numbers, &system, side, [q, w, x, v], known(&state));
            let found = growth(&equations, 0.0, [&state, &state]);
            for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                assert!((found / expected - 1.0).abs() < 1e-12, "{side:?} {found} {expected}");
            }
            let [again, found_rates] = growth_of_rates(&equations, 0.0, [&state, &state]);
            assert_eq!(again, found);
            for (found, expected) in found_rates.iter().flatten().zip(expected_rates.iter().flatten()) {
                assert!((found / expected - 1.0).abs() < 1e-12, "{side:?} {found} {expected}");
            }
            // A piece is bounded by more than its ends, but by little more if it is short.
            let larger = [1.001 * q, -w, x, -v, 0.0];
            let wide = growth(&equations, 1e-4 * q / w, [&state, &larger]);
            let [expected, _] = picard(&numbers, &system, side, [1.001 * q, w, x, v], known(&larger));
            for (found, expected) in wide.iter().flatten().zip(expected.iter().flatten()) {
                assert!((1.0..2.0).contains(&(found / expected)), "{side:?} {found} {expected}");
            }
            assert!(growth(&equations, 1e6, [&state, &larger])[0][0].is_infinite(), "too long a piece");
            let [_, rates] = growth_of_rates(&equations, 1e6, [&state, &larger]);
            assert!(rates[1][0].is_infinite(), "too long a piece");
        }
    }
}

/// Over a whole contact: speeds grow by what all else than Hertz's force may do, and that force is the undisturbed collision's.
#[test]
fn exact_bounds_over_a_contact_add_up_every_cause() {
    let strong = Numbers { p: 1e5, omega: 300.0, ..SSVI };
    for numbers in [SSVI, ROW1, TWO_SIDED, strong] {
        let system = numbers.coupled();
        for side in Side::BOTH {
            let equations = system.regularised_contact(side);
            let Numbers { m1, c1, k1, k2, c2, p, omega, .. } = numbers;
            let (w0, x1, v1, duration): (f64, f64, f64, f64) = (0.7, 0.04, 0.3, 1e-3);
            let q0 = equations.greatest_depth(w0);
            let (by, beyond) = (lightness(&numbers), (system.wall(side) - numbers.d).abs());
            let beside = |w: f64, v: f64, q: f64| {
                let resisting = (p + c1 * v + k1 * (x1 + duration * v)) / m1;
                by.map(|by| resisting + by * (c2 * w + k2 * (q * q + beyond)))
            };
            let depth = |w: f64| q0 * (0.6 + 0.4 * w / w0);
            // Where the speeds were guessed to end: half more towards each other, three times the touch-down's for the structure.
            let (w, v) = (1.5 * w0, v1 + 3.0 * w0);
            let [on_primary, apart] = beside(w, v, depth(w));
            let (w, v) = (
                w0 + 2.0 * duration * apart,
                v1 + duration * on_primary + by[0] / by[1] * (2.0 * w0 + 3.0 * duration * apart),
            );
            let q = depth(w);
            let [on_primary, apart] = beside(w, v, q);
            let hertz = system.hertz(side);
            let (a, rate) = (on_primary + by[0] * hertz * q.powi(3), apart + by[1] * hertz * q.powi(3));
            // d(q³)/dt = 1.5 q w, and u √(1 - u⁵) is at most 0.658.
            let jerk = by.map(|by| {
                (omega * p + c1 * a + k1 * v) / m1 + by * (c2 * rate + k2 * w + hertz * 1.5 * 0.658 * q * w)
            });
            let expected = [
                [x1 + duration * v, v, 0.5 * a],
                [v, a, 0.5 * jerk[0]],
                [q * q + beyond, w, 0.5 * rate],
                [w, rate, 0.5 * jerk[1]],
            ];
            let over =
                equations.over_contact(&[0.0, w0, -x1, -v1, 0.0], q0, duration, p).expect("a short contact");
            let impulse = w0 + w + duration * apart;
            let beside = [v, on_primary, w, apart];
            for (found, expected) in over.beside.iter().zip(&beside).chain([(&over.impulse, &impulse)]) {
                assert!((found / expected - 1.0).abs() < 1e-12, "{side:?} {found} {expected}");
            }
            assert_eq!(over.duration, duration);
            let found = equations.growth_over_contact(&over);
            assert_eq!(over.most, found.map(|[most, ..]| most));
            for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                assert!((found / expected - 1.0).abs() < 1e-12, "{side:?} {found} {expected}");
            }
        }
    }
}

#[test]
fn invariant_no_contact_leaves_its_bounds() {
    let mut spread = Spread::new(19);
    let mut bounded = 0;
    for _ in 0..300 {
        let numbers = Numbers {
            m2: spread.logarithmic(1.0, 1000.0),
            k2: spread.logarithmic(10.0, 3e4),
            c2: spread.logarithmic(1.0, 1e4),
            p: spread.logarithmic(1.0, 1e6),
            omega: spread.logarithmic(1.0, 30.0),
            ..SSVI
        };
        let (system, side) = (numbers.coupled(), Side::BOTH[usize::from(spread.unit() < 0.5)]);
        let mut equations = system.regularised_contact(side);
        equations.set_excitation(0.0, system.excitation(T));
        let speed = spread.logarithmic(0.05, 2.0);
        let touch = [0.0, speed, 0.1 * spread.signed(), 0.6 * spread.signed(), 0.0];
        let depth = equations.greatest_depth(speed);
        let (mut states, h) = (vec![touch], 0.01 * depth / speed);
        while states.last().is_some_and(|y| y[0] >= 0.0) && states.len() < 3000 {
            states.extend(states.last().map(|y| advance(&equations, y, h)));
        }
        states.pop(); // has left the wall
        let duration = states.last().expect("the first")[4];
        let Some(over) = equations.over_contact(&touch, depth, duration, numbers.p) else {
            continue;
        };
        let (bounds, mut impulse) = (equations.growth_over_contact(&over), 0.0);
        bounded += 1;
        let beyond = side.sign() * (system.wall(side) - numbers.d);
        let accelerations =
            |y: &RegularisedState| (equations.derivative(y)[3] / y[0].max(1e-300), equations.acceleration(y));
        for pair in states[1..].windows(2) {
            let [q, w, x1, v1, t] = pair[0];
            let [(a, rate), (next_a, next_rate)] = [accelerations(&pair[0]), accelerations(&pair[1])];
            let passed = pair[1][4] - t;
            let values = [
                [x1, v1, 0.5 * a],
                [v1, a, 0.5 * (next_a - a) / passed],
                [q * q + beyond, w, 0.5 * rate],
                [w, rate, 0.5 * (next_rate - rate) / passed],
            ];
            for (value, bound) in values.iter().flatten().zip(bounds.iter().flatten()) {
                assert!(value.abs() <= bound * (1.0 + 1e-9), "{value} {bound} {numbers:?}");
            }
            let force = equations.hertz_rate() * q.powi(3);
            let beside = [v1, a - side.sign() * force / equations.mass_ratio(), w, rate + force];
            for (value, bound) in beside.iter().zip(&over.beside) {
                assert!(value.abs() <= bound * (1.0 + 1e-9), "{value} {bound} {numbers:?}");
            }
            impulse += equations.hertz_rate() * 0.5 * (q.powi(3) + pair[1][0].powi(3)) * passed;
            // The rule of trapezoids is good to 1e-3 here.
            assert!(impulse <= over.impulse * 1.001, "{impulse} {} {numbers:?}", over.impulse);
        }
    }
    assert!(bounded > 100, "{bounded}");
}

/// Pieces on which a damper that is held swings by up to some radians, too far for Picard and Lindelöf.
#[test]
fn invariant_no_long_piece_of_a_held_contact_leaves_its_bounds() {
    let mut spread = Spread::new(23);
    let (mut bounded, mut tight, mut changed, mut near) = ([0; 3], 0, 0, 0);
    for draw in 0..30_000 {
        let numbers = Numbers {
            m2: spread.logarithmic(1.0, 1000.0),
            k2: spread.logarithmic(1e3, 1e8),
            c2: spread.logarithmic(1.0, 1e5),
            p: spread.logarithmic(1.0, 1e4),
            omega: spread.logarithmic(1.0, 30.0),
            lambda: if draw % 3 == 1 { spread.logarithmic(0.01, 10.0) } else { 0.0 },
            e: if draw % 3 == 2 { 0.5 + 0.45 * spread.signed() } else { 1.0 },
            d: 0.0,
            ..SSVI
        };
        let (system, side) = (numbers.coupled(), Side::Primary);
        let mut equations = system.regularised_contact(side);
        equations.set_excitation(0.0, system.excitation(T));
        equations.carry_excitation();
        // About the place at which the wall would hold it, or far from there.
        let (x1, v1) = (0.3 * spread.signed(), 2.0 * spread.signed());
        let stiffness = numbers.k2 * lightness(&numbers)[1];
        let q = (10.0 / (stiffness + equations.hertz_rate() * 0.01)).sqrt() * spread.logarithmic(0.1, 30.0);
        let rate = (stiffness + 1.5 * equations.hertz_rate() * q).sqrt();
        let from = [q, rate * q * q * spread.signed() * spread.logarithmic(1e-6, 0.5), x1, v1, 0.0];
        if equations.push(from[1]) <= 0.0 {
            continue;
        }
        let turns = spread.logarithmic(0.1, 4.0);
        let h = turns / rate / q;
        let mut states = vec![from];
        for _ in 0..300 {
            let next = advance(&equations, states.last().expect("the first"), h / 300.0);
            states.push(next);
        }
        // A piece ends where the damper leaves the wall, where the force of a loss ends, or before its polynomial does.
        if states
            .iter()
            .any(|y| y[0] < 0.0 || equations.push(y[1]) < 0.0 || numbers.omega * y[4] > equations.turn())
        {
            continue;
        }
        let ends = [&from, states.last().expect("the first")];
        let change = equations.change(h, ends);
        if let Some(change) = &change {
            // By a unit of force between them both bodies accelerate, x1 and x2 in the signs of the side.
            let [by_primary, apart] = lightness(&numbers).map(|a| side.sign() * system.hertz(side) * a);
            let kick = change.forces.expect("no speed that follows the forces").kick;
            for (found, expected) in kick.into_iter().zip([0.0, by_primary, 0.0, by_primary - apart]) {
                assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} {expected}");
            }
            changed += 1;
            near += u32::from(stays_within(&equations, change, &states));
        }
        let [bounds, rates] = equations.growth_of_rates(ends, &change);
        if !bounds.as_flattened().iter().all(|bound| bound.is_finite()) {
            continue;
        }
        bounded[draw % 3] += u32::from(turns > 2.0 || (draw % 3 == 2 && turns > 0.5));
        let beyond = side.sign() * (system.wall(side) - numbers.d);
        let mut fastest: f64 = 0.0;
        for pair in states.windows(2) {
            let [now, next] = [0, 1].map(|i| equations.derivative(&pair[i]));
            let [q, w, x1, v1, _] = pair[0];
            let acceleration = equations.acceleration(&pair[0]);
            let slope = |i: usize| 0.5 * (next[i] - now[i]) / (h / 300.0);
            let values = [
                [x1, now[2], slope(2)],
                [v1, now[3], slope(3)],
                [q * q + beyond, q * w, 0.5 * (next[0] * 2.0 * pair[1][0] - q * w) / (h / 300.0)],
                [w, now[1], slope(1)],
            ];
            for (value, bound) in values.iter().zip(&bounds) {
                for (value, bound) in value.iter().zip(bound) {
                    assert!(
                        value.abs() <= bound * (1.0 + 1e-6) + 1e-12,
                        "{value} {bound} {numbers:?} {from:?} {h}"
                    );
                }
            }
            assert!(acceleration.abs() <= rates[3][0] * (1.0 + 1e-9), "{acceleration} {rates:?} {numbers:?}");
            fastest = fastest.max(w.abs());
        }
        tight += u32::from(turns > 2.0 && bounds[3][0] < 3.0 * fastest);
    }
    assert!(bounded.iter().all(|n| *n > 100) && tight > 50, "{bounded:?} {tight}");
    assert!(changed > 5000 && 2 * near > changed, "{changed} {near}");
}

/// No state of a piece is farther from the end that is nearer in `θ` than its bounds say; returns whether its speed comes half as far.
fn stays_within(equations: &RegularisedContact, change: &Change, states: &[RegularisedState]) -> bool {
    let last = states.len() - 1;
    let forces = change.forces.expect("no speed that follows the forces");
    let numbers = |y: &RegularisedState| {
        let [q, w, x1, v1, _] = *y;
        let a1 = if q > 0.0 { equations.derivative(y)[3] / q } else { 0.0 };
        let (rate, contact) = (equations.acceleration(y), equations.contact_over_stiffness(y));
        [q, x1, v1, w, a1, rate, contact, equations.excitation(y)[0]]
    };
    let amplitude = equations.excitation(&states[0]).into_iter().fold(0.0, f64::hypot);
    let [[x1, v1, _, w], [_, a1, _, rate]] = [change.states, change.rates];
    let bounds = [change.root, x1, v1, w, a1, rate, forces.contact, [amplitude, forces.turn * amplitude]];
    let ends = [states[0], states[last]].map(|y| numbers(&y));
    let mut near = false;
    for (k, y) in states.iter().enumerate().filter(|(_, y)| y[0] > 0.0) {
        let end = ends[usize::from(2 * k > last)];
        for (i, (value, [most, of])) in numbers(y).into_iter().zip(bounds).enumerate() {
            let off = (value - end[i]).abs();
            assert!(value.abs() <= most * (1.0 + 1e-9), "{i}: {value} {most}");
            assert!(off <= of * (1.0 + 1e-9) + 1e-12 * most, "{i}: {off} {of} {y:?}");
            near |= i == 3 && off > 0.5 * of;
        }
    }
    near
}

/// A force too strong for the argument is told, and so is one that is no number.
#[test]
fn contract_no_bound_is_given_where_none_is_proven() {
    let equations = SSVI.coupled().regularised_contact(Side::Primary);
    let touch = [0.0, 0.7, 0.0, 0.0, 0.0];
    let depth = equations.greatest_depth(0.7);
    for amplitude in [1e9, 1e12, f64::NAN] {
        assert_eq!(equations.over_contact(&touch, depth, 0.01, amplitude), None, "{amplitude}");
    }
}
