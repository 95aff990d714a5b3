//! What hunts need that no test does: those that take minutes at least, and draws.

pub mod durations;
pub mod robust;
pub mod scenes;
pub mod walk;
pub mod worst;
