//! The text of a sweep: the answer first, then some of its rows.

use crate::rows::Rows;
use crate::sweep::points::Sweep;
use retune_model::Parameter;
use retune_optim::Limits;
use retune_report::table::{Column, Table};
use retune_study::{counted, frequency, hertz_and_rpm, over, rounded};
use textwrap::{Options, fill};

const WIDEST: usize = 80;
/// Width of a column with a frequency or another parameter, and of one with a quantity.
const NARROW: usize = 9;
const WIDE: usize = 12;
/// Rows of a short table, besides those with the largest and the smallest value.
const FEW: usize = 12;
/// The mark of the row with the smallest value, the longer of the two.
const SMALLEST: &str = " < smallest";
/// The mark of a row whose design breaks a limit.
const BROKEN: &str = " over limit";

/// The names of the columns shown in the text and the figure.
pub(crate) fn shown(sweep: &Sweep) -> Vec<String> {
    if sweep.plan().objective {
        return vec![sweep.study().quantity().name().to_owned()];
    }
    sweep.plan().quantities.iter().map(|quantity| quantity.name().to_owned()).collect()
}

/// A sweep in a few words: `ssvi, omega from 5 to 8 rad/s`.
pub(crate) fn title(sweep: &Sweep) -> String {
    let plan = sweep.plan();
    let unit = plan.over.unit();
    let ends = |ends: [f64; 2]| ends.map(|end| rounded(end, 4)).join(" to ");
    let hertz = [plan.from, plan.to].map(|end| hertz_and_rpm(end)[0]);
    let hertz = if plan.over.is_frequency() { format!(" ({} Hz)", ends(hertz)) } else { String::new() };
    let range = ends([plan.from, plan.to]);
    format!("{}: {} from {range} {unit}{hertz}", sweep.study().name(), plan.over.symbol())
}

/// The damper of the scene, without the parameter that is swept.
fn damper(sweep: &Sweep) -> String {
    let Some(damper) = sweep.study().scene.damper else { return "no damper".to_owned() };
    let all = [Parameter::M2].into_iter().chain(Parameter::PAPER);
    // A damper without walls has no gaps.
    let words: Vec<String> = all
        .filter(|parameter| *parameter != sweep.plan().over)
        .filter_map(|parameter| Some((parameter, parameter.of_damper(&damper)?)))
        .map(|(parameter, value)| format!("{parameter} {} {}", rounded(value, 4), parameter.unit()))
        .collect();
    format!("damper: {}", words.join(", "))
}

/// The meaning of each point, in words.
pub(crate) fn each(sweep: &Sweep) -> String {
    let study = sweep.study();
    if sweep.plan().objective {
        let omega = study.scene.forcing.frequency.get();
        let over = over(&study.objective(), omega);
        let over = if over.is_empty() { over } else { format!(": {over}") };
        return format!("each the objective of the study{over}");
    }
    let (t0, end) = (study.window.t0.get(), study.window.end.get());
    let start = if study.begins_at_rest().is_ok() { "rest" } else { "its start" };
    format!("each a run from {start}, largest values from {t0} to {end} s")
}

/// A value of the parameter with its unit.
fn at(sweep: &Sweep, value: f64) -> String {
    let over = sweep.plan().over;
    if over.is_frequency() {
        return format!("omega = {}", frequency(value));
    }
    format!("{} = {} {}", over.symbol(), rounded(value, 4), over.unit())
}

/// The row with the largest or the smallest value of a column, and that value. `sign` is 1 or -1.
pub(crate) fn extreme(values: &[f64], sign: f64) -> Option<(usize, f64)> {
    let known = values.iter().copied().enumerate().filter(|(_, value)| value.is_finite());
    // The first of equal ones.
    known.fold(None, |best: Option<(usize, f64)>, next| match best {
        Some((_, value)) if sign * value >= sign * next.1 => best,
        _ => Some(next),
    })
}

/// The answer and a table of all rows, or of a few and those with the largest and the smallest value. `reasons` are the points without a
/// value, each with the reason.
pub fn text(sweep: &Sweep, table: &Table, reasons: &[(f64, String)], all: bool) -> String {
    let count = counted(sweep.len() as u64, "value");
    let each = fill(&format!("{count}, {}", each(sweep)), Options::new(WIDEST).subsequent_indent("  "));
    let mut lines = vec![title(sweep), damper(sweep), each, String::new()];
    if let Some((value, reason)) = reasons.first() {
        let count = counted(reasons.len() as u64, "point");
        let have = if reasons.len() == 1 { "has" } else { "have" };
        let words = format!("{count} {have} no value; the first, {}: {reason}", at(sweep, *value));
        lines.push(fill(&words, Options::new(WIDEST).subsequent_indent("  ")));
    }
    let values: Vec<f64> = table.rows.iter().map(|row| row[0].number()).collect();
    let broken = broken(table);
    for name in shown(sweep) {
        lines.extend(answer(sweep, table, (&values, &broken), &name));
        let none = table.column(&name).map_or(0, |all| all.iter().filter(|value| !value.is_finite()).count());
        if none > 0 && reasons.is_empty() {
            lines.push(format!("  none at {}", counted(none as u64, "value")));
        }
    }
    let breaking = broken.iter().filter(|broken| **broken).count();
    if breaking > 0 {
        let count = counted(breaking as u64, "value");
        lines.push(format!("{count} with a design that breaks a limit of the study"));
    }
    lines.push(String::new());
    let columns = columns(sweep, table);
    lines.extend(header(&columns));
    let (first, alone) = (shown(sweep).into_iter().next(), shown(sweep).len() == 1);
    let end = |numbers: Option<Vec<f64>>, sign| Some(extreme(&numbers?, sign)?.0);
    let high = end(first.as_ref().and_then(|name| table.column(name)), 1.0);
    let low = end(first.as_ref().and_then(|name| feasible(table, name, &broken)), -1.0);
    for i in chosen(table.rows.len(), [high, low].into_iter().flatten(), all) {
        let cells = columns.iter().map(|(_, width, values)| format!("{:>width$}", cell(values[i])));
        let mark = match Some(i) {
            _ if broken[i] => BROKEN,
            _ if high == low && breaking == 0 => "",
            // With several quantities the extremes differ; the answer reports them.
            _ if !alone => "",
            row if row == high => " < largest",
            row if row == low => SMALLEST,
            _ => "",
        };
        lines.push(cells.collect::<String>() + mark);
    }
    lines.join("\n")
}

/// Whether the design of each row breaks a limit by more than rounding.
fn broken(table: &Table) -> Vec<bool> {
    let violations = table.column("violation").unwrap_or_else(|| vec![0.0; table.rows.len()]);
    violations.into_iter().map(|violation| violation > Limits::ROUNDING).collect()
}

/// A column with NaN for designs that break a limit; the whole column if all do.
fn feasible(table: &Table, name: &str, broken: &[bool]) -> Option<Vec<f64>> {
    let numbers = table.column(name)?;
    if !broken.contains(&false) {
        return Some(numbers);
    }
    Some(
        numbers
            .into_iter()
            .zip(broken)
            .map(|(number, broken)| if *broken { f64::NAN } else { number })
            .collect(),
    )
}

/// The largest and smallest value of a quantity and their places, with and without a damper, in words.
fn answer(sweep: &Sweep, table: &Table, (values, broken): (&[f64], &[bool]), name: &str) -> Vec<String> {
    let unit = table.unit(name);
    let extremes = |column: &str| -> Option<[String; 2]> {
        let numbers = table.column(column)?;
        let (high, lowest) = (extreme(&numbers, 1.0)?, extreme(&numbers, -1.0)?);
        let low = extreme(&feasible(table, column, broken)?, -1.0)?;
        let words = |(row, value): (usize, f64)| {
            let space = if unit.is_empty() { "" } else { " " };
            format!("{} {unit}{space}at {}", rounded(value, 4), at(sweep, values[row]))
        };
        let same = high.1 == lowest.1;
        let always = format!("{} {unit} at every value", rounded(high.1, 4));
        Some(if same { [always, String::new()] } else { [words(high), words(low)] })
    };
    let Some([high, low]) = extremes(name) else { return vec![format!("{name} has no value anywhere")] };
    let mut lines = vec![format!("{name}: largest {high}")];
    if low.is_empty() {
        lines = vec![format!("{name}: {high}")];
    } else {
        let some_keep = broken.contains(&true) && broken.contains(&false);
        lines.push(format!("  smallest {}{low}", if some_keep { "that keeps the limits " } else { "" }));
    }
    if let Some([high, low]) = extremes(&format!("{name}_none")) {
        let largest = if low.is_empty() { "" } else { "largest " };
        lines.push(format!("  without a damper {largest}{high}"));
    }
    lines
}

/// The columns that fit on a line, each with heading, width and values.
fn columns(sweep: &Sweep, table: &Table) -> Vec<([String; 2], usize, Vec<f64>)> {
    let of = |column: &Column, heading: &str, width| {
        let values = table.column(&column.name).unwrap_or_default();
        ([heading.to_owned(), column.unit.to_string()], width, values)
    };
    let find = |name: &str| table.columns.iter().find(|column| column.name == name);
    let mut columns = vec![("omega", "omega"), ("f_Hz", ""), ("n_rpm", "")]
        .into_iter()
        .filter_map(|(name, heading)| Some(of(find(name)?, heading, NARROW)))
        .collect::<Vec<_>>();
    if !sweep.plan().over.is_frequency() {
        columns = table.columns.first().map(|column| of(column, &column.name, WIDE)).into_iter().collect();
    }
    let names = shown(sweep);
    let with: Vec<_> =
        names.iter().filter_map(|name| Some(of(find(name)?, name, WIDE.max(name.len() + 2)))).collect();
    let without = names.iter().filter_map(|name| Some(of(find(&format!("{name}_none"))?, "no damper", WIDE)));
    let worst = find("omega_worst").map(|column| of(column, "worst at", WIDE));
    let worst = worst.filter(|(.., values)| values.iter().any(|omega| omega.is_finite()));
    let used =
        |columns: &[([String; 2], usize, Vec<f64>)]| columns.iter().map(|(_, width, _)| width).sum::<usize>();
    // The mark of a row must have room.
    for column in with.into_iter().chain(without).chain(worst) {
        if used(&columns) + column.1 + SMALLEST.len() <= WIDEST {
            columns.push(column);
        }
    }
    columns
}

fn header(columns: &[([String; 2], usize, Vec<f64>)]) -> [String; 2] {
    [0, 1].map(|line| {
        columns
            .iter()
            .map(|(heading, width, _)| format!("{:>width$}", heading[line]))
            .collect::<String>()
            .trim_end()
            .to_owned()
    })
}

fn cell(value: f64) -> String {
    if value.is_finite() { rounded(value, 4) } else { "-".to_owned() }
}

fn chosen(count: usize, ends: impl Iterator<Item = usize>, all: bool) -> Vec<usize> {
    if all || count <= FEW {
        return (0..count).collect();
    }
    let mut rows: Vec<usize> = (0..FEW).map(|i| i * (count - 1) / (FEW - 1)).chain(ends).collect();
    rows.sort_unstable();
    rows.dedup();
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_few_rows_are_shown_and_the_largest_among_them() {
        assert_eq!(chosen(5, [3].into_iter(), false), [0, 1, 2, 3, 4]);
        let few = chosen(601, [333].into_iter(), false);
        assert!(few.len() == FEW + 1 && few.contains(&333), "{few:?}");
        assert_eq!((few[0], few[FEW]), (0, 600));
        assert_eq!(chosen(601, [].into_iter(), true).len(), 601);
    }

    #[test]
    fn contract_the_largest_of_some_is_the_first_of_equal_ones_and_finite() {
        let values = [f64::INFINITY, 1.0, 3.0, 3.0, f64::NAN, 0.5];
        assert_eq!(extreme(&values, 1.0), Some((2, 3.0)));
        assert_eq!(extreme(&values, -1.0), Some((5, 0.5)));
        assert_eq!(extreme(&[f64::NAN], 1.0), None);
    }
}
