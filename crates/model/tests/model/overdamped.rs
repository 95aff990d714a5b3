//! Contacts with a strong dashpot, whose speed into the wall follows the forces.

use crate::bounds::{T, growth_of_rates, lightness};
use retune_model::Side;
use retune_testkit::scenes::{LOSSY, Numbers, SSVI, Spread, advance};

/// By the speed that follows the forces, a difference quotient along its motion, the equation of motion is fulfilled up to what is said to be left out.
#[test]
fn invariant_a_speed_that_follows_the_forces_leaves_out_what_it_says() {
    let mut spread = Spread::new(29);
    let (mut seen, mut near, mut greatest) = (0, 0, 0.0_f64);
    for number in 0..30_000 {
        let numbers = Numbers {
            c1: spread.logarithmic(1.0, 1e4),
            m2: spread.logarithmic(1.0, 1000.0),
            k2: spread.logarithmic(1.0, 1e5),
            c2: spread.logarithmic(1e4, 1e6),
            omega: spread.logarithmic(1.0, 30.0),
            ..SSVI
        };
        let (system, side) = (numbers.coupled(), Side::BOTH[number % 2]);
        let mut equations = system.regularised_contact(side);
        equations.set_excitation(0.0, system.excitation(T));
        equations.set_overdamped(true);
        let mut y = [spread.logarithmic(1e-4, 0.1), 0.0, 0.3 * spread.signed(), 2.0 * spread.signed(), 0.0];
        let following = equations.following(&y);
        y[1] = following.speed[0];
        let error = equations.error_of_following(&y, &following);
        if !(1e-7..1e-3).contains(&error) {
            continue;
        }
        // In a thousandth of the time in which anything changes.
        let [inverse_m1, apart] = lightness(&numbers);
        let fast = numbers.c2 * apart;
        let nearing = (y[1].abs() + following.speed[1].abs() / fast) / (y[0] * y[0]);
        let seconds = 1e-4 / (fast * error.cbrt() + nearing);
        let speed = |seconds: f64| {
            let ahead = advance(&equations, &y, seconds / y[0]);
            (equations.following(&ahead).speed[0], ahead[4])
        };
        let [(later, to), (earlier, from)] = [speed(seconds), speed(-seconds)];
        let left = (later - earlier) / (to - from) - equations.acceleration(&y);
        let sway = (numbers.k1 * inverse_m1).sqrt() * y[3].abs();
        let size = apart / inverse_m1 * (equations.size_of_terms(&y) + sway);
        // Measured, not proven: see `docs/theory.md`.
        assert!(left.abs() <= 1.05 * error * size, "{left:e} {error:e} {size:e} {y:?} {numbers:?}");
        (seen, near) = (seen + 1, near + i32::from(nearing > 0.1 * fast * error.cbrt()));
        greatest = greatest.max(left.abs() / (error * size));
    }
    assert!(seen > 5000 && near > 1000 && greatest > 0.5, "{seen} {near} {greatest}");
    for (numbers, q, follows) in [(SSVI, 1e-3, true), (LOSSY, 1e-3, false), (SSVI, 0.0, false)] {
        let equations = Numbers { c2: 1e8, ..numbers }.coupled().regularised_contact(Side::Primary);
        let y = [q, 0.0, 0.1, 0.1, 0.0];
        assert_eq!(equations.error_of_following(&y, &equations.following(&y)) < 1e-9, follows, "{numbers:?}");
    }
}

/// The force and its rates, beside a state whose rates are those of the speed that follows the forces.
#[test]
fn exact_the_jet_is_of_the_force_and_of_the_speed_that_follows_it() {
    let numbers = Numbers { c2: 1e7, d: 0.0, ..SSVI };
    let (system, omega) = (numbers.coupled(), numbers.omega);
    for side in Side::BOTH {
        let mut equations = system.regularised_contact(side);
        equations.set_excitation(0.0, system.excitation(T));
        equations.set_overdamped(true);
        let y = [3e-2, 0.0, 0.05, -0.4, 2e-3];
        let (states, force) = equations.jet(&y);
        let [cos, sin] = system.excitation(T + 2e-3);
        for (found, exact) in force.iter().zip([cos, -omega * sin, -omega * omega * cos]) {
            assert!((found - exact).abs() < 1e-12 * omega * omega * numbers.p, "{found} {exact}");
        }
        let following = equations.following(&y);
        for k in 0..3 {
            let [now, next] = [states[k], states[k + 1]];
            assert_eq!([now[1], now[3]], [next[0], next[2]], "the rates of one are those of the next");
            assert_eq!(next[1], following.acceleration[k]);
            let apart = side.sign() * (now[3] - now[1]) - following.speed[k];
            assert!(apart.abs() <= 1e-12 * (now[1].abs() + now[3].abs()), "{k}: {apart:e}");
        }
    }
}

/// Pieces of contacts whose speed follows the forces.
#[test]
fn invariant_no_piece_of_an_overdamped_contact_leaves_its_bounds() {
    let mut spread = Spread::new(31);
    let mut bounded = 0;
    for _ in 0..3000 {
        let numbers = Numbers {
            m2: spread.logarithmic(1.0, 1000.0),
            k2: spread.logarithmic(1.0, 1e5),
            c2: spread.logarithmic(1e6, 1e8),
            p: spread.logarithmic(1.0, 1e4),
            omega: spread.logarithmic(1.0, 30.0),
            d: 0.0,
            ..SSVI
        };
        let (system, side) = (numbers.coupled(), Side::Primary);
        let mut equations = system.regularised_contact(side);
        equations.set_excitation(0.0, system.excitation(T));
        equations.set_overdamped(true);
        let (x1, v1) = (0.3 * spread.signed(), 2.0 * spread.signed());
        let mut from = [spread.logarithmic(1e-4, 1e-2), 0.0, x1, v1, 0.0];
        from[1] = equations.following(&from).speed[0];
        let seconds = spread.logarithmic(1e-4, 0.05) / numbers.omega;
        let h = seconds / from[0];
        let mut states = vec![from];
        for _ in 0..100 {
            let mut next = advance(&equations, states.last().expect("the first"), h / 100.0);
            next[1] = equations.following(&next).speed[0];
            states.push(next);
        }
        if states
            .iter()
            .any(|y| y[0] <= 0.0 || equations.error_of_following(y, &equations.following(y)) > 1e-6)
        {
            continue;
        }
        let to = states.last().expect("the first");
        let [bounds, rates] = growth_of_rates(&equations, h, [&from, to]);
        let change = equations.change(h, [&from, to]);
        let Some(change) = change.filter(|_| bounds[0][0].is_finite()) else { continue };
        bounded += 1;
        for pair in states.windows(2) {
            let [now, next] = [0, 1].map(|i| equations.derivative(&pair[i]));
            let [[speed, rate, _], [_, next_rate, _]] = [0, 1].map(|i| equations.following(&pair[i]).speed);
            let [q, _, x1, v1, _] = pair[0];
            let slope = |i: usize| 0.5 * (next[i] - now[i]) / (h / 100.0);
            let values = [
                [x1, now[2], slope(2)],
                [v1, now[3], slope(3)],
                [q * q, q * speed, 0.5 * (next[0] * 2.0 * pair[1][0] - q * speed) / (h / 100.0)],
                [speed, q * rate, 0.5 * (pair[1][0] * next_rate - q * rate) / (h / 100.0)],
            ];
            for (value, bound) in values.iter().flatten().zip(bounds.iter().flat_map(|row| &row[..3])) {
                assert!(value.abs() <= bound * (1.0 + 1e-6), "{value} {bound} {numbers:?} {from:?} {h}");
            }
            for (value, [most, _]) in [v1, now[3] / q, speed, rate].iter().zip(change.rates) {
                assert!(value.abs() <= most * (1.0 + 1e-9), "{value} {most} {numbers:?}");
            }
            assert!(rate.abs() <= rates[3][0] * (1.0 + 1e-9), "{rate} {rates:?} {numbers:?}");
            let nearer = |i: usize, value: f64, ends: [f64; 2]| {
                let off = (value - ends[0]).abs().min((value - ends[1]).abs());
                assert!(
                    off <= change.states[i][1] * (1.0 + 1e-9) + 1e-15,
                    "{i}: {off} {change:?} {numbers:?}"
                );
            };
            [(0, 2), (1, 3), (3, 1)].into_iter().for_each(|(i, j)| nearer(i, pair[0][j], [from[j], to[j]]));
        }
    }
    assert!(bounded > 500, "{bounded}");
}
