//! The plan of a run: the smallest model that is exact for a request, chosen once.
//!
//! All code that computes a motion uses [`Plan::of`]. No other file chooses between models by the method or by the presence of walls.

use crate::hybrid::contact_free::clears_walls;
use crate::recurrence::repeats::has_room;
use crate::settings::{Method, Settings, Window};
use crate::system::LinearSystem;
use retune_model::{Bare, Coupled};
use std::f64::consts::TAU;

/// What is requested of a system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    /// Its motion from any state.
    Motion,
    /// The largest energy of the structure in a window of the run from its start.
    Energy(Window),
    /// Largest values in a window of the run from its start; additional measures are observed from `late` (s) on.
    Largest { window: Window, late: f64 },
    /// The largest values of the motion to which the run from its start settles.
    Settled,
}

/// How a request is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Plan {
    /// In closed form: the bare structure, or a damper that provably touches neither wall.
    Closed,
    /// By the exact flow, step by step: there are no walls.
    Free,
    /// By flight and contact alternately.
    Hybrid,
    /// As [`Self::Hybrid`], but the run may end once its motion repeats and one repetition has been observed from this time (s) on.
    UntilItRepeats(f64),
    /// By a general method.
    General(General),
}

/// A general method: every one but the hybrid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum General {
    Ode23s,
    Ode45,
    Ode23,
    Dop853,
    Rk4,
    Euler,
}

/// The properties of a system that determine its plan.
pub trait Planned<const N: usize>: LinearSystem<N> {
    /// Whether there are walls.
    fn has_walls(&self) -> bool;
    /// Whether it provably touches no wall in the run from its start, and has a closed form.
    fn clears_walls(&self) -> bool;
    /// Largest energy of the structure in its steady motion without walls, J; infinite if there is none.
    fn steady_energy(&self) -> f64;
    /// Period of the force, s.
    fn period(&self) -> f64;
}

impl Plan {
    /// The plan for a request.
    pub fn of<const N: usize>(system: &impl Planned<N>, settings: &Settings, request: Request) -> Self {
        let general = match settings.method {
            Method::Hybrid => None,
            Method::Ode23s => Some(General::Ode23s),
            Method::Ode45 => Some(General::Ode45),
            Method::Ode23 => Some(General::Ode23),
            Method::Dop853 => Some(General::Dop853),
            Method::Rk4 => Some(General::Rk4),
            Method::Euler => Some(General::Euler),
        };
        if let Some(method) = general {
            return Self::General(method);
        }
        let is_closed = match request {
            Request::Motion | Request::Largest { .. } => false,
            Request::Energy(_) => system.clears_walls(),
            Request::Settled => system.clears_walls() && system.steady_energy().is_finite(),
        };
        if is_closed {
            return Self::Closed;
        }
        if !system.has_walls() {
            return Self::Free;
        }
        match request {
            Request::Energy(window) => Self::until_it_repeats(system, window, window.from),
            Request::Largest { window, late } => Self::until_it_repeats(system, window, late),
            Request::Motion | Request::Settled => Self::Hybrid,
        }
    }

    /// Tests a run for repetition only if it is long enough for the test to pay.
    fn until_it_repeats<const N: usize>(system: &impl Planned<N>, window: Window, late: f64) -> Self {
        let pays = has_room(system.period(), window.from.max(late), window.to);
        if pays { Self::UntilItRepeats(late) } else { Self::Hybrid }
    }
}

impl Planned<2> for Bare {
    fn has_walls(&self) -> bool {
        false
    }
    fn clears_walls(&self) -> bool {
        self.history().is_none()
    }
    fn steady_energy(&self) -> f64 {
        if self.history().is_some() { f64::INFINITY } else { Bare::steady(self, self.frequency()).e1_max }
    }
    fn period(&self) -> f64 {
        TAU / self.frequency()
    }
}

impl Planned<4> for Coupled {
    fn has_walls(&self) -> bool {
        Coupled::has_walls(self)
    }
    fn clears_walls(&self) -> bool {
        clears_walls(self)
    }
    fn steady_energy(&self) -> f64 {
        let is_steady = self.bare().history().is_none();
        if is_steady { Coupled::steady(self, self.bare().frequency()).e1_max } else { f64::INFINITY }
    }
    fn period(&self) -> f64 {
        TAU / self.bare().frequency()
    }
}
