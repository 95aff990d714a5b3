//! The dampers of `losses` at each restitution, and their table.

use crate::columns;
use crate::contacts::Powers;
use retune_model::Design;
use retune_report::cells;
use retune_report::table::Table;
use retune_study::Study;
use serde::Serialize;

/// The table.
pub(super) const FILE: &str = "losses.csv";

/// For what a damper was tuned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tuning {
    /// The paper's.
    Paper,
    /// For contacts that lose nothing.
    Lossless,
    /// For all restitutions at once.
    Hedged,
    /// For each restitution.
    Anew,
}

impl Tuning {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Paper, Self::Lossless, Self::Hedged, Self::Anew];

    /// Its name in the table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Lossless => "tuned without loss",
            Self::Hedged => "tuned for all",
            Self::Anew => "re-tuned",
        }
    }
}

/// A damper at a restitution.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// For what it was tuned.
    pub tuning: Tuning,
    /// The restitution.
    pub restitution: f64,
    /// The design.
    pub design: Design,
    /// What it is worth there.
    pub worth: Worth,
}

/// What a damper is worth at a restitution.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Worth {
    /// The value of the objective, worst over its band.
    pub value: f64,
    /// Where, rad/s.
    pub omega: f64,
    /// Mean powers lost in the window of that run, W.
    pub powers: Powers,
    /// Largest impact speed in that window, m/s.
    pub impact_speed: f64,
}

/// All points.
#[derive(Debug, Serialize)]
pub struct Losses {
    /// The points, by damper.
    pub points: Vec<Point>,
    /// The study.
    #[serde(skip)]
    pub study: Study,
}

impl Losses {
    /// Those of a damper, by falling restitution.
    pub fn of(&self, tuning: Tuning) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(move |point| point.tuning == tuning)
    }

    /// The table.
    pub(super) fn table(&self) -> Table {
        let parameters = columns::of_designs(self.points.iter().map(|point| &point.design));
        let quantity = self.study.quantity().name();
        let last = [quantity, "omega", "power_structure", "power_damper", "power_impacts", "impact_speed"];
        let mut table =
            columns::table(&[&["damper", "restitution"], &*columns::symbols(&parameters), &last].concat());
        for Point { tuning, restitution, design, worth } in &self.points {
            let Worth { value, omega, powers, impact_speed } = worth;
            let [structure, damper, impacts] = powers.parts();
            table.push(
                [
                    cells![tuning.name(), *restitution],
                    columns::cells_of(design, &parameters),
                    cells![*value, *omega, structure, damper, impacts, *impact_speed],
                ]
                .concat(),
            );
        }
        table
    }
}
