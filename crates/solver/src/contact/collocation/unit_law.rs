//! The laws of loss, in the units of an undisturbed collision.

use retune_model::Restoring;
use std::sync::Arc;
use wide::f64x4;

/// The factor of Hertz's force in the units of an undisturbed collision, those of `lossy_rule`.
#[derive(Clone)]
pub enum UnitLaw {
    /// The same restitution at every speed.
    Restoring(Arc<Restoring>),
    /// Hunt and Crossley's `1 + χ ż`.
    Damping(f64),
}

impl UnitLaw {
    /// The law with a χ that is larger by `offset`; unchanged for a law with one restitution.
    pub fn with_chi_offset(&self, offset: f64) -> Self {
        match self {
            Self::Restoring(law) => Self::Restoring(Arc::clone(law)),
            Self::Damping(chi) => Self::Damping(chi + offset),
        }
    }

    /// The factor at `S = z^(5/2)/2` and `ż`.
    pub fn push(&self, s: f64, w: f64) -> f64 {
        match self {
            Self::Restoring(law) => law.push(s, w),
            Self::Damping(chi) => 1.0 + chi * w,
        }
    }

    /// [`Self::push`] in four lanes.
    #[inline(always)]
    pub fn push_of_four(&self, s: f64x4, w: f64x4) -> f64x4 {
        match self {
            Self::Restoring(law) => law.push_of_four(s, w),
            Self::Damping(chi) => w * *chi + 1.0,
        }
    }

    /// The factor, and its derivatives by `ln z` and by `ż`.
    pub fn slopes(&self, s: f64, w: f64) -> [f64; 3] {
        match self {
            Self::Restoring(law) => law.slopes(s, w),
            Self::Damping(chi) => [1.0 + chi * w, 0.0, *chi],
        }
    }
}
