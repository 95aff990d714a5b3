//! Third-party integrators, each wrapped as a function that follows one phase of the motion.

mod with_diffeq;
mod with_diffsol;
mod with_ivp;

use crate::motion::{Equations, Track};
use crate::runs::{Found, Timing, timed};
use crate::scenes::Case;
use std::panic::{self, AssertUnwindSafe};

/// Integrates the motion from `y` between two times and passes it to the track, if any. Returns the time and state reached, and
/// whether an event ended it.
pub type Piece =
    fn(&Equations, (f64, [f64; 4]), f64, f64, Option<&mut Track>) -> Result<(f64, [f64; 4], bool), String>;

/// An integrator of another program.
pub struct Peer {
    /// Name and version.
    pub program: &'static str,
    pub method: &'static str,
    /// Integrates one phase.
    pub piece: Piece,
    /// Tightest useful tolerance.
    pub tightest: f64,
}

pub const PEERS: [Peer; 9] = {
    const fn peer(program: &'static str, method: &'static str, piece: Piece, tightest: f64) -> Peer {
        Peer { program, method, piece, tightest }
    }
    [
        peer("differential-equations 0.7", "DOP853", with_diffeq::dop853, 1e-12),
        peer("differential-equations 0.7", "Radau5", with_diffeq::radau5, 1e-10),
        peer("differential-equations 0.7", "Kvaerno745", with_diffeq::kvaerno745, 1e-9),
        peer("ivp 0.6", "DOP853", with_ivp::dop853, 1e-12),
        peer("ivp 0.6", "RK23", with_ivp::rk23, 1e-8),
        peer("ivp 0.6", "LSODA", with_ivp::lsoda, 1e-11),
        peer("ivp 0.6", "BDF", with_ivp::bdf, 1e-9),
        peer("diffsol 0.18", "BDF", with_diffsol::bdf, 1e-9),
        peer("diffsol 0.18", "TR-BDF2", with_diffsol::tr_bdf2, 1e-7),
    ]
};

/// Most events of a run.
const MOST_EVENTS: usize = 10_000;

/// Runs an integrator that might not return: the bound on evaluations stops it, which counts as a failure.
fn guarded<T>(run: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    let loud = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let end = panic::catch_unwind(AssertUnwindSafe(run));
    panic::set_hook(loud);
    end.unwrap_or_else(|payload| {
        Err(payload.downcast_ref::<String>().cloned().unwrap_or_else(|| String::from("panicked")))
    })
}

fn follow(
    peer: &Peer,
    case: &Case,
    located: bool,
    rtol: f64,
    mut track: Option<&mut Track>,
) -> Result<([f64; 4], u64), String> {
    let mut equations = Equations::new(&case.scene, located);
    let (mut t, mut y) = (0.0, equations.rest());
    if let Some(track) = track.as_deref_mut() {
        track.moment(&equations, t, &y);
    }
    for _ in 0..MOST_EVENTS {
        let event;
        (t, y, event) = (peer.piece)(&equations, (t, y), case.to, rtol, track.as_deref_mut())?;
        if !y.iter().all(|v| v.is_finite()) {
            return Err(format!("not a finite number at t = {t} s"));
        }
        if !event || t >= case.to {
            return Ok((y, equations.evaluations.get()));
        }
        let touched = equations.change(&mut y);
        if let (true, Some(track)) = (touched, track.as_deref_mut()) {
            track.touches.push(t);
        }
    }
    Err(format!("more than {MOST_EVENTS} events: stuck at t = {t} s"))
}

/// A run of a third-party integrator. Unlike Retune's, the time excludes the search for E1max.
pub fn run(peer: &Peer, case: &Case, located: bool, rtol: f64, is_timed: bool) -> Result<Found, String> {
    let spacing = if case.name == "near-rigid" { 2e-5 } else { 2e-4 };
    let mut track = Track::new(spacing);
    guarded(|| follow(peer, case, located, rtol, Some(&mut track)))?;
    let (final_state, evaluations) = follow(peer, case, located, rtol, None)?;
    let time = if is_timed { timed(|| follow(peer, case, located, rtol, None)) } else { Timing::NONE };
    Ok(Found {
        e1_max: track.e1_max,
        final_state,
        impacts: track.touches.len(),
        touches: Some(track.touches),
        evaluations,
        time,
    })
}
