//! Study files and their schema.

mod refused;
mod schema;
