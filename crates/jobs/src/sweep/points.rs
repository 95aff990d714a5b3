//! The points of a sweep. Each depends on its value alone, so they can be computed in any order, by any number of machines.

use crate::Error;
use crate::columns::column;
use crate::rows::Rows;
use crate::sweep::plan::{Plan, Quantity};
use retune_model::{Measure, Parameter, Scene};
use retune_optim::{Axis, Goal, Limits, Objective};
use retune_report::table::{Cell, Column, Table};
use retune_solver::{SolverError, decay_time, simulate};
use retune_study::{Rule, Setting, Study, hertz_and_rpm};

/// A plan with its study.
#[derive(Clone, Debug)]
pub struct Sweep {
    plan: Plan,
    study: Study,
    axis: Axis,
}

impl Rows for Sweep {
    fn len(&self) -> usize {
        self.axis.points()
    }

    fn width(&self) -> usize {
        match (self.plan.objective, self.study.scene.damper) {
            (true, _) => OBJECTIVE,
            (false, Some(_)) => self.of_structure() + OF_DAMPER + self.of_structure(),
            (false, None) => self.of_structure(),
        }
    }

    fn numbers(&self, row: usize) -> (Vec<f64>, Option<String>) {
        self.numbers_at(self.value(row))
    }
}

/// Numbers of the damper in a run: its largest values, and its impacts.
const OF_DAMPER: usize = Measure::OF_DAMPER.len() + 2;
/// Numbers of an objective: its value, the frequency of its worst run, the violation of the limits, and its value without a damper.
const OBJECTIVE: usize = 4;

impl Sweep {
    /// Checks a plan for a study.
    ///
    /// # Errors
    /// The scene cannot have one of the values, or the objective does not depend on the parameter.
    pub fn new(plan: Plan, study: Study) -> Result<Self, Error> {
        let axis = plan.axis()?;
        // The allowed values of a parameter form an interval, so checking both ends suffices.
        for end in [plan.from, plan.to] {
            study.scene_with(&[Setting::new(plan.over, end)])?;
        }
        if plan.objective {
            if study.optimize.is_none() {
                return Err(Error::rule(&study)(Rule::NoOptimize));
            }
            let objective = study.objective();
            let takes_its_own = |term: &Objective| match plan.over {
                Parameter::Omega => term.omega.is_some(),
                Parameter::K1 => term.k1.is_some(),
                Parameter::Restitution => term.restitution.is_some(),
                _ => false,
            };
            if objective.terms().iter().all(|(_, term)| takes_its_own(term)) {
                let over = plan.over;
                let problem = format!(
                    "{over}: the objective takes its own values of {over}, so that it does not change with that of the scene: \
                     sweep another parameter, or leave out --objective"
                );
                return Err(Error::Argument { option: "--over", problem });
            }
        }
        Ok(Self { plan, study, axis })
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// The value of the parameter at a point, in its SI unit.
    pub fn value(&self, point: usize) -> f64 {
        self.axis.value(point)
    }

    /// The numbers at a value of the parameter, infinite where missing, and if so the reason for the first.
    pub fn numbers_at(&self, value: f64) -> (Vec<f64>, Option<String>) {
        let scene = match self.study.scene_with(&[Setting::new(self.plan.over, value)]) {
            Ok(scene) => scene,
            Err(error) => return (vec![f64::INFINITY; self.width()], Some(error.to_string())),
        };
        let (mut numbers, reason) =
            if self.plan.objective { self.objective(&scene) } else { self.runs(&scene) };
        // To a journal, NaN means a number that was never computed.
        numbers.iter_mut().filter(|number| !number.is_finite()).for_each(|number| *number = f64::INFINITY);
        (numbers, reason)
    }

    /// Whether its runs have a decay time instead of a transmissibility.
    fn decays(&self) -> bool {
        self.study.scene.forcing.is_transient()
    }

    /// Number of a run's numbers for the structure: its largest values, and its decay time if it has one.
    fn of_structure(&self) -> usize {
        Measure::OF_STRUCTURE.len() + usize::from(self.decays())
    }

    fn runs(&self, scene: &Scene) -> (Vec<f64>, Option<String>) {
        let bare = Scene { damper: None, ..*scene };
        let scenes = scene.damper.map(|_| *scene).into_iter().chain([bare]);
        let (mut numbers, mut reason) = (Vec::with_capacity(self.width()), None);
        for scene in scenes {
            let before = numbers.len();
            if let Err(error) = self.run(&scene, &mut numbers) {
                let of_damper = if scene.damper.is_some() { OF_DAMPER } else { 0 };
                numbers.resize(before + self.of_structure() + of_damper, f64::INFINITY);
                reason = reason.or_else(|| Some(error.to_string()));
            }
        }
        (numbers, reason)
    }

    /// The numbers of a run: of the structure, then of the damper if there is one.
    fn run(&self, scene: &Scene, numbers: &mut Vec<f64>) -> Result<(), SolverError> {
        let (window, settings) = (self.study.window.window(), self.study.solver.settings());
        let run = simulate(scene, window, &settings)?;
        let decay = if self.decays() { decay_time(scene, window.to, &settings)? } else { None };
        numbers.extend(Measure::OF_STRUCTURE.map(|measure| run.largest(measure)));
        numbers.extend(self.decays().then(|| decay.unwrap_or(f64::INFINITY)));
        if scene.damper.is_some() {
            numbers.extend(Measure::OF_DAMPER.map(|measure| run.largest(measure)));
            numbers.extend(run.impacts.map(|count| count as f64));
        }
        Ok(())
    }

    fn objective(&self, scene: &Scene) -> (Vec<f64>, Option<String>) {
        let (goal, settings) = (self.study.goal(), self.study.solver.settings());
        let bare = Goal { limits: Limits::default(), ..goal.clone() };
        let bare = bare.evaluate(&Scene { damper: None, ..*scene }, &settings, f64::INFINITY);
        let none = bare.map_or(f64::INFINITY, |found| found.value);
        match goal.evaluate(scene, &settings, f64::INFINITY) {
            Ok(found) => {
                let omega = found.worst_omega().unwrap_or(f64::INFINITY);
                // An empty sum of violations is -0.
                (vec![found.value, omega, found.violation + 0.0, none], None)
            }
            Err(error) => (vec![f64::INFINITY, f64::INFINITY, f64::INFINITY, none], Some(error.to_string())),
        }
    }

    /// The columns of its table.
    pub fn columns(&self) -> Vec<Column> {
        let mut columns = vec![column(self.plan.over.symbol())];
        if self.plan.over.is_frequency() {
            columns.extend([Column::new("f_Hz", "Hz"), Column::new("n_rpm", "rpm")]);
        }
        if self.plan.objective {
            let name = self.study.quantity().name();
            columns.extend([name, "omega_worst", "violation", &format!("{name}_none")].map(column));
            return columns;
        }
        let last = if self.decays() { Measure::DecayTime.name() } else { Quantity::Transmissibility.name() };
        let structure = || Measure::OF_STRUCTURE.map(Measure::name).into_iter().chain([last]);
        columns.extend(structure().map(column));
        if self.study.scene.damper.is_some() {
            columns.extend(Measure::OF_DAMPER.map(Measure::name).map(column));
            columns.extend(["impacts", "impacts_structure", "impacts_obstacle"].map(column));
            columns.extend(structure().map(|name| column(&format!("{name}_none"))));
        }
        columns
    }

    /// The row of a table at a value of the parameter, from its numbers.
    pub fn row(&self, value: f64, numbers: &[f64]) -> Vec<f64> {
        let mut row = vec![value];
        if self.plan.over.is_frequency() {
            row.extend(hertz_and_rpm(value));
        }
        if self.plan.objective {
            row.extend(numbers);
            return row;
        }
        let scene = self.study.scene_with(&[Setting::new(self.plan.over, value)]);
        let structure = |row: &mut Vec<f64>, numbers: &[f64]| {
            row.extend(numbers);
            if self.decays() {
                return;
            }
            let of = |measure| {
                Measure::OF_STRUCTURE.iter().position(|other| *other == measure).map(|i| numbers[i])
            };
            let [displacement, ground] = [Measure::Displacement, Measure::GroundForce].map(of);
            let share = scene.as_ref().ok().zip(displacement.zip(ground));
            row.push(
                share.map_or(f64::NAN, |(scene, (x1, force))| scene.forcing.transmissibility(x1, force)),
            );
        };
        let (first, others) = numbers.split_at(self.of_structure());
        structure(&mut row, first);
        if let Some((damper, bare)) = others.split_at_checked(OF_DAMPER) {
            let (largest, impacts) = damper.split_at(Measure::OF_DAMPER.len());
            row.extend(largest);
            row.extend([impacts[0] + impacts[1], impacts[0], impacts[1]]);
            structure(&mut row, bare);
        }
        row
    }

    /// The table of all points from their consecutive numbers; numbers that are not finite are left empty.
    pub fn table(&self, numbers: &[f64]) -> Table {
        let mut table = Table::new(self.columns());
        for (i, numbers) in numbers.chunks(self.width()).enumerate() {
            let row = self.row(self.value(i), numbers);
            let cell = |(column, value): (&Column, f64)| match column.name.starts_with("impacts") {
                true if value.is_finite() => Cell::Count(value as u64),
                _ => Cell::finite(value),
            };
            let row = table.columns.iter().zip(row).map(cell).collect();
            table.push(row);
        }
        table
    }
}
