//! The value of a design under other records than those of its study: the other sign, other draws, fewer samples.

use super::certificate::{Certificate, Found, Records, UnderRecord};
use crate::Error;
use rayon::prelude::*;
use retune_model::{Forcing, History, Scene, Source};
use retune_study::Study;

/// Other draws of a random force.
const DRAWS: u64 = 5;

/// How records are changed.
#[derive(Clone, Copy)]
enum Change {
    Sign,
    Samples,
    Draw(u64),
}

impl Change {
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

    /// A changed forcing; none where there is nothing to change.
    fn forcing(self, forcing: &Forcing) -> Option<Forcing> {
        let source = Source::History(self.of(*forcing.history()?)?);
        Some(Forcing { source, ..*forcing })
    }
}

/// The design of a certificate under other records; none where its study has no record.
pub(super) fn other_records(study: &Study, certificate: &Certificate) -> Option<Records> {
    study.scene.forcing.history()?;
    let draws = (1..=DRAWS).map(Change::Draw);
    let changes: Vec<Change> = [Change::Sign, Change::Samples].into_iter().chain(draws).collect();
    let under: Vec<UnderRecord> = changes.into_par_iter().filter_map(|change| under(study, change)).collect();
    (!under.is_empty()).then(|| Records::new(certificate.value, under))
}

fn under(study: &Study, change: Change) -> Option<UnderRecord> {
    let (mut goal, mut scene, mut any) = (study.goal(), study.scene, false);
    let mut changed = |forcing: &mut Forcing| {
        if let Some(other) = change.forcing(forcing) {
            (*forcing, any) = (other, true);
        }
    };
    changed(&mut scene.forcing);
    goal.objective.for_each_term(&mut |term| term.records.iter_mut().for_each(&mut changed));
    let found = |scene: &Scene| goal.evaluate(scene, &study.solver.settings(), f64::INFINITY);
    any.then(|| UnderRecord {
        under: change.words(),
        found: Found::new(found(&scene).map_err(Error::from), !goal.limits.is_empty()),
    })
}
