//! The paper's scenes, and variations of them, for the tests of every crate.
#![allow(clippy::approx_constant, reason = "the paper's 6.28 and 0.318 are not 2π and 1/π")]

use retune_model::{
    Amplitude, Bare, Bounce, Contact, Coupled, Damper, Forcing, Loss, NonNegative, PoissonRatio, Positive,
    Primary, RegularisedContact, RegularisedState, Restitution, Rigid, Scene, Source, Surfaces,
};

/// A scene as plain numbers in the paper's symbols and SI units, to be varied by `..`.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the paper's symbols")]
pub struct Numbers {
    pub m1: f64,
    pub c1: f64,
    pub k1: f64,
    pub p: f64,
    pub omega: f64,
    pub m2: f64,
    pub k2: f64,
    pub c2: f64,
    pub d: f64,
    pub c: f64,
    pub r: f64,
    pub q: f64,
    /// Young's moduli E1 … E4, N/m².
    pub young: [f64; 4],
    /// λ of contacts that lose energy, s/m.
    pub lambda: f64,
    /// Restitution at every speed; 1 if λ is given.
    pub e: f64,
    /// The restitution of contacts with the obstacle, if it differs.
    pub e_obstacle: Option<f64>,
    /// Restitution of rigid walls, which then replace the surfaces.
    pub rigid: Option<f64>,
}

/// Table 2, the tuned single-sided vibro-impact damper.
pub const SSVI: Numbers = Numbers {
    m1: 1000.0,
    c1: 452.0,
    k1: 3.95e4,
    p: 800.0,
    omega: 6.28,
    m2: 60.0,
    k2: 215.0,
    c2: 232.0,
    d: 0.06,
    c: 0.36,
    r: 2.0,
    q: 0.318,
    young: [2.1e11, 2.21e7, 2.1e11, 2.05e7],
    lambda: 0.0,
    e: 1.0,
    e_obstacle: None,
    rigid: None,
};

/// Table 2, the tuned mass damper: its walls are out of reach.
pub const TMD: Numbers = Numbers { k2: 600.0, c2: 262.0, d: 2.08, c: 4.7, ..SSVI };

/// Table 1, row 1.
pub const ROW1: Numbers = Numbers { k2: 150.0, c2: 218.4, c: 0.11, ..SSVI };

/// Table 1, row 2.
pub const ROW2: Numbers = Numbers { k2: 210.0, ..ROW1 };

/// Table 1, row 3.
pub const ROW3: Numbers = Numbers { k2: 220.375, c2: 233.45, d: 0.060375, c: 0.36225, ..SSVI };

/// Both walls within reach.
pub const TWO_SIDED: Numbers = Numbers { k2: 2400.0, c2: 100.0, d: 0.1, c: 0.1, ..SSVI };

/// [`TWO_SIDED`] with contacts that lose energy: at 1 m/s a restitution of 0.79.
pub const LOSSY: Numbers = Numbers { lambda: 0.4, ..TWO_SIDED };

/// [`TWO_SIDED`] with one restitution at every speed.
pub const RESTORING: Numbers = Numbers { e: 0.7, ..TWO_SIDED };

/// Rigid walls with this restitution.
///
/// # Panics
/// It is not in [0, 1].
pub fn rigid(e: f64) -> Contact {
    Contact::Rigid(Rigid { restitution: Bounce::new(e).expect("in [0, 1]") })
}

/// The kinds of harmonic forcing, with amplitudes of similar effect: N, kg·m, m and m/s².
pub const DRIVEN: [(Amplitude, f64); 4] = [
    (Amplitude::Force, 800.0),
    (Amplitude::Imbalance, 20.0),
    (Amplitude::Base, 0.02),
    (Amplitude::BaseAcceleration, 0.8),
];

impl Numbers {
    /// The loss of contacts.
    fn loss(&self) -> Loss {
        if self.e < 1.0 {
            Loss::Restoring(Restitution::new(self.e).expect("above 0"))
        } else {
            Loss::Damping(non_negative(self.lambda))
        }
    }

    /// The structure.
    pub fn primary(&self) -> Primary {
        Primary { mass: positive(self.m1), damping: non_negative(self.c1), stiffness: non_negative(self.k1) }
    }

    /// The force on it.
    pub fn forcing(&self) -> Forcing {
        Forcing::force(non_negative(self.p), non_negative(self.omega))
    }

    /// The damper with both of its walls.
    pub fn damper(&self) -> Damper {
        let poisson = |value| PoissonRatio::new(value).expect("a Poisson's ratio");
        let [young_1, young_2, young_3, young_4] = self.young.map(positive);
        let (metal, rubber) = (poisson(0.3), poisson(0.4));
        Damper {
            mass: positive(self.m2),
            stiffness: non_negative(self.k2),
            damping: non_negative(self.c2),
            rest_distance: non_negative(self.d),
            clearance: non_negative(self.c),
            contact: Some(self.rigid.map(rigid).unwrap_or(Contact::Hertz(Surfaces {
                radius: positive(self.r),
                coefficient: positive(self.q),
                young_1,
                poisson_1: metal,
                young_2,
                poisson_2: rubber,
                young_3,
                poisson_3: metal,
                young_4,
                poisson_4: rubber,
                loss: self.loss(),
                loss_obstacle:
                    self.e_obstacle.map(|e| Loss::Restoring(Restitution::new(e).expect("above 0"))),
                strength: None,
                density: None,
            }))),
        }
    }

    /// The whole scene.
    pub fn scene(&self) -> Scene {
        Scene { primary: self.primary(), forcing: self.forcing(), damper: Some(self.damper()) }
    }

    /// The scene with a damper that has no walls.
    pub fn open_scene(&self) -> Scene {
        let none = NonNegative::default();
        let damper = Damper { rest_distance: none, clearance: none, contact: None, ..self.damper() };
        Scene { damper: Some(damper), ..self.scene() }
    }

    /// The scene without a damper.
    pub fn bare_scene(&self) -> Scene {
        Scene { damper: None, ..self.scene() }
    }

    /// The scene with another kind of forcing of amplitude `p`.
    pub fn forced_by(&self, amplitude: Amplitude) -> Scene {
        let forcing = Forcing {
            source: Source::Harmonic(amplitude, non_negative(self.p)),
            frequency: non_negative(self.omega),
            start: None,
        };
        Scene { forcing, ..self.scene() }
    }

    /// The equations of the structure with its damper.
    pub fn coupled(&self) -> Coupled {
        Coupled::new(&self.primary(), &self.forcing(), &self.damper())
    }

    /// The equations of the structure alone.
    pub fn bare(&self) -> Bare {
        Bare::new(&self.primary(), &self.forcing())
    }
}

fn positive(value: f64) -> Positive {
    Positive::new(value).expect("a positive number")
}

fn non_negative(value: f64) -> NonNegative {
    NonNegative::new(value).expect("a number not below zero")
}

/// Numbers spread evenly over (0, 1), the same in every run (Marsaglia's xorshift64*).
pub struct Spread(u64);

impl Spread {
    /// Other numbers for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// The next number in (0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// The next number in (-1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// The next number between two positive ones, evenly on a logarithmic scale.
    pub fn logarithmic(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    /// A state `[x1, v1, x2, v2]` of usual size in which the damper is `r` (m) ahead of the structure.
    pub fn state(&mut self, r: f64) -> [f64; 4] {
        let (x1, v1, v2) = (0.1 * self.signed(), 0.6 * self.signed(), 1.5 * self.signed());
        [x1, v1, x1 + r, v2]
    }
}

/// One step of the classical Runge–Kutta method in `θ`.
pub fn advance(equations: &RegularisedContact, y: &RegularisedState, h: f64) -> RegularisedState {
    let along =
        |k: &RegularisedState, h: f64| -> RegularisedState { std::array::from_fn(|i| y[i] + h * k[i]) };
    let a = equations.derivative(y);
    let b = equations.derivative(&along(&a, 0.5 * h));
    let c = equations.derivative(&along(&b, 0.5 * h));
    let d = equations.derivative(&along(&c, h));
    along(&std::array::from_fn(|i| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0), h)
}

/// `df/ds` at `s = 0`, by central differences of order 8 with spacing `h`.
pub fn slope<const N: usize>(h: f64, f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let mut sum = [0.0; N];
    for (k, weight) in weights.into_iter().enumerate() {
        let s = (k + 1) as f64 * h;
        let (ahead, behind) = (f(s), f(-s));
        for i in 0..N {
            sum[i] += weight * (ahead[i] - behind[i]) / h;
        }
    }
    sum
}
