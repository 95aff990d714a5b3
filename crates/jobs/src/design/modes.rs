//! A table of modes, one of which becomes the structure of a design.

use super::typed::Specification;
use crate::Error;
use retune_model::{Mode, NonNegative, Positive, left_out, most_felt};
use retune_study::{frequency, rounded};
use std::f64::consts::TAU;
use std::path::Path;

/// The columns of a table, in any order: frequency, Hz, share of critical damping, modal mass, kg, and shape at the damper.
const COLUMNS: [&str; 4] = ["f", "zeta", "M", "phi"];

/// The equivalent structure of mode `which` (from 1) at the damper, and words on it and on the modes left out. Without a number, the mode
/// that a force at the damper excites most.
///
/// # Errors
/// The table cannot be read, or has no such mode.
pub fn structure(path: &Path, which: Option<usize>) -> Result<(Specification, String), Error> {
    let file = path.display().to_string();
    let refused = |problem: String| Error::Requirement { place: file.clone(), problem };
    let modes = modes(&retune_store::plain::text(path)?).map_err(&refused)?;
    let given = which.map_or_else(|| most_felt(&modes), |number| number.checked_sub(1));
    let (count, number) = (modes.len(), which.unwrap_or(0));
    let chosen = given.filter(|i| *i < count).ok_or_else(|| Error::Requirement {
        place: "--mode".to_owned(),
        problem: format!("{number} is not allowed here: give a number from 1 to {count}"),
    })?;
    let mode = modes[chosen];
    let primary = mode.primary().map_err(|error| {
        refused(format!("mode {}: phi = {}: it does not move the damper: {error}", chosen + 1, mode.shape))
    })?;
    let [m1, k1, c1] = [primary.mass.get(), primary.stiffness.get(), primary.damping.get()];
    let typed = |value: f64| Some(value.to_string().into());
    let specification =
        Specification { m1: typed(m1), k1: typed(k1), c1: typed(c1), ..Specification::default() };
    let ([m1, k1, c1], number) = ([m1, k1, c1].map(|value| rounded(value, 6)), chosen + 1);
    let (natural, others) = (frequency(mode.omega.get()), rounded(100.0 * left_out(&modes, chosen), 2));
    let words = format!(
        "mode {number} of {count}, {natural}, is at the damper a structure of m1 = {m1} kg, k1 = {k1} N/m and c1 = {c1} N·s/m; at its \
         frequency the modes that are left out add {others} % to its displacement by a force there"
    );
    Ok((specification.within(&file), words))
}

/// The modes of a table, CSV with a header.
fn modes(text: &str) -> Result<Vec<Mode>, String> {
    let text = text.trim_start_matches('\u{feff}');
    let mut table =
        csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes());
    let names = table.headers().map_err(|error| error.to_string())?.clone();
    if names.iter().all(str::is_empty) {
        return Err("is empty: give a table with the columns f, zeta, M and phi".to_owned());
    }
    let mut places = [0; COLUMNS.len()];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        let found = names.iter().position(|name| name == column);
        if names.iter().filter(|name| *name == column).count() > 1 {
            return Err(format!("has the column {column} twice: give it once"));
        }
        *place = found.ok_or_else(|| {
            let have: Vec<&str> = names.iter().collect();
            format!(
                "has no column {column}: give f (Hz), zeta (a share), M (kg) and phi, the mode shape at the damper; it has {}",
                have.join(", ")
            )
        })?;
    }
    let mode = |row: csv::Result<csv::StringRecord>| {
        let row = row.map_err(|error| error.to_string())?;
        let line = row.position().map_or(0, csv::Position::line);
        let wrong = |column: usize, problem: String| format!("line {line}: {}: {problem}", COLUMNS[column]);
        let at = |column: usize| {
            let field = row.get(places[column]).unwrap_or("");
            let number = field.parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| wrong(column, format!("\"{field}\" is not a number")))
        };
        Ok(Mode {
            omega: Positive::new(at(0)?)
                .and_then(|f| Positive::new(TAU * f.get()))
                .map_err(|error| wrong(0, error.to_string()))?,
            zeta: NonNegative::new(at(1)?).map_err(|error| wrong(1, error.to_string()))?,
            mass: Positive::new(at(2)?).map_err(|error| wrong(2, error.to_string()))?,
            shape: at(3)?,
        })
    };
    let modes = table.records().map(mode).collect::<Result<Vec<Mode>, String>>()?;
    if modes.is_empty() { Err("has no mode: give at least one line".to_owned()) } else { Ok(modes) }
}
