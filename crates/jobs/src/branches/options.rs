//! The options of `branches`: the parameter, its range, the numbers of runs.

use crate::Error;
use crate::describe::forced;
use retune_dynamics::periodic::branches::{Plan, SPACINGS};
use retune_model::Parameter;
use retune_study::Study;
use serde_json::{Value, json};

/// Most samples, and most starts at each.
const MOST: usize = 10_000;

/// The options as typed.
#[derive(Clone, Debug)]
pub struct Options {
    /// The parameter.
    pub over: Parameter,
    /// Its least value; by default that of the band of the study, or 0.8 of its own.
    pub from: Option<String>,
    /// Its largest value; by default that of the band of the study, or 1.25 of its own.
    pub to: Option<String>,
    /// Number of values at which runs are started from rest.
    pub samples: usize,
    /// Number of other starts for each, over the whole range and the states that the force can reach.
    pub starts: usize,
    /// Number of runs at each value from whose states deflated Newton iterations look for further motions.
    pub apart: usize,
    /// Number of values at which a run from rest alone is followed as well.
    pub fine: usize,
    /// Whether to look for the force at which an isola begins.
    pub margin: bool,
    /// The value of the parameter at which the basins are computed; by default none are.
    pub basins: Option<String>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            over: Parameter::Omega,
            from: None,
            to: None,
            samples: 31,
            starts: 16,
            apart: 0,
            fine: 3001,
            margin: false,
            basins: None,
        }
    }
}

impl Options {
    /// The plan for a study, and the value at which basins are asked for.
    pub(crate) fn plan(&self, study: &Study) -> Result<(Plan, Option<f64>), Error> {
        let Self { over, samples, starts, apart, fine, .. } = *self;
        study.begins_at_rest().map_err(Error::rule(study))?;
        let refuse = |option, problem| Error::Argument { option, problem };
        if study.scene.damper.is_none() {
            let problem = "the scene has no damper: its steady response is known in closed form".to_owned();
            return Err(refuse("STUDY", problem));
        }
        if study.scene.forcing.is_transient() {
            let forcing = forced(&study.scene.forcing);
            let problem =
                format!("the structure is {forcing}: only a forcing with an omega has periodic motions");
            return Err(refuse("STUDY", problem));
        }
        if let Some((amplitude, size)) = study.scene.forcing.amplitude()
            && size.get() == 0.0
            && over != amplitude
        {
            let problem =
                format!("{} is 0: nothing moves the structure; give it a value above 0", amplitude.symbol());
            return Err(refuse("STUDY", problem));
        }
        if self.margin && over != Parameter::Omega {
            let problem = format!("an isola is looked for over omega, not over {}", over.symbol());
            return Err(refuse("--margin", problem));
        }
        if !over.has_derivative() {
            let known = Parameter::differentiable(", ");
            return Err(refuse("--over", format!("{over}: branches are followed over one of {known}")));
        }
        let [low, high] = default_range(over, study)?;
        let end = |option, text: &Option<String>, otherwise: f64| {
            let value = text.as_ref().map_or(Ok(otherwise), |text| over.read(text));
            let value = value.map_err(|problem| refuse(option, problem))?;
            match over.at(study.scene, value) {
                Ok(_) if value.is_finite() && value > 0.0 => Ok(value),
                Err(reason) if value > 0.0 => Err(refuse(option, format!("{over}: {reason}"))),
                _ => Err(refuse(option, format!("{value} {}: give a value above 0", over.unit()))),
            }
        };
        let range = [end("--from", &self.from, low)?, end("--to", &self.to, high)?];
        if range[0] >= range[1] {
            return Err(refuse("--to", format!("{} is not above --from {}", range[1], range[0])));
        }
        let runs = format!("give 2 to {MOST}");
        for (option, count, least, allowed) in [
            ("--samples", samples, 2, runs.clone()),
            ("--starts", starts, 0, format!("give at most {MOST}")),
            ("--apart", apart, 0, format!("give at most {MOST}")),
            ("--fine", fine, if fine == 0 { 0 } else { 2 }, format!("{runs}, or 0 for none")),
        ] {
            if count < least || count > MOST {
                return Err(refuse(option, format!("{count} is not allowed here: {allowed}")));
            }
        }
        let basins = self.basins.as_ref().map(|_| end("--basins", &self.basins, low)).transpose()?;
        let plan = Plan { samples, starts, apart, fine, passes: SPACINGS.len(), ..Plan::over(over, range) };
        Ok((plan, basins))
    }
}

/// The band of the study for ω, else from 0.8 to 1.25 of the scene's own value.
fn default_range(over: Parameter, study: &Study) -> Result<[f64; 2], Error> {
    let band = study.objective().omega.map(|band| band.of(&study.scene.primary));
    if let (Parameter::Omega, Some(band)) = (over, band) {
        return Ok([band.from, band.to]);
    }
    match over.of(&study.scene) {
        Some(nominal) => {
            let high = 1.25 * nominal;
            // No restitution is above 1.
            Ok([0.8 * nominal, if over == Parameter::Restitution { high.min(1.0) } else { high }])
        }
        None => Err(Error::Argument {
            option: "--over",
            problem: format!("the scene of study {} has no {}", study.name(), over.symbol()),
        }),
    }
}

/// The plan as it stands in the resolved study.
pub(crate) fn plan_json(plan: &Plan) -> Value {
    let Plan { parameter, range: [from, to], samples, starts, apart, fine, .. } = plan;
    json!({ "over": parameter.symbol(), "from": from, "to": to, "samples": samples, "starts": starts, "apart": apart, "fine": fine })
}

/// The plan in a resolved study; none if it is not one.
pub(crate) fn plan_of(json: &Value) -> Option<Plan> {
    let count = |name: &str| json[name].as_u64().map(|count| count as usize);
    let range = [json["from"].as_f64()?, json["to"].as_f64()?];
    Some(Plan {
        samples: count("samples")?,
        starts: count("starts")?,
        apart: count("apart")?,
        fine: count("fine")?,
        passes: SPACINGS.len(),
        ..Plan::over(json["over"].as_str()?.parse().ok()?, range)
    })
}
