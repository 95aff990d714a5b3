//! Which E1max a search makes small: at one ω or the worst over a band, in a window of time or steady.

use super::{Rule, Study};
use retune_model::Positive;
use retune_optim::When;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which E1max is made small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Objective {
    /// The worst over a band of omega; leave it out (or null) for the omega of `scene` alone.
    pub omega: Option<Band>,
    /// Where E1max is taken: in `window`, or steady.
    pub response: Response,
}

/// A band of angular frequencies: E1max is the largest over it, with its peaks refined between samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Band {
    /// Lowest angular frequency, rad/s.
    pub from: Positive,
    /// Highest angular frequency, rad/s.
    pub to: Positive,
    /// Evenly spaced frequencies at which runs are made first, both ends included; each maximum of them is then refined between
    /// its neighbours by at most 12 more. What is found this way is a lower bound: a peak that shows at no sample is missed. The
    /// steady response needs no samples: it is exact over the whole band.
    #[serde(default = "samples")]
    #[schemars(range(min = 2, max = 10000))]
    pub samples: usize,
}

/// When E1max is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Response {
    /// The largest in `window` of a run from rest.
    #[default]
    Window,
    /// The largest once all transients have died, in closed form. A design whose damper would reach a wall has no value; the
    /// solver only runs the design that was found.
    Steady,
}

fn samples() -> usize {
    61
}

/// Most samples of a band: at a third of a millisecond each, three seconds for a design.
const MOST_SAMPLES: usize = 10_000;

impl Objective {
    /// Whether it is that of a study that does not name one.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Checks the band.
    ///
    /// # Errors
    /// [`Rule::EmptyBand`], [`Rule::Samples`].
    pub(super) fn check(&self) -> Result<(), Rule> {
        let Some(Band { from, to, samples }) = self.omega else { return Ok(()) };
        if from >= to {
            return Err(Rule::EmptyBand { from: from.get(), to: to.get() });
        }
        match samples {
            2..=MOST_SAMPLES => Ok(()),
            _ => Err(Rule::Samples { samples, most: MOST_SAMPLES }),
        }
    }

    /// The band as searches take it.
    pub fn band(&self) -> Option<retune_optim::Band> {
        let Band { from, to, samples } = self.omega?;
        Some(retune_optim::Band { from: from.get(), to: to.get(), samples })
    }
}

impl Study {
    /// Which E1max its search makes small.
    pub fn objective(&self) -> Objective {
        self.optimize.as_ref().map(|optimize| optimize.objective).unwrap_or_default()
    }

    /// When E1max is taken.
    pub fn when(&self) -> When {
        match self.objective().response {
            Response::Window => When::Window(self.window.window()),
            Response::Steady => When::Steady,
        }
    }
}
