//! A certificate as text.

use super::{Certificate, FINER, Motion, Neighbourhood, Run, Sensitivity, Short, WorstRun};
use crate::amount::Amount;
use retune_study::short;

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { words, error_bar, quantity, regime, exponent, .. } = self;
        write!(f, "certificate: {words}\n  {} ± {error_bar:.1e} {}, ", quantity.name(), quantity.unit())?;
        write!(f, "{regime}, largest Lyapunov exponent {exponent:.3} /s at the worst run")
    }
}

impl std::fmt::Display for Certificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { made_by, design, value, error_bar, worst_run, motion, neighbourhood, .. } = self;
        writeln!(f, "{made_by}")?;
        writeln!(f, "design        {}", design.words(6))?;
        let predictable = if self.predictable { "predictable" } else { "not predictable" };
        let Amount { quantity, value, .. } = *value;
        let (name, unit) = (quantity.name(), quantity.unit());
        writeln!(f, "{name:<14}{} {unit} ± {error_bar:.1e} {unit}, {predictable}", short(value))?;
        let WorstRun { value, omega, k1, phase } = worst_run;
        let phase = if *phase == 0.0 { String::new() } else { format!(", phase {} rad", short(*phase)) };
        let (omega, k1) = (short(*omega), short(*k1));
        writeln!(
            f,
            "worst run     {} {unit} at omega = {omega} rad/s, k1 = {k1} N/m{phase}",
            short(value.value)
        )?;
        for Run { method, rtol, value } in &self.convergence {
            let method = format!("{} {rtol:e}", method.name());
            writeln!(f, "  {method:<14}{:.10} {unit}", value.value)?;
        }
        if let Some(finer) = self.finer {
            writeln!(f, "finer band    {} {unit} with {FINER} times the samples", short(finer))?;
        }
        let Motion { regime, exponent, exponent_error, contacts_per_period: [a, b], confidence, .. } = motion;
        writeln!(f, "motion        {regime} (probability {confidence:.2})")?;
        writeln!(f, "exponent      {exponent:.4} ± {exponent_error:.4} /s, the largest Lyapunov exponent")?;
        writeln!(
            f,
            "contacts      {a:.2} on the structure, {b:.2} on the obstacle in a period of the force"
        )?;
        writeln!(f, "parameter     {:<25}worst within 1 %", format!("slope, {unit} for 1 % more"))?;
        for Sensitivity { parameter, slope_per_percent, worst, worst_at_percent, .. } in &self.sensitivity {
            let slope = format!("{slope_per_percent:+.4}");
            writeln!(f, "  {parameter:<12}{slope:<25}{} {unit} at {worst_at_percent:+} %", short(*worst))?;
        }
        let Neighbourhood { members, errors, low, median, high } = neighbourhood;
        let [low, median, high] = [low, median, high].map(|energy| short(*energy));
        writeln!(
            f,
            "neighbours    {members} within {} %: 90 % of them have {low} to {high} {unit}, the median {median} {unit}",
            100.0 * errors
        )?;
        if let Some(limits) = &self.limits {
            let near = limits.broken_near().unwrap_or_else(|| "kept by all designs near it".to_owned());
            let own = limits.broken().map_or(near, |broken| format!("NOT KEPT: {broken}"));
            writeln!(f, "limits        {own}; broken by {} of {members} neighbours", limits.neighbours())?;
        }
        writeln!(f, "verdict       {}", self.words)?;
        write!(f, "rule          {}", self.rule)
    }
}
