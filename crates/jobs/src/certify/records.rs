//! The value of a design under variants of the study's records: the other sign, other draws, fewer samples.

use super::certificate::verdict::or_none;
use super::walls::{Change, Changed, Outcome};
use crate::Error;
use crate::amount::Amount;
use rayon::prelude::*;
use retune_model::{Forcing, History, Scene, Source};
use retune_study::{Study, joined};
use serde::Serialize;

const DRAWS: u64 = 5;

#[derive(Clone, Copy)]
enum Variant {
    Sign,
    Samples,
    Draw(u64),
}

impl Variant {
    fn of(self, history: History) -> Option<History> {
        match self {
            Self::Sign => history.reversed(),
            Self::Samples => history.coarser(),
            Self::Draw(seeds) => history.drawn_again(seeds),
        }
    }

    fn words(self) -> String {
        match self {
            Self::Sign => "with the other sign".to_owned(),
            Self::Samples => "with every second sample".to_owned(),
            Self::Draw(seeds) => format!("with the seed + {seeds}"),
        }
    }

    /// The changed forcing; none where there is nothing to change.
    fn forcing(self, forcing: &Forcing) -> Option<Forcing> {
        let source = Source::History(self.of(*forcing.history()?)?);
        Some(Forcing { source, ..*forcing })
    }
}

/// The values of a design under other records; none where its study has no record.
pub(super) fn other_records(study: &Study, own: Amount) -> Option<Records> {
    // A stationary motion depends on the spectrum only, not on the draw.
    study.scene.forcing.history().filter(|_| !study.objective().is_stationary())?;
    let draws = (1..=DRAWS).map(Variant::Draw);
    // Without walls the values are the same under the other sign.
    let has_walls = study.scene.damper.is_some_and(|damper| damper.contact.is_some());
    let sign = has_walls.then_some(Variant::Sign);
    let changes: Vec<Variant> = sign.into_iter().chain([Variant::Samples]).chain(draws).collect();
    let under: Vec<Changed> = changes.into_par_iter().filter_map(|change| under(study, change)).collect();
    (!under.is_empty()).then(|| Records::new(own, under))
}

fn under(study: &Study, change: Variant) -> Option<Changed> {
    let (mut goal, mut scene, mut any) = (study.goal(), study.scene, false);
    let mut changed = |forcing: &mut Forcing| {
        if let Some(other) = change.forcing(forcing) {
            (*forcing, any) = (other, true);
        }
    };
    changed(&mut scene.forcing);
    goal.objective.for_each_term(&mut |term| term.records.iter_mut().for_each(&mut changed));
    let found = |scene: &Scene| goal.evaluate(scene, &study.solver.settings(), f64::INFINITY);
    any.then(|| Changed {
        change: Change::Under(change.words()),
        found: Outcome::new(found(&scene).map_err(Error::from), !goal.limits.is_empty()),
    })
}

#[derive(Clone, Debug, Serialize)]
pub struct Records {
    words: String,
    each: Vec<Changed>,
}

impl Records {
    /// The records of a design with this value.
    pub fn new(Amount { quantity, value, .. }: Amount, each: Vec<Changed>) -> Self {
        let others = each.iter().map(|one| one.words(quantity));
        let others = joined(&others.collect::<Vec<_>>(), ", ");
        let words = format!("{} {}; {others}", quantity.name(), or_none(value, quantity));
        Self { words, each }
    }

    pub fn words(&self) -> &str {
        &self.words
    }
}
