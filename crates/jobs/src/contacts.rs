//! The contacts of a run and its energy balance, in words and as data.

use retune_model::{Coupled, HERTZ_YIELD, Measure, Parameter, Scene, Side, Surfaces};
use retune_optim::Need;
use retune_solver::{Collisions, Losses, Window, simulate_in_detail};
use retune_study::{Setting, Study, counted, rounded};
use serde::Serialize;

/// Radius of the contact area, as a share of R, above which it is not small as Hertz's theory assumes.
const WIDE: f64 = 1.0 / 3.0;
/// A contact is quasi-static, as Hertz's theory assumes, if it lasts at least this many round trips of a wave through the damper.
const WAVES: f64 = 5.0;

/// Relative difference up to which two largest forces are taken to be of the same run; one may be a peak found between samples.
const SAME: f64 = 0.01;

/// The contacts with both walls in a run; none for a wall that is not touched.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Contacts {
    structure: Option<Wall>,
    obstacle: Option<Wall>,
}

/// The contacts with one wall: their largest values. SI units.
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
    /// None for a rigid wall.
    #[serde(skip)]
    validity: Option<Validity>,
}

/// The properties by which the validity of Hertz's law is checked. SI units.
#[derive(Clone, Copy, Debug)]
struct Validity {
    /// R.
    radius: f64,
    /// The yield strength, where it is given.
    strength: Option<f64>,
    /// The round-trip time of a wave through the damper, where its density is given.
    wave: Option<f64>,
}

impl Validity {
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
    /// The contacts of a scene from the collisions of a run; none if it touches no wall.
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
                validity: surfaces.as_ref().map(|surfaces| Validity::of(surfaces, side, damper.mass.get())),
            })
        };
        let [structure, obstacle] = Side::BOTH.map(wall);
        (structure.is_some() || obstacle.is_some()).then_some(Self { structure, obstacle })
    }

    /// The contacts of the run from rest with the largest contact force, `force`. None without contacts, where that run fails, or where it
    /// reproduces another force: `force` is then from another record or a member of an ensemble.
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
        let reached = run.largest(Measure::ContactForce);
        let is_same_run = reached == value || (reached - value).abs() <= SAME * value;
        is_same_run.then(|| Self::new(&scene, found)).flatten()
    }

    fn walls(&self) -> impl Iterator<Item = (&'static str, &Wall)> {
        let named = [("structure", &self.structure), ("obstacle", &self.obstacle)];
        named.into_iter().filter_map(|(name, wall)| Some((name, wall.as_ref()?)))
    }

    pub fn words(&self) -> Vec<String> {
        self.walls().map(|(name, wall)| format!("{name}: {}", wall.words())).collect()
    }

    /// Warnings where the contact law is used outside its range of validity.
    pub fn warnings(&self) -> Vec<String> {
        let of = |(name, wall): (&str, &Wall)| {
            let all = [wall.wide(), wall.yields(), wall.fast()];
            all.into_iter().flatten().map(|words| format!("on the {name} {words}")).collect::<Vec<_>>()
        };
        self.walls().flat_map(of).collect()
    }
}

impl Wall {
    /// A warning if the contact area is not small.
    fn wide(&self) -> Option<String> {
        let radius = self
            .validity
            .map(|validity| validity.radius)
            .filter(|radius| self.contact_radius > WIDE * radius)?;
        let [contact_radius, radius] = [self.contact_radius, radius].map(millimetres);
        Some(format!(
            "the contact area has a radius of {contact_radius}, more than a third of R = {radius}: Hertz's law holds for small areas"
        ))
    }

    /// A warning if the contact is not elastic.
    fn yields(&self) -> Option<String> {
        let strength =
            self.validity?.strength.filter(|strength| self.contact_pressure > HERTZ_YIELD * strength)?;
        let times = rounded(self.contact_pressure / strength, 3);
        let [contact_pressure, strength] = [self.contact_pressure, strength].map(pressure);
        Some(format!(
            "the pressure of {contact_pressure} is {times} times the yield strength of {strength}: at {HERTZ_YIELD} times that, yield begins below the \
             surface (Tresca and von Mises, nu = 0.3): Hertz's law holds for elastic contacts"
        ))
    }

    /// A warning if the contact is not quasi-static.
    fn fast(&self) -> Option<String> {
        let wave = self.validity?.wave.filter(|wave| self.shortest < WAVES * wave)?;
        let [shortest, wave] = [self.shortest, wave].map(|time| format!("{} ms", rounded(1e3 * time, 3)));
        Some(format!(
            "the shortest contact lasts {shortest}, less than {WAVES} times the {wave} of a wave through the damper and back: Hertz's law holds for quasi-static contacts"
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
        if self.validity.is_none() {
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

/// The mean dissipated powers in a window, W.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Powers {
    structure: f64,
    damper: f64,
    impacts: f64,
}

impl Powers {
    /// From the energies lost in `seconds`.
    pub fn new(losses: Losses, seconds: f64) -> Self {
        let Losses { structure, damper, impacts } = losses;
        Self { structure: structure / seconds, damper: damper / seconds, impacts: impacts / seconds }
    }

    /// The powers of the structure's dashpot, the damper's dashpot and the impacts, W.
    pub fn parts(&self) -> [f64; 3] {
        [self.structure, self.damper, self.impacts]
    }

    /// The energy balance in words; none if nothing is lost.
    pub fn words(&self) -> Option<String> {
        let [structure, damper, impacts] = self.parts();
        let total = structure + damper + impacts;
        let [c1, c2, impacts] = self.parts().map(|part| rounded(100.0 * part / total, 3));
        let on_average = format!("{} W on average", rounded(total, 4));
        (total > 0.0).then(|| format!("{on_average}: {c1} % in c1, {c2} % in c2, {impacts} % in impacts"))
    }
}
