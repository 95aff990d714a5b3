//! `just lab stability`: every method on every difficulty, into `results/stability/`. `just lab stability check` recomputes everything and
//! compares it byte for byte.

use rayon::prelude::*;
use retune_jobs::methods;
use retune_lab::atlas::draw::{Row, VERDICTS};
use retune_lab::atlas::others::{self, OTHERS};
use retune_lab::atlas::{
    MOST_STEPS, REFERENCE, Verdict, WAYS, cell, difficulties, draw, energy, energy_cell, missed, objective,
    rigid, stable, truth,
};
use retune_lab::scenes::in_json;
use retune_lab::{Any, runs, sealed};
use std::fmt::Write;
use std::fs;
use std::path::Path;

fn main() -> Any<()> {
    let folder = Path::new("results/stability");
    match std::env::args().nth(1).as_deref() {
        None => write(folder),
        Some("check") => check(folder),
        Some(other) => Err(format!("stability {other}: nothing, or check").into()),
    }
}

/// Writes all files elsewhere and compares them with those of a directory.
fn check(folder: &Path) -> Any<()> {
    let again = Path::new("target/stability");
    if again.exists() {
        fs::remove_dir_all(again)?;
    }
    write(again)?;
    let mut changed = Vec::new();
    for entry in fs::read_dir(again)? {
        let name = entry?.file_name();
        if fs::read(again.join(&name))? != fs::read(folder.join(&name)).unwrap_or_default() {
            changed.push(name.to_string_lossy().into_owned());
        }
    }
    if changed.is_empty() {
        Ok(())
    } else {
        Err(format!("results/stability is not what the code makes: {}", changed.join(" ")).into())
    }
}

/// The file from which CVODE reads the difficulties.
const SCENES: &str = "target/difficulties.json";

/// Writes all files.
fn write(folder: &Path) -> Any<()> {
    fs::create_dir_all(folder)?;
    let (own, of_others) = rows()?;
    let names = [WAYS.map(|way| way.name).to_vec(), OTHERS.each_ref().map(|other| other.name).to_vec()];
    let titles = ["Where methods fail", "Where other people's integrators fail"];
    for (((name, title), ways), rows) in
        ["atlas", "others"].into_iter().zip(titles).zip(&names).zip([&own, &of_others])
    {
        fs::write(folder.join(format!("{name}.csv")), csv(ways, rows)?)?;
        draw::matrix(&folder.join(format!("{name}.svg")), title, ways, rows)?;
    }
    let mut text = heading(&names[0], &own)?;
    write!(text, "\n{OF_OTHERS}\n\n{}", totals(&names[1], &of_others)?)?;
    let chart = |name: &str| folder.join(format!("{name}.svg"));
    let [values, optima] = objective::tables(&chart("objective"))?;
    for (name, table, what) in [
        ("stable_steps", stable::table(&chart("stable_steps"))?, STABLE),
        ("energy", energy::table(&chart("energy"))?, ENERGY),
        ("missed", missed::table()?, MISSED),
        ("rigid", rigid::table()?, RIGID),
        ("objective", values, OBJECTIVE),
    ] {
        write!(text, "\n{what}\n\n![{name}]({name}.svg)\n\nNumbers: [`{name}.csv`]({name}.csv).\n")?;
        fs::write(folder.join(format!("{name}.csv")), table)?;
    }
    let table = |name: &str| fs::read_to_string(folder.join(name));
    missed::draw(&folder.join("missed.svg"), &table("missed.csv")?)?;
    rigid::draw(&folder.join("rigid.svg"), &table("rigid.csv")?)?;
    let cells = |line: &str| format!("| {} |\n", line.replace(',', " | "));
    let mut lines = optima.lines();
    let head = lines.next().unwrap_or_default();
    write!(text, "\n{OPTIMA}\n\n{}|{}\n", cells(head), " --- |".repeat(head.split(',').count()))?;
    lines.for_each(|line| text += &cells(line));
    fs::write(folder.join("optima.csv"), optima)?;
    fs::write(folder.join("README.md"), text)?;
    seal(folder)
}

/// Writes the manifest, with the scenes of the atlas beside it.
fn seal(folder: &Path) -> Any<()> {
    let difficulties = difficulties::all()?;
    let ways = WAYS.iter().map(|way| (way.name, way.method, way.contacts, way.setting));
    let plan = methods::plan(REFERENCE, MOST_STEPS, ways);
    sealed::seal(folder, &methods::STABILITY, plan, difficulties.iter().map(|difficulty| &difficulty.case))
}

/// The rows of Retune's methods, the energy over 1,000 impacts last, and the rows of third-party integrators.
fn rows() -> Any<(Vec<Row>, Vec<Row>)> {
    let all = difficulties::all()?;
    fs::write(SCENES, in_json(all.iter().map(|difficulty| &difficulty.case))?)?;
    let cvode = runs::cvode(SCENES);
    let row = |d: &difficulties::Difficulty| -> Result<(Row, Row), String> {
        let truth = truth(d)?;
        let own = WAYS.iter().map(|way| cell(way, &d.case, &truth)).collect();
        let of_others =
            OTHERS.iter().map(|other| others::cell(other, &d.case, &truth, cvode.as_deref())).collect();
        Ok(((d.group, d.case.name, own), (d.group, d.case.name, of_others)))
    };
    let rows = all.par_iter().map(row).collect::<Result<Vec<_>, _>>()?;
    let (mut own, of_others): (Vec<Row>, Vec<Row>) = rows.into_iter().unzip();
    let energy = WAYS.iter().map(energy_cell).collect();
    own.push(("long", "1,000 lossless impacts: the energy", energy));
    Ok((own, of_others))
}

fn csv(ways: &[&str], rows: &[Row]) -> Result<String, std::fmt::Error> {
    let mut table =
        String::from("group,difficulty,method,verdict,error,impacts,expected_impacts,evaluations,cause\n");
    for (group, name, cells) in rows {
        for (way, cell) in ways.iter().zip(cells) {
            writeln!(
                table,
                "{group},{},{way},{},{:.2e},{},{},{},{}",
                name.replace(',', ";"),
                cell.verdict.name(),
                cell.error,
                cell.impacts[0],
                cell.impacts[1],
                cell.evaluations,
                cell.cause.replace(',', ";")
            )?;
        }
    }
    Ok(table)
}

/// The number of verdicts of each kind for each method.
fn totals(ways: &[&str], rows: &[Row]) -> Result<String, std::fmt::Error> {
    let count = |j: usize, verdict| rows.iter().filter(|r| r.2[j].verdict == verdict).count();
    let mut text = String::from(
        "| method | works | miscounts | inaccurate | says it fails | fails silently |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    for (j, way) in ways.iter().enumerate() {
        let counts = VERDICTS.map(|verdict| count(j, verdict).to_string());
        writeln!(text, "| {way} | {} |", counts.join(" | "))?;
    }
    Ok(text)
}

fn heading(ways: &[&str], rows: &[Row]) -> Result<String, std::fmt::Error> {
    let mut text = format!(
        "# Where methods fail\n\nWritten by `just lab stability`. Every method runs each difficulty as a careful user would, at rtol 1e-6 or steps of 1 ms; \
         `ode23s defaults` is MATLAB's rtol 1e-3, as in the paper. The error is the larger of the relative errors of E1max and of the final state, against the hybrid at \
         rtol 1e-12, which DOP853 confirms (a test). *Works*: at most {:e}, every impact counted. *Miscounts*: the motion is as right, but shallow impacts are missed or counted twice. *Inaccurate*: at most {:e}, and at most one impact, or one in ten, miscounted. \
         *Says it fails*: an error is returned. *Fails silently*: anything else. Below each error: the evaluations of right-hand side and Jacobian; of the hybrid, each step of its exact flight counts as one. \
         Nothing here is a time: `just lab stability check` makes all of it again and compares it byte for byte.\n\n![atlas](atlas.svg)\n\n{}\n## Causes\n\n",
        retune_lab::atlas::WORKS,
        retune_lab::atlas::INACCURATE,
        totals(ways, rows)?
    );
    for (_, name, cells) in rows {
        for (way, cell) in ways.iter().zip(cells).filter(|(_, c)| c.verdict != Verdict::Works) {
            let error = if cell.error.is_nan() { String::new() } else { format!(" ({:.0e})", cell.error) };
            writeln!(
                text,
                "- **{name}**, {way}: {}{error}. {}.",
                cell.verdict.name(),
                sentence(&cell.cause)
            )?;
        }
    }
    Ok(text)
}

/// The text with a capital first letter.
fn sentence(cause: &str) -> String {
    let mut letters = cause.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

const OF_OTHERS: &str = "## Other people's integrators\n\nThe same difficulties at rtol 1e-6: Radau5 of the crate differential-equations, BDF of diffsol, LSODA of ivp, each with contacts located \
by its own root finding and with forces stepped over, and CVODE in C, which finds roots (it has no law of one restitution at every speed: *not run*). Located methods fail silently where the run begins on a wall, at a zero of \
the event function, which root finding does not report. The largest E1 is sought in their dense output every 0.2 ms. Numbers and causes: [`others.csv`](others.csv).\n\n\
![Where other people's integrators fail](others.svg)";
const STABLE: &str = "## Largest stable step\n\nOn the eigenvalues of the scenes' flight, and of two contacts frozen at their deepest, from the growth of each \
method's own step; theory is its stability function at those eigenvalues. The hybrid's flight is exact and has no limit, ode23s is L-stable and has none.";
const ENERGY: &str = "## Energy over 1,000 lossless impacts\n\nWithout damping and force the mechanical energy is constant. The hybrid's change at rtol 1e-6, \
some 7e-4, is honest: the tolerance allows 1e-6 in every step of a contact, 1,000 contacts add it up, and a test holds it to less than rtol for each impact. Loose tolerances \
compound: at 1e-2 the same 0.4 % an impact is a factor of some sixty after 1,000.";
const MISSED: &str = "## Contacts jumped over\n\nA step jumps over a contact if it begins and ends in flight although the exact motion from its beginning touches a wall \
and leaves it again within it. It happens to shallow contacts: a TMD whose wall stands at 99 % or 99.9 % of its free swing. Methods that locate contacts search the dense output of each step and find \
more, stepping methods see the ends of steps alone, and none of them notices. Contacts struck at speed (the SSVI, and the same 10⁴ times as stiff) are jumped over only in runs that blow up: a step that would is thrown back \
by the error estimate, and a fixed step lands deep in the wall and blows up.";
const RIGID: &str = "## Toward rigid walls\n\nThe limit of K → ∞ is an instantaneous elastic impact, which a propagator of its own follows. The contact's \
duration, and with it the distance of the two motions, falls as K^(−2/5).";
const OBJECTIVE: &str = "## The objective against tolerance and parameters\n\nE1max of Table 2's SSVI.";
const OPTIMA: &str = "## The optimum that fminsearch reports\n\nFrom Table 2's SSVI, E1max over 50 to 100 s, MATLAB's options. The last but two columns are the reported E1max and that of the \
same design under the hybrid at rtol 1e-12: where they differ, the search tuned the solver's error and not the damper.";
