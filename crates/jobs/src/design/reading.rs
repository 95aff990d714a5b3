//! Converts requirements as given to SI units; missing, contradictory or impossible ones are refused with advice on what to give.

use super::driving::Driving;
use super::history;
use super::requirements::{Dampers, Requirements, STEEL, Wall};
use super::typed::{Specification, Typed};
use super::words::{percent, radians};
use crate::Error;
use retune_model::{Amplitude, Measure, Parameter, Positive, Unit, unit};
use retune_optim::{Limit, Limits};
use retune_study::rounded;
use std::f64::consts::TAU;

/// The band where none is given: natural frequency ± this share.
const BAND: f64 = 0.1;
/// A share without `%` of at least this is taken for a slip: 0.5 % is meant, not half.
const SLIP: f64 = 0.2;

impl Specification {
    /// The requirements in SI units.
    pub fn requirements(&self) -> Result<Requirements, Error> {
        checked(self)
    }
}

fn checked(specification: &Specification) -> Result<Requirements, Error> {
    let [m1, k1] = structure(specification)?;
    let natural = (k1 / m1).sqrt();
    let c1 = damping(specification, 2.0 * m1 * natural)?;
    let (driving, hertz) = match history::given(specification)? {
        Some((forcing, after)) => {
            (Driving::History { forcing, after }, unit_of_f1(specification).unwrap_or("Hz"))
        }
        None => {
            let amplitude = driving(specification)?;
            let (band, hertz) = band(specification, natural)?;
            (Driving::Harmonic { amplitude, band }, hertz)
        }
    };
    let mass = mass(specification, m1)?;
    let goal = goal(specification)?;
    let (limits, k2_max) = limits(specification)?;
    let k1_error = specification.k1_error.as_ref().map(|typed| share(typed, "k1_error", 1.0)).transpose()?;
    let dampers = specification.damper.as_ref().map_or(Ok(Dampers::Both), |typed| {
        let known = Dampers::ALL.into_iter().find(|dampers| dampers.name() == typed.text);
        known.ok_or_else(|| {
            typed.refused("damper", format!("\"{}\" is none: give tmd, ssvi or both", typed.text))
        })
    })?;
    let wall = specification.wall.as_ref().map(wall).transpose()?;
    Ok(Requirements {
        m1,
        k1,
        c1,
        driving,
        frequencies: hertz,
        mass,
        goal,
        limits,
        k2_max,
        k1_error,
        dampers,
        wall,
        of_mode: false,
    })
}

fn missing(option: &str, problem: &str) -> Error {
    Error::Requirement { place: option.to_owned(), problem: format!("missing: {problem}") }
}

fn positive(typed: &Typed, field: &str, units: &[Unit]) -> Result<f64, Error> {
    let value = typed.number(field, units)?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(typed.refused(field, format!("{} is not allowed here: give a number above 0", typed.text)))
    }
}

/// A share below `most`; one without `%` of at least [`SLIP`] is refused.
fn share(typed: &Typed, field: &str, most: f64) -> Result<f64, Error> {
    let value = positive(typed, field, unit::SHARE)?;
    let (text, percent) = (typed.text.trim(), rounded(100.0 * value, 4));
    if !text.ends_with('%') && value >= SLIP {
        return Err(typed.refused(
            field,
            format!("{text} is {percent} %: write {text}% if that is what is meant, else {percent}%"),
        ));
    }
    if value >= most {
        return Err(typed.refused(
            field,
            format!("{percent} % is not allowed here: give less than 100 %, for instance 10%"),
        ));
    }
    Ok(value)
}

/// `[m1, k1]`, kg and N/m.
fn structure(specification: &Specification) -> Result<[f64; 2], Error> {
    let [m1, k1, f1] = [
        (&specification.m1, Parameter::M1),
        (&specification.k1, Parameter::K1),
        (&specification.f1, Parameter::Omega),
    ]
    .map(|(typed, parameter)| {
        let name = if parameter == Parameter::Omega { "f1" } else { parameter.symbol() };
        typed.as_ref().map(|typed| -> Result<f64, Error> {
            let value = positive(typed, name, parameter.units())?;
            // A bare number is a frequency in Hz: nobody names a natural frequency f1 in rad/s.
            Ok(if name == "f1" && is_bare(&typed.text) { TAU * value } else { value })
        })
    });
    match (m1.transpose()?, k1.transpose()?, f1.transpose()?) {
        (Some(m1), Some(k1), None) => Ok([m1, k1]),
        (Some(m1), None, Some(omega)) => Ok([m1, m1 * omega * omega]),
        (None, Some(k1), Some(omega)) => Ok([k1 / (omega * omega), k1]),
        (Some(m1), Some(k1), Some(_)) => {
            let natural = rounded((k1 / m1).sqrt() / TAU, 4);
            let problem =
                format!("m1 and k1 are given too, which make it {natural} Hz: leave one of the three out");
            Err(specification
                .f1
                .as_ref()
                .map_or_else(|| missing("--f1", ""), |typed| typed.refused("f1", problem)))
        }
        (None, _, _) => Err(missing("--m1", "the mass of the structure, for instance --m1 40t")),
        (Some(_), None, None) => Err(missing(
            "--f1",
            "the natural frequency of the structure, for instance --f1 2Hz, or its stiffness, --k1 6.3MN/m",
        )),
    }
}

fn is_bare(text: &str) -> bool {
    text.trim().parse::<f64>().is_ok()
}

/// c1, N·s/m; `critical` is twice the mass times the natural frequency.
fn damping(specification: &Specification, critical: f64) -> Result<f64, Error> {
    let c1 = match (&specification.c1, &specification.zeta) {
        (Some(typed), None) => {
            let c1 = typed.number("c1", Parameter::C1.units())?;
            if !(c1 >= 0.0 && c1.is_finite()) {
                let problem = format!("{} is not allowed here: give a number not below 0", typed.text);
                return Err(typed.refused("c1", problem));
            }
            (c1, typed, "c1")
        }
        (None, Some(typed)) => {
            let zeta = typed.number("zeta", unit::SHARE)?;
            let zeta = if zeta == 0.0 { 0.0 } else { share(typed, "zeta", f64::INFINITY)? };
            (zeta * critical, typed, "zeta")
        }
        (Some(_), Some(typed)) => {
            return Err(typed.refused("zeta", "c1 is given too: leave one of them out"));
        }
        (None, None) => {
            let words = "the damping of the structure as a share of critical, for instance --zeta 1% (steel 0.2 to 1 %, concrete 1 to 2 %), or --c1";
            return Err(missing("--zeta", words));
        }
    };
    let (c1, typed, field) = c1;
    if c1 >= critical {
        let percent = rounded(100.0 * c1 / critical, 3);
        let most = rounded(critical, 3);
        let problem = format!(
            "{} is {percent} % of critical damping: such a structure does not vibrate, and needs no damper; \
             check the unit (critical is {most} N·s/m)",
            typed.text
        );
        return Err(typed.refused(field, problem));
    }
    Ok(c1)
}

/// The harmonic excitation: its kind and amplitude.
fn driving(specification: &Specification) -> Result<(Amplitude, f64), Error> {
    let all = [
        ("force", &specification.force, Amplitude::Force),
        ("imbalance", &specification.imbalance, Amplitude::Imbalance),
        ("base", &specification.base, Amplitude::Base),
        ("base_acceleration", &specification.base_acceleration, Amplitude::BaseAcceleration),
    ];
    let given: Vec<_> =
        all.iter().filter_map(|(name, typed, of)| Some((*name, typed.as_ref()?, *of))).collect();
    match given.as_slice() {
        [] => Err(missing(
            "--force",
            "what moves the structure: --force 280N, --imbalance 0.02kg·m, --base 1mm, --base-acceleration 0.1g, --shock half-sine,20ms,5g or --record FILE",
        )),
        [(name, typed, of)] => Ok((*of, positive(typed, name, of.parameter().units())?)),
        [(first, ..), (name, typed, _), ..] => {
            Err(typed
                .refused(name, format!("{} is given too: leave one of them out", first.replace('_', "-"))))
        }
    }
}

/// The unit of frequency that a text contains.
fn frequency_unit(text: &str) -> Option<&'static str> {
    unit::FREQUENCY.iter().rev().find(|(name, _)| text.contains(name)).map(|(name, _)| *name)
}

/// The unit in which the natural frequency is given.
fn unit_of_f1(specification: &Specification) -> Option<&'static str> {
    specification.f1.as_ref().map(|typed| frequency_unit(&typed.text).unwrap_or("Hz"))
}

/// The band, rad/s, and the unit in which frequencies are reported.
fn band(specification: &Specification, natural: f64) -> Result<([f64; 2], &'static str), Error> {
    let unit_of_f1 = unit_of_f1(specification);
    let Some(typed) = &specification.band else {
        return Ok(([(1.0 - BAND) * natural, (1.0 + BAND) * natural], unit_of_f1.unwrap_or("Hz")));
    };
    let text = typed.text.replace("+-", "±").replace("+/-", "±");
    let given = frequency_unit(&text);
    let number = |text: &str| {
        // A bare number takes the unit of the other end: 1.8..2.2Hz.
        let text =
            if is_bare(text) { format!("{text} {}", given.unwrap_or("rad/s")) } else { text.to_owned() };
        unit::read(&text, unit::FREQUENCY).map_err(|problem| typed.refused("band", problem))
    };
    let ends = if let Some((middle, width)) = text.split_once('±') {
        let middle = if middle.trim().is_empty() { natural } else { number(middle)? };
        let width = width.trim();
        let half = match width.strip_suffix('%') {
            Some(percent) => {
                middle * 0.01 * unit::read(percent, &[]).map_err(|problem| typed.refused("band", problem))?
            }
            None => number(width)?,
        };
        [middle - half, middle + half]
    } else if let Some((from, to)) =
        text.split_once("..").or_else(|| text.split_once('–')).or_else(|| text.split_once(" to "))
    {
        [number(from)?, number(to)?]
    } else {
        let problem = format!(
            "\"{}\" is no band: give its ends, {}; a damper that is tuned for one frequency alone fails beside it",
            typed.text, "for instance 1.8Hz..2.2Hz, or 1500rpm±5%"
        );
        return Err(typed.refused("band", problem));
    };
    let [from, to] = ends;
    let unit = given.or(unit_of_f1).unwrap_or("rad/s");
    if from > 0.0 && from < to && to.is_finite() {
        return wrong_unit(typed, given, ends, natural).map_or(Ok((ends, unit)), Err);
    }
    let [low, high] = [from.min(to), from.max(to)].map(|end| rounded(end / radians(unit), 6));
    let problem = if from > to && to > 0.0 {
        format!("the lower end comes first: write {low}..{high}{unit}")
    } else {
        format!("from {low} to {high} {unit} is not allowed here: give two different frequencies above 0")
    };
    Err(typed.refused("band", problem))
}

/// The error of a band without a unit, taken in rad/s, that would contain the natural frequency only in Hz.
fn wrong_unit(typed: &Typed, unit: Option<&str>, [from, to]: [f64; 2], natural: f64) -> Option<Error> {
    let holds = |size: f64| (size * from..=size * to).contains(&natural);
    if unit.is_some() || holds(1.0) || !holds(TAU) {
        return None;
    }
    let [low, high, own] = [from, to, natural].map(|omega| rounded(omega, 6));
    Some(typed.refused(
        "band",
        format!("without a unit it is {low}..{high} rad/s, which leaves out the structure's own {own} rad/s: write {low}..{high}Hz if that is what is meant, else {low}..{high}rad/s"),
    ))
}

/// Share of the structure's mass below which a number without a unit is a slip.
const LIGHT: f64 = 1e-3;

/// Mass of the damper, kg.
fn mass(specification: &Specification, m1: f64) -> Result<f64, Error> {
    let Some(typed) = &specification.mass else {
        let words = "the mass of the damper, for instance --mass 2% (of the structure) or --mass 800kg";
        return Err(missing("--mass", words));
    };
    let mass = if typed.text.trim().ends_with('%') {
        m1 * positive(typed, "mass", unit::SHARE)?
    } else {
        positive(typed, "mass", unit::MASS)?
    };
    if mass > m1 {
        let problem = format!(
            "{} is more than the structure's {} kg: a damper is lighter; 1 to 5 % are usual, for instance --mass 2%",
            typed.text,
            rounded(m1, 6)
        );
        return Err(typed.refused("mass", problem));
    }
    if is_bare(&typed.text) && mass < LIGHT * m1 {
        let (own, share) = (rounded(mass, 6), percent(mass / m1));
        let meant = rounded(if mass < 1.0 { 100.0 * mass } else { mass }, 6);
        let problem = format!(
            "{own} is {own} kg, {share} of the structure: write {meant}% if that is what is meant, else {own}kg"
        );
        return Err(typed.refused("mass", problem));
    }
    Ok(mass)
}

/// The quantity of a name, which may be hyphenated: `ground-force`.
fn measure(name: &str) -> Option<Measure> {
    let name = name.replace('-', "_");
    Measure::ALL.into_iter().find(|measure| measure.name() == name)
}

fn goal(specification: &Specification) -> Result<Measure, Error> {
    let Some(typed) = &specification.goal else { return Ok(Measure::Energy) };
    let known = measure(&typed.text).filter(|measure| !measure.is_of_damper());
    known.ok_or_else(|| {
        let all = Measure::OF_STRUCTURE.map(Measure::name).join(", ");
        typed.refused("goal", format!("\"{}\" is none: give one of {all}", typed.text))
    })
}

fn limits(specification: &Specification) -> Result<(Limits, Option<f64>), Error> {
    let (mut limits, mut k2) = (Limits::default(), None);
    for (name, typed) in specification.all_limits()? {
        let field = format!("limit {name}");
        let units = |limit: Limit| match limit {
            Limit::Of(measure) => measure.units(),
            Limit::Cavity => unit::LENGTH,
        };
        if name == "k2" {
            k2 = Some(positive(&typed, &field, Parameter::K2.units())?);
            continue;
        }
        let known = measure(&name).map(Limit::Of).or((name == "cavity").then_some(Limit::Cavity));
        let Some(limit) = known else {
            let all = Measure::ALL.map(Measure::name).join(", ");
            let problem = format!("there is no quantity \"{name}\": give one of {all}, cavity, k2");
            return Err(typed.refused("limit", problem));
        };
        let value = positive(&typed, &field, units(limit))?;
        limits = limits.with(limit, Positive::new(value)?);
    }
    Ok((limits, k2))
}

/// Materials of walls: name, Young's modulus (N/m²), Poisson's ratio.
const MATERIALS: [(&str, f64, f64); 2] = [("steel", STEEL, 0.3), ("rubber", 5e6, RUBBER)];
/// Poisson's ratio of the damper's surfaces without a named material: the paper's.
const RUBBER: f64 = 0.4;

/// The walls: radius and Young's modulus or material of the damper's surfaces, and the restitution of a contact.
fn wall(typed: &Typed) -> Result<Wall, Error> {
    let (mut radius, mut modulus, mut restitution, mut poisson) = (None, None, None, RUBBER);
    let part_of = |text: &str| Typed { text: text.to_owned(), ..typed.clone() };
    for part in typed.text.split(',').map(str::trim) {
        let material = MATERIALS.iter().find(|(name, ..)| *name == part);
        match (material, part.split_once('=').map(|(name, value)| (name.trim(), value))) {
            (Some(&(_, young, ratio)), _) => (modulus, poisson) = (Some(young), ratio),
            (_, Some(("R", value))) => radius = Some(positive(&part_of(value), "wall", unit::LENGTH)?),
            (_, Some(("E", value))) => modulus = Some(positive(&part_of(value), "wall", unit::MODULUS)?),
            (_, Some(("e", value))) => restitution = Some(positive(&part_of(value), "wall", unit::SHARE)?),
            _ => {
                let problem = format!(
                    "\"{part}\" is not known: give the radius and Young's modulus of the damper's surfaces, for instance R=20mm,E=5MPa, or rubber or steel for E; e=0.7 is a restitution"
                );
                return Err(typed.refused("wall", problem));
            }
        }
    }
    if let Some(e) = restitution.filter(|e| *e > 1.0) {
        return Err(
            typed.refused("wall", format!("e = {e} is not allowed here: at most 1, which loses nothing"))
        );
    }
    let missing =
        |name: &str| typed.refused("wall", format!("{name} is missing: for instance R=20mm,E=5MPa"));
    Ok(Wall {
        radius: radius.ok_or_else(|| missing("R"))?,
        modulus: modulus.ok_or_else(|| missing("E"))?,
        poisson,
        restitution,
    })
}
