//! The designs as a table of numbers in SI units, and the function that recomputes its rows.

use super::candidate::{Candidate, What};
use super::comparison::Comparison;
use crate::recompute::{Row, Source};
use crate::resolved::Resolved;
use crate::{Error, columns};
use retune_model::{Measure, Parameter, Scene};
use retune_report::cells;
use retune_report::table::{Cell, Table};
use retune_study::Study;
use std::path::Path;

/// The largest value of each quantity of a candidate and, under a harmonic, its frequency, each with its column.
fn numbers(of: &Candidate, measures: &[Measure]) -> Vec<(String, f64)> {
    let one = |measure: &Measure| {
        let (name, need) = (measure.name(), of.steady.get(*measure));
        let omega = (!of.is_transient()).then(|| (format!("omega_{name}"), need.omega));
        std::iter::once((name.to_owned(), need.value)).chain(omega)
    };
    measures.iter().flat_map(one).collect()
}

/// All candidates under all limits, and the dampers without each of them.
pub(super) fn table(compared: &Comparison) -> Table {
    let reported: Vec<Measure> = compared.measures().collect();
    let numbers = |of: &Candidate| numbers(of, &reported);
    let measures = numbers(&compared.none);
    let head = ["limits", "damper", "m2", "k2", "c2", "D", "C"];
    let all: Vec<&str> = head.into_iter().chain(measures.iter().map(|(name, _)| name.as_str())).collect();
    let mut table = columns::table(&all);
    let mut push = |limits: String, of: &Candidate| {
        let damper = of.damper();
        let value_of =
            |parameter: Parameter| damper.and_then(|damper| parameter.of_damper(&damper)).unwrap_or(f64::NAN);
        let design = Parameter::PAPER.map(|parameter| Cell::from(value_of(parameter)));
        let first = cells![limits, of.what.name(), value_of(Parameter::M2)];
        table.push(
            [first, design.to_vec(), numbers(of).into_iter().map(|(_, value)| value.into()).collect()]
                .concat(),
        );
    };
    compared.all().for_each(|of| push("all".to_owned(), of));
    for cost in &compared.costs {
        for of in std::iter::once(&cost.tmd).chain(&cost.ssvi) {
            push(format!("no {}", cost.constraint.name()), of);
        }
    }
    table
}

/// Recomputes the numbers of a row.
pub(super) fn recompute(place: &Path, _name: &str) -> Result<Source, Error> {
    let studies = Resolved::read(place)?.studies()?;
    Ok(Source::new(move |row: Row| {
        let what = row.text("damper");
        let name = if what == What::None.name() { What::Tmd.name() } else { what };
        let (_, study) = studies.iter().find(|(known, _)| known == name)?;
        let scene = if what == What::None.name() {
            Scene { damper: None, ..study.scene }
        } else {
            study.scene_at(&row.design()?)?
        };
        let of = if what == What::Ssvi.name() { What::Ssvi } else { What::Tmd };
        let found = Candidate::new(of, &Study { scene, ..study.clone() }).ok()?;
        let reported: Vec<Measure> =
            Measure::ALL.into_iter().filter(|measure| row.has(measure.name())).collect();
        Some(numbers(&found, &reported))
    }))
}
