//! Limits that a design must keep, and how designs that break them compare with others.
//!
//! The rules are those of K. Deb (An efficient constraint handling method for genetic algorithms, Comput. Methods Appl. Mech.
//! Engrg. 186, 2000): a design that keeps all limits is better than any that breaks one; of two that break some, the one that
//! breaks them by less in total is better. They are combined in one number, [`ranked`], so that every search follows them.

mod file;

use retune_model::{Measure, NonNegative, Parameter, PerMeasure, Positive};
use retune_solver::Also;
use serde::{Serialize, Serializer};

/// A quantity that a limit may be set on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Limit {
    /// The largest value of a measure in any run, or its longest decay time.
    Of(Measure),
    /// `D + C`, m.
    Cavity,
}

impl Limit {
    /// All of them.
    pub const ALL: [Self; Measure::OF_RUN.len() + 1] = {
        let mut all = [Self::Cavity; Measure::OF_RUN.len() + 1];
        let mut i = 0;
        while i < Measure::OF_RUN.len() {
            all[i] = Self::Of(Measure::OF_RUN[i]);
            i += 1;
        }
        all
    };

    /// Its name in studies.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Of(measure) => measure.name(),
            Self::Cavity => "cavity",
        }
    }

    /// The SI unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Of(measure) => measure.unit(),
            Self::Cavity => "m",
        }
    }

    /// What it is.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Of(measure) => measure.words(),
            Self::Cavity => "D + C, the length of the cavity",
        }
    }

    /// Its place in [`Self::ALL`].
    const fn index(self) -> usize {
        match self {
            Self::Of(measure) => measure.index(),
            Self::Cavity => Measure::OF_RUN.len(),
        }
    }
}

impl Serialize for Limit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl std::fmt::Display for Limit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// A value for each [`Limit`]: what is allowed, or what was reached.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PerLimit<T>(pub [T; Limit::ALL.len()]);

impl<T: Copy> PerLimit<T> {
    /// The same value for every limit.
    pub const fn all(value: T) -> Self {
        Self([value; Limit::ALL.len()])
    }

    /// The value for `limit`.
    pub fn get(&self, limit: Limit) -> T {
        self.0[limit.index()]
    }

    /// Sets the value for `limit`.
    pub fn set(&mut self, limit: Limit, value: T) {
        self.0[limit.index()] = value;
    }
}

impl PerLimit<f64> {
    /// The values of the measures, without the cavity.
    pub fn measures(&self) -> PerMeasure<f64> {
        PerMeasure(Measure::OF_RUN.map(|measure| self.get(Limit::Of(measure))))
    }
}

/// Limits on a design. Any design that violates a limit ranks below every feasible one; of two infeasible designs the one with the
/// smaller violation (the sum of reached / limit - 1) is better.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    most: PerLimit<Option<Positive>>,
    /// Time from which the limits of runs apply, s: 0 if left out, for the whole run from rest; t0 of `window` for the same motion as
    /// the objective. A settled motion is always included, in whole blocks. Limits of a steady response are of that alone.
    pub from: Option<NonNegative>,
}

/// Values of [`ranked`] from here on are of designs that break a limit. No objective value comes near.
pub const INFEASIBLE: f64 = 1e100;

/// A reached value within this share of its limit makes the limit active.
pub const ACTIVE: f64 = 0.01;

impl Limits {
    /// The share of a limit by which rounding may exceed it: a smaller excess is not reported.
    pub const ROUNDING: f64 = 1e-12;

    /// The largest value allowed of a quantity.
    pub fn get(&self, limit: Limit) -> Option<f64> {
        self.most.get(limit).map(Positive::get)
    }

    /// These limits with one more.
    #[must_use]
    pub fn with(mut self, limit: Limit, most: Positive) -> Self {
        self.most.set(limit, Some(most));
        self
    }

    /// These limits from another time on, s.
    #[must_use]
    pub const fn since(self, from: Option<NonNegative>) -> Self {
        Self { from, ..self }
    }

    /// Whether neither a limit nor `from` is set.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// The quantities that a limit is set on.
    pub fn set(&self) -> impl Iterator<Item = Limit> {
        let limits = *self;
        Limit::ALL.into_iter().filter(move |limit| limits.get(*limit).is_some())
    }

    /// Whether no limit is set.
    pub fn is_empty(&self) -> bool {
        self.set().next().is_none()
    }

    /// The measures that runs must observe, and from when on; `None` if no limit needs a run.
    pub fn also(&self) -> Option<Also> {
        let limited = |measure: &Measure| self.get(Limit::Of(*measure)).is_some();
        let measures: PerMeasure<bool> = Measure::OF_RUN.into_iter().filter(limited).collect();
        let from = self.from.map_or(0.0, NonNegative::get);
        (measures != PerMeasure::default()).then_some(Also { measures, from })
    }

    /// The violation: the sum of `reached / limit - 1` over the broken limits; 0 for a feasible design.
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

/// The number that searches minimise: the objective's value of a feasible design, in the unit of its quantity; above [`INFEASIBLE`] for any
/// other.
pub fn ranked(value: f64, violation: f64) -> f64 {
    if violation > 0.0 { INFEASIBLE * (1.0 + violation) } else { value }
}

/// The objective's value from the result of [`ranked`]; NaN if infeasible or without a value.
pub fn value_of(ranked: f64) -> f64 {
    if ranked < INFEASIBLE { ranked } else { f64::NAN }
}

/// The derivative of the cavity D + C by a parameter.
pub(super) fn widens(by: Parameter) -> f64 {
    if by.is_gap() { 1.0 } else { 0.0 }
}
