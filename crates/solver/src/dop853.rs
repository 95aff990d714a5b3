//! One step of DOP853, the explicit Runge–Kutta method of order 8 with error estimates of orders 5 and 3.
//!
//! Dormand & Prince; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, 2nd ed. 1993, II.5 and the code
//! DOP853, whose coefficients and names these are. For autonomous systems: the nodes `c` are not needed.

/// The result of a step.
pub struct Step<const L: usize> {
    /// The solution of order 8 at the end of the step.
    pub y: [f64; L],
    /// Error estimate of order 5, per unit of step length.
    pub error5: [f64; L],
    /// Error estimate of order 3, per unit of step length.
    pub error3: [f64; L],
}

/// Evaluations that one step makes beside the one at its start, which the caller hands over.
pub const EVALUATIONS: u64 = 11;

/// Order of the method.
pub const ORDER: i32 = 8;

/// `y + h Σ a k`.
#[inline(always)]
fn stage<const L: usize, const M: usize>(y: &[f64; L], h: f64, terms: [(f64, &[f64; L]); M]) -> [f64; L] {
    let sum = combine(terms);
    std::array::from_fn(|i| y[i] + h * sum[i])
}

/// `Σ a k`.
#[inline(always)]
fn combine<const L: usize, const M: usize>(terms: [(f64, &[f64; L]); M]) -> [f64; L] {
    let mut sum = [0.0; L];
    for (a, k) in terms {
        for i in 0..L {
            sum[i] += a * k[i];
        }
    }
    sum
}

/// One step of length `h` from `y` of `y' = f(y)`, with `k1 = f(y)`.
#[inline(always)]
#[rustfmt::skip]
pub fn step<const L: usize>(f: impl Fn(&[f64; L]) -> [f64; L], y: &[f64; L], k1: &[f64; L], h: f64) -> Step<L> {
    let k2 = f(&stage(y, h, [(0.05260015195876773, k1)]));
    let k3 = f(&stage(y, h, [(0.0197250569845379, k1), (0.0591751709536137, &k2)]));
    let k4 = f(&stage(y, h, [(0.02958758547680685, k1), (0.08876275643042054, &k3)]));
    let k5 = f(&stage(y, h, [(0.2413651341592667, k1), (-0.8845494793282861, &k3), (0.924834003261792, &k4)]));
    let k6 = f(&stage(y, h, [(0.037037037037037035, k1), (0.17082860872947386, &k4), (0.12546768756682242, &k5)]));
    let k7 = f(&stage(y, h, [(0.037109375, k1), (0.17025221101954405, &k4), (0.06021653898045596, &k5),
        (-0.017578125, &k6)]));
    let k8 = f(&stage(y, h, [(0.03709200011850479, k1), (0.17038392571223998, &k4), (0.10726203044637328, &k5),
        (-0.015319437748624402, &k6), (0.008273789163814023, &k7)]));
    let k9 = f(&stage(y, h, [(0.6241109587160757, k1), (-3.3608926294469414, &k4), (-0.868219346841726, &k5),
        (27.59209969944671, &k6), (20.154067550477894, &k7), (-43.48988418106996, &k8)]));
    let k10 = f(&stage(y, h, [(0.47766253643826434, k1), (-2.4881146199716677, &k4), (-0.590290826836843, &k5),
        (21.230051448181193, &k6), (15.279233632882423, &k7), (-33.28821096898486, &k8), (-0.020331201708508627, &k9)]));
    let k11 = f(&stage(y, h, [(-0.9371424300859873, k1), (5.186372428844064, &k4), (1.0914373489967295, &k5),
        (-8.149787010746927, &k6), (-18.52006565999696, &k7), (22.739487099350505, &k8), (2.4936055526796523, &k9),
        (-3.0467644718982196, &k10)]));
    let k12 = f(&stage(y, h, [(2.273310147516538, k1), (-10.53449546673725, &k4), (-2.0008720582248625, &k5),
        (-17.9589318631188, &k6), (27.94888452941996, &k7), (-2.8589982771350235, &k8), (-8.87285693353063, &k9),
        (12.360567175794303, &k10), (0.6433927460157636, &k11)]));
    let slope = combine([(0.054293734116568765, k1), (4.450312892752409, &k6), (1.8915178993145003, &k7),
        (-5.801203960010585, &k8), (0.3111643669578199, &k9), (-0.1521609496625161, &k10), (0.20136540080403034, &k11),
        (0.04471061572777259, &k12)]);
    let error5 = combine([(0.01312004499419488, k1), (-1.2251564463762044, &k6), (-0.4957589496572502, &k7),
        (1.6643771824549864, &k8), (-0.35032884874997366, &k9), (0.3341791187130175, &k10), (0.08192320648511571, &k11),
        (-0.022355307863886294, &k12)]);
    let error3 = combine([(1.0, &slope), (-0.2440944881889764, k1), (-0.7338466882816119, &k9),
        (-0.022058823529411766, &k12)]);
    Step { y: std::array::from_fn(|i| y[i] + h * slope[i]), error5, error3 }
}

impl<const L: usize> Step<L> {
    /// DOP853's blend of its two estimates: `|h| e5² / √(n (e5² + 0.01 e3²))`, with `e` the scaled Euclidean norms.
    ///
    /// `controlled` lists the components that count, each with the reciprocal of its tolerance; the step is good where the
    /// result is at most 1. NaN where the step is not finite.
    #[inline(always)]
    pub fn error<const M: usize>(&self, h: f64, controlled: [(usize, f64); M]) -> f64 {
        let norm2 = |e: &[f64; L]| controlled.iter().map(|&(i, scale)| (e[i] * scale).powi(2)).sum::<f64>();
        let (e5, e3) = (norm2(&self.error5), norm2(&self.error3));
        let denominator = e5 + 0.01 * e3;
        if denominator == 0.0 { 0.0 } else { h.abs() * e5 / (denominator * M as f64).sqrt() }
    }
}
