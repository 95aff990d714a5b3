//! The primary structure alone: equation (1) without a damper, one degree of freedom.

use crate::{Excitation, Forcing, History, Of, Primary, SampledForce, Source, Start, Stretch};
use nalgebra::{Complex, SMatrix};

/// The bare primary structure. Its state is `[x1, v1]` (m, m/s).
#[derive(Clone, Copy, Debug)]
pub struct Bare {
    pub(crate) m1: f64,
    pub(crate) c1: f64,
    pub(crate) k1: f64,
    /// The force `f` and its partner `s` obey `df/dt = -ω s` and `ds/dt = ω f`, the second with 0 in the place of ω where the force is linear
    /// in time; rad/s.
    pub(crate) omega: f64,
    pub(crate) returns: f64,
    frequency: f64,
    source: Source,
    /// Where the motion starts away from rest.
    pub(crate) away: Option<Start>,
    /// Amplitude of the force at ω, N, and its phase, rad: φ, and by how much the force leads the motion of a base.
    amplitude: f64,
    phase: f64,
    lead: f64,
    /// The stretch of time to which it is confined, see [`Self::during`].
    stays: Option<Stretch>,
}

impl Bare {
    /// Collects the numbers of a structure and its forcing.
    pub fn new(primary: &Primary, forcing: &Forcing) -> Self {
        let bare = Self {
            m1: primary.mass.get(),
            c1: primary.damping.get(),
            k1: primary.stiffness.get(),
            omega: forcing.frequency.get(),
            returns: forcing.frequency.get(),
            frequency: forcing.frequency.get(),
            source: forcing.source,
            away: forcing.start(),
            amplitude: 0.0,
            phase: 0.0,
            lead: 0.0,
            stays: None,
        };
        if let Source::History(history) = forcing.source {
            let [omega, returns] = history.course.turning();
            return Self {
                omega,
                returns,
                frequency: 0.0,
                amplitude: bare.force_of(&history).abs() * history.course.bounds()[0],
                ..bare
            };
        }
        let [amplitude, lead] = bare.amplitude_and_lead(bare.omega);
        Self { amplitude, lead, ..bare }
    }

    /// The amplitude of the force at the angular frequency `omega`, N, and by how much it leads, rad. A base that moves by `y` pushes
    /// the structure by `k1 y + c1 dy/dt`.
    fn amplitude_and_lead(&self, omega: f64) -> [f64; 2] {
        let Source::Harmonic(of, size) = self.source else { return [0.0; 2] };
        let size = of.at(size.get(), omega);
        if of.is_of_base() {
            [size * self.k1.hypot(omega * self.c1), (omega * self.c1).atan2(self.k1)]
        } else {
            [size, 0.0]
        }
    }

    /// The force per unit of a history: an acceleration a of the base is the force -m1 a in coordinates that move with it.
    fn force_of(&self, history: &History) -> f64 {
        match history.of {
            Of::Force => 1.0,
            Of::BaseAcceleration => -self.m1,
        }
    }

    /// The history that forces it, if one does.
    pub fn history(&self) -> Option<&History> {
        self.source.history()
    }

    /// Whether the coordinates move with a base that is accelerated: every mass then feels a force in proportion to it.
    pub fn moves_with_base(&self) -> bool {
        self.history().is_some_and(|history| history.of == Of::BaseAcceleration)
    }

    /// The stretch of time at `t` (s) in which the force goes on as one solution of its equation, with the force at its start; at a jump the
    /// stretch that begins there. None for a harmonic force, which has a single one.
    pub fn stretch(&self, t: f64) -> Option<Stretch> {
        let history = self.history()?;
        if self.stays.is_some() {
            return self.stays;
        }
        let (stretch, unit) = (history.course.stretch(t), self.force_of(history));
        Some(Stretch { begin: stretch.begin.map(|of| unit * of), ..stretch })
    }

    /// The force at time `t` (s) of a stretch, as [`Self::excitation`].
    pub fn excitation_in(&self, stretch: &Stretch, t: f64) -> Excitation {
        self.turned(stretch.begin, t - stretch.from)
    }

    /// `[P cos(ωt + φ), P sin(ωt + φ)]` (N), or its counterpart under a history, `elapsed` seconds after it was `[f, s]`.
    pub fn turned(&self, [f, s]: Excitation, elapsed: f64) -> Excitation {
        if [f, s] == [0.0; 2] {
            return [0.0; 2];
        }
        if self.returns == 0.0 {
            return [f - self.omega * s * elapsed, s];
        }
        let (sin, cos) = (self.omega * elapsed).sin_cos();
        [f * cos - s * sin, s * cos + f * sin]
    }

    /// The samples of the force, if it has any.
    pub fn sampled_force(&self) -> Option<SampledForce> {
        let history = self.history()?;
        Some(SampledForce::new(history.course.samples()?, self.force_of(history)))
    }

    /// The time (s) until which samples set the steps of a flight, see [`Course::paced_until`](crate::Course::paced_until).
    pub fn paced_until(&self) -> f64 {
        self.history().map_or(f64::INFINITY, |history| history.course.paced_until())
    }

    /// This structure as if one of its stretches of time never ended.
    #[must_use]
    pub fn during(self, stretch: Stretch) -> Self {
        Self { stays: Some(Stretch { to: f64::INFINITY, ..stretch }), ..self }
    }

    /// The largest force, N, and the largest rate of it where it has one, N/s.
    pub fn force_bounds(&self) -> [f64; 2] {
        match self.history() {
            Some(history) => history.course.bounds().map(|bound| self.force_of(history).abs() * bound),
            None => [self.amplitude, self.amplitude * self.omega],
        }
    }

    /// The two factors ω of `df/dt = -ω s` and `ds/dt = ω f`, rad/s; the second is 0 where the force is linear in time.
    pub fn turning(&self) -> [f64; 2] {
        [self.omega, self.returns]
    }

    /// The forcing's kind and size.
    pub fn source(&self) -> Source {
        self.source
    }

    /// Whether the base moves, so that its force goes through the ground.
    pub fn is_on_moving_base(&self) -> bool {
        self.source.is_moving_base()
    }

    /// This structure under the force `P cos(ωt + φ)`, or on a base that moves by `Y cos(ωt + φ)`, φ in rad. Time still begins at 0.
    #[must_use]
    pub fn with_phase(self, phase: f64) -> Self {
        Self { phase, ..self }
    }

    /// This structure with another mass, under the same force.
    pub(crate) fn with_mass(self, m1: f64) -> Self {
        Self { m1, ..self }
    }

    /// m1, kg.
    pub fn mass(&self) -> f64 {
        self.m1
    }

    /// Angular frequency ω of the force, rad/s; 0 where it has none.
    pub fn frequency(&self) -> f64 {
        self.frequency
    }

    /// `[P cos(ωt + φ), P sin(ωt + φ)]` at time `t` (s), N, with the amplitude and the phase of whatever forces the structure.
    pub fn excitation(&self, t: f64) -> Excitation {
        if let Some(stretch) = self.stretch(t) {
            return self.excitation_in(&stretch, t);
        }
        let (sin, cos) = (self.omega * t + (self.phase + self.lead)).sin_cos();
        [self.amplitude * cos, self.amplitude * sin]
    }

    /// The complex amplitude `P e^{iφ}` of the force at the angular frequency `omega`, N.
    pub(crate) fn force(&self, omega: f64) -> Complex<f64> {
        let [amplitude, lead] = self.amplitude_and_lead(omega);
        Complex::from_polar(amplitude, self.phase + lead)
    }

    /// State at rest, `[0, 0]`.
    pub fn rest(&self) -> [f64; 2] {
        [0.0; 2]
    }

    /// State at t = 0: at rest unless the forcing has a start.
    pub fn start(&self) -> [f64; 2] {
        self.away.map_or(self.rest(), |start| [start.x1.get(), start.v1.get()])
    }

    /// Equation (1) without a damper: `[v1, a1]`, m/s and m/s².
    pub fn derivative(&self, [cos, _]: Excitation, &[x1, v1]: &[f64; 2]) -> [f64; 2] {
        [v1, (cos - self.c1 * v1 - self.k1 * x1) / self.m1]
    }

    /// The system matrix `A` of `y' = A y + b P cos ωt`, and `b`.
    pub fn linear_part(&self) -> (SMatrix<f64, 2, 2>, [f64; 2]) {
        let a = SMatrix::<f64, 2, 2>::new(0.0, 1.0, -self.k1 / self.m1, -self.c1 / self.m1);
        (a, [0.0, 1.0 / self.m1])
    }

    /// The power that the structure's dashpot dissipates, W: `c1 (v1 - vb)²`, with the velocity `vb` of a moving base.
    pub fn dashpot_loss(&self, [cos, sin]: Excitation, v1: f64) -> f64 {
        // The base moves by Y cos(ωt + φ), and pushes by the real part of (k1 + i ω c1) Y e^(i(ωt + φ)).
        let impedance = Complex::new(self.k1, self.omega * self.c1);
        let moves = self.is_on_moving_base() && impedance.norm_sqr() > 0.0;
        let base = if moves { -self.omega * (Complex::new(cos, sin) / impedance).im } else { 0.0 };
        self.c1 * (v1 - base).powi(2)
    }

    /// `∂y'/∂t`, which is due to the force alone.
    pub fn time_derivative(&self, [_, sin]: Excitation) -> [f64; 2] {
        [0.0, -self.omega * sin / self.m1]
    }

    /// A bound on how fast the motion can change, 1/s: the larger of ω and `√(k1/m1) + c1/m1`, which is no less than the
    /// norm of the linear part in the energy norm.
    pub fn rate(&self) -> f64 {
        self.returns.max((self.k1 / self.m1).sqrt() + self.c1 / self.m1)
    }

    /// The rate of the force, in the symbols of a study file.
    pub(crate) fn turns_by(&self) -> &'static str {
        if self.history().is_some() { "1/duration" } else { "omega" }
    }

    /// The largest contribution to [`Self::rate`], in the symbols of a study file.
    pub fn fastest(&self) -> &'static str {
        largest([
            (self.returns, self.turns_by()),
            ((self.k1 / self.m1).sqrt(), "k1/m1"),
            (self.c1 / self.m1, "c1/m1"),
        ])
    }

    /// Energy of the primary structure, `E1 = (m1 v1² + k1 x1²) / 2`, J.
    #[inline]
    pub fn primary_energy(&self, x1: f64, v1: f64) -> f64 {
        0.5 * (self.m1 * v1 * v1 + self.k1 * x1 * x1)
    }

    /// `[m1, k1]`: the weights of `v1²` and `x1²` in twice the primary energy.
    pub fn primary_energy_weights(&self) -> [f64; 2] {
        [self.m1, self.k1]
    }

    /// The largest `|row · y|` over all states of `√(2 E1) = 1` (the dual norm); infinite if `row` weights a position without a
    /// spring.
    pub fn dual_energy_norm(&self, &[x1, v1]: &[f64; 2]) -> f64 {
        let part = |weight: f64, scale: f64| if weight == 0.0 { 0.0 } else { weight * weight / scale };
        (part(x1, self.k1) + part(v1, self.m1)).sqrt()
    }

    /// Largest growth of `√(2E)`, `P / √m1`, √J/s, with `E` the mechanical energy of the structure and of the damper: the power of
    /// the force is at most `P |v1| <= P √(2E / m1)`, and everything else only dissipates energy.
    pub fn energy_norm_growth(&self) -> f64 {
        self.amplitude / self.m1.sqrt()
    }

    /// The energy bound: the largest possible energy after `t` seconds, J. `√(2E)` grows by at most
    /// [`Self::energy_norm_growth`], so from rest it is `(P t)² / (2 m1)`.
    pub fn most_energy(&self, t: f64) -> f64 {
        let [x1, v1] = self.start();
        0.5 * ((2.0 * self.primary_energy(x1, v1)).sqrt() + self.energy_norm_growth() * t).powi(2)
    }

    /// A bound on `|x1|`, m, over a stretch of `seconds` that ends at `x1` and on which the primary energy is at most `e1`:
    /// `√(2 E1 / k1)`, or what speeds of at most `√(2 E1 / m1)` allow.
    pub fn reach(&self, e1: f64, x1: f64, seconds: f64) -> f64 {
        (2.0 * e1 / self.k1).sqrt().min(x1.abs() + (2.0 * e1 / self.m1).sqrt() * seconds)
    }

    /// `[E1, dE1/dt, d²E1/dt²]` in J, W, W/s.
    ///
    /// With `G` the sum of all forces on the PS but its spring, `dE1/dt = v1 (m1 a1 + k1 x1) = v1 G` and
    /// `d²E1/dt² = a1 G + v1 dG/dt`; here `G = P cos ωt - c1 v1`.
    #[inline]
    pub fn primary_energy_rates(&self, [cos, sin]: Excitation, &[x1, v1]: &[f64; 2]) -> [f64; 3] {
        let g = cos - self.c1 * v1;
        let a1 = (g - self.k1 * x1) / self.m1;
        let g_rate = -self.omega * sin - self.c1 * a1;
        [self.primary_energy(x1, v1), v1 * g, a1 * g + v1 * g_rate]
    }
}

/// The name of the largest number.
pub(crate) fn largest<const N: usize>(terms: [(f64, &'static str); N]) -> &'static str {
    const { assert!(N > 0, "there is a largest number") };
    let mut largest = terms[0];
    for term in terms {
        if term.0.total_cmp(&largest.0).is_ge() {
            largest = term;
        }
    }
    largest.1
}
