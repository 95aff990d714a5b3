//! `just lab hunt…`: many draws of what `cargo test` checks with few. Prints the table of `results/robustness`, then any faults on standard
//! error; with faults the exit code is 1.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use retune_lab::hunts::{durations, robust, scenes, walk, worst};
use retune_lab::{Any, machine};
use retune_testkit::hunt as hunts;
use retune_testkit::hunt::draws::Scenes;
use retune_testkit::hunt::{
    Hunt, bands, branches, dampers, dashpots, kills, largest, needs, peaks, repeats, rigid, settled,
};
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "hunt NAME [DRAWS]: largest, losses, held, histories, rigid, repeats, peaks, needs, robust (DRAWS or FIRST..LAST), branches, dampers, dashpots, durations, walk (a share of its \
                     steps), worst, scenes, settled, bands, kills";

fn main() -> Any<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (name, draws) = match &arguments[..] {
        [name] => (name.as_str(), None),
        [name, draws] => (name.as_str(), Some(draws.as_str())),
        _ => return Err(USAGE.into()),
    };
    let number = |usual: u32| draws.map_or(Ok(usual), str::parse);
    let many = |usual: u32| number(usual).map(|count| count as usize);
    let mut well = true;
    let mut show = |heading: &str, hunt: Hunt| {
        print!("{heading}");
        hunt.rows.iter().for_each(|row| println!("{row}"));
        hunt.faults.iter().for_each(|fault| eprintln!("fault: {fault}"));
        well &= hunt.faults.is_empty();
    };
    match name {
        "largest" => {
            let count = number(150_000)?.into();
            show(include_str!("../hunts/hunt.md"), largest::beside_everywhere(Scenes::Any, count));
            show("", largest::beside_everywhere(Scenes::TwoMaxima, count));
            show("", largest::beside_everywhere(Scenes::Lossy, count));
            show("", largest::beside_dop853(Scenes::Any, count));
            show("", largest::beside_dop853(Scenes::Lossy, count));
        }
        "losses" => {
            let count = number(20_000)?.into();
            show(include_str!("../hunts/hunt.md"), largest::beside_everywhere(Scenes::Lossy, count));
            show("", largest::beside_dop853(Scenes::Lossy, count));
        }
        "held" => {
            let count = number(3000)?.into();
            show(include_str!("../hunts/hunt.md"), largest::beside_everywhere(Scenes::Held, count));
            show("", largest::beside_dop853(Scenes::Held, count));
        }
        "histories" => {
            let count = number(10_000)?.into();
            show(HISTORIES, largest::beside_everywhere(Scenes::Histories, count));
            show("", largest::beside_dop853(Scenes::Histories, count));
        }
        "dashpots" => show(DASHPOTS, dashpots::dashpots(number(20_000)?.into())),
        "rigid" => show(include_str!("../hunts/rigid.md"), rigid::rigid(number(40_000)?.into())),
        "repeats" => show(include_str!("../hunts/repeats.md"), repeats::repeats(number(42_000)?.into())),
        "peaks" => show(include_str!("../hunts/peaks.md"), peaks::peaks(number(3000)?)),
        "needs" => {
            // A scan may come closer to a peak than the search for it.
            let hunt = needs::needs(number(50)?.into(), 100.0, 2001, 1e-5);
            show(include_str!("../hunts/needs.md"), hunt);
        }
        "robust" => {
            let (first, last) =
                draws.unwrap_or("100").split_once("..").unwrap_or(("0", draws.unwrap_or("100")));
            show(include_str!("../hunts/robust.md"), robust::robust(first.parse()?..last.parse()?)?);
        }
        "branches" => {
            let stiffnesses = [2e4, 2.5e4, 3e4, 3.5e4, 4.5e4, 5e4, 5.5e4, 6e4];
            show(PERIODS, branches::periods(&stiffnesses, [0.8, 1.25]));
            show(FROM_REST, branches::from_rest(&branches::DAMPERS, many(3001)?));
        }
        "durations" => show(&timed(include_str!("../hunts/durations.md")), durations::durations(many(3000)?)),
        "worst" => show(&timed(include_str!("../hunts/worst.md")), worst::worst(number(400)?)),
        "dampers" => show(include_str!("../hunts/dampers.md"), dampers::dampers(many(7)?, 500)),
        "walk" => show(WALK, walk::walk(draws.map_or(Ok(1.0), str::parse)?)?),
        "scenes" => show("", hunts::scenes::scenes(&scenes::drawn(many(30_000)?))),
        "settled" => show("", settled::settled_stays(many(4000)?)),
        "bands" => show("", bands::bands(number(1_000_000)?.into())),
        "kills" => show(KILLS, kills::kills(&Path::new("target/release/retune").canonicalize()?, many(240)?)),
        _ => return Err(USAGE.into()),
    }
    Ok(if well { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A heading with the machine behind its times.
fn timed(heading: &str) -> String {
    heading.replace("MACHINE", &machine::words(&machine::this()))
}

const HISTORIES: &str = "# The hunt under pulses and records

Written by `just lab hunt`. The scenes of `hunt.md` under a half sine, a rectangle or noise (samples 2 ms to half a second apart, equidistant or
not, at most 4000), a force of 300 to 6000 N or an acceleration of the base by as much over m1; three times as much for a pulse. 20 s from
rest; one scene in five has contacts that lose energy (`crates/testkit/src/hunt/histories.rs`). DOP853 begins anew at every sample.

| what | scenes | with contacts | seen | allowed | faults |
| --- | ---: | ---: | --- | ---: | ---: |
";

const DASHPOTS: &str = "# Long steps beside short ones, with strong dashpots

Written by `just lab hunt-dashpots`. The relative motion of the damper decays at 30 to 10,000 times the frequency of the force; m2 1 to 3000 kg,
k1 1e4 to 1e5 N/m, k2 0 to 30 c2 per second, D 0 to 0.05 m, C 0 to 0.2 m, one in four without a wall in reach, one in ten without c1 and one with so
much that the structure creeps, too; 20 s from rest at rtol 1e-10 (`crates/testkit/src/hunt/dashpots.rs`). Once the fast part of the motion has
decayed, the solver leaves it out and takes longer steps (`crates/solver/src/linear/reduced.rs`, in contacts
`crates/model/src/regularised/overdamped.rs`); the other run takes all its short ones. In one scene of eight D = 0: a wall holds the damper half of the
time, and the other run takes short steps in its contacts, since short flights would add up more rounding errors than the damper's small swing allows.
Where both come to the same end to 1e-9, E1max, E2max, both ends of the relative displacement, x1max, v1max, a1max and the force on the
ground must agree; without a wall, E1max of the damper in closed form, too.

| what | scenes | long steps | short steps | allowed | faults |
| --- | ---: | ---: | ---: | ---: | ---: |
";

const PERIODS: &str = "
## Branches of Table 2's damper at eight stiffnesses

| k1, N/m | branches | motions | of a shorter period | ends where no motion is found ahead |
| ---: | ---: | ---: | ---: | ---: |
";

const FROM_REST: &str = "
## Runs from rest at many frequencies of four dampers, and between them

| k2, N/m | c2, N·s/m | D, m | C, m | branches | frequencies | on a branch | irregular | largest exponents of these, 1/s | between them, on no branch |
| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: |
";

const WALK: &str = "
## Walks under k2 <= 300 N/m, C = 0: 10000 steps on 601 frequencies, then 3200 on 5000

| walk | k2, N/m | c2, N·s/m | D, m | E1max on 601 frequencies, J | on 5000 |
| --- | ---: | ---: | ---: | ---: | ---: |
";

const KILLS: &str = "| command | stage | kills |
| --- | --- | ---: |
";
