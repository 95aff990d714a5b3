//! The series of a contact against its equations.

use retune_model::{ContactSeries, RegularisedContact, RegularisedState, Side};
use retune_testkit::scenes::{Numbers, ROW1, SSVI, Spread, TWO_SIDED, slope};

const T: f64 = 1.21;

/// Scenes whose contacts have no loss: one of them with a fast, strong force.
const SCENES: [Numbers; 4] = [SSVI, ROW1, TWO_SIDED, Numbers { p: 8e6, omega: 300.0, ..SSVI }];

/// The equations of a contact, a state in it and the series about that.
fn contacts(turn: f64, mut check: impl FnMut(&RegularisedContact, &RegularisedState, &ContactSeries)) {
    let mut spread = Spread::new(31);
    for numbers in SCENES {
        let system = numbers.coupled();
        for side in Side::BOTH {
            let mut equations = system.regularised_contact(side);
            for _ in 0..20 {
                let [q, w, x1, v1] = [0.05, 0.8, 0.1, 0.6]
                    .map(|size| size * spread.logarithmic(0.1, 1.0) * spread.signed().signum());
                let state = [q.abs(), w, x1, v1, 0.3];
                equations.set_excitation(0.3, system.excitation(T));
                let mut series = ContactSeries::for_turn(turn, 1e-16);
                let [depth, ..] = sizes(&equations, &state);
                let unit = 1.0 / (depth * equations.turning(depth));
                series.expand(&equations, &state, system.excitation(T), unit);
                check(&equations, &state, &series);
            }
        }
    }
}

/// The speed, the depth and the structure's speed that errors are measured by.
fn sizes(equations: &RegularisedContact, y: &RegularisedState) -> [f64; 3] {
    let speed = y[1].abs().max(equations.speed_at_depth(y[0]));
    [equations.greatest_depth(speed), speed, speed / equations.mass_ratio()]
}

/// How far a series holds to so much of these, at most until spring and wall have turned the damper by a radian.
fn length(equations: &RegularisedContact, y: &RegularisedState, series: &ContactSeries, allowed: f64) -> f64 {
    let sizes = sizes(equations, y);
    series.reach(sizes.map(|size| allowed * size), 1.0 / (sizes[0] * equations.turning(sizes[0])))
}

#[test]
fn exact_the_series_of_a_contact_obeys_its_equations() {
    contacts(1.0, |equations, state, series| {
        let h = 0.5 * length(equations, state, series, 1e-13);
        for share in [0.1, 0.5, 0.9] {
            let moment = series.at(share * h);
            let mut there = equations.clone();
            there.set_excitation(moment.state[4], moment.excitation);
            let rates = there.derivative(&moment.state);
            let found = slope(1e-3 * h, |s| series.at(share * h + s).state);
            for i in 0..5 {
                let size = rates[i].abs().max(moment.state[i].abs() / h);
                assert!((found[i] - rates[i]).abs() < 1e-9 * size, "{i} at {share}: {found:?} {rates:?}");
            }
            let size = there.acceleration(&moment.state).abs() + there.size_of_terms(&moment.state);
            let defect = equations.defect(series, share * h, &moment);
            assert!((0.0..1e-11 * size).contains(&defect), "{defect} {size}");
        }
        // Far beyond its reach it obeys them no longer, and says so.
        let far = 8.0 * length(equations, state, series, 1e-4);
        let moment = series.at(far);
        let defect = equations.defect(series, far, &moment);
        assert!(defect > 1e-3 * equations.acceleration(state).abs(), "{defect} at {far}");
    });
}

/// The state after `h` in so many steps.
fn in_steps(
    equations: &RegularisedContact,
    series: &ContactSeries,
    h: f64,
    steps: usize,
) -> RegularisedState {
    let mut series = series.clone();
    for _ in 1..steps {
        let moment = series.at(h / steps as f64);
        series.expand(equations, &moment.state, moment.excitation, series.unit());
    }
    series.at(h / steps as f64).state
}

#[test]
fn order_the_last_terms_say_how_far_a_series_reaches() {
    let mut lengths = Vec::new();
    for allowed in [1e-12, 1e-8, 1e-4] {
        let (mut worst, mut sum) = (0.0_f64, 0.0);
        contacts(1.5, |equations, state, series| {
            let sizes = sizes(equations, state);
            let h = series.reach(sizes.map(|size| allowed * size), f64::INFINITY);
            let (found, expected) = (series.at(h).state, in_steps(equations, series, h, 16));
            for (i, size) in [(0, sizes[0]), (1, sizes[1]), (3, sizes[2])] {
                worst = worst.max((found[i] - expected[i]).abs() / (allowed * size));
            }
            sum += h;
        });
        assert!(worst < 10.0, "{allowed}: {worst}");
        lengths.push(sum);
    }
    assert!(lengths.is_sorted() && lengths[2] > 1.5 * lengths[0], "{lengths:?}");
}

#[test]
fn invariant_no_series_leaves_its_bounds() {
    let mut tight = 0;
    contacts(1.5, |equations, state, series| {
        let length = length(equations, state, series, 1e-13);
        let (slopes, growths) = (series.bounds(length), series.bounds(length));
        let [growth, rates] = equations.growth_in_series(&growths);
        let mut there_on = series.clone();
        for (from, to) in [(0.0, 1.0), (0.2, 0.5), (0.9, 1.0)] {
            let [begin, end] = [from, to].map(|share| series.at(share * length).state);
            let change = equations.change_in_series(&slopes, (to - from) * length, [&begin, &end]);
            let numbers = |y: &RegularisedState| {
                let at = equations.physical(y);
                [at[0], at[1], y[0] * y[0], y[1]]
            };
            for i in 0..=20 {
                let share = f64::from(i) / 20.0;
                let moment = series.at((from + share * (to - from)) * length);
                let (here, nearer) =
                    (numbers(&moment.state), numbers(if share < 0.5 { &begin } else { &end }));
                for k in 0..4 {
                    let [most, of] = change.states[k];
                    let away = (here[k] - nearer[k]).abs();
                    assert!(away <= of * (1.0 + 1e-12) + 1e-15, "{k}: {away} {of}");
                    assert!(k == 2 || here[k].abs() <= most, "{k}: {} {most}", here[k]);
                    tight += u32::from(away > 0.2 * of && away > 0.0);
                }
                // Terms of every order: those of the series about this place. Bounds are of polynomials, which lack later terms.
                there_on.expand(equations, &moment.state, moment.excitation, series.unit());
                let found = equations.growth_in_series(&there_on.bounds(0.0));
                for (found, bounds) in found.iter().zip([&growth, &rates]) {
                    for (found, bound) in found.iter().flatten().zip(bounds.iter().flatten()) {
                        assert!(*found <= bound * (1.0 + 1e-7), "{found} {bound}");
                    }
                }
                let cube = moment.state[0].powi(3);
                assert!(cube <= change.forces.expect("the forces").contact[0] * (1.0 + 1e-12));
            }
        }
    });
    assert!(tight > 1000, "{tight}");
}
