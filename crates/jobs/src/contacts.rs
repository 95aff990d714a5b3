//! What the contacts of a run are like, and where its energy goes: in words, and as data.

use retune_model::{Coupled, Scene, Side};
use retune_solver::{Collisions, Losses, Settings, SolverError, Window, collisions};
use retune_study::{counted, rounded};
use serde::Serialize;

/// The share of R above which the radius of the contact area is no longer small, as Hertz's theory takes it to be.
const WIDE: f64 = 1.0 / 3.0;

/// The contacts with both walls in a run; none with a wall that is not touched.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Contacts {
    structure: Option<Wall>,
    obstacle: Option<Wall>,
}

/// The contacts with one wall: the largest value of each. SI units.
#[derive(Clone, Copy, Debug, Serialize)]
struct Wall {
    impacts: u64,
    impact_speed: f64,
    indentation: f64,
    contact_radius: f64,
    contact_pressure: f64,
    /// Duration of the shortest and of the longest contact, null if none has begun and ended.
    shortest: f64,
    longest: f64,
    /// R, m; none of a rigid wall.
    #[serde(skip)]
    radius: Option<f64>,
}

impl Contacts {
    /// Of a run of a scene; none if it touches no wall.
    ///
    /// # Errors
    /// The run fails.
    pub fn of(scene: &Scene, window: Window, settings: &Settings) -> Result<Option<Self>, SolverError> {
        let Some(damper) = scene.damper.filter(|damper| damper.contact.is_some()) else { return Ok(None) };
        let system = Coupled::new(&scene.primary, &scene.forcing, &damper);
        let found = collisions(scene, window, settings)?;
        let wall = |side: Side| {
            let Collisions { count, speed, indentation, shortest, longest } = found[side as usize];
            (count > 0 || indentation > 0.0).then(|| Wall {
                impacts: count,
                impact_speed: speed,
                indentation,
                contact_radius: system.contact_radius(indentation),
                contact_pressure: system.wall_pressure(side, indentation),
                shortest,
                longest,
                radius: damper
                    .contact
                    .and_then(|contact| contact.surfaces().copied())
                    .map(|of| of.radius.get()),
            })
        };
        let [structure, obstacle] = Side::BOTH.map(wall);
        Ok((structure.is_some() || obstacle.is_some()).then_some(Self { structure, obstacle }))
    }

    fn walls(&self) -> impl Iterator<Item = (&'static str, &Wall)> {
        let named = [("structure", &self.structure), ("obstacle", &self.obstacle)];
        named.into_iter().filter_map(|(name, wall)| Some((name, wall.as_ref()?)))
    }

    /// A sentence for each wall.
    pub fn words(&self) -> Vec<String> {
        self.walls().map(|(name, wall)| format!("{name}: {}", wall.words())).collect()
    }

    /// Where the law of the contact is used outside of what it holds for.
    pub fn warnings(&self) -> Vec<String> {
        let wide = self.walls().filter_map(|(name, wall)| {
            let radius = wall.radius.filter(|radius| wall.contact_radius > WIDE * radius)?;
            Some((name, wall, radius))
        });
        wide.map(|(name, wall, radius)| {
            format!(
                "on the {name} the contact area has a radius of {}, more than a third of R = {}: Hertz's law holds for small areas",
                millimetres(wall.contact_radius),
                millimetres(radius)
            )
        })
        .collect()
    }
}

impl Wall {
    fn words(&self) -> String {
        let Self { impacts, impact_speed, indentation, contact_radius, contact_pressure, .. } = *self;
        let lasting = if self.longest > 0.0 {
            let [shortest, longest] = [self.shortest, self.longest].map(|time| rounded(1e3 * time, 3));
            if shortest == longest {
                format!("{shortest} ms long, ")
            } else {
                format!("{shortest} to {longest} ms long, ")
            }
        } else {
            String::new()
        };
        let impacts = format!("{} at up to {} m/s", counted(impacts, "impact"), rounded(impact_speed, 3));
        if self.radius.is_none() {
            return format!("{impacts} on a rigid wall");
        }
        format!(
            "{impacts}, {lasting}{} deep, on a radius of {}, pressure {}",
            millimetres(indentation),
            millimetres(contact_radius),
            pressure(contact_pressure)
        )
    }
}

fn millimetres(length: f64) -> String {
    format!("{} mm", rounded(1e3 * length, 3))
}

fn pressure(value: f64) -> String {
    let (scale, unit) = if value < 1e6 { (1e-3, "kPa") } else { (1e-6, "MPa") };
    format!("{} {unit}", rounded(scale * value, 3))
}

/// The mean powers that the motion in a window loses, W.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Powers {
    structure: f64,
    damper: f64,
    impacts: f64,
}

impl Powers {
    /// From what is lost in so many seconds.
    pub fn new(losses: Losses, seconds: f64) -> Self {
        let Losses { structure, damper, impacts } = losses;
        Self { structure: structure / seconds, damper: damper / seconds, impacts: impacts / seconds }
    }

    /// In the dashpot of the structure, in that of the damper, in impacts, W.
    pub fn parts(&self) -> [f64; 3] {
        [self.structure, self.damper, self.impacts]
    }

    /// Where the energy goes; none if nothing is lost.
    pub fn words(&self) -> Option<String> {
        let [structure, damper, impacts] = self.parts();
        let total = structure + damper + impacts;
        let share = |part: f64| rounded(100.0 * part / total, 3);
        (total > 0.0).then(|| {
            format!(
                "{} W on average: {} % in c1, {} % in c2, {} % in impacts",
                rounded(total, 4),
                share(structure),
                share(damper),
                share(impacts)
            )
        })
    }
}
