//! What the contacts of a run are like, and where its energy goes: in words, and as data.

use retune_model::{Coupled, HERTZ_YIELD, Measure, Parameter, Scene, Side, Surfaces};
use retune_optim::Need;
use retune_solver::{Collisions, Losses, Window, simulate_in_detail};
use retune_study::{Setting, Study, counted, rounded};
use serde::Serialize;

/// The share of R above which the radius of the contact area is no longer small, as Hertz's theory takes it to be.
const WIDE: f64 = 1.0 / 3.0;
/// A contact is quasi-static, as Hertz's theory takes it to be, where a wave passes the damper and comes back so many times while it lasts.
const WAVES: f64 = 5.0;

/// The share by which the largest force of one run may differ from itself, found between the samples of an objective.
const SAME: f64 = 0.01;

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
    /// None of a rigid wall.
    #[serde(skip)]
    known: Option<Known>,
}

/// What Hertz's law is judged by. SI units.
#[derive(Clone, Copy, Debug)]
struct Known {
    /// R.
    radius: f64,
    /// The yield strength, where it is given.
    strength: Option<f64>,
    /// The time of a wave through the damper and back, where its density is given.
    wave: Option<f64>,
}

impl Known {
    fn of(surfaces: &Surfaces, side: Side, mass: f64) -> Self {
        let strength = surfaces.strength.map(f64::from);
        Self {
            radius: surfaces.radius.get(),
            strength,
            wave: surfaces.waves(mass).map(|waves| waves[side as usize]),
        }
    }
}

impl Contacts {
    /// Of a scene, from those of a run of it; none if it touches no wall.
    pub fn new(scene: &Scene, found: [Collisions; 2]) -> Option<Self> {
        let damper = scene.damper.filter(|damper| damper.contact.is_some())?;
        let system = Coupled::new(&scene.primary, &scene.forcing, &damper);
        let surfaces = damper.contact.and_then(|contact| contact.surfaces().copied());
        let wall = |side: Side| {
            let Collisions { count, speed, indentation, shortest, longest } = found[side as usize];
            (count > 0 || indentation > 0.0).then(|| Wall {
                impacts: count,
                impact_speed: speed,
                indentation,
                contact_radius: system.contact_radius(indentation),
                contact_pressure: match system.is_rigid() {
                    true => f64::INFINITY,
                    false => system.wall_pressure(side, indentation),
                },
                shortest,
                longest,
                known: surfaces.as_ref().map(|surfaces| Known::of(surfaces, side, damper.mass.get())),
            })
        };
        let [structure, obstacle] = Side::BOTH.map(wall);
        (structure.is_some() || obstacle.is_some()).then_some(Self { structure, obstacle })
    }

    /// Of the run from rest of a scene by a study where it strikes its walls hardest, at the place of its largest contact force; none where it strikes
    /// none, or cannot be run there, or where that run has another force: it is then one of another record, or of a member of an ensemble.
    pub fn hardest(study: &Study, scene: &Scene, force: Need) -> Option<Self> {
        let Need { value, omega, k1, restitution } = force;
        let mut there = vec![Setting::new(Parameter::K1, k1)];
        if !scene.forcing.is_transient() {
            there.push(Setting::new(Parameter::Omega, omega));
        }
        if Parameter::Restitution.of(scene).is_some() {
            there.push(Setting::new(Parameter::Restitution, restitution));
        }
        let scene = Study { scene: *scene, ..study.clone() }.scene_with(&there).ok()?;
        let whole = Window { from: 0.0, ..study.window.window() };
        if value <= 0.0 {
            return None;
        }
        let (run, _, found) = simulate_in_detail(&scene, whole, &study.solver.settings()).ok()?;
        let own = run.largest(Measure::ContactForce);
        let is_it = own == value || (own - value).abs() <= SAME * value;
        is_it.then(|| Self::new(&scene, found)).flatten()
    }

    fn walls(&self) -> impl Iterator<Item = (&'static str, &Wall)> {
        let named = [("structure", &self.structure), ("obstacle", &self.obstacle)];
        named.into_iter().filter_map(|(name, wall)| Some((name, wall.as_ref()?)))
    }

    pub fn words(&self) -> Vec<String> {
        self.walls().map(|(name, wall)| format!("{name}: {}", wall.words())).collect()
    }

    /// Where the law of the contact is used outside of what it holds for.
    pub fn warnings(&self) -> Vec<String> {
        let of = |(name, wall): (&str, &Wall)| {
            let all = [wall.wide(), wall.yields(), wall.fast()];
            all.into_iter().flatten().map(|words| format!("on the {name} {words}")).collect::<Vec<_>>()
        };
        self.walls().flat_map(of).collect()
    }
}

impl Wall {
    /// That its area is not small.
    fn wide(&self) -> Option<String> {
        let radius =
            self.known.map(|known| known.radius).filter(|radius| self.contact_radius > WIDE * radius)?;
        let [own, radius] = [self.contact_radius, radius].map(millimetres);
        Some(format!(
            "the contact area has a radius of {own}, more than a third of R = {radius}: Hertz's law holds for small areas"
        ))
    }

    /// That it is not elastic.
    fn yields(&self) -> Option<String> {
        let strength =
            self.known?.strength.filter(|strength| self.contact_pressure > HERTZ_YIELD * strength)?;
        let times = rounded(self.contact_pressure / strength, 3);
        let [own, strength] = [self.contact_pressure, strength].map(pressure);
        Some(format!(
            "the pressure of {own} is {times} times the yield strength of {strength}: at {HERTZ_YIELD} times that, yield begins below the \
             surface (Tresca and von Mises, nu = 0.3): Hertz's law holds for elastic contacts"
        ))
    }

    /// That it is not quasi-static.
    fn fast(&self) -> Option<String> {
        let wave = self.known?.wave.filter(|wave| self.shortest < WAVES * wave)?;
        let [own, wave] = [self.shortest, wave].map(|time| format!("{} ms", rounded(1e3 * time, 3)));
        Some(format!(
            "the shortest contact lasts {own}, less than {WAVES} times the {wave} of a wave through the damper and back: Hertz's law holds for quasi-static contacts"
        ))
    }

    fn words(&self) -> String {
        let Self { impacts, impact_speed, indentation, contact_radius, contact_pressure, .. } = *self;
        let [shortest, longest] = [self.shortest, self.longest].map(|time| rounded(1e3 * time, 3));
        let lasting = match self.longest > 0.0 {
            true if shortest == longest => format!("{shortest} ms long, "),
            true => format!("{shortest} to {longest} ms long, "),
            false => String::new(),
        };
        let impacts = format!("{} at up to {} m/s", counted(impacts, "impact"), rounded(impact_speed, 3));
        if self.known.is_none() {
            return format!("{impacts} on a rigid wall");
        }
        let [deep, radius] = [indentation, contact_radius].map(millimetres);
        format!(
            "{impacts}, {lasting}{deep} deep, on a radius of {radius}, pressure {}",
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
        let [c1, c2, impacts] = self.parts().map(|part| rounded(100.0 * part / total, 3));
        let on_average = format!("{} W on average", rounded(total, 4));
        (total > 0.0).then(|| format!("{on_average}: {c1} % in c1, {c2} % in c2, {impacts} % in impacts"))
    }
}
