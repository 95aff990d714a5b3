//! Columns of tables, from the catalogue of parameters and quantities.

use retune_model::{Design, Measure, Parameter};
use retune_report::table::{Cell, Column, Table};

/// The numbers of a state `[x1, v1, x2, v2]`, with their SI units.
pub const STATE: [(&str, &str); 4] = [("x1", "m"), ("v1", "m/s"), ("x2", "m"), ("v2", "m/s")];

/// The column of a name: in the SI unit of the parameter, quantity or state variable of this name, alone or before `_`, as in `E1max_none`;
/// else without a unit.
pub fn column(name: &str) -> Column {
    let parameters = Parameter::ALL.map(|parameter| (parameter.symbol(), parameter.unit()));
    let measures = Measure::every().map(|measure| (measure.name(), measure.unit()));
    let matches = |(known, _): &(&str, &'static str)| {
        name.strip_prefix(known).is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
    };
    // The longest match wins: `base_acceleration` also begins with `base`.
    let known = parameters.into_iter().chain(measures).chain(STATE).filter(matches);
    let known = known.max_by_key(|(known, _)| known.len());
    Column::new(name, known.map_or("", |(_, unit)| unit))
}

/// A table of columns with these names, without rows.
pub fn table(names: &[&str]) -> Table {
    Table::new(names.iter().copied().map(column))
}

/// The parameters of a table of designs: the paper's, and any other that a design has.
pub fn of_designs<'a>(designs: impl Iterator<Item = &'a Design> + Clone) -> Vec<Parameter> {
    let has = |of: &Parameter| designs.clone().any(|design| !design.get(*of).is_nan());
    let others: Vec<Parameter> = Parameter::VARIED.into_iter().filter(has).collect();
    Parameter::columns(&others)
}

/// The names of the columns of some parameters.
pub fn symbols(parameters: &[Parameter]) -> Vec<&'static str> {
    parameters.iter().map(|parameter| parameter.symbol()).collect()
}

/// The cells of a design; empty for parameters that it does not have, such as gaps without walls.
pub fn cells_of(design: &Design, parameters: &[Parameter]) -> Vec<Cell> {
    parameters.iter().map(|parameter| design.get(*parameter).into()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_units_are_those_of_the_catalogue() {
        let names = [
            "k2",
            "k2_most",
            "E1",
            "E1max",
            "E1max_none",
            "contact_force",
            "omega_worst",
            "v1",
            "decay_time",
            "base_acceleration",
            "place",
            "x1rms_none",
        ];
        let table = table(&names);
        let units: Vec<&str> = table.columns.iter().map(|column| &*column.unit).collect();
        assert_eq!(units, ["N/m", "N/m", "N/m²", "J", "J", "N", "rad/s", "m/s", "s", "m/s²", "", "m"]);
    }
}
