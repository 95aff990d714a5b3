//! The largest steady response over a band of frequencies, in closed form: without samples no narrow peak can hide between them.
//!
//! With `u = ω²` the square of an amplitude is `V / M`, two polynomials in `u`, so it is largest at an end of the band or where
//! the sign of `W = V' M - V M'` (of degree 6 at most) falls through zero. The band is cut wherever a factor of `V` or `M` is zero
//! (`band/factors.rs`), so on a piece all factors keep their signs. Then `V`, `M` and the terms of their slopes, in the Bernstein basis,
//! are made of sums and products without a difference: each is known to some 20 roundings of its own size, however small.
//! The computed `W` is off by at most `γ (|V'| M + V |M'|)`, slopes taken term by term, `γ` about 1e-14, and its roots are isolated
//! with certainty (`band/roots.rs`). A maximum that is missed by a wrong sign of `W` is higher by a factor of at most
//! `exp(γ ∫ |V'|/V + |M'|/M)`, and the integral is a few times the logarithm of the range of `V` and `M`: 1e-11 is never reached. So
//! the value is exact to rounding for any damping, however small: a peak whose width is 1e-14 of its frequency has its full height,
//! although no floating-point frequency lies that close to it.

mod factors;
mod roots;

use crate::{Bare, Coupled, Measure};
use factors::{Factors, Numerator, ON_RESONANCE, Piece, Point};

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
    /// Largest steady value of a quantity over the band `[from, to]` of angular frequencies, rad/s, `0 < from <= to`; as
    /// [`Self::steady_e1_max`]. Stroke and contact force are zero without a damper.
    pub fn steady_max(&self, measure: Measure, [from, to]: [f64; 2]) -> Worst {
        if measure == Measure::Energy {
            return self.steady_e1_max([from, to]);
        }
        let mut worst = Worst::NONE;
        if matches!(measure, Measure::Stroke | Measure::ContactForce) {
            return Worst { value: 0.0, frequency: from };
        }
        for end in [from, to] {
            worst.note(end, self.steady(end).largest(self, end, measure));
        }
        // |X1|² = (P/m1)² / ((u - u0)² + u r²), r = c1/m1: by 1, by u, by u² and by k1² + u c1², the last of which is largest at
        // u² + 2 g u = 2 g u0 with g = (k1/c1)². `past` is u - u0 without a difference.
        let (u0, rate) = (self.k1 / self.m1, self.c1 / self.m1);
        let half = 0.5 * rate * rate;
        let (u, past) = match measure {
            Measure::Displacement => (u0 - half, -half),
            Measure::Velocity => (u0, 0.0),
            Measure::Acceleration => {
                let u = u0 / (1.0 - half / u0);
                (u, u * (half / u0))
            }
            Measure::GroundForce => {
                let share = 2.0 * u0 * (self.c1 / self.k1).powi(2);
                let root = 1.0 + (1.0 + share).sqrt();
                (2.0 * u0 / root, -u0 * share / (root * root))
            }
            Measure::Energy | Measure::Stroke | Measure::ContactForce => return worst,
        };
        let omega = u.max(0.0).sqrt();
        if from * (1.0 - ON_RESONANCE) <= omega && omega <= to * (1.0 + ON_RESONANCE) {
            let x1 = self.p / (self.m1 * past.hypot(omega * rate));
            let by = match measure {
                Measure::Velocity => omega,
                Measure::Acceleration => u,
                Measure::GroundForce => self.k1.hypot(omega * self.c1),
                _ => 1.0,
            };
            worst.note(omega.clamp(from, to.max(from)), by * x1);
        }
        worst
    }

    /// Largest steady E1max, J, over the band `[from, to]` of angular frequencies, rad/s, `0 < from <= to`. Infinite at the
    /// resonance of an undamped structure, also where the band ends on it to 8 roundings.
    pub fn steady_e1_max(&self, [from, to]: [f64; 2]) -> Worst {
        let mut worst = Worst::NONE;
        for end in [from, to] {
            worst.note(end, self.steady(end).e1_max);
        }
        // Up to u0 = k1/m1 E1max is the spring's, from there on the mass's: `(P/m1)² / ((u - u0)² + u (c1/m1)²)` by k1/2 and by m1 u/2.
        // The first is largest at `u0 - (c1/m1)²/2`, the second at u0.
        let (natural, rate) = (self.k1 / self.m1, self.c1 / self.m1);
        let below = 0.5 * rate * rate;
        for (u, below) in [(natural, 0.0), (natural - below, below)] {
            let omega = u.max(0.0).sqrt();
            if from * (1.0 - ON_RESONANCE) <= omega && omega <= to * (1.0 + ON_RESONANCE) {
                let amplitude = self.p / (self.m1 * below.hypot(omega * rate));
                worst.note(omega.clamp(from, to.max(from)), 0.5 * amplitude * amplitude * self.k1);
            }
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

    /// Largest amplitude `|X1|`, m, of the primary structure over a band; as [`Self::steady_e1_max`].
    pub fn steady_displacement_max(&self, band: [f64; 2]) -> Worst {
        self.steady_max(Measure::Displacement, band)
    }

    /// Largest steady stroke (spring deflection) `|X2 - X1|`, m, over a band; as [`Self::steady_e1_max`].
    pub fn steady_stroke_max(&self, band: [f64; 2]) -> Worst {
        self.steady_max(Measure::Stroke, band)
    }

    /// Largest steady value of a quantity over a band; as [`Self::steady_e1_max`]. The contact force is zero, as long as the damper
    /// touches neither wall.
    pub fn steady_max(&self, measure: Measure, [from, to]: [f64; 2]) -> Worst {
        let mut worst = Worst::NONE;
        if from < to && measure != Measure::ContactForce {
            let factors = Factors::new(self, to * to);
            Search { system: self, factors, measure, band: [from, to], worst: &mut worst }.run();
        } else {
            worst.note(from, self.steady(from).largest(self.bare(), from, measure));
        }
        worst
    }
}

struct Search<'a> {
    system: &'a Coupled,
    factors: Factors,
    /// The quantity to be maximised, a multiple of `V / M` or of its square root.
    measure: Measure,
    band: [f64; 2],
    worst: &'a mut Worst,
}

impl Search<'_> {
    /// Looks at every cut of the band, then at every maximum between two cuts that can be higher.
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
            if self.value(numerator, v / m) > self.worst.value {
                roots::falls(piece.slope(numerator), &mut |s| self.note(&piece, numerator, s));
            }
        }
    }

    fn note(&mut self, piece: &Piece, numerator: Numerator, s: f64) {
        let [from, to] = self.band;
        let frequency = (piece.u(s) * self.factors.unit).sqrt().clamp(from, to);
        self.worst.note(frequency, self.value(numerator, piece.ratio(numerator, s)));
    }

    /// `V` from a cut on to the next.
    fn numerator(&self, from: &Point) -> Numerator {
        match self.measure {
            Measure::Energy if from.past(&self.factors.primary) < 0.0 => Numerator::Damper,
            Measure::Energy | Measure::Velocity => Numerator::DamperBySquare,
            Measure::Displacement => Numerator::Damper,
            Measure::Acceleration => Numerator::DamperByFourth,
            Measure::GroundForce => {
                let Bare { k1, c1, .. } = *self.system.bare();
                Numerator::DamperByGround([k1 * k1, c1 * c1 * self.factors.unit])
            }
            Measure::Stroke | Measure::ContactForce => Numerator::Square,
        }
    }

    fn value(&self, numerator: Numerator, ratio: f64) -> f64 {
        let Bare { m1, k1, p, .. } = *self.system.bare();
        let amplitude = p / (m1 * self.factors.unit);
        let unit = self.factors.unit;
        let size = amplitude * ratio.sqrt();
        match self.measure {
            // Below its own frequency the structure's spring holds the largest energy, above it its mass (see `numerator`).
            Measure::Energy if numerator == Numerator::Damper => 0.5 * k1 * amplitude * amplitude * ratio,
            Measure::Energy => 0.5 * m1 * unit * amplitude * amplitude * ratio,
            Measure::Velocity => size * unit.sqrt(),
            Measure::Acceleration => size * unit,
            Measure::Displacement | Measure::GroundForce | Measure::Stroke | Measure::ContactForce => size,
        }
    }
}
