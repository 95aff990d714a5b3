//! A share of a work of many points, for many machines: `--shard 3/64` computes the third of sixty-four shares and writes it as one
//! part, whose name holds the hash of its content. A part never changes: it exists complete, or not at all.
//!
//! Points are those of a grid with one number each, or of a sweep with several; a part holds the numbers one after the other.

mod complete;
mod part;

pub use part::{PARTS, Shard, Shared};
