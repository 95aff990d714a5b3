//! A contact with the same restitution at every speed.
//!
//! After H. M. Lankarani and P. E. Nikravesh (J. Mech. Des. 112 (1990) 369) λ of Hunt and Crossley is taken as `χ / v`, with the speed `v` at
//! touch-down, and `χ` here from the exact relation. For a contact whose speed at touch-down is not known, that begins pressed into
//! the wall, or is disturbed, `v` is not a property of its state. So `v` is taken as the speed at touch-down of the *undisturbed collision
//! through the present state*: the force is a function of `z` and `ż` alone, and in an undisturbed collision `v` is the one at touch-down.
//!
//! With `h = ż/v` that collision obeys `v dh/dt = -κ z^(3/2) (1 + χ h)`, and so
//!
//! ```text
//! S = (2/5) κ z^(5/2) = v² G(h),      G(h) = ∫_h^1 s / (1 + χ s) ds
//! ```
//!
//! with `h = 1` at touch-down and `h = -e` at lift-off, `G(-e) = 0`. Given `S` and `ż`, this determines `h` and `v`. The factor of the
//! force is `1 + χ h >= 1 - χ e > 0`: it never pulls.

use super::collision::chi;
use super::remainder::Remainder;
use crate::kept::Kept;
use std::sync::Arc;
use wide::f64x4;

/// The factor `f` of Hertz's force at an indentation `z` that changes at the rate `w`, with its derivatives: those by `z` times `z`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Factor {
    pub f: f64,
    pub by_z: f64,
    pub by_w: f64,
    pub by_zz: f64,
    pub by_zw: f64,
    pub by_ww: f64,
}

/// The law of a restitution.
#[derive(Clone, Debug)]
pub struct Restoring {
    pub(crate) chi: f64,
    e: f64,
    /// dχ/de.
    chi_by_e: f64,
    /// `ln(1 + χ)` and `ln(1 - χ e)`, the latter without the cancellation of 1 - χ e at small e.
    logs: [f64; 2],
    /// The stage by polynomials instead of its equation.
    remainder: Option<Remainder>,
}

/// The stage of an undisturbed collision at which a contact is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stage {
    /// ż/v, 1 at touch-down and -e at lift-off.
    pub h: f64,
    /// v, the speed at touch-down, m/s.
    pub v: f64,
    /// `1 + χ h`.
    pub f: f64,
    /// G(h).
    pub g: f64,
    /// `2 (1 + χ h) G + h²`, from e² at lift-off to 1 at touch-down: it grows with h, by `2 χ G`.
    pub d: f64,
}

/// Below this χ the integrals over `[h, 1]` are series.
const SMALL: f64 = 0.25;
/// Terms of these series: the first neglected one is below `SMALL^TERMS`.
const TERMS: i32 = 28;
/// The least restitution with polynomials: below it they would show the rounding of `G`, up to some 1e-15/e².
const LEAST: f64 = 0.002;
/// How much beyond lift-off, as a share of w², a stage is computed by the polynomials of contacts.
const BEYOND: f64 = 1e-3;

/// Laws by their restitutions.
static LAWS: Kept<Restoring> = Kept::new();

impl Restoring {
    /// The law of the restitution `e` in (0, 1), computed once for a restitution.
    pub(crate) fn of(e: f64) -> Arc<Self> {
        LAWS.of(e, || Self::new(e))
    }

    fn new(e: f64) -> Self {
        let chi = chi(e);
        let chi_by_e = chi * e * (1.0 + chi) / ((1.0 - chi * e) - e * e * (1.0 + chi));
        let first = chi.ln_1p();
        let logs = [first, first - chi * (1.0 + e)];
        let law = Self { chi, e, chi_by_e, logs, remainder: None };
        let at = |x: f64| {
            let Stage { h, g, .. } = law.solved(0.5 * (1.0 - x) * (1.0 + x), x);
            (h * h + 2.0 * g).sqrt()
        };
        let remainder = (e >= LEAST).then(|| Remainder::new(law.branch(), at)).flatten();
        Self { remainder, ..law }
    }

    /// The branch point of h as a function of x, beyond touch-down: `D = 0` there. Infinite where χ is small.
    fn branch(&self) -> f64 {
        if self.chi < SMALL {
            return f64::INFINITY;
        }
        let at = |h: f64| self.with((self.chi * h).ln_1p(), 1.0 + self.chi * h, h);
        let (mut low, mut high) = (1.0, 4.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if at(middle).d > 0.0 { low = middle } else { high = middle }
        }
        let Stage { h, g, .. } = at(low);
        h / (h * h + 2.0 * g).sqrt()
    }

    /// `G = ∫_h^1 s / (1 + χ s) ds = ((1 - h) - ln((1 + χ) / f) / χ) / χ`, from h and ln f.
    fn g(&self, h: f64, log: f64) -> f64 {
        let chi = self.chi;
        if chi < SMALL {
            let (mut sum, mut sign, mut power) = (0.0, 1.0, h * h);
            for k in 2..TERMS + 2 {
                sum += sign * (1.0 - power) / f64::from(k);
                (sign, power) = (-chi * sign, h * power);
            }
            return sum;
        }
        (chi * (1.0 - h) - (self.logs[0] - log)) / (chi * chi)
    }

    /// The stage at this ln f, without v.
    fn at(&self, log: f64) -> Stage {
        let f = log.exp();
        let h = if self.chi < SMALL { log.exp_m1() } else { f - 1.0 } / self.chi;
        self.with(log, f, h)
    }

    fn with(&self, log: f64, f: f64, h: f64) -> Stage {
        let g = self.g(h, log);
        Stage { h, v: f64::NAN, f, g, d: 2.0 * f * g + h * h }
    }

    /// The stage at this h between -e and 1, without v.
    pub(crate) fn stage_at(&self, h: f64) -> Stage {
        let log = (self.chi * h).ln_1p();
        if h <= -self.e || log <= self.logs[1] {
            self.at(self.logs[1])
        } else {
            self.with(log, 1.0 + self.chi * h, h)
        }
    }

    /// e.
    pub fn restitution(&self) -> f64 {
        self.e
    }

    /// Whether the factor is computed by polynomials instead of an iteration: for restitutions of 0.002 and above.
    pub fn is_tabulated(&self) -> bool {
        self.remainder.is_some()
    }

    /// The factor of the force at `S` (m²/s²) and the rate of indentation `w` (m/s).
    #[inline]
    pub fn push(&self, s: f64, w: f64) -> f64 {
        match self.whole(s, w) {
            Some((remainder, whole)) => {
                let x = w / whole.sqrt();
                1.0 + self.chi * x * remainder.at(x)
            }
            None => self.solved(s, w).f,
        }
    }

    /// [`Self::push`] of four contacts at once, with bitwise equal results.
    #[inline]
    pub fn push_of_four(&self, s: f64x4, w: f64x4) -> f64x4 {
        let square = w * w;
        let whole = square + s * 2.0;
        let holds = s.simd_ge(square * -BEYOND) & whole.simd_gt(f64x4::ZERO);
        if let Some(remainder) = self.remainder.as_ref().filter(|_| holds.all()) {
            let x = w / whole.sqrt();
            return x * self.chi * remainder.at_four(x) + 1.0;
        }
        let (s, w) = (s.to_array(), w.to_array());
        f64x4::new(std::array::from_fn(|i| self.push(s[i], w[i])))
    }

    /// `ż² + 2 S`, m²/s², where the polynomials hold.
    #[inline]
    fn whole(&self, s: f64, w: f64) -> Option<(&Remainder, f64)> {
        let whole = w * w + 2.0 * s;
        let remainder = self.remainder.as_ref()?;
        (s >= -BEYOND * w * w && whole > 0.0).then_some((remainder, whole))
    }

    /// The stage at `S` (m²/s²) and the rate of indentation `w` (m/s). A step of an integration may end a little beyond lift-off, where
    /// `S < 0` and `h < -e`.
    pub(crate) fn stage(&self, s: f64, w: f64) -> Stage {
        let Some((remainder, whole)) = self.whole(s, w) else { return self.solved(s, w) };
        let root = whole.sqrt();
        let x = w / root;
        let r = remainder.at(x);
        let (h, g) = (x * r, s / whole * (r * r));
        let f = 1.0 + self.chi * h;
        Stage { h, v: root / r, f, g, d: 2.0 * f * g + h * h }
    }

    /// The stage from its equation: the root of `φ = w² G - h² S` on the side of the sign of w, by Halley's iteration on ln f, safeguarded
    /// by bisection.
    fn solved(&self, s: f64, w: f64) -> Stage {
        let Self { chi, e, logs, .. } = *self;
        if w == 0.0 {
            let deepest = self.at(0.0);
            return Stage { v: (s / deepest.g).sqrt(), ..deepest };
        }
        let whole = w * w + 2.0 * s;
        let (a, b) = (w * w / whole, s / whole);
        let beyond = if s < 0.0 { 2.0 * chi } else { 0.0 };
        let rises = w <= 0.0;
        let [mut low, mut high] = if rises { [logs[1] - beyond, 0.0] } else { [0.0, logs[0] + beyond] };
        let x = w / whole.sqrt();
        let r = self.remainder.as_ref().map_or(1.0, |remainder| remainder.at(x).clamp(e, 1.0));
        let mut log = (chi * x * r).ln_1p().max(low).min(high);
        let mut stage = self.at(log);
        for _ in 0..100 {
            let Stage { h, f, g, .. } = stage;
            let value = a * g - b * h * h;
            if (value > 0.0) == rises {
                high = log
            } else {
                low = log
            }
            let weight = (a + 2.0 * b * f) / chi;
            let slope = -h * weight;
            let curvature = -(f / chi) * (weight + 2.0 * b * h);
            let newton = value / slope;
            let next = log - newton / (1.0 - 0.5 * newton * curvature / slope);
            let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            let step = next - log;
            log = next;
            stage = self.at(log);
            // Convergence is cubic.
            if step.abs() <= 1e-6 * log.abs() || value == 0.0 {
                break;
            }
        }
        // Of the two formulas for v, the one without cancellation.
        let v = if stage.h.abs() > 0.5 * e { w / stage.h } else { (s / stage.g).sqrt() };
        Stage { v, ..stage }
    }

    /// The factor of the force, and its derivatives by `ln z` and by `w` (s/m).
    pub fn slopes(&self, s: f64, w: f64) -> [f64; 3] {
        let Factor { f, by_z, by_w, .. } = self.factor(s, w);
        [f, by_z, by_w]
    }

    /// The factor `1 + χ h` with its derivatives. `h` depends on `u = ż/√S` alone, with `h' = 2 f G^(3/2) / D`.
    pub(crate) fn factor(&self, s: f64, w: f64) -> Factor {
        if s == 0.0 && w == 0.0 {
            return Factor { f: 1.0, ..Factor::default() };
        }
        let chi = self.chi;
        let Stage { h, v, f, g, d, .. } = self.stage(s, w);
        let along = 2.0 * f * g / d; // dh/du / √G
        let bend = (2.0 * chi * g - 3.0 * h - 4.0 * chi * f * g * g / d) * along / d; // d²h/du² / G
        let (first, second) = (h * along, h * h * bend); // u h', u² h''
        Factor {
            f,
            by_z: -1.25 * chi * first,
            by_w: chi * along / v,
            by_zz: chi * (1.5625 * (first + second) + 1.25 * first),
            by_zw: -1.25 * chi * (along + h * bend) / v,
            by_ww: chi * bend / (v * v),
        }
    }

    /// The derivative of the factor by e.
    pub(crate) fn by_restitution(&self, s: f64, w: f64) -> f64 {
        if s == 0.0 && w == 0.0 {
            return 0.0;
        }
        let stage = self.stage(s, w);
        self.chi_by_e * (stage.h + self.chi * self.h_by_chi(stage))
    }

    /// `dh/dχ` at fixed S and ż: `h f / D ∂G/∂χ`, with `∂G/∂χ = -∫_h^1 s² / (1 + χ s)² ds`.
    fn h_by_chi(&self, Stage { h, f, d, .. }: Stage) -> f64 {
        let chi = self.chi;
        // f ∂G/∂χ: the integral itself grows without bound where f vanishes.
        let by_chi = if chi < SMALL {
            let (mut sum, mut sign, mut power) = (0.0, 1.0, h * h * h);
            for k in 3..TERMS + 3 {
                sum += sign * f64::from(k - 2) * (1.0 - power) / f64::from(k);
                (sign, power) = (-chi * sign, h * power);
            }
            -sum * f
        } else {
            // s - 2 ln(1 + χ s) / χ - 1 / (χ (1 + χ s)), at 1 and at h
            let upper = 1.0 - 2.0 * self.logs[0] / chi - 1.0 / (chi * (1.0 + chi));
            // f ln f, which vanishes with f: for e below 0.0013, f is zero to rounding at lift-off.
            let entropy = if f > 0.0 { f * f.ln() } else { 0.0 };
            let lower = f * h - 2.0 * entropy / chi - 1.0 / chi;
            -(f * upper - lower) / (chi * chi)
        };
        h / d * by_chi
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [f64; 10] = [1e-3, 0.01, 0.05, 0.2, 0.5, 0.7, 0.9, 0.95, 0.999, 1.0 - 1e-9];

    /// Along the undisturbed collision, integrated by the equation of h, v is the speed at touch-down.
    #[test]
    fn exact_the_stages_of_an_undisturbed_collision() {
        for e in ALL {
            let law = Restoring::new(e);
            let end = law.stage_at(-e);
            assert!(
                end.g.abs() < 1e-15 / law.chi.min(1.0) && (end.h / -e - 1.0).abs() < 1e-13,
                "{e}: {end:?}"
            );
            for v in [1e-4, 1.0, 30.0] {
                for i in 0..=200 {
                    let h = -e + (1.0 + e) * f64::from(i) / 200.0;
                    let stage = law.stage(v * v * law.stage_at(h).g.max(0.0), h * v);
                    let allowed = 2e-13 / (e * law.chi.min(1.0)).min(1.0);
                    assert!((stage.h - h).abs() < allowed, "{e} {v} {h}: {stage:?}");
                    assert!((stage.v / v - 1.0).abs() < allowed / e, "{e} {v} {h}: {stage:?}");
                }
            }
        }
    }

    /// Compares the polynomials with the equation that they replace, up to the end of their range.
    #[test]
    fn exact_polynomials_in_place_of_the_equation() {
        let every = (0..60).map(|i| LEAST.powf(1.0 - f64::from(i) / 60.0));
        for e in [0.28, 0.3, 0.32, 0.42, 0.44, 0.46, 0.48, 0.855, 0.86, 0.999].into_iter().chain(every) {
            let law = Restoring::new(e);
            let mut worst = 0.0_f64;
            for i in 0..=4000 {
                let x = -1.0 + f64::from(i) / 2000.0;
                let s = 0.5 * (1.0 - x) * (1.0 + x);
                let [a, b] = [law.stage(s, x), law.solved(s, x)];
                worst = worst.max((a.h - b.h).abs()).max((a.f - b.f).abs()).max((a.v - b.v).abs());
            }
            // The logarithm in G cancels to a relative size of e².
            let allowed = if e < 0.28 { 1e-15 / (e * e) } else { 1e-14 };
            assert!(law.is_tabulated() && worst < allowed, "{e}: {worst:e}");
            for x in [-0.99, -0.8, -0.51, -0.2, 0.1, 0.45, 0.55, 0.999] {
                for x in [[x, x + 0.001, -0.3 * x, 0.7 * x], [x, x + 0.001, 0.999 * x, 0.99 * x]] {
                    let s = x.map(|x| 0.5 * (1.0 - x) * (1.0 + x));
                    let alone: [f64; 4] = std::array::from_fn(|i| law.push(s[i], x[i]));
                    assert_eq!(law.push_of_four(f64x4::new(s), f64x4::new(x)).to_array(), alone, "{e} {x:?}");
                }
            }
        }
    }

    /// The strongest loss: the factor vanishes at lift-off, and its derivatives stay finite.
    #[test]
    fn regress_derivatives_where_the_force_vanishes_are_finite() {
        let law = Restoring::new(1e-3);
        for w in [-0.999e-3, -0.9e-3, -1e-4, 0.0, 1.0] {
            let (Factor { f, by_z, by_w, .. }, by_e) = (law.factor(1e-9, w), law.by_restitution(1e-9, w));
            assert!([f, by_z, by_w, by_e].iter().all(|number| number.is_finite()), "{w}: {f} {by_e}");
        }
    }

    /// Compares every derivative of the factor with differences.
    #[test]
    fn exact_derivatives_of_the_factor() {
        for e in [0.05, 0.3, 0.7, 0.92, 0.99] {
            let law = Restoring::new(e);
            // S = z^(5/2), so that z is the fifth root of S².
            let at = |z: f64, w: f64| law.factor(z.powf(2.5), w);
            for (z, w) in [(0.7, 1.0), (0.3, 0.2), (1.3, -0.4), (0.5, -2.0), (0.9, 0.0), (0.02, 1.0)] {
                let Factor { by_z, by_w, by_zz, by_zw, by_ww, .. } = at(z, w);
                let by_e = law.by_restitution(z.powf(2.5), w);
                let (dz, dw, de) = (1e-5 * z, 1e-5, 1e-6);
                let by_differences = [
                    z * (at(z + dz, w).f - at(z - dz, w).f) / (2.0 * dz),
                    (at(z, w + dw).f - at(z, w - dw).f) / (2.0 * dw),
                    (Restoring::new(e + de).factor(z.powf(2.5), w).f
                        - Restoring::new(e - de).factor(z.powf(2.5), w).f)
                        / (2.0 * de),
                    z * z * (at(z + dz, w).by_z / (z + dz) - at(z - dz, w).by_z / (z - dz)) / (2.0 * dz),
                    (at(z, w + dw).by_z - at(z, w - dw).by_z) / (2.0 * dw),
                    (at(z, w + dw).by_w - at(z, w - dw).by_w) / (2.0 * dw),
                ];
                for (found, expected) in
                    [by_z, by_w, by_e, by_zz, by_zw, by_ww].into_iter().zip(by_differences)
                {
                    let size = 1.0 + expected.abs();
                    assert!((found - expected).abs() < 2e-6 * size, "{e} {z} {w}: {found} {expected}");
                }
            }
        }
    }
}
