//! `track`: both dampers tuned anew for each stiffness k1 of the structure, and E1max of each tuning at other stiffnesses.
//!
//! Each damper is tuned for its study's own k1 first, then outwards from there: every search of the study is made again, and one
//! more refinement starts at the design of the neighbouring k1.

mod draw;
mod tuned;

pub use tuned::{energy, kept};

use crate::designs::Table;
use crate::tune::{Found, optimize};
use crate::{Error, Observer, Request};
use retune_store::Order;
use retune_study::{self as study, PaperStudy, PerVariable, Setting, Study, short};
use serde_json::json;
use tuned::{Tuned, csv, retention};

/// Tunes both dampers anew for each stiffness of the primary structure, and shows how E1max is retained.
///
/// # Errors
/// A study or a stiffness is wrong, nothing can be computed, or the results cannot be written.
pub fn track(request: &Request, stiffnesses: &[Setting], watch: &dyn Observer) -> Result<(), Error> {
    let rows = study::read_table2(&request.study)?;
    for setting in stiffnesses {
        rows.iter().try_for_each(|row| row.study.with(std::slice::from_ref(setting)).map(drop))?;
    }
    let (out, order) = (request.out_of_file()?, request.order("track"));
    const FILES: [&str; 3] = ["retention.csv", "retention.svg", "path.svg"];
    let k1: Vec<f64> = stiffnesses.iter().map(Setting::value).collect();
    let plan = json!({ "k1": k1 });
    let mut table = Table::new(["retune", "k1"], &FILES, &out, &order, plan, &rows, watch)?;
    request.on_threads(|| {
        let tuned = rows
            .into_iter()
            .map(|row| tune(row, stiffnesses, &order, &mut table, watch))
            .collect::<Result<Vec<Tuned>, Error>>()?;
        let mut designs: Vec<(f64, &str, Found)> = tuned
            .iter()
            .flat_map(|damper| damper.designs.iter().map(|(k1, found)| (*k1, damper.name.as_str(), *found)))
            .collect();
        designs.sort_by(|a, b| a.0.total_cmp(&b.0)); // stable: dampers in the order of the table
        for (k1, name, found) in designs {
            table.push(&k1.to_string(), name, found);
        }
        let curves = retention(&tuned);
        let directory = table.directory();
        directory.write("retention.csv", &csv(&tuned, &curves))?;
        directory.write("retention.svg", &draw::retention(&tuned, &curves))?;
        directory.write("path.svg", &draw::path(&tuned))?;
        table.finish(watch)
    })
}

/// Tunes one damper for the stiffness of its study, then for each of `others`, outwards.
fn tune(
    row: PaperStudy,
    others: &[Setting],
    order: &Order,
    table: &mut Table,
    watch: &dyn Observer,
) -> Result<Tuned, Error> {
    let PaperStudy { damper: name, study } = row;
    let nominal = study.scene.primary.stiffness.get();
    let mut stiffnesses: Vec<f64> = others.iter().map(Setting::value).chain([nominal]).collect();
    stiffnesses.sort_by(f64::total_cmp);
    stiffnesses.dedup();
    let here = stiffnesses.iter().position(|k1| *k1 == nominal).unwrap_or_default();
    let mut designs: Vec<Option<Found>> = vec![None; stiffnesses.len()];
    let upwards = (here..stiffnesses.len()).map(|i| (i, i.checked_sub(1).filter(|_| i > here)));
    let downwards = (0..here).rev().map(|i| (i, Some(i + 1)));
    for (i, neighbour) in upwards.chain(downwards) {
        let k1 = stiffnesses[i];
        let from = neighbour.and_then(|neighbour| designs[neighbour]);
        let study = warm(&study, k1, from)?;
        let warm = if from.is_some() { ", and from the design of the k1 beside it" } else { "" };
        let natural = short(study.scene.primary.natural_frequency());
        watch.log(&format!(
            "\n{name} at k1 = {k1} N/m (natural frequency {natural} rad/s), {}{warm}",
            study::over(&study.objective(), study.scene.forcing.frequency.get())
        ))?;
        let place = table.directory().part(&format!("k1-{k1}/{}", study.name()));
        let (optimum, results) = optimize(&study, &place, order, watch)?;
        table.keep(&study, &optimum, results);
        watch.log(&optimum.report())?;
        designs[i] = Some(optimum.found());
    }
    let designs = stiffnesses.into_iter().zip(designs).filter_map(|(k1, found)| Some((k1, found?))).collect();
    Ok(Tuned { name, study, nominal, designs })
}

/// The study at another stiffness, with one more start.
fn warm(study: &Study, k1: f64, from: Option<Found>) -> Result<Study, Error> {
    let mut study = study.with(&[Setting::new("k1", k1)])?;
    if let (Some(optimize), Some(Found { damper, .. })) = (&mut study.optimize, from) {
        optimize.starts.push(PerVariable::of_design(&damper.design, &optimize.vary));
    }
    Ok(study)
}
