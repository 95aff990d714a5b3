//! Retune's methods and third-party integrators on the same scenes: speed against accuracy, and failures. Also hunts for errors.
//!
//! No crate imports this one, and it is not built with the program (`just lab` lists what builds it). Third-party integrators need the
//! feature `integrators`. To read: `scenes`, `runs`, `reference`, then `comparison` and `text` (`just lab accuracy`) or `atlas` (`just lab
//! stability`).
#![allow(missing_docs, reason = "its own programs and tests use it: what a name says is not said again")]

pub mod atlas;
#[cfg(feature = "integrators")]
pub mod comparison;
pub mod curves;
pub mod hunts;
pub mod machine;
pub mod moreau_jean;
pub mod motion;
pub mod panel;
#[cfg(feature = "integrators")]
pub mod peers;
pub mod records;
pub mod reference;
pub mod runs;
pub mod savings;
pub mod scenes;
pub mod sealed;
pub mod statistics;
pub mod text;

/// A result, or any error.
pub type Any<T> = Result<T, Box<dyn std::error::Error>>;

/// The structure and the damper of a scene that has one, as one system.
pub fn system(scene: &retune_model::Scene) -> Option<retune_model::Coupled> {
    scene.damper.as_ref().map(|damper| retune_model::Coupled::new(&scene.primary, &scene.forcing, damper))
}

/// Powers of ten from `10^-from` down to `10^-to`.
pub fn decades(from: i32, to: i32) -> Vec<f64> {
    (from..=to).map(|k| 10f64.powi(-k)).collect()
}
