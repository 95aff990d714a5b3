//! Hunts of which `cargo test` runs none: the least of them takes minutes.

pub mod robust;
pub mod walk;
