//! What is asked of a design, and the studies that follow from it.
//!
//! Bounds and grids scale with the structure: stiffnesses and dampings with those of Den Hartog's damper, gaps with the amplitude of the
//! structure without a damper.

use crate::Error;
use retune_model::{Bare, Positive, Scene, Surfaces, den_hartog};
use retune_study::read::from_text;
use retune_study::{Rule, Study};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// What is asked of a design. SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Requirements {
    /// Mass of the structure, kg.
    pub m1: f64,
    /// Its stiffness, N/m.
    pub k1: f64,
    /// Its damping, N·s/m.
    pub c1: f64,
    /// Amplitude of the force on it, N.
    #[serde(rename = "P")]
    pub force: f64,
    /// The angular frequencies of the force, rad/s.
    pub band: [f64; 2],
    /// Mass of the damper, kg.
    pub mass: f64,
    /// Largest stroke of its spring, m.
    pub stroke: Option<f64>,
    /// Largest stiffness of its spring, N/m.
    pub k2_max: Option<f64>,
    /// Share by which k1 may be off.
    pub k1_error: Option<f64>,
}

/// A limit that is wished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// On the stroke.
    Stroke,
    /// On the stiffness.
    K2,
}

impl Wish {
    /// Its name in tables and directories.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stroke => "stroke-limit",
            Self::K2 => "k2-limit",
        }
    }

    /// Its name in a sentence.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Stroke => "the stroke",
            Self::K2 => "k2",
        }
    }
}

impl Requirements {
    /// Checks the requirements one by one.
    ///
    /// # Errors
    /// The first that cannot be fulfilled, by its name on the command line.
    pub fn check(&self) -> Result<(), Error> {
        let refuse = |field: &str, value: String, allowed: &'static str| {
            let rule = Rule::NotAllowed { field: format!("--{field}"), value, allowed };
            Err(Error::Rule { name: "design".to_owned(), rule })
        };
        let positive = [
            ("m1", Some(self.m1)),
            ("k1", Some(self.k1)),
            ("P", Some(self.force)),
            ("mass", Some(self.mass)),
            ("stroke", self.stroke),
            ("k2-max", self.k2_max),
        ];
        for (field, value) in positive {
            if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
                return refuse(field, value.to_string(), "a number above 0");
            }
        }
        if !(self.c1 >= 0.0 && self.c1.is_finite()) {
            return refuse("c1", self.c1.to_string(), "a number not below 0");
        }
        let [from, to] = self.band;
        if !(from > 0.0 && from < to && to.is_finite()) {
            let band = format!("{from} to {to} rad/s");
            return refuse("band", band, "two frequencies above 0, the lower one first");
        }
        if let Some(error) = self.k1_error.filter(|error| !(*error > 0.0 && *error < 1.0)) {
            return refuse("k1-error", error.to_string(), "a share above 0 and below 1, for instance 0.1");
        }
        if self.mass > self.m1 {
            let mass = self.mass.to_string();
            return refuse("mass", mass, "a mass no larger than m1: a damper is lighter than its structure");
        }
        Ok(())
    }

    /// The limits that are wished.
    pub fn limits(&self) -> Vec<Wish> {
        let stroke = self.stroke.map(|_| Wish::Stroke);
        stroke.into_iter().chain(self.k2_max.map(|_| Wish::K2)).collect()
    }

    /// The same without one limit.
    #[must_use]
    pub fn without(&self, limit: Wish) -> Self {
        let mut requirements = self.clone();
        match limit {
            Wish::Stroke => requirements.stroke = None,
            Wish::K2 => requirements.k2_max = None,
        }
        requirements
    }

    /// The structure and the force on it, at the frequency of the band that is nearest to its own.
    fn bare(&self) -> Result<Scene, Error> {
        let natural = self.natural_frequency();
        let study = json!({
            "name": "bare",
            "scene": {
                "primary": { "m1": self.m1, "c1": self.c1, "k1": self.k1 },
                "forcing": { "P": self.force, "omega": natural.clamp(self.band[0], self.band[1]) }
            },
            "window": { "t0": 0, "T": 1 }
        });
        Ok(from_text(&study.to_string(), "design")?.scene)
    }

    /// √(k1/m1), rad/s.
    pub fn natural_frequency(&self) -> f64 {
        (self.k1 / self.m1).sqrt()
    }

    /// Den Hartog's k2 (N/m) and c2 (N·s/m), and the largest steady displacement (m) of the structure alone over the band. An undamped
    /// structure counts as damped by 1 %.
    fn scales(&self) -> Result<([f64; 2], f64), Error> {
        let damped = Self { c1: self.c1.max(0.02 * self.m1 * self.natural_frequency()), ..self.clone() };
        let Scene { primary, forcing, .. } = damped.bare()?;
        let response = Bare::new(&primary, &forcing).steady(forcing.frequency.get());
        Ok((den_hartog(&primary, self.mass), response.x1.norm()))
    }

    /// The study of the TMD: steady, in closed form, k2 and c2 free. Its walls are out of reach.
    ///
    /// # Errors
    /// A number is beyond what a study may hold.
    pub fn tmd(&self) -> Result<Study, Error> {
        let ([k2, c2], reach) = self.scales()?;
        let far = 1e3 * reach.max(self.stroke.unwrap_or(0.0));
        let most = self.k2_max.unwrap_or(20.0 * k2);
        let start = [k2.min(most), c2];
        let axis = |from: f64, to: f64| json!({ "from": from, "to": to, "points": 21, "scale": "log" });
        let optimize = json!({
            "vary": ["k2", "c2"],
            "objective": { "omega": self.omega(), "response": "steady" },
            "bounds": { "k2": [0, most], "c2": [0, 200.0 * c2] },
            "surf": { "k2": axis(0.05 * k2.min(most), (4.0 * k2).min(most)), "c2": axis(0.05 * c2, 20.0 * c2) },
            "refine": { "starts": 3, "scaled": true, "TolX": 1e-10, "TolFun": 1e-12 * self.energy(reach) }
        });
        self.study("tmd", start, [far; 2], optimize)
    }

    /// The study of the SSVI NES: runs from rest, all four parameters free.
    ///
    /// # Errors
    /// As [`Self::tmd`].
    pub fn ssvi(&self) -> Result<Study, Error> {
        let ([k2, c2], reach) = self.scales()?;
        let most = self.k2_max.unwrap_or(4.0 * k2);
        let start = [(0.1 * k2).min(most), c2];
        let axis = |from: f64, to: f64, scale: &str, points: u32| json!({ "from": from, "to": to, "points": points, "scale": scale });
        let stiffest = k2.min(most);
        let optimize = json!({
            "vary": ["k2", "c2", "D", "C"],
            "objective": { "omega": self.omega() },
            "bounds": { "k2": [0, most], "c2": [0, 50.0 * c2], "D": [0, 4.0 * reach], "C": [0, 8.0 * reach] },
            "surf": {
                "k2": axis(0.08 * stiffest, stiffest, "log", 6),
                "c2": axis(0.2 * c2, 4.0 * c2, "log", 6),
                "D": axis(0.0, 0.8 * reach, "linear", 5),
                "C": axis(0.2 * reach, 2.6 * reach, "linear", 5)
            },
            "coarse": { "rtol": 1e-4, "peaks": false },
            "refine": { "starts": 2, "scaled": true, "TolX": 1e-3, "TolFun": 1e-5 * self.energy(reach), "MaxFunEvals": 300 }
        });
        self.study("ssvi", start, [0.2 * reach, reach], optimize)
    }

    /// The energy that the structure's spring stores at a displacement of `reach` (m), J: the scale of tolerances.
    fn energy(&self, reach: f64) -> f64 {
        0.5 * self.k1 * reach.powi(2)
    }

    fn omega(&self) -> Value {
        json!({ "from": self.band[0], "to": self.band[1], "samples": 31 })
    }

    /// The walls of the damper: nobody who asks for a design has them yet.
    ///
    /// # Errors
    /// There are none for its mass.
    pub fn contact(&self) -> Result<Surfaces, Error> {
        let refuse = |_| Error::Rule {
            name: "design".to_owned(),
            rule: Rule::NotAllowed {
                field: "--mass".to_owned(),
                value: self.mass.to_string(),
                allowed: "a mass above 0",
            },
        };
        Positive::new(self.mass).and_then(Surfaces::for_mass).map_err(refuse)
    }

    /// A study of 100 periods of the structure, the first half of which passes before maxima are taken.
    fn study(
        &self,
        name: &str,
        [k2, c2]: [f64; 2],
        [d, c]: [f64; 2],
        mut optimize: Value,
    ) -> Result<Study, Error> {
        let period = TAU / self.natural_frequency();
        if let Some(stroke) = self.stroke {
            optimize["limits"] = json!({ "stroke": stroke, "from": 50.0 * period });
        }
        let bare = self.bare()?;
        let study = json!({
            "name": name,
            "scene": {
                "primary": bare.primary,
                "forcing": bare.forcing,
                "damper": {
                    "m2": self.mass, "k2": k2, "c2": c2, "D": d, "C": c,
                    "contact": self.contact()?
                }
            },
            "window": { "t0": 50.0 * period, "T": 100.0 * period },
            "optimize": optimize
        });
        Ok(from_text(&study.to_string(), "design")?)
    }
}
