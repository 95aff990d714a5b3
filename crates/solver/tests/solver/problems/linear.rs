//! Forced linear motion by another way than the solver's: Padé's matrix exponential of the system joined with its force, and
//! the largest value of a smooth function by sampling and golden sections.

use nalgebra::{DMatrix, DVector, SMatrix};
use retune_testkit::scenes::Numbers;

/// A linear system with its force as two more components: `u = (y - rest, cos ωt, sin ωt)`, `u' = M u`.
pub struct Joined<const N: usize> {
    matrix: DMatrix<f64>,
    rest: [f64; N],
    omega: f64,
}

impl<const N: usize> Joined<N> {
    fn new((a, b): (SMatrix<f64, N, N>, [f64; N]), rest: [f64; N], p: f64, omega: f64) -> Self {
        let mut matrix = DMatrix::zeros(N + 2, N + 2);
        for i in 0..N {
            (0..N).for_each(|j| matrix[(i, j)] = a[(i, j)]);
            matrix[(i, N)] = b[i] * p;
        }
        (matrix[(N, N + 1)], matrix[(N + 1, N)]) = (-omega, omega);
        Self { matrix, rest, omega }
    }

    /// The state `s` seconds after it was `y` at time `t`.
    pub fn after(&self, t: f64, y: [f64; N], s: f64) -> [f64; N] {
        self.out(&(self.flow(s) * self.joined(t, y)))
    }

    /// The states `k h` seconds after it was `y` at time `t`, `k = 0 ..= n`.
    pub fn grid(&self, t: f64, y: [f64; N], h: f64, n: usize) -> Vec<[f64; N]> {
        let (flow, mut u) = (self.flow(h), self.joined(t, y));
        let mut states = vec![y];
        for k in 1..=n {
            u = &flow * u;
            let angle = self.omega * (t + k as f64 * h);
            (u[N], u[N + 1]) = (angle.cos(), angle.sin());
            states.push(self.out(&u));
        }
        states
    }

    fn flow(&self, s: f64) -> DMatrix<f64> {
        (&self.matrix * s).exp()
    }

    fn joined(&self, t: f64, y: [f64; N]) -> DVector<f64> {
        let (sin, cos) = (self.omega * t).sin_cos();
        DVector::from_iterator(N + 2, (0..N).map(|i| y[i] - self.rest[i]).chain([cos, sin]))
    }

    fn out(&self, u: &DVector<f64>) -> [f64; N] {
        std::array::from_fn(|i| self.rest[i] + u[i])
    }

    /// The largest value of `quantity` over `from ..= to` of the motion that was `y` at time 0, and when.
    pub fn largest(
        &self,
        y: [f64; N],
        [from, to]: [f64; 2],
        quantity: impl Fn(&[f64; N]) -> f64,
    ) -> (f64, f64) {
        let n = ((to - from) / 0.01).ceil() as usize;
        let h = (to - from) / n as f64;
        let grid = self.grid(from, self.after(0.0, y, from), h, n);
        let value = |k: usize| quantity(&grid[k]);
        let top = (0..=n).map(value).fold(0.0, f64::max);
        let mut best = (f64::NEG_INFINITY, 0.0);
        let highest = |k: usize| value(k) >= value(k.saturating_sub(1)) && value(k) >= value((k + 1).min(n));
        for k in (0..=n).filter(|&k| value(k) > 0.99 * top && highest(k)) {
            let (left, right) = (if k == 0 { 0.0 } else { -h }, if k == n { 0.0 } else { h });
            let t = from + k as f64 * h;
            let (s, found) = golden([left, right], |s| quantity(&self.after(t, grid[k], s)));
            if found > best.0 {
                best = (found, t + s);
            }
        }
        best
    }
}

/// Where and how large a function with one maximum on an interval is.
pub fn golden([mut a, mut b]: [f64; 2], f: impl Fn(f64) -> f64) -> (f64, f64) {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let [mut c, mut d] = [b - ratio * (b - a), a + ratio * (b - a)];
    let [mut at_c, mut at_d] = [f(c), f(d)];
    for _ in 0..40 {
        if at_c > at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - ratio * (b - a);
            at_c = f(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + ratio * (b - a);
            at_d = f(d);
        }
    }
    [(a, f(a)), (b, f(b)), (c, at_c), (d, at_d)]
        .into_iter()
        .fold((a, f64::NEG_INFINITY), |best, x| if x.1 > best.1 { x } else { best })
}

/// The coupled system of a scene without its walls.
pub fn joined(numbers: &Numbers) -> Joined<4> {
    let system = numbers.coupled();
    Joined::new(system.linear_part(), system.rest(), numbers.p, numbers.omega)
}
