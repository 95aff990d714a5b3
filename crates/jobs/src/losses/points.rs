//! The dampers of `losses` at each restitution, and their table.

use crate::contacts::Powers;
use crate::recompute::{Row, Source};
use crate::resolved::Resolved;
use crate::{Error, columns};
use retune_model::{Design, Parameter};
use retune_report::cells;
use retune_report::table::{Cell, Table};
use retune_solver::simulate_in_detail;
use retune_study::{Rule, Setting, Study};
use std::path::Path;

pub(super) const FILE: &str = "losses.csv";

/// What a damper was tuned for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tuning {
    /// The paper's.
    Paper,
    /// The damper of the study's scene.
    Study,
    /// For lossless contacts.
    Lossless,
    /// For all restitutions at once.
    Hedged,
    /// For each restitution.
    Anew,
}

impl Tuning {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Paper, Self::Study, Self::Lossless, Self::Hedged, Self::Anew];

    /// Its name in the table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Study => "of the study",
            Self::Lossless => "tuned without loss",
            Self::Hedged => "tuned for all",
            Self::Anew => "re-tuned",
        }
    }
}

/// A design at a restitution, and its performance there.
#[derive(Clone, Debug)]
pub struct Point {
    /// The restitution.
    pub restitution: f64,
    /// The design.
    pub design: Design,
    /// The value of the objective, worst over its band.
    pub value: f64,
    /// The worst frequency, rad/s.
    pub omega: f64,
    /// Mean powers lost in the window of that run, in the dashpots of the structure and of the damper and in impacts, W.
    pub powers: [f64; 3],
    /// Largest impact speed in that window, m/s.
    pub impact_speed: f64,
}

impl Point {
    pub(super) fn new(study: &Study, restitution: f64, design: Design) -> Result<Self, Error> {
        let alone = at(study, restitution)?;
        let scene = alone.scene_at(&design).ok_or_else(|| Error::rule(study)(Rule::NoDamper))?;
        let (settings, window) = (alone.solver.settings(), alone.window.window());
        let found = alone.goal().evaluate(&scene, &settings, f64::INFINITY)?;
        let run = found.worst_run(scene, &alone.goal());
        let (_, lost, walls) = simulate_in_detail(&run, window, &settings)?;
        let powers = Powers::new(lost, window.to - window.from).parts();
        let impact_speed = walls.iter().map(|wall| wall.speed).fold(0.0, f64::max);
        let omega = run.forcing.frequency.get();
        Ok(Self { restitution, design, value: found.value, omega, powers, impact_speed })
    }

    /// The named numbers of its row that follow from restitution and design.
    fn numbers(&self, study: &Study) -> [(&'static str, f64); 6] {
        let [structure, damper, impacts] = self.powers;
        [
            (study.quantity().name(), self.value),
            ("omega", self.omega),
            ("power_structure", structure),
            ("power_damper", damper),
            ("power_impacts", impacts),
            ("impact_speed", self.impact_speed),
        ]
    }
}

/// The study for one restitution alone.
pub(super) fn at(study: &Study, restitution: f64) -> Result<Study, Error> {
    let mut alone = study.with(&[Setting::new(Parameter::Restitution, restitution)])?;
    if let Some(optimize) = &mut alone.optimize {
        optimize.objective.restitution = None;
    }
    Ok(alone)
}

/// All points.
#[derive(Debug)]
pub struct Losses {
    /// The points, by damper.
    pub points: Vec<(Tuning, Point)>,
    /// The study.
    pub study: Study,
}

impl Losses {
    /// The points of a damper, by falling restitution.
    pub fn of(&self, tuning: Tuning) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(move |(own, _)| *own == tuning).map(|(_, point)| point)
    }

    /// The dampers that are compared.
    pub fn tunings(&self) -> Vec<Tuning> {
        Tuning::ALL.into_iter().filter(|tuning| self.of(*tuning).next().is_some()).collect()
    }

    pub(super) fn table(&self) -> Table {
        let parameters = columns::of_designs(self.points.iter().map(|(_, point)| &point.design));
        let first = [&["damper", "restitution"], &*columns::symbols(&parameters)].concat();
        let mut table = Table::default();
        for (tuning, point) in &self.points {
            let (names, numbers): (Vec<&str>, Vec<Cell>) =
                point.numbers(&self.study).map(|(name, number)| (name, number.into())).into_iter().unzip();
            table.columns = columns::table(&[&*first, &names].concat()).columns;
            let first = cells![tuning.name(), point.restitution];
            table.push([first, columns::cells_of(&point.design, &parameters), numbers].concat());
        }
        table
    }
}

/// Recomputes the rows of the table from design and restitution.
pub(super) fn recompute(place: &Path, _name: &str) -> Result<Source, Error> {
    let (_, study) = Resolved::one(place)?;
    Ok(Source::new(move |row: Row| {
        let point = Point::new(&study, row.number("restitution"), row.design()?).ok()?;
        Some(point.numbers(&study).map(|(name, number)| (name.to_owned(), number)).into())
    }))
}
