//! The study that a session starts from, and the study that results when a page changes its damper and numbers.

use crate::forcing::forced;
use crate::limits::bounded;
use crate::motion::{IMPACTS, period};
use crate::protocol::{Answer, DamperKind, Place};
use crate::refused::Refused;
use crate::response::{Drawn, band, of_all_motions};
use retune_jobs::Error;
use retune_jobs::design::Specification;
use retune_model::{Contact, Damper, Forcing, Measure, NonNegative, Parameter, Scene, Surfaces, Unit};
use retune_optim::Objective;
use retune_study::{Rule, Setting, Span, Study, StudyError, read_record_text};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// The study that is explored if none is named: a copy of `studies/ssvi.json`, which a test compares.
const DEFAULT: &str = include_str!("study.json");

/// The study of a session, and where it came from.
#[derive(Clone, Debug)]
pub struct Start {
    study: Study,
    /// The argument of the command line, while its study is in use.
    pub file: Option<String>,
    damper: Damper,
    /// Whether it is a structure entered on the page.
    is_own: bool,
    /// Whether a study was named on the command line.
    is_named: bool,
}

/// A number that a page can change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Control {
    /// Its name in `--set`.
    pub name: &'static str,
    /// What it is.
    pub words: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Every unit in which it may be typed, with its size in `unit`.
    pub units: &'static [Unit],
    /// The study's value.
    pub value: f64,
    /// The range of the slider.
    pub range: [f64; 2],
    /// Whether the slider is logarithmic.
    pub log: bool,
    /// Its bounds in the study's search, if any.
    pub bounds: [Option<f64>; 2],
    /// Whether it belongs to walls and contacts, which are seldom changed.
    pub of_contact: bool,
    /// Whether it is the amplitude of a forcing.
    pub amplitude: bool,
    /// The dampers that have it.
    pub dampers: &'static [DamperKind],
}

/// The fields of a pulse and of a record.
const GIVEN: [&str; 8] = ["pulse", "record", "of", "peak", "duration", "unit", "scale", "column"];

/// The numbers that a page shows first, in this order; the amplitudes and then all other parameters follow.
const FIRST: [Parameter; 8] = [
    Parameter::Omega,
    Parameter::K2,
    Parameter::C2,
    Parameter::D,
    Parameter::C,
    Parameter::M2,
    Parameter::K1,
    Parameter::C1,
];

/// The dampers that have a parameter.
const fn dampers(parameter: Parameter) -> &'static [DamperKind] {
    if parameter.is_gap() || parameter.is_of_contact() {
        &[DamperKind::Ssvi]
    } else if parameter.is_of_damper() {
        &[DamperKind::Tmd, DamperKind::Ssvi]
    } else {
        &[DamperKind::None, DamperKind::Tmd, DamperKind::Ssvi]
    }
}

impl Start {
    /// Reads a study file or results; the paper's SSVI NES if none are named.
    ///
    /// # Errors
    /// The study is wrong.
    pub fn read(path: Option<&Path>) -> Result<Self, StudyError> {
        let default = retune_study::read::from_text(DEFAULT, "ssvi.json")?;
        let study = path.map(retune_study::read).transpose()?;
        let file = path.map(|path| path.display().to_string());
        let is_named = file.is_some();
        let none = || StudyError::Rule { file: "ssvi.json".to_owned(), rule: Rule::NoDamper };
        let other = default.scene.damper.ok_or_else(none)?;
        let study = study.unwrap_or(default);
        // A damper without walls gets the paper's gaps, and walls for its mass.
        let own = study.scene.damper.unwrap_or(other);
        let damper = if own.contact.is_some() {
            own
        } else {
            let Damper { rest_distance, clearance, .. } = other;
            let contact = Surfaces::for_mass(own.mass).ok().map(Contact::Hertz);
            Damper { rest_distance, clearance, contact, ..own }
        };
        Ok(Self { study, file, damper, is_own: false, is_named })
    }

    /// The study of a structure given by the fields of `retune design`, with Den Hartog's TMD; gaps and walls of its SSVI NES are scaled
    /// as there.
    ///
    /// # Errors
    /// A field is missing or wrong: its name, and what to give.
    pub fn own(structure: &BTreeMap<String, Value>) -> Result<Self, Refused> {
        let specification: Specification =
            serde_json::from_value(json!(structure)).map_err(Refused::whole)?;
        let refused = |error: Error| match error {
            Error::Requirement { place, problem } => {
                Refused::of(&place.trim_start_matches('-').replace('-', "_"), problem)
            }
            other => Refused::whole(other),
        };
        let requirements = specification.requirements().map_err(refused)?;
        let (open, walled) = (requirements.tmd().map_err(refused)?, requirements.ssvi().map_err(refused)?);
        let nothing = || Refused::whole("a damper is missing");
        let tmd = open.scene.damper.ok_or_else(nothing)?;
        let ssvi = walled.scene.damper.ok_or_else(nothing)?;
        let damper = Damper { stiffness: tmd.stiffness, damping: tmd.damping, ..ssvi };
        let scene = open.scene;
        Ok(Self {
            study: Study { scene, name: Some("own".to_owned()), ..walled },
            file: None,
            damper,
            is_own: true,
            is_named: false,
        })
    }

    /// This study under a pulse or a record; the run lasts until the structure is at rest again.
    ///
    /// # Errors
    /// It is neither, or has a field that does not belong to it.
    pub fn under(&self, forcing: Map<String, Value>, text: Option<&str>) -> Result<Self, Refused> {
        let stray = forcing.keys().find(|name| !GIVEN.contains(&name.as_str()));
        if let Some(name) = stray {
            return Err(Refused::of(name, format!("is not allowed here: give {}", GIVEN.join(", "))));
        }
        let mut forcing: Forcing = serde_json::from_value(Value::Object(forcing)).map_err(Refused::whole)?;
        match text {
            Some(text) => {
                read_record_text(&mut forcing, text).map_err(|problem| Refused::of("record", problem))?;
            }
            None if forcing.record_mut().is_some() => {
                return Err(Refused::of("record", "the text of its file is missing"));
            }
            None => {}
        }
        let scene = Scene { forcing, ..self.study.scene };
        let window = Span::settled(&scene).map_err(Refused::whole)?;
        let mut study = Study { scene, window, ..self.study.clone() };
        if let Some(optimize) = &mut study.optimize {
            let quantity = optimize.objective.quantity();
            (optimize.objective, optimize.limits.from) =
                (Objective { quantity, ..Objective::default() }, None);
        }
        let start = Self { study: bounded(study)?, file: None, ..self.clone() };
        start.with(start.damper_kind()).check().map_err(Refused::whole)?;
        Ok(start)
    }

    /// The study as it was read.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// The first answer: what a page must know before its first request.
    pub fn hello(&self) -> Answer {
        let study = &self.study;
        let (band, quantity) = (band(study), study.quantity());
        let of = json!({ "name": quantity.name(), "unit": quantity.unit(), "words": quantity.words() });
        Answer::new("hello")
            .with("version", env!("CARGO_PKG_VERSION"))
            .with("study", study.name())
            .with("damper", self.damper_kind())
            .with("controls", self.controls())
            .with("own", self.is_own)
            .with("transient", study.scene.forcing.is_transient())
            .with("forcing", forced(&study.scene.forcing))
            .with("period", period(study))
            .with("named", self.is_named)
            .with("band", [band.from, band.to])
            .with("window", [study.window.t0.get(), study.window.end.get()])
            .with("quantity", of)
            .with("quantities", Measure::ALL.map(|quantity| Drawn::of(study, quantity)))
            .with("figures", figures())
            .with("tunes", study.optimize.is_some())
            .with("motions", of_all_motions(study))
    }

    /// The damper that the study has.
    pub fn damper_kind(&self) -> DamperKind {
        match &self.study.scene.damper {
            None => DamperKind::None,
            Some(damper) if damper.contact.is_some() => DamperKind::Ssvi,
            Some(_) => DamperKind::Tmd,
        }
    }

    /// The study at a place, by the rules of study files. The bounds of its search are not checked: a user may leave them.
    ///
    /// # Errors
    /// A number that a study may not have.
    pub fn at(&self, place: &Place) -> Result<Study, Refused> {
        let settings = settings(place)?;
        let study = Study { optimize: None, ..self.with(place.damper) };
        let study = study.with(&settings)?;
        bounded(Study { optimize: self.with(place.damper).optimize, ..study })
    }

    /// The study at a place as a file would have it, including its search.
    ///
    /// # Errors
    /// As for [`Self::at`]; or a broken rule of the search, for instance a value out of its bounds.
    pub fn file_at(&self, place: &Place) -> Result<Study, Refused> {
        let mut study = self.with(place.damper);
        if place.damper == DamperKind::None {
            study.optimize = None;
        }
        Ok(study.with(&settings(place)?)?)
    }

    /// The study with another damper.
    fn with(&self, damper_kind: DamperKind) -> Study {
        let mut study = self.study.clone();
        let Damper { mass, stiffness, damping, .. } = self.damper;
        let zero = NonNegative::default();
        let open = Damper { mass, stiffness, damping, rest_distance: zero, clearance: zero, contact: None };
        study.scene.damper = match damper_kind {
            DamperKind::None => None,
            DamperKind::Tmd => Some(open),
            DamperKind::Ssvi => Some(self.damper),
        };
        if let Some(optimize) = study.optimize.as_mut().filter(|_| damper_kind == DamperKind::Tmd) {
            // Without walls there are no gaps to tune.
            for gap in [Parameter::D, Parameter::C] {
                optimize.vary.retain(|variable| *variable != gap);
                optimize.bounds.set(gap, None);
                optimize.surf.iter_mut().for_each(|axes| axes.set(gap, None));
                optimize.starts.iter_mut().for_each(|start| start.set(gap, None));
                optimize.global.iter_mut().for_each(|global| global.sides.set(gap, None));
            }
        }
        study
    }

    /// All numbers that a page can change, for every kind of damper.
    pub fn controls(&self) -> Vec<Control> {
        let walled = Study { optimize: None, ..self.with(DamperKind::Ssvi) };
        let control = |parameter: Parameter| {
            let value = parameter.of(&walled.scene)?;
            let [from, to] = self.range(parameter, value);
            let range = [from.min(value), to.max(value)];
            let log = range[0] > 0.0 && range[1] >= 10.0 * range[0];
            Some(Control {
                name: parameter.symbol(),
                words: parameter.words(),
                unit: parameter.unit(),
                units: parameter.units(),
                value,
                range,
                log,
                bounds: self.bounds(parameter),
                of_contact: parameter.is_of_contact(),
                amplitude: Parameter::AMPLITUDES.contains(&parameter),
                dampers: dampers(parameter),
            })
        };
        let first = || FIRST.into_iter().chain(Parameter::AMPLITUDES);
        let others = Parameter::ALL.into_iter().filter(|parameter| first().all(|one| one != *parameter));
        first().chain(others).filter_map(control).collect()
    }

    /// The bounds of the study's search on a parameter.
    fn bounds(&self, parameter: Parameter) -> [Option<f64>; 2] {
        let search = self.study.optimize.as_ref().filter(|optimize| optimize.vary.contains(&parameter));
        search
            .and_then(|optimize| optimize.bounds.get(parameter))
            .map_or([None; 2], |(lower, upper)| [Some(lower), upper])
    }

    /// The range of a slider: the band, the search's bounds (up to [`WIDEST`] times the value), or else a range around the value.
    fn range(&self, parameter: Parameter, value: f64) -> [f64; 2] {
        if parameter.is_frequency() {
            let band = band(&self.study);
            return [band.from, band.to];
        }
        match (self.bounds(parameter), parameter) {
            ([Some(lower), Some(upper)], _) if value > 0.0 => [lower, upper.min(WIDEST * value)],
            ([Some(lower), Some(upper)], _) => [lower, upper],
            (_, Parameter::Nu1 | Parameter::Nu2 | Parameter::Nu3 | Parameter::Nu4) => [0.0, 0.49],
            (_, Parameter::Restitution) => [0.1, 1.0],
            (_, Parameter::M1) => [0.25 * value, 4.0 * value],
            (_, Parameter::K1) => [0.4 * value, 2.5 * value],
            (_, Parameter::M2) => [0.25 * value, 4.0 * value],
            (_, parameter) if parameter.is_gap() || Parameter::AMPLITUDES.contains(&parameter) => {
                [0.0, if value > 0.0 { 4.0 * value } else { 1.0 }]
            }
            _ if value > 0.0 => [0.1 * value, 10.0 * value],
            _ => [0.0, 1.0],
        }
    }
}

/// A slider ends at most at this multiple of its first value.
const WIDEST: f64 = 30.0;

/// The figures of a run: name, unit and description of each.
fn figures() -> Vec<[&'static str; 3]> {
    let largest = Measure::ALL.map(|measure| [measure.name(), measure.unit(), measure.words()]);
    let impacts = [IMPACTS, "", "impacts in the window, on the structure and on the obstacle"];
    largest.into_iter().chain([impacts]).collect()
}

/// The numbers of a place as settings of `--set`.
pub fn settings(place: &Place) -> Result<Vec<Setting>, Refused> {
    let setting = |(name, value): (&String, &f64)| Ok(format!("{name}={value}").parse::<Setting>()?);
    place.set.iter().map(setting).collect()
}
