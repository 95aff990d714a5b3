//! A certificate as text.

use super::verdict::{NO_ENERGY, between};
use super::{Certificate, FINER, Motion, Neighbourhood, Run, Sensitivity, Short, WorstRun};
use retune_study::short;

/// An energy; one that is not finite is of a design that cannot be computed.
fn joules(energy: f64) -> String {
    if energy.is_finite() { format!("{} J", short(energy)) } else { NO_ENERGY.to_owned() }
}

/// An error bar.
fn bar(energy: f64) -> String {
    if energy.is_finite() { format!("{energy:.1e} J") } else { "an unknown error".to_owned() }
}

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { words, error_bar, regime, exponent, .. } = self;
        write!(f, "certificate: {words}\n  E1max ± {}, ", bar(*error_bar))?;
        write!(f, "{regime}, largest Lyapunov exponent {exponent:.3} /s at the worst run")
    }
}

impl std::fmt::Display for Certificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { made_by, design, e1_max, error_bar, worst_run, motion, neighbourhood, .. } = self;
        let [m2, k2, c2, d, c] = design.values().map(short);
        writeln!(f, "{made_by}")?;
        writeln!(f, "design        m2 = {m2} kg, k2 = {k2} N/m, c2 = {c2} N·s/m, D = {d} m, C = {c} m")?;
        let predictable = if self.predictable { "predictable" } else { "not predictable" };
        writeln!(f, "E1max         {} ± {}, {predictable}", joules(*e1_max), bar(*error_bar))?;
        let WorstRun { e1_max, omega, k1, phase } = worst_run;
        let phase = if *phase == 0.0 { String::new() } else { format!(", phase {} rad", short(*phase)) };
        let (omega, k1) = (short(*omega), short(*k1));
        writeln!(f, "worst run     {} at omega = {omega} rad/s, k1 = {k1} N/m{phase}", joules(*e1_max))?;
        for Run { method, rtol, e1_max } in &self.convergence {
            let method = format!("{} {rtol:e}", method.name());
            let digits = if e1_max.is_finite() { format!("{e1_max:.10} J") } else { NO_ENERGY.to_owned() };
            writeln!(f, "  {method:<14}{digits}")?;
        }
        if let Some(finer) = self.finer {
            writeln!(f, "finer band    {} with {FINER} times the samples", joules(finer))?;
        }
        let Motion { regime, exponent, exponent_error, contacts_per_period: [a, b], confidence, .. } = motion;
        writeln!(f, "motion        {regime} (probability {confidence:.2})")?;
        writeln!(f, "exponent      {exponent:.4} ± {exponent_error:.4} /s, the largest Lyapunov exponent")?;
        writeln!(
            f,
            "contacts      {a:.2} on the structure, {b:.2} on the obstacle in a period of the force"
        )?;
        writeln!(f, "parameter     slope, J for 1 % more    worst within 1 %")?;
        for Sensitivity { parameter, slope_per_percent, worst, worst_at_percent, .. } in &self.sensitivity {
            let known = slope_per_percent.is_finite();
            let slope = if known { format!("{slope_per_percent:+.4}") } else { NO_ENERGY.to_owned() };
            writeln!(f, "  {parameter:<12}{slope:<25}{} at {worst_at_percent:+} %", joules(*worst))?;
        }
        let Neighbourhood { members, errors, low, median, high } = neighbourhood;
        let (errors, median, range) = (100.0 * errors, joules(*median), between(*low, *high));
        writeln!(
            f,
            "neighbours    {members} within {errors} %: 90 % of them have {range}, the median {median}"
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
