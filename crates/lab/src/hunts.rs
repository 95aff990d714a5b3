//! Hunts that take minutes or more, and draws that no test needs.

pub mod durations;
pub mod robust;
pub mod scenes;
pub mod walk;
pub mod worst;
