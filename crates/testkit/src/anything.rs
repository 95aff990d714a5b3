//! Generates any valid scene, over fifteen orders of magnitude about the paper's, and checks what must hold for every one: a
//! finite answer or a typed error, within the limit on work, and nothing that physics rules out. The property tests draw scenes at
//! random, the fuzzer by code coverage.

use crate::scenes::SSVI;
use retune_model::{
    Contact, Damper, Forcing, Loss, NonNegative, PoissonRatio, Positive, Primary, Restitution, Scene,
    Surfaces,
};
use retune_solver::{Contacts, Method, Response, SceneKind, Settings, SolverError, Window, e1_max, simulate};

/// Number of draws in [0, 1] that define a run.
pub const DRAWS: usize = 28;

/// Most steps of a run.
pub const MOST_STEPS: u64 = 5_000;

/// A run of any scene.
#[derive(Clone, Copy, Debug)]
pub struct Anything {
    /// The scene.
    pub scene: Scene,
    /// The window of the run.
    pub window: Window,
    /// The settings of the run.
    pub settings: Settings,
}

/// Orders of magnitude over which a parameter is drawn, centred on the paper's value.
const ORDERS: f64 = 15.0;

/// `about` moved by up to half of [`ORDERS`] up or down.
fn scaled(about: f64, draw: f64) -> f64 {
    about * 10f64.powf(ORDERS * (draw - 0.5))
}

fn positive(about: f64, draw: f64) -> Positive {
    Positive::new(scaled(about, draw)).expect("a positive number")
}

/// Like [`positive`], but the lowest draw gives exactly zero.
fn not_negative(about: f64, draw: f64) -> NonNegative {
    let value = if draw < 0.02 { 0.0 } else { scaled(about, draw) };
    NonNegative::new(value).expect("a number not below zero")
}

fn poisson(draw: f64) -> PoissonRatio {
    PoissonRatio::new(0.5 - 1.499 * draw).expect("a Poisson's ratio")
}

/// The loss of a contact: none in two draws of three, λ in one of six, one restitution at every speed in the last sixth.
fn loss(draw: f64) -> Loss {
    let e = 6.0 * draw - 5.0;
    match Restitution::new(e) {
        Ok(e) => Loss::Restoring(e),
        Err(_) => Loss::Damping(not_negative(1.0, (6.0 * draw - 4.0).max(0.0))),
    }
}

impl Anything {
    /// The run defined by `draws`, each in [0, 1].
    pub fn new(draws: &[f64; DRAWS]) -> Self {
        let [m1, c1, k1, p, omega, m2, k2, c2, d, c, r, q, e1, e2, e3, e4, rest @ ..] = *draws;
        let [nu1, nu2, nu3, nu4, t, t0, rtol, atol, method, contacts, bare, lambda] = rest;
        let damper = Damper {
            mass: positive(SSVI.m2, m2),
            stiffness: not_negative(SSVI.k2, k2),
            damping: not_negative(SSVI.c2, c2),
            rest_distance: not_negative(SSVI.d, d),
            clearance: not_negative(SSVI.c, c),
            contact: Some(Contact::Hertz(Surfaces {
                radius: positive(SSVI.r, r),
                coefficient: positive(SSVI.q, q),
                young_1: positive(SSVI.young[0], e1),
                poisson_1: poisson(nu1),
                young_2: positive(SSVI.young[1], e2),
                poisson_2: poisson(nu2),
                young_3: positive(SSVI.young[2], e3),
                poisson_3: poisson(nu3),
                young_4: positive(SSVI.young[3], e4),
                poisson_4: poisson(nu4),
                loss: loss(lambda),
                // In three of five lossy dampers, contacts with the obstacle lose something else.
                loss_obstacle: (lambda > 0.8).then(|| loss(1.8 - lambda)),
                strength: None,
                density: None,
            })),
        };
        let scene = Scene {
            primary: Primary {
                mass: positive(SSVI.m1, m1),
                damping: not_negative(SSVI.c1, c1),
                stiffness: not_negative(SSVI.k1, k1),
            },
            forcing: Forcing::force(not_negative(SSVI.p, p), not_negative(SSVI.omega, omega)),
            damper: (bare > 0.05).then_some(damper),
        };
        let to = 10f64.powf(4.0 * t - 2.0);
        let window = Window { from: if t0 < 0.2 { 0.0 } else { 0.999 * t0 * to }, to };
        // The hybrid in half of the draws: it is the default, and the other methods share one loop.
        let others = &Method::ALL[1..];
        let method = match method {
            x if x < 0.5 => Method::Hybrid,
            x => others[(((x - 0.5) * 2.0 * others.len() as f64) as usize).min(others.len() - 1)],
        };
        let settings = Settings {
            method,
            contacts: if contacts < 0.5 { Contacts::Located } else { Contacts::Stepped },
            rtol: 10f64.powf(-1.0 - 12.0 * rtol),
            atol: if atol < 0.1 { 0.0 } else { 10f64.powf(-15.0 * atol) },
            step: None,
            max_steps: MOST_STEPS,
        };
        Self { scene, window, settings }
    }

    /// The run defined by the fuzzer's bytes, two per draw: finer than any threshold of a scene. Missing draws are 0.5, the paper's value.
    pub fn of_bytes(bytes: &[u8]) -> Self {
        let mut draws = [0.5; DRAWS];
        for (draw, pair) in draws.iter_mut().zip(bytes.chunks_exact(2)) {
            *draw = f64::from(u16::from_le_bytes([pair[0], pair[1]])) / f64::from(u16::MAX);
        }
        Self::new(&draws)
    }

    /// Makes all kinds of runs and checks their results.
    ///
    /// # Panics
    /// If a property is violated.
    pub fn check(&self) {
        let Self { scene, window, settings } = self;
        let largest = e1_max(scene, *window, settings, f64::INFINITY);
        match &largest {
            Ok(peak) => {
                assert!(peak.value.is_finite() && peak.value >= 0.0, "E1max {peak:?}: {self:?}");
                self.check_time(peak.time);
                self.check_energy(peak.value);
            }
            Err(error) => self.check_error(error),
        }
        match simulate(scene, *window, settings) {
            Err(error) => self.check_error(&error),
            Ok(found) => {
                let numbers = [found.e1_max.value, found.e2_max.value, found.relative_displacement_max];
                let all = numbers.iter().chain(&found.force_max);
                assert!(all.clone().all(|value| value.is_finite() && *value >= 0.0), "{found:?}: {self:?}");
                assert!(found.final_state.iter().all(|value| value.is_finite()), "{found:?}: {self:?}");
                assert!(found.work.steps <= settings.max_steps, "{found:?}: {self:?}");
                self.check_structure(&found);
                self.check_time(found.e1_max.time);
                self.check_time(found.e2_max.time);
                self.check_energy(found.e1_max.value);
                if let Ok(peak) = largest {
                    self.check_same(found.e1_max.value, peak.value);
                }
                self.check_touches(&found);
            }
        }
    }

    /// The largest motions of the structure are finite and lie in the window; none has more energy than E1max.
    fn check_structure(&self, found: &Response) {
        for largest in found.structure.all() {
            assert!(largest.value.is_finite() && largest.value >= 0.0, "{found:?}: {self:?}");
            self.check_time(largest.time);
        }
        let [m1, k1] = [self.scene.primary.mass.get(), self.scene.primary.stiffness.get()];
        let [x1, v1] = [found.structure.displacement, found.structure.velocity].map(|largest| largest.value);
        if self.settings.method == Method::Hybrid {
            let most = 2.0 * found.e1_max.value * (1.0 + 1e-9);
            assert!(m1 * v1 * v1 <= most && k1 * x1 * x1 <= most, "{found:?}: {self:?}");
        }
    }

    fn check_time(&self, t: f64) {
        assert!(t >= self.window.from && t <= self.window.to, "t = {t}: {self:?}");
    }

    /// From rest the power of the force is at most P √(2E/m1), so that E <= (P t)²/(2 m1): no method may create energy. The hybrid
    /// has an allowance of 1e-6, general methods one of 100 %.
    fn check_energy(&self, e1: f64) {
        let most = (self.scene.forcing.amplitude().map_or(0.0, |(_, p)| p.get()) * self.window.to).powi(2)
            / (2.0 * self.scene.primary.mass.get());
        let error = if self.settings.method == Method::Hybrid { 1e-6 } else { 1.0 };
        assert!(e1 <= most * (1.0 + error), "E1max {e1} J of at most {most} J: {self:?}");
    }

    fn check_error(&self, error: &SolverError) {
        let t = match *error {
            SolverError::StepTooSmall { t, .. }
            | SolverError::TooFast { t, .. }
            | SolverError::Contact { t }
            | SolverError::Unstable { t }
            | SolverError::NonFinite { t }
            | SolverError::Implausible { t, .. } => t,
            SolverError::Missed { .. }
            | SolverError::RigidWalls { .. }
            | SolverError::Grazing { .. }
            | SolverError::NoPeriod { .. }
            | SolverError::NoDerivatives { .. } => {
                panic!("{error}: {self:?}")
            }
            SolverError::TooManySteps { t, limit, .. } | SolverError::TooSlow { t, limit, .. } => {
                assert_eq!(limit, self.settings.max_steps);
                t
            }
        };
        assert!(t >= 0.0 && t <= self.window.to, "{error}: {self:?}");
    }

    /// The objective and the full run agree for a bare structure. (With contacts the motion may be chaotic.)
    fn check_same(&self, full: f64, objective: f64) {
        if self.scene.damper.is_none() && self.settings.method == Method::Hybrid {
            let most = full.max(objective);
            assert!((full - objective).abs() <= 1e-6 * most, "{full} J and {objective} J: {self:?}");
        }
    }

    /// A wall that the damper does not touch at rest has no contact force without a touch-down. (The solver itself detects missed
    /// contacts, and [`SolverError::Missed`] is never accepted here.)
    fn check_touches(&self, found: &Response) {
        let Some(damper) = self.scene.damper else { return };
        let apart = damper.rest_distance.get() > 0.0 && damper.clearance.get() > 0.0;
        if self.settings.method == Method::Hybrid && apart && self.window.from == 0.0 {
            for side in [0, 1] {
                let missed = found.impacts[side] == 0 && found.force_max[side] > 0.0;
                assert!(!missed, "a contact force on a wall without a touch-down, {found:?}: {self:?}");
            }
        }
        let linear = found.scene != SceneKind::Contact;
        assert!(!linear || (found.impacts, found.force_max) == ([0; 2], [0.0; 2]), "{found:?}: {self:?}");
    }
}
