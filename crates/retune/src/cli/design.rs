//! What may be typed for `design`.

use super::running::Running;
use clap::Args;
use retune_study::angular_frequency;

/// `design`.
#[derive(Debug, Args)]
pub struct Design {
    /// Mass of the structure, kg
    #[arg(long, value_name = "KG")]
    pub m1: f64,
    /// Stiffness of the structure, N/m
    #[arg(long, value_name = "N/m")]
    pub k1: f64,
    /// Damping of the structure, N·s/m
    #[arg(long, value_name = "N·s/m")]
    pub c1: f64,
    /// Amplitude of the force, N
    #[arg(long = "P", value_name = "N")]
    pub force: f64,
    /// Lowest and highest frequency of the force: rad/s, or with its unit, for instance `--band 10Hz 14Hz` or `--band 600rpm 840rpm`
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], value_parser = angular_frequency)]
    pub band: Vec<f64>,
    /// Mass of the damper, kg
    #[arg(long, value_name = "KG")]
    pub mass: f64,
    /// Largest stroke of the damper's spring, m
    #[arg(long, value_name = "M")]
    pub stroke: Option<f64>,
    /// Largest stiffness of the damper's spring, N/m
    #[arg(long, value_name = "N/m")]
    pub k2_max: Option<f64>,
    /// Share by which k1 may be off, for instance 0.1
    #[arg(long, value_name = "SHARE")]
    pub k1_error: Option<f64>,
    /// The options of the run.
    #[command(flatten)]
    pub running: Running,
}
