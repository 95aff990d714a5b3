//! Where each parameter stands in a scene: its value, read and set.

use super::Parameter;
use crate::{
    Bounce, Contact, Damper, Forcing, Loss, NonNegative, OutOfRange, PoissonRatio, Positive, Restitution,
    Scene, Source,
};
use schemars::{Schema, json_schema};

/// Why a scene lacks a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Absent {
    /// There is no damper.
    #[error("the scene has no damper")]
    NoDamper,
    /// The damper has no walls: no gaps, no surfaces.
    #[error("the damper has no walls")]
    NoWalls,
    /// The walls are rigid: they have a restitution alone.
    #[error("the walls are rigid: `restitution` is all that they have")]
    Rigid,
    /// The forcing is given by another parameter.
    #[error("the forcing of the scene is given by `{0}`")]
    Forcing(&'static str),
    /// Each wall has its own loss.
    #[error("each wall has its own loss: give `loss` alone, for both")]
    Losses,
    /// The loss of the contact is given by another parameter.
    #[error("the loss of the contact is given by `{0}`")]
    Loss(&'static str),
}

/// Why a parameter cannot be set.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Unsettable {
    /// The scene does not have it.
    #[error(transparent)]
    Absent(#[from] Absent),
    /// The value is not allowed.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
}

/// Where a parameter stands in a scene, with its range.
enum Place<'a> {
    Positive(&'a mut Positive),
    /// One that may be left out.
    Optional(&'a mut Option<Positive>),
    NonNegative(&'a mut NonNegative),
    Poisson(&'a mut PoissonRatio),
    Restitution(&'a mut Restitution),
    Bounce(&'a mut Bounce),
}

impl Place<'_> {
    fn get(&self) -> Option<f64> {
        Some(match self {
            Self::Positive(at) => at.get(),
            Self::Optional(at) => at.as_ref()?.get(),
            Self::NonNegative(at) => at.get(),
            Self::Poisson(at) => at.get(),
            Self::Restitution(at) => at.get(),
            Self::Bounce(at) => at.get(),
        })
    }

    fn set(self, value: f64) -> Result<(), OutOfRange> {
        match self {
            Self::Positive(at) => *at = Positive::new(value)?,
            Self::Optional(at) => *at = Some(Positive::new(value)?),
            Self::NonNegative(at) => *at = NonNegative::new(value)?,
            Self::Poisson(at) => *at = PoissonRatio::new(value)?,
            Self::Restitution(at) => *at = Restitution::new(value)?,
            Self::Bounce(at) => *at = Bounce::new(value)?,
        }
        Ok(())
    }
}

impl Parameter {
    /// Where it stands in a scene.
    fn place(self, scene: &mut Scene) -> Result<Place<'_>, Absent> {
        let (given_by, has_frequency) = (scene.forcing.given_by(), scene.forcing.source.is_harmonic());
        let Scene { primary, forcing, damper } = scene;
        let place = match (self, &mut forcing.source) {
            (Self::M1, _) => Place::Positive(&mut primary.mass),
            (Self::C1, _) => Place::NonNegative(&mut primary.damping),
            (Self::K1, _) => Place::NonNegative(&mut primary.stiffness),
            (one, Source::Harmonic(of, size)) if one == of.parameter() => Place::NonNegative(size),
            (Self::Omega, _) if has_frequency => Place::NonNegative(&mut forcing.frequency),
            (one, _) if one.is_frequency() || Self::AMPLITUDES.contains(&one) => {
                return Err(Absent::Forcing(given_by));
            }
            _ => return self.place_in(damper.as_mut().ok_or(Absent::NoDamper)?),
        };
        Ok(place)
    }

    /// Where it stands in a damper.
    fn place_in(self, damper: &mut Damper) -> Result<Place<'_>, Absent> {
        let Damper { mass, stiffness, damping, rest_distance, clearance, contact } = damper;
        match self {
            Self::M2 => return Ok(Place::Positive(mass)),
            Self::K2 => return Ok(Place::NonNegative(stiffness)),
            Self::C2 => return Ok(Place::NonNegative(damping)),
            _ => {}
        }
        let contact = contact.as_mut().ok_or(Absent::NoWalls)?;
        match self {
            Self::D => return Ok(Place::NonNegative(rest_distance)),
            Self::C => return Ok(Place::NonNegative(clearance)),
            _ => {}
        }
        let contact = match (self, contact) {
            (Self::Restitution, Contact::Rigid(rigid)) => return Ok(Place::Bounce(&mut rigid.restitution)),
            (_, Contact::Rigid(_)) => return Err(Absent::Rigid),
            (_, Contact::Hertz(surfaces)) => surfaces,
        };
        let place = match self {
            Self::Q => Place::Positive(&mut contact.coefficient),
            Self::E1 => Place::Positive(&mut contact.young_1),
            Self::Nu1 => Place::Poisson(&mut contact.poisson_1),
            Self::E2 => Place::Positive(&mut contact.young_2),
            Self::Nu2 => Place::Poisson(&mut contact.poisson_2),
            Self::E3 => Place::Positive(&mut contact.young_3),
            Self::Nu3 => Place::Poisson(&mut contact.poisson_3),
            Self::E4 => Place::Positive(&mut contact.young_4),
            Self::Nu4 => Place::Poisson(&mut contact.poisson_4),
            Self::Strength => Place::Optional(&mut contact.strength),
            Self::Density => Place::Optional(&mut contact.density),
            Self::Lambda | Self::Restitution if contact.loss_obstacle.is_some() => {
                return Err(Absent::Losses);
            }
            Self::Lambda | Self::Restitution => return self.place_in_loss(&mut contact.loss),
            _ => Place::Positive(&mut contact.radius),
        };
        Ok(place)
    }

    /// Where it stands in the loss of a contact. A contact without loss accepts either parameter.
    fn place_in_loss(self, loss: &mut Loss) -> Result<Place<'_>, Absent> {
        if loss.is_none() {
            *loss = match self {
                Self::Restitution => Loss::Restoring(Restitution::ONE),
                _ => Loss::default(),
            };
        }
        match (self, loss) {
            (Self::Restitution, Loss::Restoring(e)) => Ok(Place::Restitution(e)),
            (Self::Lambda, Loss::Damping(lambda)) => Ok(Place::NonNegative(lambda)),
            (_, Loss::Restoring(_)) => Err(Absent::Loss("restitution")),
            (_, Loss::Damping(_)) => Err(Absent::Loss("lambda")),
        }
    }

    /// Its value in a scene, in its SI unit; none where the scene has no such parameter.
    pub fn of(self, scene: &Scene) -> Option<f64> {
        self.place(&mut scene.clone()).ok().and_then(|place| place.get())
    }

    /// Gives it a value in a scene, in its SI unit.
    ///
    /// # Errors
    /// The scene does not have it, or the value is out of its range; the scene is then unchanged.
    pub fn set(self, scene: &mut Scene, value: f64) -> Result<(), Unsettable> {
        let mut changed = *scene;
        self.place(&mut changed)?.set(value)?;
        *scene = changed;
        Ok(())
    }

    /// Its value in a damper; none where it is not one of a damper, or the damper has no walls.
    pub fn of_damper(self, damper: &Damper) -> Option<f64> {
        let mut damper = *damper;
        let place = self.is_of_damper().then(|| self.place_in(&mut damper).ok()).flatten();
        place.and_then(|place| place.get())
    }

    /// Its value in a damper; NaN where it has none.
    pub fn get(self, damper: &Damper) -> f64 {
        self.of_damper(damper).unwrap_or(f64::NAN)
    }

    /// Gives it a value in a damper.
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn set_damper(self, damper: &mut Damper, value: f64) -> Result<(), Unsettable> {
        if !self.is_of_damper() {
            return Err(Absent::NoDamper.into());
        }
        let mut changed = *damper;
        self.place_in(&mut changed)?.set(value)?;
        *damper = changed;
        Ok(())
    }

    /// Whether a value of one of [`Self::VARIED`] must be above zero.
    const fn is_positive(self) -> bool {
        matches!(self, Self::M2 | Self::R)
    }

    /// Checks a value of one of [`Self::VARIED`], without a damper.
    ///
    /// # Errors
    /// It is out of its range.
    pub fn check(self, value: f64) -> Result<(), OutOfRange> {
        if self.is_positive() {
            Positive::new(value).map(|_| ())
        } else {
            NonNegative::new(value).map(|_| ())
        }
    }

    /// The range of one of [`Self::VARIED`] as a JSON Schema.
    pub(crate) fn range_schema(self) -> Schema {
        if self.is_positive() {
            json_schema!({ "type": "number", "exclusiveMinimum": 0.0 })
        } else {
            json_schema!({ "type": "number", "minimum": 0.0 })
        }
    }

    /// The scene with this parameter at `value`, in its SI unit; unchanged if it has no such parameter.
    ///
    /// # Errors
    /// The value is out of the parameter's range.
    pub fn at(self, mut scene: Scene, value: f64) -> Result<Scene, OutOfRange> {
        match self.set(&mut scene, value) {
            Err(Unsettable::OutOfRange(refused)) => Err(refused),
            Ok(()) | Err(Unsettable::Absent(_)) => Ok(scene),
        }
    }
}

impl Forcing {
    /// The field of a study that defines this forcing.
    pub fn given_by(&self) -> &'static str {
        match (self.amplitude(), self.source) {
            (Some((parameter, _)), _) => parameter.symbol(),
            (None, Source::History(history)) => history.course.given_by(),
            _ => "start",
        }
    }

    /// The number that sets the size of the motion, one of [`Parameter::AMPLITUDES`]. A free decay has none.
    pub fn amplitude(&self) -> Option<(Parameter, NonNegative)> {
        match self.source {
            Source::Harmonic(of, size) => Some((of.parameter(), size)),
            Source::Decay(_) | Source::History(_) => None,
        }
    }
}
