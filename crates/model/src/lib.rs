//! The physics of a damper on a forced oscillator: one copy of each formula of the paper, beside its equation number.
//!
//! A heavy *primary structure* (PS; `m1, c1, k1`) is excited by `F(t) = P cos ωt`, by a rotating imbalance or by its base, or
//! decays from a start, or feels a pulse or a record ([`Forcing`]). A light damper (`m2, c2, k2`) moves in a
//! cavity of the PS: it touches the PS where `x2 - x1 <= 0` and the obstacle (the cavity's far wall, which moves with the
//! PS) where `x2 - x1 >= D + C`. Its spring is at rest at `x2 - x1 = D`.
//!
//! [`Scene`] holds the parameters, whose types admit no value out of range. [`Bare`] and [`Coupled`] are equation (1) without and
//! with a damper: derivatives, energies and their rates, the closed-form steady response ([`Steady`]) and its largest value over a
//! band of frequencies ([`Worst`]). [`RegularisedContact`] is equation (1) during one contact, without the kink of Hertz's law.
//!
//! ```
//! use retune_model::{Coupled, Scene, Side};
//!
//! // The SSVI of the paper's Table 2, in the symbols of the paper and SI units.
//! let scene: Scene = serde_json::from_str(
//!     r#"{
//!         "primary": { "m1": 1000, "c1": 452, "k1": 39500 },
//!         "forcing": { "P": 800, "omega": 6.28 },
//!         "damper": {
//!             "m2": 60, "k2": 215, "c2": 232, "D": 0.06, "C": 0.36,
//!             "contact": {
//!                 "R": 2, "q": 0.318,
//!                 "E1": 2.1e11, "nu1": 0.3, "E2": 2.21e7, "nu2": 0.4,
//!                 "E3": 2.1e11, "nu3": 0.3, "E4": 2.05e7, "nu4": 0.4
//!             }
//!         }
//!     }"#,
//! )?;
//! let system = Coupled::new(&scene.primary, &scene.forcing, &scene.damper.expect("a damper"));
//! // Without contact the damper would swing farther than D: it touches the structure.
//! assert!(system.steady(6.28).stroke() > system.rest_distance());
//! // 1 mm inside the structure it is pushed away from it.
//! let [f1, f2] = system.contact_forces(&[0.0, 0.0, system.wall(Side::Primary) - 1e-3, 0.0]);
//! assert!(f1 > 0.0 && f2 == 0.0);
//! # Ok::<(), serde_json::Error>(())
//! ```
//!
//! This crate never steps in time, reads files, starts threads or prints. All quantities are in SI units.
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod amplitude;
mod band;
mod bare;
mod coupled;
mod damper;
mod design;
mod excitation;
mod forcing;
mod hertz;
mod history;
mod kept;
mod loss;
mod made;
mod measure;
mod mode;
mod parameter;
mod per_variable;
mod polynomial;
mod record;
mod record_file;
mod regularised;
mod rms;
mod scene;
mod sensitivity;
mod settling;
mod stationary;
mod steady;
pub mod unit;
mod value;
mod wall;

pub use amplitude::Amplitude;
pub use band::Worst;
pub use bare::Bare;
pub use coupled::{Coupled, Side};
pub use damper::Damper;
pub use design::{Design, NoDesign};
pub use excitation::{Excitation, Stretch};
pub use forcing::{Forcing, Source, Start};
pub use hertz::{
    HERTZ_YIELD, hertz_energy, hertz_force, hertz_force_curvature, hertz_force_slope, hertz_pressure,
    hertz_stiffness,
};
pub use history::{Course, History, Of, Pulse, Shape};
pub use kept::Kept;
pub use loss::{Loss, Restoring};
pub use made::{Form, Harmonic, Made, Recipe, Spectrum, Sweep, Unmade, drawn_number};
pub use measure::{Measure, PerMeasure};
pub use mode::{Mode, left_out, most_felt};
pub use parameter::Parameter;
pub use parameter::place::{Absent, Unsettable};
pub use per_variable::PerVariable;
pub use record::{BadSamples, Column, Record, RecordFile, SampledForce, Samples, Spacing};
pub use regularised::bounds::{Change, Forces, Growth, ORDERS, OverContact};
pub use regularised::series::{ContactSeries, SeriesMoment};
pub use regularised::{RegularisedContact, RegularisedState};
pub use rms::Rms;
pub use scene::{Primary, Scene, den_hartog, nishihara_asami, warburton};
pub use stationary::Stationary;
pub use steady::Steady;
pub use unit::Unit;
pub use value::{Bounce, Finite, NonNegative, OutOfRange, PoissonRatio, Positive, Restitution};
pub use wall::{Contact, Rigid, Surfaces};

/// Energy ratios of section 3: `R1 = E1max / (E1max + E2max)` and `R2 = E2max / (E1max + E2max)`, dimensionless.
///
/// Both are NaN when nothing moved (`E1max = E2max = 0`).
pub fn energy_ratios(e1_max: f64, e2_max: f64) -> [f64; 2] {
    let total = e1_max + e2_max;
    [e1_max / total, e2_max / total]
}
