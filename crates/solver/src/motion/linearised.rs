//! A contact that was computed at once, linearised for small changes.

use super::knot::Knot;
use nalgebra::DMatrix;
use retune_model::Side;

/// Orders of the integrals that are kept.
pub const MOMENTS: usize = 10;

/// A contact at the nodes of its rule. A force `K f(t)` on the damper moves the state by `Σ_k A^k b ∫ (t - s)^k / k! f(s) ds`, with `b` what
/// `K` alone does to its rate; these integrals are sums over the nodes.
pub struct LinearContact {
    /// The wall.
    pub side: Side,
    /// Touch-down.
    pub touch: Knot<4>,
    /// The state at lift-off.
    pub end: [f64; 4],
    /// Duration, s.
    pub duration: f64,
    /// The times of the nodes and of lift-off as shares of the duration.
    pub times: Vec<f64>,
    /// `√z` at the nodes, √m.
    pub roots: Vec<f64>,
    /// Number of the integrals that are significant.
    pub terms: usize,
    /// The integrals at the nodes and at lift-off: `z^1.5` and powers of time.
    pub impulses: Vec<[f64; MOMENTS]>,
    /// The integrals of `z^1.5 dz/dt`, which a loss adds to the force; empty unless requested.
    pub drags: Vec<[f64; MOMENTS]>,
    /// `A^k b`, and by how much it reduces the indentation.
    pub kicks: [[f64; 4]; MOMENTS],
    /// See `kicks`.
    pub gains: [f64; MOMENTS],
    /// By how much `z^1.5` at each node reduces the indentation at the nodes and at lift-off, a column for each node.
    pub reductions: DMatrix<f64>,
    /// What `z^1.5` at each node adds to the state at lift-off.
    pub additions: Vec<[f64; 4]>,
}
