//! The worst over a band against dense sampling, narrow peaks, and Den Hartog's curves.

use retune_model::{Coupled, Measure, Worst, den_hartog, nishihara_asami};
use retune_testkit::scenes::{Numbers, SSVI, Spread, TMD};

/// The largest of `f` over `count` even places, sharpened by golden sections between the neighbours of each.
fn sampled(f: impl Fn(f64) -> f64, [from, to]: [f64; 2], count: usize) -> f64 {
    let at = |i: usize| from + (to - from) * i as f64 / (count - 1) as f64;
    let values: Vec<f64> = (0..count).map(|i| f(at(i))).collect();
    let mut largest = values[0].max(values[count - 1]);
    for i in 1..count - 1 {
        if values[i] < values[i - 1] || values[i] < values[i + 1] {
            continue;
        }
        let (mut a, mut b) = (at(i - 1), at(i + 1));
        for _ in 0..80 {
            let [left, right] = [0.381_966, 0.618_034].map(|share| a + share * (b - a));
            if f(left) < f(right) { a = left } else { b = right }
        }
        largest = largest.max(f(0.5 * (a + b)));
    }
    largest
}

#[test]
fn reference_worst_is_that_of_dense_sampling_refined() {
    let mut spread = Spread::new(11);
    for _ in 0..60 {
        let numbers = Numbers {
            c1: spread.logarithmic(50.0, 2000.0),
            k1: spread.logarithmic(1e4, 1e5),
            m2: spread.logarithmic(1.0, 500.0),
            k2: spread.logarithmic(10.0, 2e4),
            c2: spread.logarithmic(5.0, 2000.0),
            ..TMD
        };
        let from = spread.logarithmic(0.5, 8.0);
        let band = [from, from * spread.logarithmic(1.01, 6.0)];
        let (system, bare) = (numbers.coupled(), numbers.bare());
        let mut pairs = vec![
            (system.steady_e1_max(band), sampled(|omega| system.steady(omega).e1_max, band, 4001)),
            (system.steady_stroke_max(band), sampled(|omega| system.steady(omega).stroke(), band, 4001)),
            (
                system.steady_max(Measure::Displacement, band),
                sampled(|omega| system.steady(omega).x1.norm(), band, 4001),
            ),
            (bare.steady_e1_max(band), sampled(|omega| bare.steady(omega).e1_max, band, 4001)),
        ];
        for measure in Measure::ALL.into_iter().filter(|measure| !measure.is_of_walls()) {
            let at = |omega: f64| system.steady(omega).largest(&bare, omega, measure);
            pairs.push((system.steady_max(measure, band), sampled(at, band, 4001)));
            if measure != Measure::Stroke {
                let at = |omega: f64| bare.steady(omega).largest(&bare, omega, measure);
                pairs.push((bare.steady_max(measure, band), sampled(at, band, 4001)));
            }
        }
        for (Worst { value, frequency }, expected) in pairs {
            assert!((value / expected - 1.0).abs() < 1e-12, "{numbers:?} {band:?}: {value} {expected}");
            assert!(band[0] <= frequency && frequency <= band[1]);
        }
    }
}

/// A peak 1e-9 of the band wide, where 600 samples see nothing: without damping of the damper and hardly any of the structure,
/// `c1 -> 0`, the height of a resonance is that of its own mode.
#[test]
fn exact_narrow_peaks_are_found_and_grow_as_the_inverse_square_of_damping() {
    for damping in [1e-2, 1e-4, 1e-6] {
        let numbers = Numbers { c1: damping, c2: damping, k2: 2000.0, ..TMD };
        let system = numbers.coupled();
        let worst = system.steady_e1_max([5.0, 8.0]);
        let coarse = (0..=600).map(|i| system.steady(5.0 + 0.005 * f64::from(i)).e1_max).fold(0.0, f64::max);
        assert!(worst.value > 10.0 * coarse, "{worst:?} {coarse}");
        // No place near it, at any distance that counts, is higher.
        for power in 1..16 {
            for sign in [-1.0, 1.0] {
                let omega = worst.frequency * (1.0 + sign * 10.0_f64.powi(-power));
                let value = system.steady(omega).e1_max;
                assert!(value <= worst.value * (1.0 + 1e-9), "{damping}: {value} at {omega}, {worst:?}");
            }
        }
        // A resonance's height goes as 1/c² where both dampings are small.
        let half = Numbers { c1: 0.5 * damping, c2: 0.5 * damping, ..numbers }.coupled();
        let ratio = half.steady_e1_max([5.0, 8.0]).value / worst.value;
        assert!((ratio / 4.0 - 1.0).abs() < 1e-6, "{ratio}");
    }
}

#[test]
fn exact_resonance_of_an_undamped_system_is_unbounded() {
    let numbers = Numbers { c1: 0.0, c2: 0.0, k2: 2000.0, ..TMD };
    assert!(numbers.coupled().steady_e1_max([5.0, 8.0]).value > 1e20);
    assert!(numbers.bare().steady_e1_max([5.0, 8.0]).value > 1e20);
}

#[test]
fn contract_a_band_of_one_frequency_is_that_frequency() {
    let steady = TMD.coupled().steady(6.25);
    let worst = TMD.coupled().steady_e1_max([6.25, 6.25]);
    assert_eq!(worst, Worst { value: steady.e1_max, frequency: 6.25 });
}

/// E1max without a damper: below `√(k1/m1)` that of the spring, above that of the mass, so the peak is the displacement's.
#[test]
fn exact_bare_peak_is_that_of_the_text_books() {
    let zeta = SSVI.c1 / (2.0 * (SSVI.k1 * SSVI.m1).sqrt());
    let worst = SSVI.bare().steady_e1_max([5.0, 8.0]);
    // Velocity resonance, above which E1 = m1 v1²/2 falls: |v1| = P/c1 at ω0.
    let natural = (SSVI.k1 / SSVI.m1).sqrt();
    assert!((worst.frequency / (natural * (1.0 - 2.0 * zeta * zeta).sqrt()) - 1.0).abs() < 1e-10);
    // Displacement resonance: |X1| = P / (k1 2ζ √(1 - ζ²)).
    let amplitude = SSVI.p / (SSVI.k1 * 2.0 * zeta * (1.0 - zeta * zeta).sqrt());
    assert!((worst.value / (0.5 * SSVI.k1 * amplitude * amplitude) - 1.0).abs() < 1e-12);
}

/// The resonances of one degree of freedom: of displacement below ω0, of velocity at ω0, where `|V1| = P/c1`, of acceleration above it,
/// and of the force on the ground at `ω² = ω0² (√(1 + 8ζ²) - 1) / 4ζ²` (S. Rao, Mechanical Vibrations, on transmissibility).
#[test]
fn exact_bare_resonances_are_those_of_the_text_books() {
    let bare = SSVI.bare();
    let natural = (SSVI.k1 / SSVI.m1).sqrt();
    let zeta = SSVI.c1 / (2.0 * (SSVI.k1 * SSVI.m1).sqrt());
    let (z2, narrow) = (zeta * zeta, 2.0 * zeta * (1.0 - zeta * zeta).sqrt());
    let expected = [
        (Measure::Displacement, SSVI.p / (SSVI.k1 * narrow), (1.0 - 2.0 * z2).sqrt()),
        (Measure::Velocity, SSVI.p / SSVI.c1, 1.0),
        (Measure::Acceleration, SSVI.p / (SSVI.m1 * narrow), 1.0 / (1.0 - 2.0 * z2).sqrt()),
    ];
    for (measure, value, frequency) in expected {
        let worst = bare.steady_max(measure, [5.0, 8.0]);
        assert!((worst.value / value - 1.0).abs() < 1e-12, "{measure:?} {worst:?} {value}");
        assert!((worst.frequency / (natural * frequency) - 1.0).abs() < 1e-12, "{measure:?} {worst:?}");
    }
    let worst = bare.steady_max(Measure::GroundForce, [5.0, 8.0]);
    let g = (((1.0 + 8.0 * z2).sqrt() - 1.0) / (4.0 * z2)).sqrt();
    let transmitted =
        ((1.0 + (2.0 * zeta * g).powi(2)) / ((1.0 - g * g).powi(2) + (2.0 * zeta * g).powi(2))).sqrt();
    assert!((worst.frequency / (natural * g) - 1.0).abs() < 1e-10, "{worst:?}");
    assert!((worst.value / (SSVI.p * transmitted) - 1.0).abs() < 1e-12, "{worst:?}");
    for measure in [Measure::Stroke, Measure::ContactForce] {
        assert_eq!(bare.steady_max(measure, [5.0, 8.0]).value, 0.0);
    }
}

#[test]
fn contract_measures_have_the_names_of_study_files() {
    for measure in Measure::ALL {
        assert_eq!(serde_json::to_value(measure).expect("a name"), measure.name());
    }
    assert_eq!(Measure::default(), Measure::Energy);
}

/// Den Hartog (Mechanical Vibrations, 4th ed. 1956, section 3.3): without damping of the structure all curves of |X1| pass through
/// two points, whatever c2 is; at f = 1/(1 + μ) both are as high as √(1 + 2/μ) P/k1. His ζ = √(3μ/8(1 + μ)) makes the curve
/// nearly flat there: its largest is above by a share of order μ at most.
#[test]
fn exact_fixed_points_of_den_hartog() {
    for mu in [1e-3, 1e-2, 0.06, 0.5_f64] {
        let f = 1.0 / (1.0 + mu);
        let natural = (TMD.k1 / TMD.m1).sqrt();
        let (m2, damper_frequency) = (mu * TMD.m1, f * natural);
        let system = |zeta: f64| -> Coupled {
            let (k2, c2) = (m2 * damper_frequency * damper_frequency, 2.0 * m2 * damper_frequency * zeta);
            Numbers { c1: 0.0, m2, k2, c2, ..TMD }.coupled()
        };
        let height = (1.0 + 2.0 / mu).sqrt() * TMD.p / TMD.k1;
        let spring = 0.5 * TMD.k1 * height * height;
        // At this f: g² = (1 ∓ √(μ/(2 + μ))) / (1 + μ).
        let squares = [-1.0, 1.0].map(|sign| (1.0 + sign * (mu / (2.0 + mu)).sqrt()) * f);
        for g2 in squares {
            for zeta in [1e-3, 0.1, 0.3, 2.0] {
                let steady = system(zeta).steady(g2.sqrt() * natural);
                assert!((steady.x1.norm() / height - 1.0).abs() < 1e-9, "{mu} {g2} {zeta}");
                // Below √(k1/m1) E1max is the spring's, above it the mass's: there it is g² as much, so that his tuning, which
                // levels displacements, does not level energies.
                assert!((steady.e1_max / (spring * g2.max(1.0)) - 1.0).abs() < 1e-9, "{mu} {g2} {zeta}");
            }
        }
        let best = system((3.0 * mu / (8.0 * (1.0 + mu))).sqrt());
        let band = [0.5 * natural, 2.0 * natural];
        let share = best.steady_max(Measure::Displacement, band).value / height - 1.0;
        assert!((0.0..0.1 * mu).contains(&share), "{mu} {share}");
        let share = best.steady_e1_max(band).value / (spring * squares[1].max(1.0)) - 1.0;
        assert!((0.0..mu).contains(&share), "{mu} {share}");
    }
}

/// The largest displacement over all frequencies, in static deflections, of an undamped structure with a damper of `mu` of its mass.
fn compliance(mu: f64, [k2, c2]: [f64; 2], band: [f64; 2]) -> f64 {
    let system = Numbers { c1: 0.0, m2: mu * TMD.m1, k2, c2, ..TMD }.coupled();
    system.steady_max(Measure::Displacement, band).value * TMD.k1 / TMD.p
}

/// Where `f` is least in a range with one minimum, by golden sections.
fn least(f: &dyn Fn(f64) -> f64, [mut a, mut b]: [f64; 2]) -> f64 {
    for _ in 0..60 {
        let [left, right] = [0.381_966, 0.618_034].map(|share| a + share * (b - a));
        if f(left) < f(right) { b = right } else { a = left }
    }
    0.5 * (a + b)
}

/// The exact optimum that Den Hartog's formulas come near to: both peaks as high as the paper's closed form of their height, and a direct
/// minimisation of the largest displacement finds the same spring and dashpot.
#[test]
fn exact_displacement_at_the_optimum_of_nishihara_and_asami() {
    let natural = (TMD.k1 / TMD.m1).sqrt();
    let primary = Numbers { c1: 0.0, ..TMD }.scene().primary;
    for mu in [1e-3, 0.06, 0.5_f64] {
        let root = (4.0 + 3.0 * mu).sqrt();
        let height = (((8.0 + 9.0 * mu).powi(2) * (16.0 + 9.0 * mu) - 128.0 * root.powi(3))
            / (3.0 * (32.0 + 27.0 * mu)))
            .sqrt()
            / (3.0 * mu);
        let best = nishihara_asami(&primary, mu * TMD.m1);
        // The curves of all dashpots meet below and above ω0 (Den Hartog's fixed points), and both peaks are near those.
        let middle = natural / (1.0 + mu).sqrt();
        for peak in [[1.0, middle], [middle, 30.0]] {
            let own = compliance(mu, best, peak);
            assert!((own / height - 1.0).abs() < 1e-9, "{mu} {peak:?}: {own} {height}");
        }
        let worst = |k2: f64, c2: f64| compliance(mu, [k2, c2], [1.0, 30.0]);
        let dashpot = |k2: f64| least(&|c2| worst(k2, c2), [0.5 * best[1], 2.0 * best[1]]);
        let spring = least(&|k2| worst(k2, dashpot(k2)), [0.8 * best[0], 1.25 * best[0]]);
        let found = [spring, dashpot(spring)];
        for (found, own) in found.into_iter().zip(best) {
            assert!((found / own - 1.0).abs() < 1e-6, "{mu}: {found} {own}");
        }
        assert!(worst(found[0], found[1]) > height * (1.0 - 1e-12), "{mu}");
    }
}

/// The numbers of the closed form for 6 % of the mass, to their digits; and dampers so light that a difference of near numbers would lose
/// those are Den Hartog's.
#[test]
fn exact_numbers_of_nishihara_and_asami() {
    let primary = Numbers { c1: 0.0, ..TMD }.scene().primary;
    let ratios = |mu: f64, [k2, c2]: [f64; 2]| {
        let (mass, natural) = (mu * TMD.m1, (TMD.k1 / TMD.m1).sqrt());
        [(k2 / mass).sqrt() / natural, c2 / (2.0 * (k2 * mass).sqrt())]
    };
    let design = nishihara_asami(&primary, 60.0);
    let [frequency, zeta] = ratios(0.06, design);
    assert!((frequency - 0.943_384).abs() < 5e-7 && (zeta - 0.146_093).abs() < 5e-7, "{frequency} {zeta}");
    let peak = compliance(0.06, design, [1.0, 30.0]);
    assert!((peak - 5.864_689).abs() < 5e-7, "{peak}");
    for mu in [1e-6, 1e-12] {
        let mass = mu * TMD.m1;
        let [own, other] = [nishihara_asami, den_hartog].map(|of| ratios(mu, of(&primary, mass)));
        for (own, other) in own.into_iter().zip(other) {
            assert!((own / other - 1.0).abs() < mu + 1e-14, "{mu}: {own} {other}");
        }
    }
}

/// The best TMD over [5, 8] rad/s, made by `tests/reference/tmd_band.py`; its two peaks are level. And Table 2's.
#[test]
fn reference_energy_of_the_best_tmd_over_the_band() {
    let best = Numbers { k2: 2_083.081_03, c2: 111.892_94, ..TMD }.coupled();
    let worst = best.steady_e1_max([5.0, 8.0]);
    assert!((worst.value - 160.605_045_247).abs() < 1e-6, "{worst:?}");
    for (band, peak) in [([5.0, 6.0], 5.518_819_8), ([6.0, 8.0], 6.683_935_3)] {
        let half = best.steady_e1_max(band);
        assert!(
            (half.value - 160.605_045_247).abs() < 1e-6 && (half.frequency - peak).abs() < 1e-6,
            "{half:?}"
        );
    }
    let papers = TMD.coupled().steady_e1_max([5.0, 8.0]);
    assert!((papers.value - 660.41).abs() < 0.5, "{papers:?}");
}

/// Dampers with hardly any damping, or none, by `tests/reference/tmd_narrow.py` in 50 digits. Each measure is given three times:
/// with a band a rounding of its ends narrower, as it is, and wider.
#[test]
fn reference_narrow_peaks_are_those_of_mpmath() {
    let text = include_str!("../../../../tests/reference/tmd_narrow.json");
    let data: serde_json::Value = serde_json::from_str(text).expect("JSON");
    let cases = data["cases"].as_array().expect("cases");
    let (mut sharp, mut worst) = (0, 0.0_f64);
    for case in cases {
        let number = |value: &serde_json::Value| value.as_f64().expect("a number");
        let [c1, k1, m2, k2, c2] = ["c1", "k1", "m2", "k2", "c2"].map(|name| number(&case[name]));
        let system = Numbers { c1, k1, m2, k2, c2, ..TMD }.coupled();
        let band = [0, 1].map(|end| number(&case["band"][end]));
        for (name, found) in [
            ("E1max", system.steady_e1_max(band)),
            ("x1", system.steady_max(Measure::Displacement, band)),
            ("stroke", system.steady_stroke_max(band)),
        ] {
            let [least, exact, most] = [0, 1, 2].map(|i| number(&case[name][i]));
            let Worst { value, frequency } = found;
            assert!(
                least * (1.0 - 1e-12) <= value && value <= most * (1.0 + 1e-12),
                "{name} {case}: {found:?}"
            );
            assert!(band[0] <= frequency && frequency <= band[1], "{name} {case}: {found:?}");
            if most - least < 1e-12 * exact {
                sharp += 1;
                worst = worst.max((value / exact - 1.0).abs());
            }
        }
    }
    println!("{} cases, {sharp} measures known to 1e-12: off by {worst:.1e} at most", cases.len());
    assert!(cases.len() >= 60 && sharp >= 100, "{sharp} of {}", cases.len());
}
