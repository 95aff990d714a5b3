//! A certificate as text.

use super::verdict::{NONE, between, or_none};
use super::{Certificate, FINER, Measured, Motion, Neighbourhood, Run, Sensitivity, WorstRun};
use crate::amount::Amount;
use retune_study::{rounded, short};

impl Certificate {
    /// The verdict with the error bar, then lines for other records and other walls.
    pub(crate) fn verdict_words(&self) -> String {
        let records = self.records.iter().map(|records| format!("\nRecords: {}", records.words()));
        let contacts = self.walls.iter().map(|walls| format!("\nContacts: {}", walls.words()));
        format!("{} ({}){}", self.reason(), self.compared(), records.chain(contacts).collect::<String>())
    }

    /// The lines of its short form.
    pub(crate) fn lines(&self) -> Vec<String> {
        let Motion { regime, exponent, .. } = &self.measured.motion;
        let contacts = self.walls.iter().map(|walls| format!("Contacts: {}", walls.words()));
        let exponent = match exponent.is_finite() {
            true => format!(", largest Lyapunov exponent {exponent:.3} /s at the worst run"),
            false => String::new(),
        };
        let last = format!("{}, {regime}{exponent}", self.compared());
        [format!("certificate: {}", self.reason())].into_iter().chain(contacts).chain([last]).collect()
    }
}

/// A number to ten decimals, or to ten significant digits if it is below 1.
fn all_digits(value: f64) -> String {
    let small = value.abs() < 1.0 && value != 0.0;
    let decimals = if small { (9.0 - value.abs().log10().floor()) as usize } else { 10 };
    format!("{value:.decimals$}")
}

impl std::fmt::Display for Certificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { made_by, design, value, judged, measured, .. } = self;
        let Measured { worst_run, motion, neighbourhood, .. } = measured;
        writeln!(f, "{made_by}")?;
        writeln!(f, "design        {}", design.words(|_| 6))?;
        let predictable = if judged.predictable { "predictable" } else { "not predictable" };
        let Amount { quantity, value, .. } = *value;
        let (name, unit) = (quantity.name(), quantity.unit());
        let value_text = |value: f64| or_none(value, quantity);
        writeln!(f, "{name:<14}{}, {predictable}: {}", value_text(value), self.compared())?;
        let WorstRun { value, omega, k1, phase } = worst_run;
        let phase = if *phase == 0.0 { String::new() } else { format!(", phase {} rad", short(*phase)) };
        let omega = if *omega > 0.0 { format!("omega = {} rad/s, ", short(*omega)) } else { String::new() };
        let k1 = short(*k1);
        writeln!(f, "worst run     {} at {omega}k1 = {k1} N/m{phase}", value_text(value.value))?;
        for Run { method, rtol, value } in &measured.convergence {
            let (method, value) = (format!("{} {rtol:e}", method.name()), value.value);
            let digits =
                if value.is_finite() { format!("{} {unit}", all_digits(value)) } else { NONE.to_owned() };
            writeln!(f, "  {method:<14}{digits}")?;
        }
        if let Some(finer) = measured.finer.map(value_text) {
            writeln!(f, "samples       the value is a lower bound; {finer} with {FINER} times the samples")?;
        }
        let Motion { regime, exponent, exponent_error, contacts_per_period: [a, b], confidence, .. } = motion;
        writeln!(f, "motion        {regime} (probability {confidence:.2})")?;
        if let Some(motions) = &measured.motions {
            writeln!(f, "motions       {}", motions.words())?;
            writeln!(f, "              {}", motions.missed())?;
            if let Some(other) = motions.largest.as_ref().filter(|other| !other.is_from_rest()) {
                writeln!(f, "              {}", other.reproduce(motions.k1))?;
            }
        }
        if let Some(margin) = &measured.margin {
            writeln!(f, "margin        {}", margin.words())?;
        }
        if exponent.is_finite() {
            writeln!(
                f,
                "exponent      {exponent:.4} ± {exponent_error:.4} /s, the largest Lyapunov exponent"
            )?;
            writeln!(
                f,
                "contacts      {a:.2} on the structure, {b:.2} on the obstacle in a period of the force"
            )?;
        }
        writeln!(f, "parameter     {:<25}worst within 1 %", format!("slope, {unit} for 1 % more"))?;
        for Sensitivity { parameter, slope_per_percent, worst, worst_at_percent, .. } in &measured.sensitivity
        {
            let known = slope_per_percent.is_finite();
            let sign = if *slope_per_percent > 0.0 { "+" } else { "" };
            let slope =
                if known { format!("{sign}{}", rounded(*slope_per_percent, 4)) } else { NONE.to_owned() };
            writeln!(f, "  {parameter:<12}{slope:<25}{} at {worst_at_percent:+} %", value_text(*worst))?;
        }
        let Neighbourhood { members, errors, low, median, high } = neighbourhood;
        let (errors, median, range) = (100.0 * errors, value_text(*median), between(*low, *high, quantity));
        writeln!(
            f,
            "neighbours    {members} within {errors} %: 90 % of them have {range}, the median {median}"
        )?;
        if let Some(limits) = &measured.limits {
            let near = limits.broken_near().unwrap_or_else(|| "kept by all designs near it".to_owned());
            let own = limits.broken().map_or(near, |broken| format!("NOT KEPT: {broken}"));
            writeln!(f, "limits        {own}; broken by {} of {members} neighbours", limits.neighbours())?;
        }
        writeln!(f, "verdict       {}", judged.words)?;
        if let Some(records) = &self.records {
            writeln!(f, "              Records: {}", records.words())?;
        }
        if let Some(walls) = &self.walls {
            writeln!(f, "              Contacts: {}", walls.words())?;
        }
        write!(f, "rule          {}", self.rule)
    }
}
