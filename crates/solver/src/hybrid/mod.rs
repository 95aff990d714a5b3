//! The hybrid propagator: exact linear flight between contacts, regularised contacts, both ends located to rounding.
//!
//! Flight steps are exact whatever their length, so the only error is that of the contacts (see `contact`), and a flight step need only be
//! short enough to detect a contact: a certified bound on the gap over the step decides at once in nearly all cases, an exact polynomial
//! search (`gap`) in the rest.
//!
//! Read `propagate` (the loop), `flight`, then `sustained` (contacts that are followed step by step); `propagator` has the state. `rigid`
//! is the loop between rigid walls, `held` its data. `contact_free` runs scenes without contacts, which need no loop for most of their
//! time.

pub mod contact_free;
mod flight;
mod held;
mod propagate;
pub mod propagator;
mod rigid;
mod samples;
mod sustained;
