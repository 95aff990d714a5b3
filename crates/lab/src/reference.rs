//! The reference solutions, their uncertainty, and how far a motion can be predicted.

use crate::runs::{Found, errors, run, settings};
use crate::scenes::Case;
use crate::{Any, system};
use retune_dynamics::{Exponent, Stretch, follow};
use retune_solver::observe::Unobserved;
use retune_solver::{Contacts, Hybrid, Method, Motion, Phase, Settings};

/// The tolerance of the reference.
pub const REFERENCE: f64 = 1e-13;

/// The reference of a scene.
pub struct Reference {
    /// The hybrid at rtol 1e-13.
    pub found: Found,
    /// The larger difference from it of the hybrid at 1e-12 and an independent method: E1max, final state, impact times (s).
    pub uncertainty: [f64; 3],
    /// The largest Lyapunov exponent of the settled motion, 1/s; `None` without a damper (there it is `-c1 / (2 m1)`).
    pub exponent: Option<Exponent>,
    /// Mean rate (1/s) at which neighbouring motions diverge over the run itself.
    pub parting: Option<f64>,
}

/// DOP853 at 1e-13; with rigid walls, which Retune's general methods do not support, the DOP853 of another program, if it is built.
fn independent(case: &Case) -> Any<Option<Found>> {
    if system(&case.scene).is_some_and(|system| system.is_rigid()) {
        return of_a_peer(case);
    }
    Ok(Some(run(case, &settings(Method::Dop853, Contacts::Located, REFERENCE), false)?))
}

#[cfg(feature = "integrators")]
fn of_a_peer(case: &Case) -> Any<Option<Found>> {
    use crate::peers::{PEERS, run};
    let dop853 = PEERS.iter().find(|peer| peer.program.starts_with("ivp") && peer.method == "DOP853");
    let dop853 = dop853.ok_or("the crate ivp has no DOP853")?;
    Ok(Some(run(dop853, case, true, dop853.tightest, false)?))
}

#[cfg(not(feature = "integrators"))]
fn of_a_peer(_: &Case) -> Any<Option<Found>> {
    Ok(None)
}

impl Reference {
    pub fn of(case: &Case) -> Any<Self> {
        let run = |method, rtol| run(case, &settings(method, Contacts::Located, rtol), false);
        let found = run(Method::Hybrid, REFERENCE)?;
        let looser = errors(&run(Method::Hybrid, 1e-12)?, &found, case.omega());
        let independent = independent(case)?.map_or([0.0; 3], |other| errors(&other, &found, case.omega()));
        let stretch = Stretch { settle: 100, observe: 200 };
        let exponent = match case.scene.damper {
            Some(_) => Some(follow(&case.scene, None, stretch, &Settings::default())?.exponent()),
            None => None,
        };
        let uncertainty = std::array::from_fn(|i| looser[i].max(independent[i]));
        Ok(Self { found, uncertainty, exponent, parting: parting_rate(case)? })
    }

    /// Lyapunov time, s, in which neighbours diverge by a factor e at the larger of the two rates; `None` if they do not diverge.
    pub fn lyapunov_time(&self) -> Option<f64> {
        let rates = [self.parting, self.exponent.map(|e| e.value)];
        let rate = rates.into_iter().flatten().fold(f64::NEG_INFINITY, f64::max);
        (rate > 1e-3).then_some(1.0 / rate)
    }

    /// Time over which the motion can be predicted to 1e-6 in double precision, s: `ln 1e10` Lyapunov times.
    pub fn horizon(&self) -> f64 {
        self.lyapunov_time().map_or(f64::INFINITY, |time| 1e10_f64.ln() * time)
    }
}

/// Finite-time Lyapunov exponent (1/s) of two motions of a scene that start 1e-9 m apart in `x1`; `None` without a damper.
fn parting_rate(case: &Case) -> Any<Option<f64>> {
    let Some(system) = system(&case.scene) else { return Ok(None) };
    let apart = 1e-9;
    let end = |shift: f64| {
        let mut y = system.rest();
        y[0] += shift;
        y[2] += shift;
        let start = Motion { t: 0.0, y, phase: Phase::Flight };
        Hybrid::new(&system, 1e-13, case.to, 10_000_000).propagate(start, case.to, &mut Unobserved)
    };
    let (a, b) = (end(0.0)?.y, end(apart)?.y);
    let distance: f64 = (0..4)
        .map(|i| (b[i] - a[i]) * if i % 2 == 0 { 1.0 } else { 1.0 / case.omega() })
        .map(|d| d * d)
        .sum();
    Ok(Some((distance.sqrt() / apart).ln() / case.to))
}
