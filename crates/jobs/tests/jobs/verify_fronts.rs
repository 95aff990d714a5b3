//! `verify` of the results of `track` and `fronts`.

use crate::request;
use retune_jobs::Silent;
use retune_jobs::fronts::fronts;
use retune_jobs::retention::retention;
use retune_model::Parameter;
use retune_study::Setting;
use retune_testkit::observers::good;
use retune_testkit::verified::{a_changed_digit_is_found, desk};

#[test]
fn contract_results_are_verified_and_a_changed_digit_is_found() {
    let desk = desk();
    good(retention(&request(&desk, "table2.json", "retune"), &[Setting::new(Parameter::K1, 3e4)], &Silent));
    a_changed_digit_is_found(&desk, "retune", &["retune.csv", "retention.csv", "range.csv", "force.csv"]);
    good(fronts(&request(&desk, "fronts.json", "fronts"), &Silent));
    a_changed_digit_is_found(&desk, "fronts", &["k2.csv", "stroke.csv", "front.csv"]);
}
