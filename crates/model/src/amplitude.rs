//! The catalogue of harmonic forcings, by the quantity of which the amplitude is given.

/// The quantity of which a harmonic forcing gives the amplitude. Two facts determine its effect: whether it is a force on the structure or
/// a motion of its base, and the power of the angular frequency ω with which the force (N), or the displacement of the base (m), grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Amplitude {
    /// A force P cos ωt on the structure: P, N.
    Force,
    /// A rotating imbalance of the structure: m e, the mass (part of m1) times its distance from the axis, kg·m. It is the force
    /// m e ω² cos ωt.
    Imbalance,
    /// A base that moves by Y cos ωt: Y, m. On the structure it acts as the force k1 y + c1 dy/dt.
    Base,
    /// A base that moves by Y cos ωt with Y = a / ω², so that its acceleration has the amplitude a at every frequency: a, m/s².
    BaseAcceleration,
}

impl Amplitude {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Force, Self::Imbalance, Self::Base, Self::BaseAcceleration];

    /// Whether it moves the base, the power of ω, and the words before its size.
    const fn entry(self) -> (bool, i32, &'static str) {
        match self {
            Self::Force => (false, 0, "a force of"),
            Self::Imbalance => (false, 2, "an imbalance of"),
            Self::Base => (true, 0, "a base that moves by"),
            Self::BaseAcceleration => (true, -2, "a base that is accelerated by"),
        }
    }

    /// Whether it is a motion of the base.
    pub const fn is_of_base(self) -> bool {
        self.entry().0
    }

    /// The power of ω with which the force, or the displacement of the base, grows.
    pub const fn power(self) -> i32 {
        self.entry().1
    }

    /// What it is, before its size: "a force of".
    pub const fn words(self) -> &'static str {
        self.entry().2
    }

    /// The amplitude of the force, N, or of the displacement of the base, m, at the angular frequency `omega`, rad/s.
    pub fn at(self, size: f64, omega: f64) -> f64 {
        by_power(size, omega, self.power())
    }
}

/// A value times a power of another.
pub(crate) fn by_power(value: f64, by: f64, power: i32) -> f64 {
    match power {
        ..0 => value / by.powi(-power),
        _ => (0..power).fold(value, |value, _| value * by),
    }
}
