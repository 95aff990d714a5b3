//! Tables of designs in the form of the paper's Table 2, as `table2`, `retention` and `design` make them.

use crate::needs::{Largest, REPORTED};
use crate::recompute::Source;
use crate::resolved::Resolved;
use crate::summary::TunedDamper;
use crate::tune::{Optimum, objective, table2_header, table2_row};
use crate::{Error, columns};
use retune_model::{Measure, Parameter};
use retune_optim::Limit;
use retune_report::cells;
use retune_report::table::Table;
use retune_store::Directory;
use retune_study::{Study, rounded, short};
use serde::Serialize;
use std::path::Path;

/// A table of designs: the paper's columns, a label column, and the values of each design.
#[derive(Debug, Serialize)]
pub struct Designs {
    /// The name of the label column.
    pub column: &'static str,
    /// The rows.
    pub rows: Vec<Row>,
    /// The error of the first search that found no design within its limits; the table has the nearest one.
    #[serde(skip)]
    pub infeasible: Option<Error>,
}

/// A row of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The entry in the label column.
    pub label: String,
    /// The damper in words.
    pub damper: String,
    /// Its parameters.
    #[serde(flatten)]
    pub found: TunedDamper,
    /// The E1max that the paper prints for it, J.
    #[serde(rename = "E1max_printed", skip_serializing_if = "Option::is_none")]
    pub printed: Option<f64>,
    /// E1max by the objective of its study, J.
    #[serde(rename = "E1max")]
    pub e1_max: f64,
    /// E1max without a damper, J; infinite for an undamped structure at resonance.
    #[serde(rename = "E1max_none")]
    pub none: f64,
    /// The verdict of its certificate.
    pub verdict: &'static str,
    /// The reason for it, in words.
    pub reason: String,
    /// The largest values over all that the objective covers, from rest on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub needs: Option<Largest>,
}

impl Row {
    /// A row with the design that a search has found.
    pub fn of_optimum(label: &str, damper: &str, study: &Study, optimum: &Optimum) -> Self {
        Self {
            label: label.to_owned(),
            damper: damper.to_owned(),
            found: optimum.damper,
            printed: None,
            e1_max: optimum.value(),
            none: study.energy_without_damper(),
            verdict: optimum.verdict(),
            reason: optimum.reason().to_owned(),
            needs: optimum.needs.as_ref().map(|needs| needs.damper),
        }
    }
}

impl Designs {
    /// Writes the table as `name.csv` and `name.txt`.
    pub fn write(&self, name: &str, results: &Directory) -> Result<(), Error> {
        results.write(&format!("{name}.csv"), &self.table().csv())?;
        Ok(results.write(&format!("{name}.txt"), &(self.text() + "\n"))?)
    }

    /// The parameters with columns in the table, besides m2.
    pub fn parameters(&self) -> Vec<Parameter> {
        columns::of_designs(self.rows.iter().map(|row| &row.found.design))
    }

    /// The table as data.
    pub fn table(&self) -> Table {
        let parameters = self.parameters();
        let (symbols, needs) = (columns::symbols(&parameters), REPORTED.map(Measure::name));
        let energies = ["E1max", "E1max_printed", "E1max_none"];
        let mut table = columns::table(
            &[&[self.column, "damper", "m2"], &*symbols, &energies, &needs, &["verdict"]].concat(),
        );
        for Row { label, damper, found, printed, e1_max, none, verdict, needs, .. } in &self.rows {
            let first = cells![label.as_str(), damper.as_str(), found.mass.get()];
            let needs = REPORTED.map(|measure| needs.map(|needs| needs.value(measure)).into());
            let energies = cells![*e1_max, *printed, *none];
            let design = columns::cells_of(&found.design, &parameters);
            table.push([first, design, energies, needs.to_vec(), cells![*verdict]].concat());
        }
        table
    }

    /// The table as text, without an end of line.
    pub fn text(&self) -> String {
        let any_printed = self.rows.iter().any(|row| row.printed.is_some());
        let printed = |text: &str| if any_printed { format!("{text:<10}") } else { String::new() };
        let (head, column) = (table2_header(), self.column);
        let mut lines = vec![format!(
            "{column:<14}{head:<84}{}{:<11}{:<8}verdict",
            printed("printed"),
            "E1max, J",
            "none /"
        )];
        for row in &self.rows {
            let Row { label, damper, found, e1_max, verdict, .. } = row;
            let (printed, damper) =
                (printed(&row.printed.map(short).unwrap_or_default()), table2_row(damper, found));
            let (e1_max, times) = (apart(&short(*e1_max), 11), row.none / e1_max);
            let label = apart(label, 14);
            lines.push(format!("{label}{damper:<84}{printed}{e1_max}{times:<8.2}{verdict}"));
        }
        lines.push(String::new());
        for Row { label, damper, found, needs, reason, .. } in &self.rows {
            // The parameters without a column in the table above.
            let others = self.parameters().into_iter().filter(|other| !Parameter::PAPER.contains(other));
            let others: String = others
                .map(|other| (other, found.design.get(other)))
                .filter(|(_, value)| !value.is_nan())
                .map(|(other, value)| format!("{other} = {} {}; ", rounded(value, 6), other.unit()))
                .collect();
            let needs = needs.map_or(String::new(), |needs| format!("needs {}; ", needs.list()));
            lines.push(format!("{damper}, {label}: {others}{needs}{reason}"));
        }
        lines.join("\n")
    }

    /// Refuses a table with a design that breaks the limits of its study by [`Error::Infeasible`].
    ///
    /// # Errors
    /// [`Error::Infeasible`], of the first search.
    pub fn check_limits(self) -> Result<(), Error> {
        self.infeasible.map_or(Ok(()), Err)
    }
}

/// A text in a column, followed by at least one space.
fn apart(text: &str, width: usize) -> String {
    format!("{:<width$}", format!("{text} "))
}

/// Recomputes the values of a row by the objective of its damper's study: E1max, stroke and contact force on the samples of the plan;
/// without these, E1max on those of the study; and the largest values from rest on, where the row has them.
pub(crate) fn recompute(place: &Path, _name: &str) -> Result<Source, Error> {
    let resolved = Resolved::read(place)?;
    let samples = resolved.plan["samples"].as_u64().map(|samples| samples as usize);
    let studies = resolved.studies()?;
    let source = Source::new(move |row| {
        let (_, study) = studies.iter().find(|(name, _)| name == row.text("damper"))?;
        let at = row.design().filter(|_| !row.number("E1max").is_nan())?;
        let scene = study.scene_at(&at)?;
        let mut numbers = Vec::new();
        let mut say = |name: &str, value: f64| numbers.push((name.to_owned(), value));
        match samples {
            Some(samples) => {
                let found =
                    objective::with_samples(study, samples, &at).and_then(|study| objective::worst(&study));
                say("E1max", found.as_ref().map_or(f64::INFINITY, |found| found.value));
                for measure in [Measure::Stroke, Measure::ContactForce] {
                    let limit = Limit::Of(measure);
                    say(measure.name(), found.as_ref().map_or(f64::NAN, |found| found.reached.get(limit)));
                }
            }
            None => say("E1max", study.energy(&scene).unwrap_or(f64::INFINITY)),
        }
        let wanted = REPORTED.into_iter().filter(|measure| {
            let has = samples.is_none() || !matches!(measure, Measure::Stroke | Measure::ContactForce);
            has && !row.number(measure.name()).is_nan()
        });
        let wanted: Vec<Measure> = wanted.collect();
        if !wanted.is_empty() {
            let needs = Largest::of(study, &scene);
            wanted.into_iter().for_each(|measure| {
                say(measure.name(), needs.map_or(f64::NAN, |needs| needs.value(measure)));
            });
        }
        Some(numbers)
    });
    // A row with empty fields stands for a bound that no design keeps.
    Ok(source.only(|row| ["k2", "c2", "D", "C", "E1max"].iter().any(|name| !row.text(name).is_empty())))
}
