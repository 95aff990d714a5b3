//! No largest value is missed: the search for maxima beside looking everywhere, and beside another method.

use retune_model::Excitation;
use retune_solver::observe::{Form, Knot, Observer, Quantity, RunningMaximum, Segment};
use retune_solver::{Method, Response, Settings, Window, simulate};
use retune_testkit::scenes::{Numbers, SSVI};
use std::cell::Cell;
use std::f64::consts::PI;

fn run(numbers: &Numbers, to: f64, method: Method, rtol: f64) -> Response {
    let settings = Settings { method, rtol, atol: rtol * 1e-3, ..Settings::default() };
    simulate(&numbers.scene(), Window { from: 0.0, to }, &settings).expect("a run")
}

/// Scenes in which one flight step holds two maxima, with a dip between them: both of its ends are concave.
const TWO_MAXIMA: [Numbers; 3] = [
    Numbers {
        c: 0.69253168895597,
        d: 0.0595372531637714,
        r: 0.6350272881550908,
        c2: 8.649689386577819,
        k1: 62235.81747936603,
        k2: 1662.5681305782794,
        m2: 1094.99843495297,
        omega: 8.576461062918153,
        ..SSVI
    },
    Numbers {
        c: 0.6547348308830689,
        d: 0.010795415058871565,
        r: 0.25090151211446055,
        c2: 91.73069507472201,
        k1: 54619.709078149644,
        k2: 2645.4926686046892,
        m2: 148.56181808078918,
        omega: 6.9442298065176935,
        ..SSVI
    },
    Numbers {
        c: 0.4200649481193844,
        d: 0.04287275399728375,
        r: 2.951804640003278,
        c2: 64.81813716232124,
        k1: 13249.426510843248,
        k2: 2926.076768240964,
        m2: 50.37249528206486,
        omega: 9.692919717021919,
        ..SSVI
    },
];

#[test]
fn reference_two_maxima_in_one_step_are_both_seen() {
    for numbers in TWO_MAXIMA {
        let expected = run(&numbers, 20.0, Method::Dop853, 1e-12);
        for rtol in [1e-6, 1e-8, 1e-10, 1e-12] {
            let found = run(&numbers, 20.0, Method::Hybrid, rtol);
            for (found, expected) in [(found.e1_max, expected.e1_max), (found.e2_max, expected.e2_max)] {
                let error = (found.value / expected.value - 1.0).abs();
                assert!(error < 10.0 * rtol.max(1e-9), "{rtol:e}: {found:?} {expected:?} {error:e}");
            }
        }
    }
}

/// `sin(rate θ + phase)` over `θ` from 0 to 1 as a quantity, on a clock `t = θ + θ²/2`; the number of moments asked for.
struct Wave {
    rate: f64,
    phase: f64,
    /// A bound on what leaves the quintic over the whole length, rough and sharp.
    errors: Option<[f64; 2]>,
    ends: [Knot<2>; 2],
    looks: Cell<u32>,
    form: Form<2>,
}

fn knot(theta: f64) -> Knot<2> {
    Knot { t: theta + 0.5 * theta * theta, excitation: [0.0; 2], y: [theta, 0.0], clock: [1.0 + theta, 1.0] }
}

impl Wave {
    fn new(rate: f64, phase: f64, errors: Option<[f64; 2]>) -> Self {
        let form = Form::linear(&SSVI.bare(), [1.0, 0.0]);
        Self { rate, phase, errors, ends: [knot(0.0), knot(1.0)], looks: Cell::new(0), form }
    }
}

impl Segment<2> for Wave {
    fn ends(&self) -> [&Knot<2>; 2] {
        self.ends.each_ref()
    }
    fn length(&self) -> f64 {
        1.0
    }
    fn at(&self, theta: f64) -> Knot<2> {
        self.looks.set(self.looks.get() + 1);
        knot(theta)
    }
    fn at_time(&self, t: f64) -> Knot<2> {
        knot((1.0 + 2.0 * t).sqrt() - 1.0)
    }
    fn quintic_error(&self, _form: &Form<2>, _ends: [&Knot<2>; 2], h: f64, sharp: bool) -> Option<f64> {
        self.errors.map(|[rough, exact]| if sharp { exact * h.powi(6) } else { rough })
    }
}

impl Quantity<2> for &Wave {
    fn rates(&self, _drive: Excitation, &[theta, _]: &[f64; 2]) -> [f64; 3] {
        // θ' = 1/(1 + θ), θ'' = -θ'³.
        let (sin, cos) = (self.rate * theta + self.phase).sin_cos();
        let speed = 1.0 / (1.0 + theta);
        let slope = self.rate * cos;
        [sin, slope * speed, -self.rate * self.rate * sin * speed * speed - slope * speed.powi(3)]
    }
    fn form(&self) -> &Form<2> {
        &self.form
    }
}

/// The largest value, its time, how many moments were looked at, and the doubt that was left.
fn searched(wave: &Wave) -> (f64, f64, u32, f64) {
    let mut peak = RunningMaximum::new(wave, f64::INFINITY);
    peak.segment(wave);
    (peak.record().value, peak.record().time, wave.looks.get(), peak.doubt())
}

/// Where the quantity is concave its maximum is found to rounding by a handful of looks, with any of the bounds.
#[test]
fn contract_a_single_maximum_takes_few_evaluations() {
    for (rate, phase) in [(1.0, 0.8), (1.0, 1.5), (2.0, 0.0), (0.5, 1.1), (0.3, 1.569)] {
        let bound = f64::powi(rate, 6) / 46080.0;
        for errors in [None, Some([bound, bound]), Some([f64::INFINITY, bound]), Some([10.0 * bound, bound])]
        {
            let (value, time, looks, doubt) = searched(&Wave::new(rate, phase, errors));
            let theta = (0.5 * PI - phase) / rate;
            assert!((value - 1.0).abs() < 4e-16, "{rate} {phase} {errors:?}: {value}");
            assert!((time - knot(theta).t).abs() < 1e-7, "{rate} {phase} {errors:?}: {time}");
            assert!(looks <= 5 && doubt == 0.0, "{rate} {phase} {errors:?}: {looks} looks");
        }
    }
    // Where the ends are largest nothing between them is looked at.
    for (rate, phase) in [(1.0, 0.0), (1.0, PI), (2.0, 4.0)] {
        let bound = f64::powi(rate, 6) / 46080.0;
        let (value, _, looks, _) = searched(&Wave::new(rate, phase, Some([bound, bound])));
        assert_eq!(value, phase.sin().max((rate + phase).sin()));
        assert_eq!(looks, 0, "{rate} {phase}");
    }
}

/// Many maxima of one height in one piece: the largest, and how many moments it takes. A rough bound costs no look where a sharp one is at hand.
#[test]
fn regress_looks_at_a_piece_with_many_maxima() {
    let mut looks = Vec::new();
    for (rate, phase) in [(9.0, 0.3), (21.0, -1.0), (40.0, 2.0)] {
        let bound = f64::powi(rate, 6) / 46080.0;
        for errors in [None, Some([bound, bound]), Some([1e4 * bound, bound]), Some([f64::INFINITY, bound])] {
            let (value, _, count, doubt) = searched(&Wave::new(rate, phase, errors));
            assert!((value - 1.0).abs() < 4e-16 && doubt == 0.0, "{rate} {errors:?}: {value} {doubt}");
            looks.push(count);
        }
    }
    assert_eq!(looks, [7, 7, 8, 8, 10, 15, 15, 15, 20, 30, 30, 30]);
}

/// Bounds that only short stretches have: the search halves until they tell.
#[test]
fn contract_stretches_are_halved_until_their_bounds_decide() {
    struct OnlyShort(Wave, f64);
    impl Segment<2> for OnlyShort {
        fn ends(&self) -> [&Knot<2>; 2] {
            self.0.ends()
        }
        fn length(&self) -> f64 {
            1.0
        }
        fn at(&self, theta: f64) -> Knot<2> {
            self.0.at(theta)
        }
        fn at_time(&self, t: f64) -> Knot<2> {
            self.0.at_time(t)
        }
        fn quintic_error(&self, _form: &Form<2>, _ends: [&Knot<2>; 2], h: f64, _sharp: bool) -> Option<f64> {
            Some(if h > self.1 { f64::INFINITY } else { 7.0_f64.powi(6) / 46080.0 * h.powi(6) })
        }
    }
    let wave = OnlyShort(Wave::new(7.0, 0.1, Some([1.0; 2])), 0.2);
    let mut peak = RunningMaximum::new(&wave.0, f64::INFINITY);
    peak.segment(&wave);
    assert!((peak.record().value - 1.0).abs() < 4e-16 && peak.doubt() == 0.0);
    // Where no bound ever decides, the search ends all the same, and reports that nothing is proven.
    let never = OnlyShort(Wave::new(7.0, 0.1, Some([1.0; 2])), 0.0);
    let mut in_doubt = RunningMaximum::new(&never.0, f64::INFINITY);
    in_doubt.segment(&never);
    assert_eq!(in_doubt.doubt(), f64::INFINITY);
    // A cutoff is passed by what is above it, not by what is at it.
    let most = peak.record().value;
    for (cutoff, passed) in [(0.5, true), (most, false), (2.0, false)] {
        let mut peak = RunningMaximum::new(&wave.0, cutoff);
        peak.segment(&wave);
        assert_eq!(peak.satisfied(), passed, "{cutoff}");
    }
}
