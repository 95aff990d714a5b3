//! Bounds on the stage of a contact whose restitution is the same at every speed (`crate::loss::Restoring`).
//!
//! With the acceleration `A` into the wall by all forces but that of the contact, and in the coordinate of regularised contacts,
//!
//! ```text
//! σ = q/v (-κ q³ + 2 A G / D)
//! dh/dθ = f σ      dG/dθ = -h σ      dD/dθ = 2 χ G f σ      d(1/v)/dθ = -q/v² A h / D      f = 1 + χ h
//! ```
//!
//! with `f σ = q/v (dw/dt - A h²/D)`, which is small where a wall holds the damper, as dw/dt and h are small there.
//! So `h`, `1/v`, `G` and `1/D` obey polynomial equations among themselves, and each coefficient follows from those before it.

use crate::loss::Restoring;

/// Term `k` of the product of two series.
#[inline(always)]
pub(in crate::regularised) fn product<const K: usize>(a: &[f64; K], b: &[f64; K], k: usize) -> f64 {
    let mut sum = 0.0;
    for i in 0..K.min(k + 1) {
        sum += a[i] * b[k - i];
    }
    sum
}

/// Bounds on the stages of a piece.
#[derive(Clone, Copy)]
pub struct Stages<'a> {
    law: &'a Restoring,
    /// The least and the greatest h.
    h: [f64; 2],
    /// The greatest 1/v, s/m.
    slowness: f64,
}

impl<'a> Stages<'a> {
    /// Bounds for `S` and `w` in these ranges. `v` grows with `S` and the size of `w`.
    pub fn between(law: &'a Restoring, s: [f64; 2], w: [f64; 2]) -> Self {
        let h = Self::corners(s, w).map(|[s, w]| law.stage(s, w).h);
        let slowest = law.stage(s[0], 0.0_f64.max(w[0]).min(w[1]));
        Self { law, h, slowness: 1.0 / slowest.v }
    }

    /// The `[S, w]` of the least and the greatest `h` in these ranges: `h` grows with `w`, and for a `w` of one sign it nears 0 as `S`
    /// grows.
    pub fn corners([shallow, deep]: [f64; 2], [slow, fast]: [f64; 2]) -> [[f64; 2]; 2] {
        [[if slow < 0.0 { shallow } else { deep }, slow], [if fast > 0.0 { shallow } else { deep }, fast]]
    }
}

/// Series with every term replaced by its size.
pub struct StageSeries<const K: usize> {
    chi: f64,
    h: [f64; K],
    /// 1/v.
    slowness: [f64; K],
    /// 1 + χ h.
    pub f: [f64; K],
    g: [f64; K],
    /// 1/D.
    by_d: [f64; K],
    /// What follows from them: q/v, A, 2 G / D, κ q³ + 2 A G / D, σ, f σ, h / D, A h / D, dw/dt + A h² / D, A h / (D v), and G f σ / D².
    more: [[f64; K]; 11],
}

impl<const K: usize> StageSeries<K> {
    /// From bounds on the stages.
    pub fn new(Stages { law, h: [low, high], slowness }: Stages<'_>) -> Self {
        let start = |bound: f64| {
            let mut series = [0.0; K];
            series[0] = bound;
            series
        };
        // G is greatest where h is nearest to 0, and D, which grows with h, least where h is.
        let [first, middle] = [low, 0.0_f64.max(low).min(high)].map(|h| law.stage_at(h));
        Self {
            chi: law.chi,
            h: start(low.abs().max(high.abs())),
            slowness: start(slowness),
            f: start(1.0 + law.chi * high),
            g: start(middle.g),
            by_d: start(1.0 / first.d),
            more: [[0.0; K]; 11],
        }
    }

    /// Term `k + 1` of each, from term `k` of q, of `κ q³`, of the acceleration by all but the contact, `beside`, and of dw/dt, `rate`.
    pub fn extend(&mut self, k: usize, q: &[f64; K], hertz: f64, [beside, rate]: [f64; 2]) {
        let next = 1.0 / (k + 1) as f64;
        let Self { chi, h, slowness, f, g, by_d, more } = self;
        let [along, accel, share, inner, sigma, slope, hd, turned, slower, slowed, gathered] = more;
        along[k] = product(q, slowness, k);
        accel[k] = beside;
        share[k] = 2.0 * product(g, by_d, k);
        inner[k] = hertz + product(accel, share, k);
        sigma[k] = product(along, inner, k);
        hd[k] = product(h, by_d, k);
        turned[k] = product(accel, hd, k);
        slower[k] = rate + product(turned, h, k);
        slope[k] = product(along, slower, k);
        slowed[k] = product(turned, slowness, k);
        gathered[k] = 0.5 * product(share, slope, k);
        h[k + 1] = slope[k] * next;
        f[k + 1] = *chi * h[k + 1];
        g[k + 1] = product(h, sigma, k) * next;
        slowness[k + 1] = product(along, slowed, k) * next;
        by_d[k + 1] = 2.0 * *chi * product(by_d, gathered, k) * next;
    }
}
