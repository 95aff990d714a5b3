//! The largest steady response over a band of frequencies, in closed form: without samples no narrow peak can hide between them.
//!
//! With `u = ω²` the square of an amplitude is `V / M`, two polynomials in `u`, so it is largest at an end of the band or where
//! the sign of `W = V' M - V M'` (of degree 7 at most, powers of `u` taken out) falls through zero. The band is cut wherever a factor of `V` or `M` is zero
//! (`band/factors.rs`), so on a piece all factors keep their signs. Then `V`, `M` and the terms of their slopes, in the Bernstein basis,
//! are made of sums and products without a difference: each is known to some 20 roundings of its own size, however small.
//! The computed `W` is off by at most `γ (|V'| M + V |M'|)`, slopes taken term by term, `γ` about 1e-14, and its roots are isolated
//! with certainty (`band/roots.rs`). A maximum that is missed by a wrong sign of `W` is higher by a factor of at most
//! `exp(γ ∫ |V'|/V + |M'|/M)`, and the integral is a few times the logarithm of the range of `V` and `M`: 1e-11 is never reached. So
//! the value is exact to rounding for any damping, however small: a peak whose width is 1e-14 of its frequency has its full height,
//! although no floating-point frequency lies that close to it.

mod factors;
mod roots;

use crate::{Bare, Coupled, Measure, Source};
use factors::{Factors, Numerator, Piece, Point};

/// A largest value over a band, and where it is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// The angular frequency, rad/s, rounded and within the band.
    pub frequency: f64,
}

impl Worst {
    const NONE: Self = Self { value: f64::NEG_INFINITY, frequency: f64::NAN };

    fn note(&mut self, frequency: f64, value: f64) {
        let value = if value.is_nan() { f64::INFINITY } else { value }; // 0/0 where nothing resists the force
        if value > self.value {
            *self = Self { value, frequency };
        }
    }
}

impl Bare {
    /// Largest steady E1max, J, over the band `[from, to]` of angular frequencies, rad/s, `0 < from <= to`. Infinite at the
    /// resonance of an undamped structure, also where the band ends on it to 8 roundings.
    pub fn steady_e1_max(&self, band: [f64; 2]) -> Worst {
        self.steady_max(Measure::Energy, band)
    }

    /// Largest steady value of a quantity over a band; as [`Self::steady_e1_max`]. Stroke and contact force are zero without a
    /// damper.
    pub fn steady_max(&self, measure: Measure, [from, to]: [f64; 2]) -> Worst {
        if measure.is_of_damper() {
            return Worst { value: 0.0, frequency: from };
        }
        let mut worst = Worst::NONE;
        if from < to {
            let collector = Collector { worst: &mut worst, share: 1.0, visit: &mut |_| () };
            Search::new(self, Factors::of_bare(self, to * to), false, measure, [from, to], collector).run();
        } else {
            worst.note(from, self.steady(from).largest(self, from, measure));
        }
        worst
    }
}

impl Coupled {
    /// Largest steady E1max, J, over the band `[from, to]` of angular frequencies, rad/s, `0 < from <= to`, as long as the
    /// damper touches neither wall (compare [`Self::steady_stroke_max`] with `D` and `C`). Infinite at a resonance of an undamped
    /// system, also where the band ends on it to 8 roundings.
    pub fn steady_e1_max(&self, band: [f64; 2]) -> Worst {
        self.steady_max(Measure::Energy, band)
    }

    /// Largest steady stroke (spring deflection) `|X2 - X1|`, m, over a band; as [`Self::steady_e1_max`].
    pub fn steady_stroke_max(&self, band: [f64; 2]) -> Worst {
        self.steady_max(Measure::Stroke, band)
    }

    /// Largest steady value of a quantity over a band; as [`Self::steady_e1_max`]. The contact force is zero, as long as the damper
    /// touches neither wall.
    pub fn steady_max(&self, measure: Measure, band: [f64; 2]) -> Worst {
        self.steady_over(measure, band, 1.0, &mut |_| ())
    }

    /// The candidates for the largest value of a quantity over a band at a nearby design: every maximum, and the ends of the band, with at
    /// least the share `least` of the largest value.
    pub fn steady_peaks(&self, measure: Measure, band: [f64; 2], least: f64) -> Vec<Worst> {
        let mut peaks = Vec::new();
        let worst = self.steady_over(measure, band, least, &mut |peak| peaks.push(peak));
        peaks.retain(|peak: &Worst| peak.value >= least * worst.value);
        peaks
    }

    fn steady_over(
        &self,
        measure: Measure,
        [from, to]: [f64; 2],
        share: f64,
        visit: &mut dyn FnMut(Worst),
    ) -> Worst {
        let mut worst = Worst::NONE;
        if from < to && !measure.is_of_walls() {
            let factors = Factors::new(self, to * to);
            let collector = Collector { worst: &mut worst, share, visit };
            Search::new(self.bare(), factors, true, measure, [from, to], collector).run();
        } else {
            worst.note(from, self.steady(from).largest(self.bare(), from, measure));
            visit(worst);
        }
        worst
    }
}

/// Collects the results of a search: the largest value, and each candidate for at least a share of it.
struct Collector<'a> {
    worst: &'a mut Worst,
    share: f64,
    visit: &'a mut dyn FnMut(Worst),
}

struct Search<'a> {
    bare: &'a Bare,
    factors: Factors,
    /// Whether the structure has a damper.
    damper: bool,
    /// The quantity to be maximised, a multiple of `V / M` or of its square root.
    measure: Measure,
    /// Whether it is the force on a moving ground, the inertia of both masses, `ω² |m1 X1 + m2 X2|`.
    inertia: bool,
    /// Amplitude of the force, N, over `u^power` and the root of `weight`.
    force: f64,
    power: i32,
    weight: Option<[f64; 2]>,
    band: [f64; 2],
    collector: Collector<'a>,
}

impl<'a> Search<'a> {
    fn new(
        bare: &'a Bare,
        factors: Factors,
        damper: bool,
        measure: Measure,
        band: [f64; 2],
        collector: Collector<'a>,
    ) -> Self {
        let (force, power, weight) = match bare.source() {
            Source::Harmonic(of, size) => (
                of.at(size.get(), factors.unit.sqrt()),
                of.power(),
                of.is_of_base().then(|| ground(bare, factors.unit)),
            ),
            Source::Decay(_) | Source::History(_) => (0.0, 0, None),
        };
        let inertia = weight.is_some() && measure == Measure::GroundForce;
        let factors = if inertia && damper { factors.of_both_masses() } else { factors };
        Self { bare, factors, damper, measure, inertia, force, power, weight, band, collector }
    }

    /// Evaluates every cut of the band, then every maximum between two cuts that can be higher.
    fn run(&mut self) {
        let [from, to] = self.band.map(|end| self.factors.end(end));
        let inside =
            self.factors.cuts().into_iter().filter(|cut| cut.past(&from) > 0.0 && to.past(cut) > 0.0);
        let mut points = [from; 8];
        let mut last = 0;
        for cut in inside {
            last += 1;
            points[last] = cut;
        }
        last += 1;
        points[last] = to;
        for point in &points[..=last] {
            let piece = self.factors.piece(point, point);
            self.note(&piece, self.numerator(point), 0.0);
        }
        for ends in points[..=last].windows(2) {
            let (a, b) = (&ends[0], &ends[1]);
            let numerator = self.numerator(a);
            // From the end that is nearer to a natural frequency, where small differences count.
            let piece = if a.off_resonance() <= b.off_resonance() {
                self.factors.piece(a, b)
            } else {
                self.factors.piece(b, a)
            };
            let [v, m] = piece.bounds(numerator);
            if self.value(numerator, v / m) > self.collector.share * self.collector.worst.value {
                piece.falls(numerator, &mut |s| self.note(&piece, numerator, s));
            }
        }
    }

    fn note(&mut self, piece: &Piece, numerator: Numerator, s: f64) {
        let [from, to] = self.band;
        let frequency = (piece.u(s) * self.factors.unit).sqrt().clamp(from, to);
        let value = self.value(numerator, piece.ratio(numerator, s));
        self.collector.worst.note(frequency, value);
        (self.collector.visit)(Worst { value, frequency });
    }

    /// `V` between a cut and the next.
    fn numerator(&self, from: &Point) -> Numerator {
        // Below its own frequency the structure's spring holds the largest energy, above it its mass.
        let by_square = self.measure == Measure::Velocity
            || self.measure == Measure::Energy && from.past(&self.factors.primary) >= 0.0;
        let of_measure = match self.measure {
            Measure::GroundForce if !self.inertia => Some(ground(self.bare, self.factors.unit)),
            _ if by_square => Some([0.0, 1.0]),
            _ => None,
        };
        let by_fourth = matches!(self.measure, Measure::Acceleration | Measure::Stroke) || self.inertia;
        let fourth = if by_fourth { 2 } else { 0 };
        let (power, weight) = match (self.weight, of_measure) {
            // Of two weights, that of the measure is u: it counts as a power.
            (Some(weight), Some(_)) => (1, Some(weight)),
            (weight, of_measure) => (0, weight.or(of_measure)),
        };
        Numerator {
            power: self.power + fourth + power,
            weight: weight.unwrap_or([1.0, 0.0]),
            damper: self.damper && self.measure != Measure::Stroke,
        }
    }

    fn value(&self, numerator: Numerator, ratio: f64) -> f64 {
        let Bare { m1, k1, .. } = *self.bare;
        let unit = self.factors.unit;
        let amplitude = self.force / (m1 * unit);
        let size = amplitude * ratio.sqrt();
        // The numerator shows whether the spring or the mass holds the energy, see `numerator`.
        let springs = numerator.power == self.power && numerator.weight == self.weight.unwrap_or([1.0, 0.0]);
        match self.measure {
            Measure::Energy if springs => 0.5 * k1 * amplitude * amplitude * ratio,
            Measure::Energy => 0.5 * m1 * unit * amplitude * amplitude * ratio,
            Measure::Velocity => size * unit.sqrt(),
            Measure::Acceleration => size * unit,
            Measure::GroundForce if self.inertia => size * unit * m1,
            _ => size,
        }
    }
}

/// `[k1², c1²]`, the weights of `1` and `u` in `|k1 + iω c1|²`.
fn ground(bare: &Bare, unit: f64) -> [f64; 2] {
    [bare.k1 * bare.k1, bare.c1 * bare.c1 * unit]
}
