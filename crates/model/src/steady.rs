//! Steady response of the linear scenes in closed form: no damper, or a damper that never touches.

use crate::{Bare, Coupled, Measure, Parameter};
use nalgebra::Complex;

/// Amplitudes of a steady harmonic motion `x1 = Re(X1 e^{iωt})`, `x2 - D = Re(X2 e^{iωt})`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steady {
    /// Complex amplitude of the primary structure, m.
    pub x1: Complex<f64>,
    /// Complex amplitude of the damper about `D`, m; equal to `x1` without a damper, so that the stroke is zero.
    pub x2: Complex<f64>,
    /// Largest energy of the primary structure over a period, `|X1|² max(k1, m1 ω²) / 2`, J.
    pub e1_max: f64,
    /// Largest energy of the damper, the paper's E2, over a period, `|X2|² max(k2, m2 ω²) / 2`, J.
    pub e2_max: f64,
}

impl Steady {
    /// The amplitude of a quantity at the angular frequency of the response, of the structure `bare`: largest values over a period.
    /// Zero for contact forces, since the damper touches nothing.
    pub fn largest(&self, bare: &Bare, omega: f64, measure: Measure) -> f64 {
        let x1 = self.x1.norm();
        match measure {
            Measure::Energy => self.e1_max,
            Measure::Displacement => x1,
            Measure::Velocity => omega * x1,
            Measure::Acceleration => omega * omega * x1,
            Measure::GroundForce if bare.is_on_moving_base() => {
                (Complex::new(bare.k1, omega * bare.c1) * self.x1 - bare.force(omega)).norm()
            }
            Measure::GroundForce => bare.k1.hypot(omega * bare.c1) * x1,
            Measure::Stroke => self.stroke(),
            Measure::ContactForce | Measure::ContactPressure => 0.0,
            // A harmonic motion is not random and does not decay.
            Measure::DecayTime | Measure::Stationary(_) => f64::NAN,
        }
    }

    /// The stroke: the largest deflection of the damper's spring, `|x2 - x1 - D| = |X2 - X1|`, m.
    pub fn stroke(&self) -> f64 {
        (self.x2 - self.x1).norm()
    }
}

/// Largest `(m v² + k x²)/2` of the motion `x = |X| cos(ωt + φ)`: each term is largest where the other is zero, so the larger one decides.
fn largest_energy(amplitude: Complex<f64>, k: f64, m_omega2: f64) -> f64 {
    0.5 * amplitude.norm_sqr() * k.max(m_omega2)
}

impl Bare {
    /// Steady response at the angular frequency `omega` (rad/s) under the forcing of this structure:
    /// `X1 = P e^{iφ} / (k1 - m1 ω² + iω c1)`. Infinite at the resonance of an undamped structure.
    pub fn steady(&self, omega: f64) -> Steady {
        let m_omega2 = self.m1 * omega * omega;
        let x1 = self.force(omega) / Complex::new(self.k1 - m_omega2, omega * self.c1);
        Steady { x1, x2: x1, e1_max: largest_energy(x1, self.k1, m_omega2), e2_max: 0.0 }
    }

    /// The energy that the force brings to this structure without its damping, at resonance and from rest, in `time` (s), J: `x1` is then
    /// `P t sin(ωt) / (2 m1 ω)`, which solves equation (1), so the speed grows by `P t / (2 m1)` and the energy is `(P t)² / (8 m1)`.
    pub fn resonant_energy(&self, time: f64) -> f64 {
        let impulse = self.force(self.omega).norm() * time;
        impulse * impulse / (8.0 * self.m1)
    }
}

impl Coupled {
    /// Steady response at the angular frequency `omega` (rad/s) as long as the damper touches neither wall
    /// (compare [`Steady::stroke`] with `D` and `C`).
    ///
    /// Equation (1) without contact, with `S = k1 - m1 ω² + iω c1`, `Q = k2 + iω c2`, `d = Q - m2 ω²`:
    /// `X1 = P e^{iφ} d / (S d - m2 ω² Q)`, `X2 = P e^{iφ} Q / (S d - m2 ω² Q)`.
    /// Infinite or NaN at the resonance of an undamped system.
    pub fn steady(&self, omega: f64) -> Steady {
        let Bare { m1, c1, k1, .. } = *self.bare();
        let (m2, k2, c2) = self.damper();
        let omega2 = omega * omega;
        let spring = Complex::new(k2, omega * c2);
        let dynamic = Complex::new(k2 - m2 * omega2, omega * c2);
        let primary = Complex::new(k1 - m1 * omega2, omega * c1);
        let scale = self.bare().force(omega) / (primary * dynamic - spring * (m2 * omega2));
        let (x1, x2) = (dynamic * scale, spring * scale);
        Steady {
            x1,
            x2,
            e1_max: largest_energy(x1, k1, m1 * omega2),
            e2_max: largest_energy(x2, k2, m2 * omega2),
        }
    }

    /// The derivative of [`Steady::largest`] by a parameter of the damper, in the unit of the measure per SI unit of the parameter, at a
    /// fixed angular frequency (rad/s); NaN by a parameter of the structure or the force. With `N = S d - m2 ω² Q` and primes for derivatives,
    /// `X1' = (P e^{iφ} d' - X1 N') / N` and `X2' = (P e^{iφ} Q' - X2 N') / N`; walls that are not touched do not matter.
    pub fn steady_by(&self, measure: Measure, parameter: Parameter, omega: f64) -> f64 {
        let steady = self.steady(omega);
        let bare = self.bare();
        let Bare { m1, c1, k1, .. } = *bare;
        let (m2, k2, c2) = self.damper();
        let (omega2, one) = (omega * omega, Complex::new(1.0, 0.0));
        let [by_spring, by_mass] = match parameter {
            Parameter::K2 => [one, 0.0 * one],
            Parameter::C2 => [Complex::new(0.0, omega), 0.0 * one],
            Parameter::M2 => [0.0 * one, one],
            _ if parameter.is_gap() || parameter.is_of_contact() => return 0.0,
            _ => return f64::NAN,
        };
        let spring = Complex::new(k2, omega * c2);
        let primary = Complex::new(k1 - m1 * omega2, omega * c1);
        let by_dynamic = by_spring - by_mass * omega2;
        let divisor = primary * (spring - m2 * omega2) - spring * (m2 * omega2);
        let by_divisor = primary * by_dynamic - (by_mass * spring + by_spring * m2) * omega2;
        let by_x1 = (bare.force(omega) * by_dynamic - steady.x1 * by_divisor) / divisor;
        let by_x2 = (bare.force(omega) * by_spring - steady.x2 * by_divisor) / divisor;
        // Each measure is a constant times the size, or for the energy its square, of one complex number.
        let [value, by] = match measure {
            Measure::Stroke => [steady.x2 - steady.x1, by_x2 - by_x1],
            Measure::GroundForce if bare.is_on_moving_base() => {
                let ground = Complex::new(k1, omega * c1);
                [ground * steady.x1 - bare.force(omega), ground * by_x1]
            }
            _ => [steady.x1, by_x1],
        };
        let largest = steady.largest(bare, omega, measure);
        let power = if measure == Measure::Energy { 2.0 } else { 1.0 };
        if largest == 0.0 { 0.0 } else { power * largest * (by / value).re }
    }
}
