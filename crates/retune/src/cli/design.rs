//! The arguments of `design`.

use super::running::Running;
use clap::Args;
use retune_model::Parameter;

/// `design`.
#[derive(Debug, Args)]
pub struct Design {
    /// Mass of the structure: kg, or with its unit, for instance `--m1 40t`
    #[arg(long, value_name = "KG", value_parser = |text: &str| Parameter::M1.read(text))]
    pub m1: f64,
    /// Stiffness of the structure: N/m, or with its unit, for instance `--k1 20kN/m`
    #[arg(long, value_name = "N/m", value_parser = |text: &str| Parameter::K1.read(text))]
    pub k1: f64,
    /// Damping of the structure, N·s/m
    #[arg(long, value_name = "N·s/m", value_parser = |text: &str| Parameter::C1.read(text))]
    pub c1: f64,
    /// Amplitude of the force, N
    #[arg(long = "P", value_name = "N", value_parser = |text: &str| Parameter::P.read(text))]
    pub force: f64,
    /// Lowest and highest frequency of the force: rad/s, or with its unit, for instance `--band 10Hz 14Hz` or `--band 600rpm 840rpm`
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], value_parser = |text: &str| Parameter::Omega.read(text))]
    pub band: Vec<f64>,
    /// Mass of the damper, kg
    #[arg(long, value_name = "KG", value_parser = |text: &str| Parameter::M2.read(text))]
    pub mass: f64,
    /// Largest stroke of the damper's spring: m, or with its unit, for instance `--stroke 15mm`
    #[arg(long, value_name = "M", value_parser = |text: &str| Parameter::D.read(text))]
    pub stroke: Option<f64>,
    /// Largest stiffness of the damper's spring, N/m
    #[arg(long, value_name = "N/m", value_parser = |text: &str| Parameter::K2.read(text))]
    pub k2_max: Option<f64>,
    /// Share by which k1 may be off, for instance 0.1
    #[arg(long, value_name = "SHARE")]
    pub k1_error: Option<f64>,
    /// The options of the run.
    #[command(flatten)]
    pub running: Running,
}
