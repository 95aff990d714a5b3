//! Study files and their schema.

mod refused;
mod refused_search;
mod schema;
mod units;
