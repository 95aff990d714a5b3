//! Runs under pulses and records.

use retune_model::{Finite, Form, History, Of, Samples, Scene, Shape};
use retune_solver::{Method, Response, Rows, Settings, Window, e1_max, simulate, trajectory};
use retune_testkit::histories::{made, noise, pulse, record};
use retune_testkit::scenes::{LOSSY, Numbers, SSVI, Spread, TMD, TWO_SIDED};

fn run(scene: &Scene, to: f64) -> Response {
    simulate(scene, Window { from: 0.0, to }, &Settings::default()).expect("a run")
}

/// Without its damper.
fn bare(numbers: Numbers, history: History) -> Scene {
    Scene { damper: None, ..numbers.under(history) }
}

fn assert_close(found: f64, expected: f64, size: f64, tolerance: f64, what: &str) {
    let off = (found - expected).abs() / size;
    assert!(off <= tolerance, "{what}: {found} {expected}, off by {off:e}");
}

/// One step of `m x'' + c x' + k x = f0 + s t` in closed form: `x = (f0 + s t) / k - c s / k²` and a damped oscillation about it.
/// Nigam and Jennings, Bull. Seismol. Soc. Am. 59 (1969), 909.
fn closed(Numbers { m1, c1, k1, .. }: &Numbers, [x, v]: [f64; 2], [f0, s]: [f64; 2], t: f64) -> [f64; 2] {
    let delta = 0.5 * c1 / m1;
    let beta = (k1 / m1 - delta * delta).sqrt();
    let at = |t: f64| (f0 + s * t) / k1 - c1 * s / (k1 * k1);
    let (a, w) = (x - at(0.0), v - s / k1);
    let b = (w + delta * a) / beta;
    let ((sin, cos), fall) = ((beta * t).sin_cos(), (-delta * t).exp());
    let rate = fall * ((b * beta - delta * a) * cos - (a * beta + delta * b) * sin);
    [fall * (a * cos + b * sin) + at(t), rate + s / k1]
}

/// Half sine, rectangle and free motion after them, against closed forms.
#[test]
fn exact_pulses_on_an_undamped_structure() {
    let numbers = Numbers { c1: 0.0, ..SSVI };
    let (omega, duration, to) = ((numbers.k1 / numbers.m1).sqrt(), 0.35, 3.0);
    for of in [Of::Force, Of::BaseAcceleration] {
        let unit = if of == Of::Force { 1.0 } else { -numbers.m1 };
        let after = |x: f64, v: f64| {
            let (sin, cos) = (omega * (to - duration)).sin_cos();
            [x * cos + v / omega * sin, v * cos - x * omega * sin]
        };
        let f = unit * 3.0;
        let found = run(&bare(numbers, pulse(of, Shape::Rectangle, 3.0, duration)), to).final_state;
        let (sin, cos) = (omega * duration).sin_cos();
        let [x, v] = after(f / numbers.k1 * (1.0 - cos), f / numbers.k1 * omega * sin);
        assert_close(found[0], x, f.abs() / numbers.k1, 1e-12, "x1 after a rectangle");
        assert_close(found[1], v, omega * f.abs() / numbers.k1, 1e-12, "v1 after a rectangle");
        let found = run(&bare(numbers, pulse(of, Shape::HalfSine, 3.0, duration)), to).final_state;
        let turn = std::f64::consts::PI / duration;
        let size = f / (numbers.k1 - numbers.m1 * turn * turn);
        let ((sin, cos), (s, c)) = ((turn * duration).sin_cos(), (omega * duration).sin_cos());
        let [x, v] = after(size * (sin - turn / omega * s), size * turn * (cos - c));
        assert_close(found[0], x, size.abs(), 1e-12, "x1 after a half sine");
        assert_close(found[1], v, omega * size.abs(), 1e-12, "v1 after a half sine");
    }
}

/// A versed sine against its closed form, `x = p/2k (1 - cos ωt) - p/2 (cos Ωt - cos ωt) / (k - m Ω²)`: its samples leave an error of the
/// fourth order of their distance, and by default no more than `docs/theory.md` says, of pulses of a tenth to ten periods of the structure.
#[test]
fn order_the_motion_under_a_force_of_samples_is_of_fourth_order() {
    let numbers = Numbers { c1: 0.0, ..SSVI };
    let (omega, peak) = ((numbers.k1 / numbers.m1).sqrt(), 900.0);
    let error = |duration: f64, share: f64, denser| {
        let (turn, t) = (std::f64::consts::TAU / duration, share * duration);
        let (ahead, round) = ((omega * t).cos(), (turn * t).cos());
        let own = 0.5 * peak / (numbers.k1 - numbers.m1 * turn * turn);
        let exact = 0.5 * peak / numbers.k1 * (1.0 - ahead) - own * (round - ahead);
        let form = Form::VersedSine(Finite::new(peak).expect("finite"));
        let scene = bare(numbers, made(Of::Force, form, duration, denser));
        (run(&scene, t).final_state[0] - exact).abs() / (peak / numbers.k1)
    };
    for (duration, allowed) in [(0.1, 3e-14), (1.7, 8e-13), (10.0, 1.4e-11)] {
        let errors = [1.0 / 3.0, 0.5, 1.0].map(|share| error(duration, share, 1.0));
        let most = errors.into_iter().fold(0.0, f64::max);
        assert!(most <= allowed, "{duration} s: {errors:?}");
    }
    let [coarse, fine] = [error(1.7, 1.0, 0.02), error(1.7, 1.0, 0.04)];
    assert!((13.0..19.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
}

/// A record of noise, equidistant or not, against the closed form of every piece; the run goes on after the last sample.
#[test]
fn exact_a_record_on_a_structure_without_a_damper() {
    let mut spread = Spread::new(2);
    for (of, even) in [(Of::Force, true), (Of::BaseAcceleration, false)] {
        let size = if of == Of::Force { 900.0 } else { 0.9 };
        let history = noise(of, size, (0.02, 600, even), &mut spread);
        let retune_model::Course::Record(kept) = history.course else { panic!("a record") };
        let samples = kept.samples().expect("samples");
        let unit = if of == Of::Force { 1.0 } else { -SSVI.m1 };
        let (mut state, mut x1max, mut a1max, mut e1max) = ([0.0; 2], 0.0_f64, 0.0_f64, 0.0_f64);
        let to = samples.end() + 2.0;
        for i in 0..samples.len() {
            let last = i + 1 == samples.len();
            let h = if last { 2.0 } else { samples.time(i + 1) - samples.time(i) };
            let value = |i: usize| unit * samples.value(i);
            let force = if last { [0.0; 2] } else { [value(i), (value(i + 1) - value(i)) / h] };
            for k in 0..=400 {
                let t = f64::from(k) / 400.0 * h;
                let [x, v] = closed(&SSVI, state, force, t);
                x1max = x1max.max(x.abs());
                e1max = e1max.max(0.5 * (SSVI.m1 * v * v + SSVI.k1 * x * x));
                let feels = if of == Of::Force { force[0] + force[1] * t } else { 0.0 };
                a1max = a1max.max(((feels - SSVI.c1 * v - SSVI.k1 * x) / SSVI.m1).abs());
            }
            state = closed(&SSVI, state, force, h);
        }
        let found = run(&bare(SSVI, history), to);
        assert_close(found.final_state[0], state[0], x1max, 1e-12, "x1");
        assert_close(found.final_state[1], state[1], x1max * 6.3, 1e-12, "v1");
        // Samples of a maximum are below it, by little.
        for (found, sampled, what) in [
            (found.structure.displacement.value, x1max, "x1max"),
            (found.structure.acceleration.value, a1max, "a1max"),
            (found.e1_max.value, e1max, "E1max"),
        ] {
            assert!(sampled <= found * (1.0 + 1e-12), "{what}: {found} {sampled}");
            assert!(sampled >= found * (1.0 - 1e-4), "{what}: {found} {sampled}");
        }
    }
}

/// A record of few samples, and the same with further samples on its lines: contacts, chatter and all maxima are the same.
#[test]
fn exact_a_sample_on_a_line_changes_nothing() {
    let mut spread = Spread::new(4);
    let rigid = Numbers { rigid: Some(0.6), ..SSVI };
    let mut touched = 0;
    for numbers in [SSVI, TWO_SIDED, LOSSY, Numbers { e: 0.7, ..SSVI }, rigid] {
        for (of, size) in [(Of::Force, 9000.0), (Of::BaseAcceleration, 9.0)] {
            let (values, step, parts) =
                ((0..24).map(|_| size * spread.signed()).collect::<Vec<f64>>(), 0.25, 50);
            let fine = |i: usize| {
                let (from, share) = (i / parts, (i % parts) as f64 / parts as f64);
                let next = values.get(from + 1).copied().unwrap_or(0.0);
                values[from] + share * (next - values[from])
            };
            let many: Vec<f64> = (0..=(values.len() - 1) * parts).map(fine).collect();
            let [coarse, fine] = [(step, values.clone()), (step / parts as f64, many)]
                .map(|(step, values)| record(of, Samples::every(0.0, step, values).expect("a record")))
                .map(|history| run(&numbers.under(history), 5.0));
            touched += coarse.impacts.iter().sum::<u64>();
            assert_eq!(coarse.impacts, fine.impacts, "{of:?} {numbers:?}");
            let close = |a: f64, b: f64, what: &str| {
                let off = (a / b - 1.0).abs();
                assert!(off < 1e-7 || a == b, "{what}: {a} {b}, {off:e}, {of:?} {numbers:?}");
            };
            close(coarse.e1_max.value, fine.e1_max.value, "E1max");
            close(coarse.e2_max.value, fine.e2_max.value, "E2max");
            close(coarse.structure.acceleration.value, fine.structure.acceleration.value, "a1max");
            close(coarse.spring_deflection_max, fine.spring_deflection_max, "stroke");
            close(coarse.force_max[0], fine.force_max[0], "force");
            (0..4).for_each(|i| {
                let off = (coarse.final_state[i] - fine.final_state[i]).abs();
                assert!(off < 1e-6, "{i}: {off:e} {of:?} {numbers:?}");
            });
        }
    }
    assert!(touched > 40, "{touched}");
}

/// Pieces of an equidistant record are passed many at a time, over steps of one length. With one more sample on the first line it is not
/// equidistant: each piece takes its own time, and four at most go together.
#[test]
fn exact_pieces_passed_together_hide_no_largest_value() {
    let mut spread = Spread::new(12);
    for (step, count) in [(0.05, 130), (0.004, 1600)] {
        for numbers in [SSVI, TMD, Numbers { e: 0.7, ..SSVI }] {
            for (of, size) in [(Of::Force, 2500.0), (Of::BaseAcceleration, 2.5)] {
                let mut now = 0.0;
                let mut next = || {
                    now += 0.2 * (spread.signed() - now);
                    size * now
                };
                let values: Vec<f64> = (0..count).map(|_| next()).collect();
                let (mut times, mut more) =
                    ((0..count).map(|i| f64::from(i) * step).collect::<Vec<f64>>(), values.clone());
                times.insert(1, 0.3 * step);
                more.insert(1, values[0] + 0.3 * (values[1] - values[0]));
                let even = record(of, Samples::every(0.0, step, values).expect("a record"));
                let uneven = record(of, Samples::at(times, more).expect("a record"));
                for scene in [numbers.under(even), bare(numbers, even)] {
                    let other = Scene { forcing: numbers.under(uneven).forcing, ..scene };
                    let [ours, theirs] = [&scene, &other].map(|scene| run(scene, 6.0));
                    assert_eq!(ours.impacts, theirs.impacts);
                    let close = |a: f64, b: f64, what: &str| {
                        let off = (a / b - 1.0).abs();
                        assert!(off < 1e-7 || a == b, "{what}: {a} {b}, {off:e}, {of:?} {step} {numbers:?}");
                    };
                    close(ours.e1_max.value, theirs.e1_max.value, "E1max");
                    close(ours.e2_max.value, theirs.e2_max.value, "E2max");
                    close(ours.spring_deflection_max, theirs.spring_deflection_max, "stroke");
                    for (ours, theirs) in ours.structure.all().into_iter().zip(theirs.structure.all()) {
                        close(ours.value, theirs.value, "of the structure");
                    }
                    let window = Window { from: 0.0, to: 6.0 };
                    let alone = e1_max(&scene, window, &Settings::default(), f64::INFINITY);
                    assert_eq!(
                        alone.expect("a run").value,
                        ours.e1_max.value,
                        "other observers, other pieces"
                    );
                }
            }
        }
    }
}

/// Every kind of history by two methods, with contacts.
#[test]
fn reference_runs_agree_with_dop853() {
    let mut spread = Spread::new(6);
    let exact = Settings { method: Method::Dop853, rtol: 1e-12, atol: 1e-14, ..Settings::default() };
    for numbers in [SSVI, TMD, TWO_SIDED, LOSSY] {
        for (of, size) in [(Of::Force, 3000.0), (Of::BaseAcceleration, 4.0)] {
            for history in [
                pulse(of, Shape::HalfSine, size, 0.4),
                pulse(of, Shape::Rectangle, size, 0.3),
                made(of, Form::VersedSine(Finite::new(size).expect("finite")), 0.5, 1.0),
                noise(of, size, (0.05, 60, false), &mut spread),
                noise(of, size, (0.004, 500, true), &mut spread),
            ] {
                let scene = numbers.under(history);
                let window = Window { from: 0.3, to: 3.0 };
                let ours = simulate(&scene, window, &Settings::default()).expect("a run");
                let theirs = simulate(&scene, window, &exact).expect("a run");
                let close = |a: f64, b: f64, what: &str| {
                    assert!((a - b).abs() <= 2e-8 * a.abs().max(1e-9), "{what}: {a} {b} {history:?}");
                };
                assert_eq!(ours.impacts, theirs.impacts, "{history:?}");
                close(ours.e1_max.value, theirs.e1_max.value, "E1max");
                close(ours.e2_max.value, theirs.e2_max.value, "E2max");
                close(ours.spring_deflection_max, theirs.spring_deflection_max, "stroke");
                for (ours, theirs) in ours.structure.all().into_iter().zip(theirs.structure.all()) {
                    close(ours.value, theirs.value, "of the structure");
                }
                for i in 0..4 {
                    let off = (ours.final_state[i] - theirs.final_state[i]).abs();
                    assert!(off < 1e-8, "{i}: {off:e} {history:?}");
                }
            }
        }
    }
}

/// Rows of a run lie on the motion: the energy of none is above the largest, and one is near it.
#[test]
fn invariant_no_row_is_above_the_largest_value() {
    let history = noise(Of::BaseAcceleration, 4.0, (0.01, 500, true), &mut Spread::new(9));
    for numbers in [SSVI, TMD] {
        let scene = numbers.under(history);
        let (mut most, mut count) = (0.0_f64, 0);
        let rows = Rows { interval: 1e-3, events: true };
        let window = Window { from: 0.0, to: 6.0 };
        trajectory(&scene, window, &Settings::default(), rows, &mut |sample| {
            most = most.max(sample.e1);
            count += 1;
        })
        .expect("a run");
        let largest = run(&scene, 6.0).e1_max.value;
        assert!(
            count > 6000 && most <= largest * (1.0 + 1e-12) && most > largest * 0.999,
            "{most} {largest}"
        );
    }
}
