//! The samples of recipes.

use super::*;

fn recipe(form: Form, duration: f64) -> Recipe {
    Recipe { form, unit: ("N", 1.0), duration: Positive::new(duration).expect("above 0"), step: None }
}

fn finite(value: f64) -> Finite {
    Finite::new(value).expect("finite")
}

fn not_negative(value: f64) -> NonNegative {
    NonNegative::new(value).expect("not below 0")
}

/// The piecewise linear force at `t`.
fn at(samples: &Samples, t: f64) -> f64 {
    let stretch = samples.stretch(t);
    stretch.begin[0] - stretch.begin[1] * (t - stretch.from)
}

type Force = fn(f64) -> f64;

fn forms() -> [(Recipe, Force); 3] {
    let harmonics = [(2.0, 5.0, 0.3), (-1.0, 11.0, 0.0)].map(|(amplitude, omega, phase)| Harmonic {
        amplitude: finite(amplitude),
        omega: not_negative(omega),
        phase: finite(phase),
    });
    let sweep = Sweep { amplitude: finite(3.0), from: not_negative(9.0), rate: finite(-1.5) };
    [
        (recipe(Form::VersedSine(finite(4.0)), 2.0), |t| 2.0 * (1.0 - (TAU * t / 2.0).cos())),
        (recipe(Form::Harmonics(harmonics.to_vec()), 3.0), |t| {
            2.0 * (5.0 * t + 0.3).cos() - (11.0 * t).cos()
        }),
        (recipe(Form::Sweep(sweep), 8.0), |t| 3.0 * (9.0 * t - 0.75 * t * t).cos()),
    ]
}

/// Between samples and at them the error of a force is within its bound; every piece has the impulse of the force, to the fifth order of
/// its length.
#[test]
fn exact_straight_lines_stay_near_a_formula_and_keep_its_impulse() {
    for (recipe, force) in forms() {
        let [size, _] = recipe.sizes();
        assert!(recipe.error() <= 1.0001 * ERROR * size, "{} of {size}", recipe.error());
        for coarser in [1.0, 20.0] {
            let made =
                Made::new(recipe.clone()).and_then(|made| made.denser(1.0 / coarser)).expect("samples");
            let (samples, error) = (made.samples(), made.recipe().error());
            let [_, h] = samples.even().expect("equidistant");
            let mut largest = 0f64;
            for i in 0..samples.len() - 1 {
                let from = samples.time(i);
                // Simpson's rule on four intervals.
                let nodes: [f64; 5] = std::array::from_fn(|k| force(from + 0.25 * k as f64 * h));
                let impulse = h / 12.0 * (nodes[0] + 4.0 * (nodes[1] + nodes[3]) + 2.0 * nodes[2] + nodes[4]);
                let linear = 0.5 * h * (samples.value(i) + samples.value(i + 1));
                // The error after the correction is f'''' h⁵ / 240; 12 rad/s is above every frequency.
                let allowed = size * (12f64.powi(4) * h.powi(5) / 100.0 + 1e-14 * h);
                assert!((linear - impulse).abs() < allowed, "{i}: {linear} {impulse} {allowed}");
                for k in 0..8 {
                    let t = from + k as f64 / 8.0 * h;
                    largest = largest.max((at(&samples, t) - force(t)).abs());
                }
            }
            assert!(largest <= error && largest > 0.2 * error, "{largest} of {error}");
        }
    }
}

/// A draw has the variance of its spectrum, the same at each run, and another with another seed; the harmonics have the density.
#[test]
fn invariant_a_random_force_has_its_spectrum() {
    let omega = [2.0, 4.0, 9.0].map(not_negative).to_vec();
    let density = [0.0, 3.0, 1.0].map(not_negative).to_vec();
    let variance = 0.5 * 2.0 * 3.0 + 0.5 * 5.0 * 4.0;
    let draw = |seed, duration| {
        let spectrum =
            Spectrum { omega: omega.clone(), density: density.clone(), seed, white: None, to: None };
        Made::new(recipe(Form::Spectrum(spectrum), duration)).expect("samples")
    };
    assert!(draw(1, 200.0) == draw(1, 200.0) && draw(1, 200.0) != draw(2, 200.0));
    for seed in 0..3 {
        let made = draw(seed, 2000.0);
        let values: Vec<f64> = made.samples().values().collect();
        let square = values.iter().map(|f| f * f).sum::<f64>() / values.len() as f64;
        // Each harmonic goes through hundreds of periods or more.
        assert!((square / variance - 1.0).abs() < 5e-3, "{square} {variance}");
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        assert!(mean.abs() < 0.01 * variance.sqrt(), "{mean}");
        let normal = values.iter().filter(|f| f.abs() < variance.sqrt()).count() as f64 / values.len() as f64;
        assert!((normal - 0.6827).abs() < 0.03, "{normal} of a normal distribution within its deviation");
    }
    let harmonics = |made: Made| match &made.recipe().form {
        Form::Spectrum(spectrum) => spectrum.drawn(200.0).map(|[a, ..]| 0.5 * a * a).sum::<f64>(),
        _ => f64::NAN,
    };
    // The midpoint rule has an error of second order only at the kink of the table.
    assert!((harmonics(draw(1, 200.0)) / variance - 1.0).abs() < 1e-3);
}

#[test]
fn contract_what_makes_no_force_says_why() {
    let refused = |form, duration, step: Option<f64>| {
        let step = step.and_then(|step| Positive::new(step).ok());
        Made::new(Recipe { step, ..recipe(form, duration) }).expect_err("no samples").to_string()
    };
    let spectrum = |omega: &[f64], density: &[f64]| {
        let numbers = |all: &[f64]| all.iter().map(|&one| not_negative(one)).collect();
        Form::Spectrum(Spectrum {
            omega: numbers(omega),
            density: numbers(density),
            seed: 0,
            white: None,
            to: None,
        })
    };
    for table in [spectrum(&[1.0], &[1.0]), spectrum(&[1.0, 2.0], &[1.0]), spectrum(&[2.0, 2.0], &[1.0, 1.0])]
    {
        assert!(refused(table, 1.0, None).starts_with("`spectrum`: "));
    }
    assert!(refused(Form::Harmonics(vec![]), 1.0, None).starts_with("`harmonics`: empty"));
    let many = refused(Form::VersedSine(finite(1.0)), 1.0, Some(1e-9));
    assert!(many.starts_with("`duration`: 1 s are not allowed here"), "{many}");
    assert!(refused(spectrum(&[1.0, 1e6], &[1.0, 1.0]), 100.0, None).starts_with("`duration`: 100 s"));
    // A zero force, or a constant one, has samples, too.
    for amplitude in [0.0, 3.0] {
        let constant =
            Harmonic { amplitude: finite(amplitude), omega: not_negative(0.0), phase: Finite::default() };
        let made = Made::new(recipe(Form::Harmonics(vec![constant]), 2.0)).expect("samples");
        assert_eq!((made.samples().values().collect(), made.samples().end()), (vec![amplitude; 2], 2.0));
    }
}
