//! Limits that a design must keep, and how designs that break them compare with others.
//!
//! The rules are those of K. Deb (An efficient constraint handling method for genetic algorithms, Comput. Methods Appl. Mech.
//! Engrg. 186, 2000): a design that keeps all limits is better than any that breaks one; of two that break some, the one that
//! breaks them by less in total is better. They are written as one number, [`ranked`], so that every search follows them
//! without knowing of them.

use retune_model::{NonNegative, Positive, Variable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A quantity that a limit may be set on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Limit {
    /// The stroke: largest spring deflection `|x2 - x1 - D|`, m.
    Stroke,
    /// Largest contact force on either wall, N.
    Force,
    /// `D + C`, m.
    Cavity,
}

impl Limit {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Stroke, Self::Force, Self::Cavity];

    /// Its name in studies.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stroke => "stroke",
            Self::Force => "force",
            Self::Cavity => "cavity",
        }
    }

    /// The SI unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Force => "N",
            Self::Stroke | Self::Cavity => "m",
        }
    }
}

impl std::fmt::Display for Limit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// A value for each [`Limit`]: what is allowed, or what was reached.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PerLimit<T>(pub [T; 3]);

impl<T: Copy> PerLimit<T> {
    /// The value for `limit`.
    pub fn get(&self, limit: Limit) -> T {
        self.0[limit as usize]
    }

    /// Sets the value for `limit`.
    pub fn set(&mut self, limit: Limit, value: T) {
        self.0[limit as usize] = value;
    }
}

/// Limits on a design. Any design that violates a limit ranks below every feasible one; of two infeasible designs the one with the
/// smaller violation (the sum of reached / limit - 1) is better.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "LimitsGiven")]
pub struct Limits {
    /// The stroke: largest spring deflection |x2 - x1 - D| in any run of the objective, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stroke: Option<Positive>,
    /// Largest contact force on either wall in any run of the objective, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<Positive>,
    /// Largest D + C, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cavity: Option<Positive>,
    /// Time from which the limits on stroke and force apply, s: 0, the default, for the whole run from rest; t0 of `window` for the
    /// same motion as E1max. A settled motion is always included, in whole blocks. For the steady response the limits apply to the
    /// steady-state motion alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<NonNegative>,
}

/// Values of [`ranked`] from here on are of designs that break a limit. No E1max comes near.
pub const INFEASIBLE: f64 = 1e100;

/// A reached value within this share of its limit makes the limit active.
pub const ACTIVE: f64 = 0.01;

impl Limits {
    /// The largest value allowed of a quantity.
    pub fn get(&self, limit: Limit) -> Option<f64> {
        let Self { stroke, force, cavity, .. } = self;
        [stroke, force, cavity][limit as usize].map(Positive::get)
    }

    /// The same limits with another one.
    #[must_use]
    pub fn with(mut self, limit: Limit, most: Positive) -> Self {
        let Self { stroke, force, cavity, .. } = &mut self;
        *[stroke, force, cavity][limit as usize] = Some(most);
        self
    }

    /// Whether none is given, nor from when on.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Whether no limit is set.
    pub fn is_empty(&self) -> bool {
        Limit::ALL.into_iter().all(|limit| self.get(limit).is_none())
    }

    /// From when on a run must be watched for its stroke and its forces, s; `None` where no limit asks for them.
    pub fn walls_from(&self) -> Option<f64> {
        (self.get(Limit::Stroke).is_some() || self.get(Limit::Force).is_some())
            .then(|| self.from.map_or(0.0, NonNegative::get))
    }

    /// By how much the limits are broken: the sum of `reached / limit - 1` over those that are; 0 for a feasible design.
    pub fn violation(&self, reached: &PerLimit<f64>) -> f64 {
        let over = |limit| {
            let allowed = self.get(limit)?;
            let excess = reached.get(limit) / allowed - 1.0;
            Some(if excess > 0.0 { excess } else { 0.0 })
        };
        Limit::ALL.into_iter().filter_map(over).sum()
    }

    /// The limits that `reached` breaks or lies within [`ACTIVE`] of.
    pub fn active(&self, reached: &PerLimit<f64>) -> Vec<Limit> {
        let near = |limit: &Limit| {
            self.get(*limit).is_some_and(|allowed| reached.get(*limit) >= (1.0 - ACTIVE) * allowed)
        };
        Limit::ALL.into_iter().filter(near).collect()
    }
}

/// The number that searches make small: the energy (J) of a feasible design, above [`INFEASIBLE`] that of any other.
pub fn ranked(energy: f64, violation: f64) -> f64 {
    if violation > 0.0 { INFEASIBLE * (1.0 + violation) } else { energy }
}

/// The energy of a value made by [`ranked`]; NaN of one that is infeasible or has none.
pub fn energy(value: f64) -> f64 {
    if value < INFEASIBLE { value } else { f64::NAN }
}

/// The derivative of the cavity D + C by a parameter.
pub(super) fn widens(by: Variable) -> f64 {
    if matches!(by, Variable::D | Variable::C) { 1.0 } else { 0.0 }
}
