//! Checks the worst over a band against an independent search: the response in twice the precision, on grids refined towards every
//! frequency where a peak may be, and golden sections at each local maximum.

use super::Hunt;
use super::twofold::Twofold;
use crate::scenes::{Numbers, Spread, TMD};
use retune_model::{Amplitude, Bare, Coupled, Measure, Scene, Worst};

/// A quantity, of a structure with its damper or of a bare one.
#[derive(Clone, Copy, Debug)]
struct Quantity {
    of: Measure,
    bare: bool,
    /// The forcing whose amplitude is `p` of a scene.
    forcing: Amplitude,
}

/// The compared quantities: all but the contact force, and without a damper all but the stroke.
fn quantities() -> Vec<Quantity> {
    let all = Amplitude::ALL.into_iter();
    all.flat_map(|forcing| QUANTITIES.map(|quantity| Quantity { forcing, ..quantity })).collect()
}

/// The compared quantities under a force.
const QUANTITIES: [Quantity; 11] = [
    with_damper(Measure::Energy),
    with_damper(Measure::Displacement),
    with_damper(Measure::Velocity),
    with_damper(Measure::Acceleration),
    with_damper(Measure::GroundForce),
    with_damper(Measure::Stroke),
    bare(Measure::Energy),
    bare(Measure::Displacement),
    bare(Measure::Velocity),
    bare(Measure::Acceleration),
    bare(Measure::GroundForce),
];

const fn with_damper(of: Measure) -> Quantity {
    Quantity { of, bare: false, forcing: Amplitude::Force }
}

const fn bare(of: Measure) -> Quantity {
    Quantity { of, bare: true, forcing: Amplitude::Force }
}

/// The response at `centre + offset` rad/s, directly from equation (1): real and imaginary parts of `(k1 - m1 ω² + iω c1)(k2 - m2 ω² +
/// iω c2) - m2 ω² (k2 + iω c2)`.
fn response(n: &Numbers, quantity: Quantity, centre: Twofold, offset: f64) -> f64 {
    let omega = centre + Twofold::from(offset);
    let u = omega * omega;
    let [m1, k1, m2, k2] = [n.m1, n.k1, n.m2, n.k2].map(Twofold::from);
    let (c1, c2) = (omega * Twofold::from(n.c1), omega * Twofold::from(n.c2));
    let primary = k1 - m1 * u;
    let square = |re: Twofold, im: Twofold| (re * re + im * im).value();
    let p = n.p
        * match quantity.forcing {
            Amplitude::Force => 1.0,
            Amplitude::Imbalance => u.value(),
            Amplitude::Base => square(k1, c1).sqrt(),
            Amplitude::BaseAcceleration => square(k1, c1).sqrt() / u.value(),
        };
    // On a moving base the ground force is the inertial force of the masses.
    let is_inertia = quantity.of == Measure::GroundForce && quantity.forcing.is_of_base();
    let of_displacement = |amplitude2: f64| match quantity.of {
        Measure::Energy => 0.5 * p * p * n.k1.max((m1 * u).value()) * amplitude2,
        Measure::Velocity => p * (u.value() * amplitude2).sqrt(),
        Measure::Acceleration => p * u.value() * amplitude2.sqrt(),
        Measure::GroundForce if is_inertia => p * (m1 * u).value() * amplitude2.sqrt(),
        Measure::GroundForce => p * (square(k1, c1) * amplitude2).sqrt(),
        _ => p * amplitude2.sqrt(),
    };
    if quantity.bare {
        return of_displacement(1.0 / square(primary, c1));
    }
    let inertia = m2 * u;
    let damper = k2 - inertia;
    let below = square(primary * damper - c1 * c2 - inertia * k2, primary * c2 + damper * c1 - inertia * c2);
    match quantity.of {
        Measure::Stroke => p * inertia.value() / below.sqrt(),
        // ω² |m1 X1 + m2 X2| = ω² |(m1 + m2) (k2 + iω c2) - m1 m2 ω²| P / |...|.
        Measure::GroundForce if is_inertia => {
            let both = m1 + m2;
            p * u.value() * (square(both * k2 - m1 * inertia, both * c2) / below).sqrt()
        }
        _ => of_displacement(square(damper, c2) / below),
    }
}

/// Frequencies near which a peak may be, rad/s: zeros of the real or imaginary part of the determinant, and the natural frequencies of
/// either body alone.
fn centres(n: &Numbers) -> Vec<Twofold> {
    let [m1, c1, k1, m2, k2, c2] = [n.m1, n.c1, n.k1, n.m2, n.k2, n.c2].map(Twofold::from);
    let (a, b, c) = (m1 * m2, m1 * k2 + m2 * k1 + m2 * k2 + c1 * c2, k1 * k2);
    let root = (b.value() * b.value() - 4.0 * a.value() * c.value()).max(0.0).sqrt();
    let upper = (b.value() + root) / (2.0 * a.value());
    let mut squares = vec![];
    for guess in [c.value() / (a.value() * upper), upper] {
        let mut u = Twofold::from(guess);
        for _ in 0..4 {
            let slope = 2.0 * a.value() * u.value() - b.value();
            if slope != 0.0 {
                u = u - Twofold::from((a * u * u - b * u + c).value() / slope);
            }
        }
        squares.push(u);
    }
    squares.extend([n.k1 / n.m1, n.k2 / n.m2, n.k1 / (n.m1 + n.m2)].map(Twofold::from));
    let locked = (n.k1 * n.c2 + n.k2 * n.c1) / (n.c2 * (n.m1 + n.m2) + n.c1 * n.m2);
    squares.extend(locked.is_finite().then_some(Twofold::from(locked)));
    squares.into_iter().filter(|u| u.value() > 0.0).map(Twofold::sqrt).collect()
}

/// The largest value over a band by the independent search.
fn searched(n: &Numbers, quantity: Quantity, [from, to]: [f64; 2]) -> f64 {
    let mut largest = f64::NEG_INFINITY;
    let mut centres = centres(n);
    centres.push(Twofold::from(from));
    centres.push(Twofold::from(to));
    for centre in centres {
        // Farther away an offset would be less accurate than a frequency there.
        let size = centre.value();
        let below = (Twofold::from(from) - centre).value().max(-0.5 * size);
        let above = (Twofold::from(to) - centre).value().min(if size == from { to - from } else { size });
        if below > above {
            continue;
        }
        let mut offsets = vec![0.0];
        for k in 0..50 {
            let far = size * 10.0_f64.powf(-f64::from(k) / 3.0);
            offsets.extend([-far, far]);
        }
        let ratio = (above - below) / size + 1.0;
        offsets.extend((0..=60).map(|i| below + size * (ratio.powf(f64::from(i) / 60.0) - 1.0)));
        for offset in &mut offsets {
            *offset = offset.clamp(below, above);
        }
        offsets.sort_by(f64::total_cmp);
        offsets.dedup();
        let at = |offset: f64| response(n, quantity, centre, offset);
        let values: Vec<f64> = offsets.iter().map(|&offset| at(offset)).collect();
        for i in 0..offsets.len() {
            let value = if values[i].is_nan() { f64::INFINITY } else { values[i] };
            largest = largest.max(value);
            let (before, after) = (i.max(1) - 1, (i + 1).min(offsets.len() - 1));
            // Only local maxima close to the largest value so far can exceed it.
            if value < values[before] || value < values[after] || value < 0.3 * largest {
                continue;
            }
            let (mut a, mut b) = (offsets[before], offsets[after]);
            let share = 0.618_033_988_749_894_9;
            let (mut c, mut d) = (b - share * (b - a), a + share * (b - a));
            let (mut fc, mut fd) = (at(c), at(d));
            for _ in 0..40 {
                if fc > fd {
                    (b, d, fd) = (d, c, fc);
                    c = b - share * (b - a);
                    fc = at(c);
                } else {
                    (a, c, fc) = (c, d, fd);
                    d = a + share * (b - a);
                    fd = at(d);
                }
            }
            largest = largest.max(fc).max(fd);
        }
    }
    largest
}

fn found(n: &Numbers, quantity: Quantity, band: [f64; 2]) -> Worst {
    let Scene { primary, forcing, damper } = n.forced_by(quantity.forcing);
    match damper.filter(|_| !quantity.bare) {
        None => Bare::new(&primary, &forcing).steady_max(quantity.of, band),
        Some(damper) => Coupled::new(&primary, &forcing, &damper).steady_max(quantity.of, band),
    }
}

/// Largest relative difference from the independent search. The ends of the band may be off by 16 rounding errors.
fn difference(n: &Numbers, quantity: Quantity, band @ [from, to]: [f64; 2]) -> f64 {
    let Worst { value, frequency } = found(n, quantity, band);
    assert!(from <= frequency && frequency <= to, "{n:?} {quantity:?} {band:?}: {frequency}");
    let off = |expected: f64| if value == expected { 0.0 } else { value / expected - 1.0 };
    let exact = off(searched(n, quantity, band));
    if exact.abs() <= 1e-9 {
        return exact.abs();
    }
    let slack = 16.0 * f64::EPSILON;
    let most = searched(n, quantity, [from * (1.0 - slack), to * (1.0 + slack)]);
    let least = if from * (1.0 + slack) < to * (1.0 - slack) {
        searched(n, quantity, [from * (1.0 + slack), to * (1.0 - slack)])
    } else {
        0.0
    };
    // Without damping a resonance is infinite; the search gets as close to it as its arithmetic allows.
    let undamped = n.c1 == 0.0 && (n.c2 == 0.0 || quantity.bare);
    if undamped && value == f64::INFINITY && most > least_of_a_resonance(n, quantity) {
        return 0.0;
    }
    (value / most - 1.0).max(1.0 - value / least).max(0.0)
}

/// A lower bound of a value that the search finds near an infinite resonance: 1e10 times the static response (1e20 for an energy), as
/// the search comes that close to the structure's own frequency.
fn least_of_a_resonance(n: &Numbers, quantity: Quantity) -> f64 {
    let omega = (n.k1 / n.m1).sqrt();
    let still = match quantity.forcing {
        Amplitude::Force => n.p / n.k1,
        Amplitude::Imbalance => n.p / n.m1,
        Amplitude::Base => n.p,
        Amplitude::BaseAcceleration => n.p * n.m1 / n.k1,
    };
    match quantity.of {
        Measure::Energy => 1e20 * 0.5 * n.k1 * still * still,
        Measure::Velocity => 1e10 * omega * still,
        Measure::Acceleration => 1e10 * omega * omega * still,
        Measure::GroundForce => 1e10 * n.k1 * still,
        _ => 1e10 * still,
    }
}

/// A damping from 1e-9 to 1e3 N s/m, or none.
fn damping(spread: &mut Spread) -> f64 {
    if spread.unit() < 0.15 { 0.0 } else { spread.logarithmic(1e-9, 1e3) }
}

fn draw(spread: &mut Spread) -> (Numbers, [f64; 2]) {
    let numbers = Numbers {
        c1: damping(spread),
        k1: spread.logarithmic(1e4, 1e5),
        m2: spread.logarithmic(1.0, 3000.0),
        k2: if spread.unit() < 0.5 { 3500.0 * spread.unit() } else { spread.logarithmic(1e-3, 3500.0) },
        c2: damping(spread),
        ..TMD
    };
    let natural: Vec<f64> = centres(&numbers).iter().map(|centre| centre.value()).collect();
    let end = |spread: &mut Spread| match spread.unit() {
        share if share < 0.4 => spread.logarithmic(0.05, 60.0),
        share => {
            let near = natural[(spread.unit() * natural.len() as f64) as usize];
            if share < 0.7 {
                near * (1.0 + f64::EPSILON * (spread.unit() * 5.0 - 2.5).round())
            } else {
                near * (1.0 + spread.signed().signum() * spread.logarithmic(1e-15, 0.1))
            }
        }
    };
    let from = end(spread);
    let to = if spread.unit() < 0.2 { from * (1.0 + spread.logarithmic(1e-14, 1e-3)) } else { end(spread) };
    (numbers, [from.min(to), from.max(to)])
}

/// Checks `count` dampers, each over a band of its own.
pub fn bands(count: u64) -> Hunt {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let looked = |first: u64| {
        let (mut worst, mut faults) = (0.0_f64, Vec::new());
        for seed in (first..count).step_by(threads as usize) {
            let (numbers, band) = draw(&mut Spread::new(seed + 1));
            for quantity in quantities() {
                let off = difference(&numbers, quantity, band);
                worst = worst.max(off);
                if off.is_nan() || off > 1e-9 {
                    let found = found(&numbers, quantity, band);
                    faults.push(format!("{off:e} {quantity:?} {band:?} {numbers:?} {found:?}"));
                }
            }
        }
        (worst, faults)
    };
    let found: Vec<(f64, Vec<String>)> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..threads).map(|first| scope.spawn(move || looked(first))).collect();
        threads.into_iter().map(|thread| thread.join().expect("no panic")).collect()
    });
    let worst = found.iter().fold(0.0, |worst: f64, one| worst.max(one.0));
    let mut hunt = Hunt { faults: found.into_iter().flat_map(|one| one.1).collect(), ..Hunt::default() };
    hunt.row(format!(
        "{count} dampers, {} quantities each: largest difference {worst:.1e}, {} above 1e-9",
        quantities().len(),
        hunt.faults.len()
    ));
    hunt
}

/// The largest relative difference between a damper's worst and the independent search, over all its quantities.
pub fn largest_difference(numbers: &Numbers, band: [f64; 2]) -> f64 {
    let all = quantities().into_iter().filter(|quantity| !quantity.bare);
    all.map(|quantity| difference(numbers, quantity, band)).fold(0.0, f64::max)
}
