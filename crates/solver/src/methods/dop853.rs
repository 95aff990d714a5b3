//! DOP853, the explicit Runge–Kutta method of order 8 with error estimates of orders 5 and 3 and dense output of order 7.
//!
//! Dormand & Prince; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, 2nd ed. 1993, II.5 and the code
//! DOP853, whose coefficients and names these are. [`step`] is a step of an autonomous system, as the contacts of the hybrid
//! take it; [`Dop853`] is the whole method for any system.

use super::step::{Attempt, OneStep, POWERS};
use crate::system::System;

/// The result of a step.
pub struct Step<const L: usize> {
    /// The solution of order 8 at the end of the step.
    pub y: [f64; L],
    /// Error estimate of order 5, per unit of step length.
    pub error5: [f64; L],
    /// Error estimate of order 3, per unit of step length.
    pub error3: [f64; L],
}

/// Evaluations in one step, without the one at its start, which the caller supplies.
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
pub fn step<const L: usize>(
    f: impl Fn(&[f64; L]) -> [f64; L],
    y: &[f64; L],
    k1: &[f64; L],
    h: f64,
) -> Step<L> {
    stages(|_, y| f(y), y, k1, h).0
}

/// One step of `y' = f(c, y)`, where `c` is the elapsed share of the step, with the stages `k6 … k12`.
#[inline(always)]
#[rustfmt::skip]
fn stages<const L: usize>(
    f: impl Fn(f64, &[f64; L]) -> [f64; L], y: &[f64; L], k1: &[f64; L], h: f64,
) -> (Step<L>, [[f64; L]; 7]) {
    let k2 = f(0.05260015195876773, &stage(y, h, [(0.05260015195876773, k1)]));
    let k3 = f(0.0789002279381516, &stage(y, h, [(0.0197250569845379, k1), (0.0591751709536137, &k2)]));
    let k4 = f(0.1183503419072274, &stage(y, h, [(0.02958758547680685, k1), (0.08876275643042054, &k3)]));
    let k5 = f(0.2816496580927726, &stage(y, h, [(0.2413651341592667, k1), (-0.8845494793282861, &k3), (0.924834003261792, &k4)]));
    let k6 = f(1.0 / 3.0, &stage(y, h, [(0.037037037037037035, k1), (0.17082860872947386, &k4), (0.12546768756682242, &k5)]));
    let k7 = f(0.25, &stage(y, h, [(0.037109375, k1), (0.17025221101954405, &k4), (0.06021653898045596, &k5),
        (-0.017578125, &k6)]));
    let k8 = f(4.0 / 13.0, &stage(y, h, [(0.03709200011850479, k1), (0.17038392571223998, &k4), (0.10726203044637328, &k5),
        (-0.015319437748624402, &k6), (0.008273789163814023, &k7)]));
    let k9 = f(127.0 / 195.0, &stage(y, h, [(0.6241109587160757, k1), (-3.3608926294469414, &k4), (-0.868219346841726, &k5),
        (27.59209969944671, &k6), (20.154067550477894, &k7), (-43.48988418106996, &k8)]));
    let k10 = f(0.6, &stage(y, h, [(0.47766253643826434, k1), (-2.4881146199716677, &k4), (-0.590290826836843, &k5),
        (21.230051448181193, &k6), (15.279233632882423, &k7), (-33.28821096898486, &k8), (-0.020331201708508627, &k9)]));
    let k11 = f(6.0 / 7.0, &stage(y, h, [(-0.9371424300859873, k1), (5.186372428844064, &k4), (1.0914373489967295, &k5),
        (-8.149787010746927, &k6), (-18.52006565999696, &k7), (22.739487099350505, &k8), (2.4936055526796523, &k9),
        (-3.0467644718982196, &k10)]));
    let k12 = f(1.0, &stage(y, h, [(2.273310147516538, k1), (-10.53449546673725, &k4), (-2.0008720582248625, &k5),
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
    let end = std::array::from_fn(|i| y[i] + h * slope[i]);
    (Step { y: end, error5, error3 }, [k6, k7, k8, k9, k10, k11, k12])
}

impl<const L: usize> Step<L> {
    /// DOP853's blend of its two estimates: `|h| e5² / √(n (e5² + 0.01 e3²))`, with `e` the scaled Euclidean norms.
    ///
    /// `controlled` lists the components that count, each with the reciprocal of its tolerance; the step is accepted if the
    /// result is at most 1. NaN where the step is not finite.
    #[inline(always)]
    pub fn error<const M: usize>(&self, h: f64, controlled: [(usize, f64); M]) -> f64 {
        let norm2 = |e: &[f64; L]| controlled.iter().map(|&(i, scale)| (e[i] * scale).powi(2)).sum::<f64>();
        let (e5, e3) = (norm2(&self.error5), norm2(&self.error3));
        let denominator = e5 + 0.01 * e3;
        if denominator == 0.0 { 0.0 } else { h.abs() * e5 / (denominator * M as f64).sqrt() }
    }
}

/// The method for any system, with its dense output: three more evaluations a step, and one at its end.
pub struct Dop853;

impl<const N: usize> OneStep<N> for Dop853 {
    const POWER: f64 = 1.0 / 8.0;
    const EVALUATIONS: u64 = EVALUATIONS + 4;

    /// The error is DOP853's blend of its two estimates, taken for each component.
    #[rustfmt::skip]
    fn attempt(system: &impl System<N>, t: f64, y: &[f64; N], k1: &[f64; N], h: f64) -> Option<Attempt<N>> {
        let f = |c: f64, y: &[f64; N]| system.derivative(t + c * h, y);
        let (Step { y: end, error5, error3 }, [k6, k7, k8, k9, k10, k11, k12]) = stages(f, y, k1, h);
        let k13 = f(1.0, &end);
        let k14 = f(0.1, &stage(y, h, [(0.056167502283047954, k1), (0.25350021021662483, &k7),
            (-0.2462390374708025, &k8), (-0.12419142326381637, &k9), (0.15329179827876568, &k10),
            (0.00820105229563469, &k11), (0.007567897660545699, &k12), (-0.008298, &k13)]));
        let k15 = f(0.2, &stage(y, h, [(0.03183464816350214, k1), (0.028300909672366776, &k6),
            (0.053541988307438566, &k7), (-0.05492374857139099, &k8), (-0.00010834732869724932, &k11),
            (0.0003825710908356584, &k12), (-0.00034046500868740456, &k13), (0.1413124436746325, &k14)]));
        let k16 = f(7.0 / 9.0, &stage(y, h, [(-0.42889630158379194, k1), (-4.697621415361164, &k6),
            (7.683421196062599, &k7), (4.06898981839711, &k8), (0.3567271874552811, &k9),
            (-0.0013990241651590145, &k13), (2.9475147891527724, &k14), (-9.15095847217987, &k15)]));
        let tail = [k1, &k6, &k7, &k8, &k9, &k10, &k11, &k12, &k13, &k14, &k15, &k16];
        let weighted = |d: &[f64; 12], i: usize| (0..12).map(|j| d[j] * tail[j][i]).sum::<f64>();
        let blend = |i: usize| {
            let (e5, e3) = (error5[i] * error5[i], error3[i] * error3[i]);
            if e5 == 0.0 { 0.0 } else { h * e5 / (e5 + 0.01 * e3).sqrt() }
        };
        let mut dense = [[0.0; N]; POWERS];
        for i in 0..N {
            let chord = (end[i] - y[i]) / h;
            let (f1, f2) = (k1[i] - chord, 2.0 * chord - k1[i] - k13[i]);
            let mut powers = [0.0; POWERS + 1];
            // y + s h (chord + (1-s) (f1 + s (f2 + (1-s) (d0 + s (d1 + (1-s) (d2 + s d3))))))
            let factors = [chord, f1, f2, weighted(&D[0], i), weighted(&D[1], i), weighted(&D[2], i), weighted(&D[3], i)];
            for (depth, factor) in factors.into_iter().enumerate().rev() {
                powers[0] += factor;
                times(&mut powers, depth % 2 == 1);
            }
            for (j, coefficient) in dense.iter_mut().enumerate() {
                coefficient[i] = powers[j + 1];
            }
        }
        Some(Attempt { y: end, slope: k13, error: std::array::from_fn(blend), dense })
    }
}

/// Multiplies a polynomial by `1 - s`, or by `s`.
fn times(powers: &mut [f64; POWERS + 1], one_minus: bool) {
    for j in (1..=POWERS).rev() {
        powers[j] = if one_minus { powers[j] - powers[j - 1] } else { powers[j - 1] };
    }
    if !one_minus {
        powers[0] = 0.0;
    }
}

/// Weights of `k1, k6, …, k16` in the last four terms of the dense output.
#[rustfmt::skip]
const D: [[f64; 12]; 4] = [
    [-8.428938276109013, 0.5667149535193777, -3.0689499459498917, 2.38466765651207, 2.117034582445028, -0.871391583777973,
        2.2404374302607883, 0.6315787787694688, -0.08899033645133331, 18.148505520854727, -9.194632392478356,
        -4.436036387594894],
    [10.427508642579134, 242.28349177525817, 165.20045171727028, -374.5467547226902, -22.113666853125306,
        7.733432668472264, -30.674084731089398, -9.332130526430229, 15.697238121770845, -31.139403219565178,
        -9.35292435884448, 35.81684148639408],
    [19.985053242002433, -387.0373087493518, -189.17813819516758, 527.8081592054236, -11.57390253995963,
        6.8812326946963, -1.0006050966910838, 0.7777137798053443, -2.778205752353508, -60.19669523126412,
        84.32040550667716, 11.99229113618279],
    [-25.69393346270375, -154.18974869023643, -231.5293791760455, 357.6391179106141, 93.40532418362432,
        -37.45832313645163, 104.0996495089623, 29.8402934266605, -43.53345659001114, 96.32455395918828,
        -39.17726166561544, -149.72683625798564],
];
