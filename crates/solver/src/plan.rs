//! The plan of a run: the smallest model that is exact for what is asked of a system, chosen once.
//!
//! Whoever computes a motion asks [`Plan::of`] and does what it says. No other file looks at the name of a method, or asks whether there
//! are walls to touch, to choose between models.

use crate::hybrid::contact_free::clears_walls;
use crate::recurrence::repeats::has_room;
use crate::settings::{Method, Settings, Window};
use crate::system::LinearSystem;
use retune_model::{Bare, Coupled};
use std::f64::consts::TAU;

/// What is asked of a system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    /// Its motion, from whatever state.
    Motion,
    /// The largest energy of the structure in a window of the run from its start.
    Energy(Window),
    /// Largest values in a window of that run; observed beside them is the run from `late` (s) on.
    Largest { window: Window, late: f64 },
    /// The largest values of the motion on which that run settles.
    Settled,
}

/// How it is answered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Plan {
    /// In closed form: of the bare structure, or of a damper that provably stays off both walls.
    Closed,
    /// By the exact flow, step by step: there is no wall to touch.
    Free,
    /// By flight and contact in turn.
    Hybrid,
    /// The same, and the run may end when its motion repeats, once as much has been observed from this time (s) on.
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

/// What a plan must know of a system.
pub trait Planned<const N: usize>: LinearSystem<N> {
    /// Whether there is a wall to touch.
    fn has_walls(&self) -> bool;
    /// Whether it provably touches none in the run from its start, and has a closed form.
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

    /// A run is not looked at for repeating where too few periods would be left to it.
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
