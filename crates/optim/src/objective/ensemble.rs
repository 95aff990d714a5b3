//! A deterministic ensemble of scenes about one: other phases of the force, small errors of parameters. Where the motion is
//! irregular one run is a single realisation of a distribution; a statistic of the ensemble is a property of the design.

use crate::chunks::{TOGETHER, in_groups};
use retune_model::{OutOfRange, Parameter, Scene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The statistic of E1max over the members.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "Of")]
pub enum Statistic {
    /// The mean.
    #[default]
    Mean,
    /// The largest.
    Worst,
    /// The quantile: the smallest value that at least this fraction of the members, above 0 and at most 1, does not exceed.
    Quantile(#[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))] f64),
}

/// A deterministic ensemble of perturbed scenes, the same for every design: the points of a scrambled Sobol sequence.
// Owen-scrambled Sobol points (B. Burley, Practical Hash-based Owen Scrambling, J. Comput. Graph. Tech. 9(4), 2020), so that a few
// members fill their space evenly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ensemble {
    /// Number of members.
    #[schemars(range(min = 1, max = 65536))]
    pub members: u32,
    /// Whether each member has its own phase of the excitation P cos(omega t + phase), distributed evenly over 0 to 2π.
    #[serde(default = "yes")]
    pub phases: bool,
    /// Largest relative perturbation of k1, k2, c2, D and C of each member; perturbations are independent and uniformly distributed.
    #[serde(default = "errors")]
    #[schemars(range(min = 0.0), extend("exclusiveMaximum" = 1.0))]
    pub errors: f64,
    /// The statistic of E1max over the members.
    #[serde(default)]
    pub statistic: Statistic,
    /// Seed of the sequence.
    #[serde(default)]
    pub seed: u32,
}

fn yes() -> bool {
    true
}

fn errors() -> f64 {
    1e-3
}

/// The parameters that members have errors of, in the order of the sequence's dimensions behind the phase.
const PERTURBED: [Parameter; 5] = [Parameter::K1, Parameter::K2, Parameter::C2, Parameter::D, Parameter::C];

/// Most members: the length of the sequence.
pub const MOST_MEMBERS: u32 = 1 << 16;

impl Ensemble {
    /// The scene of member `i`, and the phase of its force, rad.
    ///
    /// # Errors
    /// A parameter that overflows.
    pub fn member(&self, scene: &Scene, i: u32) -> Result<(Scene, f64), OutOfRange> {
        let phase = if self.phases { TAU * self.point(i, 0) } else { 0.0 };
        let mut off = *scene;
        for parameter in PERTURBED {
            if let Some(value) = parameter.of(scene).filter(|_| self.errors > 0.0) {
                off = parameter.at(off, value * self.factor(parameter, i))?;
            }
        }
        Ok((off, phase))
    }

    /// A coordinate of the point of member `i`, 0 to 1.
    fn point(&self, i: u32, dimension: u32) -> f64 {
        f64::from(sobol_burley::sample(i, dimension, self.seed))
    }

    /// The factor on a parameter of a design in member `i`.
    pub(crate) fn factor(&self, parameter: Parameter, i: u32) -> f64 {
        let dimension = PERTURBED.iter().position(|perturbed| *perturbed == parameter);
        dimension.map_or(1.0, |number| 1.0 + self.errors * (2.0 * self.point(i, number as u32 + 1) - 1.0))
    }

    /// The statistic of `value(member, cutoff)` over all members. The values are not negative. A result above `cutoff` is only
    /// known to be above, and so may be those that `value` gives above the cutoff it is given.
    ///
    /// # Errors
    /// The first error of a member.
    pub fn over<E: Send + Sync + Clone>(
        &self,
        value: impl Fn(u32, f64) -> Result<f64, E> + Sync,
        cutoff: f64,
    ) -> Result<f64, E> {
        statistic_over(
            self.statistic,
            self.members.max(1) as usize,
            &|i, cutoff| value(i as u32, cutoff),
            cutoff,
        )
    }
}

/// A statistic of `value(i, cutoff)` over `count` cases, see [`Ensemble::over`].
///
/// # Errors
/// The first error of a case.
pub(super) fn statistic_over<E: Send + Sync + Clone>(
    statistic: Statistic,
    count: usize,
    value: &(dyn Fn(usize, f64) -> Result<f64, E> + Sync),
    cutoff: f64,
) -> Result<f64, E> {
    let known = |results: &[Result<f64, E>]| -> Vec<f64> { results.iter().flatten().copied().collect() };
    let failed = |results: &[Result<f64, E>]| results.iter().any(Result::is_err);
    // A mean is above the cutoff once a partial sum shows it, with a margin for rounding.
    let most = count as f64 * cutoff * SLACK;
    let rank = rank(statistic, count);
    let results = in_groups(
        count,
        TOGETHER,
        &|i, before| match statistic {
            Statistic::Mean => value(i, most - known(before).iter().sum::<f64>()),
            _ => value(i, cutoff),
        },
        &|results| {
            failed(results)
                || match statistic {
                    Statistic::Mean => known(results).iter().sum::<f64>() > most,
                    _ => known(results).iter().filter(|value| **value > cutoff).count() > count - rank,
                }
        },
    );
    let mut values = results.into_iter().collect::<Result<Vec<f64>, E>>()?;
    if statistic == Statistic::Mean {
        return Ok(values.iter().sum::<f64>() / count as f64);
    }
    values.sort_by(f64::total_cmp);
    // Where the groups ended early, the largest value is above the cutoff.
    let place = if values.len() < count { values.len() } else { rank };
    Ok(values[place - 1])
}

impl Ensemble {
    /// The derivative of the statistic by the value of each member, in their order; for a quantile, 1 for the member that gives it.
    pub(crate) fn by_member(&self, values: &[f64]) -> Vec<f64> {
        let count = values.len();
        if self.statistic == Statistic::Mean {
            return vec![1.0 / count as f64; count];
        }
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        let place = order.get(rank(self.statistic, count) - 1);
        (0..count).map(|i| f64::from(u8::from(Some(&i) == place))).collect()
    }
}

/// Share by which a sum must pass a cutoff to be above it whatever its rounding.
pub(crate) const SLACK: f64 = 1.0 + 1e-9;

/// The rank of a statistic among `count` sorted values, from 1.
fn rank(statistic: Statistic, count: usize) -> usize {
    match statistic {
        Statistic::Quantile(share) => ((share * count as f64).ceil() as usize).clamp(1, count),
        Statistic::Mean | Statistic::Worst => count,
    }
}
