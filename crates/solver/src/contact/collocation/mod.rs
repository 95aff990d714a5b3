//! A whole contact at once: a collocation of the contact force on the few nodes of a [`Rule`](rule::Rule).
//!
//! Between the bodies acts `F = K f`, `f = z^(3/2)`; everything else is linear. So the motion is the free one, which the contact
//! would interrupt, and what the force adds to it. With `A` the linear part and `b` what a unit of `f` adds to `y'`,
//!
//! ```text
//! y(t) = y_free(t) + Σ_k A^k b ∫₀^t (t - s)^k / k! f(s) ds
//! z(t) = z_free(t) - Σ_k g_k  ∫₀^t (t - s)^k / k! f(s) ds,      g_0 = 0, g_1 = κ
//! ```
//!
//! The second line is a Volterra equation for `z` alone. A contact is short compared with the linear motion, so a few terms are exact to
//! rounding; and it is close to the undisturbed Hertz collision, so Newton's iteration only needs inverse Jacobians that are computed once
//! per program (see `disturbed` and `newton`). One that loses energy is close to the undisturbed collision of its law (see `lossy`,
//! `lossy_rule`, `unit_law` and `node_law`). A contact that is not of this kind is declined, and integrated step by step (see
//! `regularised`).
//!
//! A record's force bends at its samples. The free motion takes every bend in exactly, and the contact force is nearly smooth there (see
//! `bends`): a contact may span samples.
//!
//! Read `undisturbed` (the collision that all are close to), `nodes` and `rule` (integrals of its force on few nodes), `response`
//! (`A^k b` and `g_k`), `disturbed`, `newton` and `solve` (the iteration), then `motion` (the motion that observers see).

pub mod bends;
pub mod disturbed;
pub mod lossy;
pub mod lossy_rule;
pub mod motion;
pub mod newton;
pub mod node_law;
pub mod nodes;
pub mod quadrature;
pub mod response;
pub mod rule;
pub mod solve;
pub mod undisturbed;
pub mod unit_law;

#[cfg(test)]
mod tests;
