//! The comparison: its scenes, its peers, its atlas.

mod accuracy;
mod atlas;
mod integrators;
