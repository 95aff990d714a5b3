//! The largest Lyapunov exponent: the mean rate at which a neighbouring motion diverges from a motion.
//!
//! Two trajectories with renormalisation (Benettin, Galgani, Giorgilli & Strelcyn, Meccanica 15, 1980): after every step the
//! neighbour is moved back to its initial distance along the line to the motion, and the logarithm of the growth is kept. Contacts
//! need no special treatment: Hertz's force is continuous, and each trajectory is integrated through its own contacts.

use serde::Serialize;

/// An exponent with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Exponent {
    /// The largest exponent, 1/s (or per step of a map).
    pub value: f64,
    /// Standard error of the mean, from the scatter of [`BLOCKS`] blocks of time, same unit. It covers the finite length of the
    /// run on its attractor, not a change of attractor after it.
    pub error: f64,
}

/// Number of blocks of time from whose scatter the error is estimated.
pub const BLOCKS: usize = 10;

impl Exponent {
    /// The mean of growth rates of equal steps, each a logarithm of growth over `duration` (s).
    ///
    /// With fewer than [`BLOCKS`] steps the error is infinite.
    pub fn of(growth: &[f64], duration: f64) -> Self {
        let mean = |part: &[f64]| part.iter().sum::<f64>() / (part.len() as f64 * duration);
        let value = if growth.is_empty() { 0.0 } else { mean(growth) };
        let length = growth.len() / BLOCKS;
        if length == 0 {
            return Self { value, error: f64::INFINITY };
        }
        let first = growth.len() - length * BLOCKS;
        let scatter: f64 = growth[first..].chunks(length).map(|block| (mean(block) - value).powi(2)).sum();
        Self { value, error: (scatter / (BLOCKS * (BLOCKS - 1)) as f64).sqrt() }
    }

    /// `(value - threshold) / error`: how many standard errors the exponent lies above a threshold.
    pub fn margin(&self, threshold: f64) -> f64 {
        (self.value - threshold) / self.error.max(1e-12)
    }
}

/// The operations on a system and two of its trajectories that [`Pair`] needs.
pub trait Neighbours {
    /// A state.
    type State: Copy;
    /// The error of a failed step.
    type Error;
    /// The state after one step.
    ///
    /// # Errors
    /// The system's own.
    fn step(&mut self, state: Self::State) -> Result<Self::State, Self::Error>;
    /// Distance between two states in a norm chosen by the system.
    fn distance(&self, a: Self::State, b: Self::State) -> f64;
    /// The state at `share` of the way from `a` to `b`.
    fn between(&self, a: Self::State, b: Self::State, share: f64) -> Self::State;
}

/// A motion and its neighbour, which starts every step at the same distance.
#[derive(Clone, Copy, Debug)]
pub struct Pair<S> {
    /// The motion.
    pub motion: S,
    /// Its neighbour.
    pub neighbour: S,
    /// The distance to which the neighbour is reset.
    pub distance: f64,
}

impl<S: Copy> Pair<S> {
    /// Advances the neighbour by one step, given the motion's new state, and resets its distance; returns the logarithm of the
    /// growth.
    ///
    /// # Errors
    /// The system's own.
    pub fn advance<N: Neighbours<State = S>>(&mut self, system: &mut N, motion: S) -> Result<f64, N::Error> {
        let neighbour = system.step(self.neighbour)?;
        let apart = system.distance(motion, neighbour);
        self.motion = motion;
        if apart > 0.0 && apart.is_finite() {
            self.neighbour = system.between(motion, neighbour, self.distance / apart);
            return Ok((apart / self.distance).ln());
        }
        // The two states are equal to the last bit: restart beside the motion, and count the smallest growth that could be
        // resolved.
        self.neighbour = system.between(
            motion,
            self.neighbour,
            self.distance / system.distance(motion, self.neighbour).max(f64::MIN_POSITIVE),
        );
        Ok(f64::EPSILON.ln())
    }
}
