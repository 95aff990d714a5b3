//! `just lab walls`: which model of a wall a damper needs, into `results/walls/`.

use rayon::prelude::*;
use retune_lab::Any;
use retune_lab::panel::{Line, WIDTHS, panel, sheet};
use retune_model::{Contact, Damper, Loss, Parameter, Positive, Restitution, Scene};
use retune_report::colour::{BLACK, BLUE, VERMILION};
use retune_report::table::Table;
use retune_report::{Axis, Shape, cells};
use retune_solver::simulate_in_detail;
use retune_study::{Setting, Study, read};
use retune_testkit::scenes::rigid;
use std::fs;
use std::path::Path;
use std::time::Instant;

/// The tuned damper of `results/ssvi`: k2, c2, D and C stand in its optimum.
const OPTIMUM: &str = "results/ssvi/optimum.json";
const STUDY: &str = "studies/ssvi.json";
const RESTITUTIONS: [f64; 9] = [1.0, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3];
/// Hertz's K relative to that of the study.
const STIFFNESSES: [f64; 5] = [0.1, 0.3, 1.0, 3.0, 10.0];
/// Number of measurements of a cost, of which the least is used.
const REPEATS: usize = 5;

/// The models of a wall, from the smallest to the largest.
#[derive(Clone, Copy, PartialEq)]
enum Wall {
    /// Impacts that take no time.
    Rigid,
    /// Hertz without loss.
    Lossless,
    /// Hertz with Hunt and Crossley's λ.
    Damped,
    /// Hertz with the restitution at every speed: the reference.
    Full,
}

impl Wall {
    const ALL: [Self; 4] = [Self::Rigid, Self::Lossless, Self::Damped, Self::Full];

    const fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Lossless => "Hertz without loss",
            Self::Damped => "Hertz, one lambda",
            Self::Full => "Hertz, one restitution",
        }
    }

    /// A scene with this wall; λ is chosen to give the restitution at the speed `at` (m/s).
    fn of(self, scene: &Scene, stiffness: f64, e: f64, at: Positive) -> Any<Scene> {
        let mut scene = *scene;
        let Some(Damper { contact: Some(contact), .. }) = &mut scene.damper else {
            return Err("a damper without walls".into());
        };
        if self == Self::Rigid {
            *contact = rigid(e);
            return Ok(scene);
        }
        let Contact::Hertz(surfaces) = contact else { return Err("rigid walls".into()) };
        for young in
            [&mut surfaces.young_1, &mut surfaces.young_2, &mut surfaces.young_3, &mut surfaces.young_4]
        {
            *young = Positive::new(young.get() * stiffness)?;
        }
        surfaces.loss = match self {
            Self::Full if e < 1.0 => Loss::Restoring(Restitution::new(e)?),
            Self::Damped => Loss::restoring_at(Restitution::new(e)?, at)?,
            _ => Loss::default(),
        };
        Ok(scene)
    }
}

/// Worst E1max over the band, J.
fn worst(study: &Study, scene: &Scene) -> Any<f64> {
    Ok(study.goal().evaluate(scene, &study.solver.settings(), f64::INFINITY)?.value)
}

/// The greatest impact speed of the worst run, m/s.
fn impact_speed(study: &Study) -> Any<Positive> {
    let (goal, settings) = (study.goal(), study.solver.settings());
    let run = goal.evaluate(&study.scene, &settings, f64::INFINITY)?.worst_run(study.scene, &goal);
    let (_, _, walls) = simulate_in_detail(&run, study.window.window(), &settings)?;
    Ok(Positive::new(walls.iter().map(|wall| wall.speed).fold(0.0, f64::max))?)
}

/// The results of the models at one stiffness and restitution, J.
struct Point {
    stiffness: f64,
    e: f64,
    values: [f64; 4],
}

impl Point {
    fn error(&self, wall: Wall) -> f64 {
        (self.values[wall as usize] / self.values[Wall::Full as usize] - 1.0).abs()
    }
}

fn main() -> Any<()> {
    let folder = Path::new("results/walls");
    fs::create_dir_all(folder)?;
    let optimum: serde_json::Value = serde_json::from_str(&fs::read_to_string(OPTIMUM)?)?;
    let design = [Parameter::K2, Parameter::C2, Parameter::D, Parameter::C];
    let design = design.map(|own| Setting::new(own, optimum[own.symbol()].as_f64().unwrap_or(f64::NAN)));
    let study = read(Path::new(STUDY))?.with(&design)?;
    let at = impact_speed(&study)?;
    let grid: Vec<(f64, f64)> =
        STIFFNESSES.iter().flat_map(|&k| RESTITUTIONS.iter().map(move |&e| (k, e))).collect();
    let point = |&(stiffness, e): &(f64, f64)| -> Result<Point, String> {
        let value = |wall: Wall| -> Any<f64> { worst(&study, &wall.of(&study.scene, stiffness, e, at)?) };
        let mut values = [f64::NAN; 4];
        for wall in Wall::ALL {
            values[wall as usize] = value(wall).map_err(|error| error.to_string())?;
        }
        Ok(Point { stiffness, e, values })
    };
    let points: Result<Vec<Point>, String> = grid.par_iter().map(point).collect();
    let points = points?;
    let mut table = Table::headed("stiffness | e | model | E1max, J | error");
    for point in &points {
        for wall in Wall::ALL {
            let (value, error) = (point.values[wall as usize], point.error(wall));
            table.push(cells![point.stiffness, point.e, wall.name(), value, format!("{error:.2e}")]);
        }
    }
    fs::write(folder.join("walls.csv"), table.csv())?;
    draw(&folder.join("walls.svg"), &points)?;
    fs::write(folder.join("README.md"), page(&points, &costs(&study, at)?, at))?;
    Ok(())
}

/// CPU time of an evaluation at the study's stiffness with e = 0.7, relative to that without loss, on one thread: the least of several.
fn costs(study: &Study, at: Positive) -> Any<[f64; 4]> {
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let mut least = [f64::INFINITY; 4];
    for _ in 0..REPEATS {
        for wall in Wall::ALL {
            let scene = wall.of(&study.scene, 1.0, 0.7, at)?;
            let since = Instant::now();
            alone.install(|| worst(study, &scene).map_err(|error| error.to_string()))?;
            least[wall as usize] = least[wall as usize].min(since.elapsed().as_secs_f64());
        }
    }
    Ok(least.map(|cost| cost / least[Wall::Lossless as usize]))
}

fn draw(path: &Path, points: &[Point]) -> Any<()> {
    let [thin, .., bold] = WIDTHS;
    let line = |wall: Wall, stiffness: f64, look| {
        let of = points.iter().filter(|point| point.stiffness == stiffness);
        Line::new(
            &format!("K × {stiffness}"),
            of.map(|point| (point.e, point.error(wall).max(1e-6))).collect(),
            look,
        )
    };
    let of = |wall: Wall| {
        let lines = vec![
            line(wall, 0.1, (BLUE, thin, Shape::Square)),
            line(wall, 10.0, (BLACK, thin, Shape::Triangle)),
            line(wall, 1.0, (VERMILION, bold, Shape::Disc)),
        ];
        let x = Axis::linear("restitution e", (0.3, 1.0));
        panel(wall.name(), x, Axis::log("error of E1max", (1e-6, 1.0)), lines, 150.0)
    };
    let panels = [Wall::Rigid, Wall::Lossless, Wall::Damped].map(of).to_vec();
    let note = "Worst E1max over 5 to 8 rad/s of the tuned SSVI NES by smaller models of its walls, against Hertz's contacts with one restitution at every speed. Errors below 1e-6 lie on the axis.";
    sheet(path, "Which model of a wall it takes", &[note], 3, panels)
}

/// The page.
fn page(points: &[Point], costs: &[f64; 4], at: Positive) -> String {
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    let mut rows = String::new();
    for &stiffness in &STIFFNESSES {
        for wall in [Wall::Rigid, Wall::Lossless, Wall::Damped] {
            let of = points.iter().filter(|point| point.stiffness == stiffness);
            let cells: Vec<String> = of.map(|point| percent(point.error(wall))).collect();
            rows += &format!("| {stiffness} | {} | {} |\n", wall.name(), cells.join(" | "));
        }
    }
    let most = |wall: Wall, range: std::ops::RangeInclusive<f64>| {
        let of = points.iter().filter(|point| range.contains(&point.e));
        percent(of.map(|point| point.error(wall)).fold(0.0, f64::max))
    };
    let found = format!(
        "At any of these stiffnesses a restitution up to 0.7 matters more than how a contact goes on: rigid walls with the right e err by at most {}, \
         Hertz's contacts without loss by up to {}. With e from 0.9 to 1 the contact itself counts: rigid walls err by up to {}, one λ by up to {}.",
        most(Wall::Rigid, 0.0..=0.7),
        most(Wall::Lossless, 0.0..=0.7),
        most(Wall::Rigid, 0.9..=1.0),
        most(Wall::Damped, 0.9..=1.0)
    );
    let heads = RESTITUTIONS.map(|e| e.to_string()).join(" | ");
    let prices: Vec<String> =
        Wall::ALL.iter().map(|wall| format!("{} {:.2}", wall.name(), costs[*wall as usize])).collect();
    let at = format!("{:.2}", at.get());
    format!(
        "# Which model of a wall it takes\n\n\
         Made by `just lab walls`; do not edit. Worst E1max over 5 to 8 rad/s (the objective of `{STUDY}`) of the tuned\n\
         damper of `results/ssvi`, with walls of four models. The full one is Hertz's contact with one restitution at every speed; the others are\n\
         smaller. λ is that which has the restitution at {at} m/s, the greatest impact speed of the worst run without loss. K is Hertz's stiffness over that of the study.\n\n\
         {found}\n\n\
         ![Errors of the smaller models](walls.svg)\n\n\
         ## Errors of E1max\n\n\
         | K | model | {heads} |\n| --- | --- |{}\n{rows}\n\
         ## Cost\n\n\
         Time of an evaluation on one thread at K = 1 and e = 0.7, over that without loss, the least of {REPEATS}: {}.\n\n\
         Numbers: [`walls.csv`](walls.csv).\n",
        " --- |".repeat(RESTITUTIONS.len()),
        prices.join(", ")
    )
}
