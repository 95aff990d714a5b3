//! Integrals of several functions at once, by the rule of Gauss and Kronrod on pieces that are halved until its two sums agree.

/// Nodes of the rule of 15 points on (-1, 1) from the middle outwards, their weights, and those of the rule of 7 points among them:
/// R. Piessens et al., QUADPACK, 1983.
const NODES: [f64; 8] = [
    0.0,
    0.207_784_955_007_898_47,
    0.405_845_151_377_397_2,
    0.586_087_235_467_691_1,
    0.741_531_185_599_394_4,
    0.864_864_423_359_769_1,
    0.949_107_912_342_758_5,
    0.991_455_371_120_812_6,
];
const KRONROD: [f64; 8] = [
    0.209_482_141_084_727_82,
    0.204_432_940_075_298_9,
    0.190_350_578_064_785_4,
    0.169_004_726_639_267_9,
    0.140_653_259_715_525_92,
    0.104_790_010_322_250_18,
    0.063_092_092_629_978_55,
    0.022_935_322_010_529_224,
];
const GAUSS: [f64; 8] = [
    0.417_959_183_673_469_4,
    0.0,
    0.381_830_050_505_118_9,
    0.0,
    0.279_705_391_489_276_64,
    0.0,
    0.129_484_966_168_869_7,
    0.0,
];

/// Maximum number of pieces: an integral that needs more is taken to diverge.
const MOST: usize = 4000;
/// Smallest tolerance: below it rounding dominates.
const LEAST: f64 = 1e-12;

/// A piece with its integrals and the differences between both rules.
struct Piece<const N: usize> {
    ends: [f64; 2],
    values: [f64; N],
    errors: [f64; N],
}

impl<const N: usize> Piece<N> {
    fn new(of: &impl Fn(f64) -> [f64; N], ends: [f64; 2]) -> Self {
        let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        let (mut values, mut gauss) = ([0.0; N], [0.0; N]);
        for (i, node) in NODES.into_iter().enumerate() {
            for sign in if i == 0 { &[1.0][..] } else { &[-1.0, 1.0] } {
                let at = of(middle + sign * half * node);
                for k in 0..N {
                    values[k] += half * KRONROD[i] * at[k];
                    gauss[k] += half * GAUSS[i] * at[k];
                }
            }
        }
        Self { ends, values, errors: std::array::from_fn(|k| (values[k] - gauss[k]).abs()) }
    }

    fn halves(&self, of: &impl Fn(f64) -> [f64; N]) -> [Self; 2] {
        let [from, to] = self.ends;
        let middle = 0.5 * (from + to);
        [Self::new(of, [from, middle]), Self::new(of, [middle, to])]
    }
}

fn sum<const N: usize>(pieces: &[Piece<N>], of: impl Fn(&Piece<N>) -> &[f64; N]) -> [f64; N] {
    std::array::from_fn(|k| pieces.iter().map(|piece| of(piece)[k]).sum())
}

/// Integrals of non-negative functions over the range of `nodes`, which separate the first pieces, and the largest relative difference of
/// both rules, at most `tolerance`. None where that takes too many pieces.
pub(super) fn integral<const N: usize>(
    of: impl Fn(f64) -> [f64; N],
    nodes: &[f64],
    tolerance: f64,
) -> Option<([f64; N], f64)> {
    let ends = nodes.windows(2).filter(|pair| pair[0] < pair[1]);
    let mut pieces: Vec<Piece<N>> = ends.map(|pair| Piece::new(&of, [pair[0], pair[1]])).collect();
    let tolerance = tolerance.max(LEAST);
    while pieces.len() <= MOST {
        let (values, errors) = (sum(&pieces, |piece| &piece.values), sum(&pieces, |piece| &piece.errors));
        let shares = |errors: &[f64; N]| {
            (0..N)
                .map(|k| if values[k] == 0.0 { errors[k] } else { errors[k] / values[k] })
                .fold(0.0, f64::max)
        };
        if !values.iter().chain(&errors).all(|one| one.is_finite()) {
            return None;
        }
        let error = shares(&errors);
        if error <= tolerance {
            return Some((values, error));
        }
        let most = 0.5 * tolerance / pieces.len() as f64;
        let halved = pieces.into_iter().flat_map(|piece| {
            if shares(&piece.errors) > most { Vec::from(piece.halves(&of)) } else { vec![piece] }
        });
        pieces = halved.collect();
    }
    None
}
