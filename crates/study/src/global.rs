//! The global search of a study: samples spread evenly over the box, then CMA-ES from the best of them.

use super::rule::Rule;
use retune_model::PerVariable;
use retune_optim::{Bounds, Global, Parameter, Scale, Side, Space};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A global search before the refinement: the points of a scrambled Sobol sequence over a box, then a CMA-ES search from each of
/// the best points that are sufficiently apart. Searches that converge to the same design share a basin; the best basins are
/// refined. The results depend on the seed, not on the number of threads.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GlobalSearch {
    /// Number of initial samples, distributed evenly over the box.
    #[schemars(range(min = 1, max = 65536))]
    pub samples: u32,
    /// Number of CMA-ES searches, each started from one of the best samples.
    #[schemars(range(min = 1, max = 1000))]
    pub searches: usize,
    /// Minimum distance between two starts along at least one side of the box, as a fraction of that side.
    pub apart: f64,
    /// Initial standard deviation of a search, as a fraction of each side.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1.0))]
    pub spread: f64,
    /// A search stops once its standard deviation is below this fraction of every side.
    #[schemars(range(min = 0.0))]
    pub tolerance: f64,
    /// Maximum number of evaluations of a search.
    #[schemars(range(min = 1))]
    pub evaluations: u64,
    /// Final designs of searches and refinements closer than this fraction of every side belong to one basin.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1.0))]
    pub basin: f64,
    /// Seed of the initial samples and of the random numbers of the searches.
    pub seed: u32,
    /// The box. Sides left out are the bounds of the parameter, on a logarithmic scale where these span a decade or more.
    #[serde(rename = "box")]
    pub sides: PerVariable<BoxSide>,
}

/// A side of the box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxSide {
    /// Smallest value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
    /// Whether distances are measured on a linear or a logarithmic scale; left out, logarithmic where the side spans a decade or more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<Scale>,
}

impl Default for GlobalSearch {
    fn default() -> Self {
        let Global { samples, searches, apart, spread, tolerance, evaluations, seed } = Global::default();
        let sides = PerVariable::default();
        Self { samples, searches, apart, spread, tolerance, evaluations, basin: 0.05, seed, sides }
    }
}

impl GlobalSearch {
    /// The settings of the search.
    pub fn global(&self) -> Global {
        let Self { samples, searches, apart, spread, tolerance, evaluations, seed, .. } = *self;
        Global { samples, searches, apart, spread, tolerance, evaluations, seed }
    }

    /// The box that is searched.
    pub(super) fn space(&self, variables: &[Parameter], bounds: &[Bounds]) -> Result<Space, Rule> {
        for (name, share) in [("spread", self.spread), ("basin", self.basin), ("apart", self.apart)] {
            if !(share > 0.0 && share <= 1.0) {
                let field = format!("optimize.global.{name}");
                return Err(Rule::not_allowed(field, share, "a number above 0 and at most 1"));
            }
        }
        for (name, count, most) in [
            ("samples", self.samples.into(), 65_536),
            ("searches", self.searches as u64, 1000),
            ("evaluations", self.evaluations, u64::MAX),
        ] {
            if !(1..=most).contains(&count) {
                let allowed = "a whole number above 0 (at most 65536 samples, 1000 searches)";
                return Err(Rule::not_allowed(format!("optimize.global.{name}"), count, allowed));
            }
        }
        if !(self.tolerance >= 0.0 && self.tolerance.is_finite()) {
            let allowed = "a finite number not below 0";
            return Err(Rule::not_allowed("optimize.global.tolerance", self.tolerance, allowed));
        }
        let sides = variables.iter().zip(bounds).map(|(&variable, bounds)| self.side(variable, bounds));
        sides.collect::<Result<Vec<Side>, Rule>>().map(Space)
    }

    fn side(&self, variable: Parameter, bounds: &Bounds) -> Result<Side, Rule> {
        let side = match (self.sides.get(variable), bounds.lower.zip(bounds.upper)) {
            (Some(BoxSide { from, to, scale: Some(scale) }), _) => Side { from, to, scale },
            (Some(BoxSide { from, to, scale: None }), _) => Side::natural(from, to),
            (None, Some((from, to))) => Side::natural(from, to),
            (None, None) => return Err(Rule::NoEnd { variable }),
        };
        let Side { from, to, scale } = side;
        if !(bounds.contain(from) && bounds.contain(to) && from < to && to.is_finite()) {
            let (field, value) = (format!("optimize.global.box.{variable}"), format!("{from} to {to}"));
            return Err(Rule::not_allowed(field, value, "`from` below `to`, both within the bounds"));
        }
        if scale == Scale::Log && from <= 0.0 {
            let field = format!("optimize.global.box.{variable}.from");
            return Err(Rule::not_allowed(field, from, "a number above 0 on a side of ratios (\"log\")"));
        }
        Ok(side)
    }
}
