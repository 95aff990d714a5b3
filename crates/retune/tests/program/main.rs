//! The program as a process: arguments, the screen, pipes, exit codes, signals. What its jobs find is tested in `jobs`.

mod anywhere;
mod catalogue;
mod commands;
mod common;
mod design;
mod documents;
mod evaluate;
mod interrupted;
mod kills;
mod numbers;
mod prove;
mod refused;
mod schema;
