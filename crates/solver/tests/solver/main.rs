//! Runs from outside of the crate.

mod any_scene;
mod bounds;
mod bounds_in_flight;
mod derivatives;
mod edge;
mod exact;
mod extreme_values;
mod extremes;
mod forcings;
mod general_methods;
mod hunt;
mod invariant;
mod loss;
mod measures;
mod observers;
mod order;
mod paper;
mod problems;
mod reference;
mod repeats;
mod running_maximum;
mod settled;
mod structure;
mod trajectory;
mod work;
