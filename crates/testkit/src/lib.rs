//! Code shared by the tests of several crates. Not part of the program: only tests, benchmarks, the fuzzer and the comparison use it.

#[cfg(feature = "anything")]
pub mod anything;
#[cfg(feature = "desk")]
pub mod desk;
pub mod histories;
pub mod hunt;
#[cfg(feature = "jobs")]
pub mod observers;
pub mod scenes;
#[cfg(feature = "desk")]
pub mod schema;
#[cfg(feature = "jobs")]
pub mod verified;
