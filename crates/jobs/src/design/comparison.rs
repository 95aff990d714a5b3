//! The comparison: no damper, the best TMD, an SSVI NES, what each limit costs, and how sure the recommended one is.

use super::candidate::{Candidate, What, with_design};
use super::requirements::{Constraint, Dampers, Requirements};
use super::trust::{certified, doubt, first_feasible, striking, trusted, worst_nearby};
use super::words::{parameters, question, sized};
use super::{Formula, ssvi, tmd};
use crate::certify::Certificate;
use crate::{Error, Observer};
use retune_model::{Measure, Parameter, Scene};
use retune_optim::{Limit, Need};
use retune_store::Journal;
use retune_study::Study;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

/// A goal that is larger by less than this share is as good: the damper without walls is recommended.
const SAME: f64 = 0.05;
/// Halvings of the mass that would keep the limits, as a share of the structure's, and the largest that is looked at.
const HALVINGS: usize = 12;
const HEAVIEST: f64 = 0.3;

/// What is compared, and what follows.
#[derive(Debug)]
pub struct Comparison {
    /// What is made small.
    pub goal: Measure,
    /// The structure alone.
    pub none: Candidate,
    /// The formulas that fit the goal, and what the TMD of each has of it.
    pub formulas: Vec<(Formula, Candidate)>,
    /// The best TMD.
    pub tmd: Candidate,
    /// The best SSVI NES that was found that strikes its walls.
    pub ssvi: Option<Candidate>,
    /// Designs of an SSVI NES that were evaluated; none where that was not wanted.
    pub tried: Option<usize>,
    /// The one to build; none where none keeps the limits.
    pub choice: Option<What>,
    /// The goal of the SSVI NES under a shock or a record with the other sign, which a damper with one wall nearer than the other feels.
    pub other_sign: Option<f64>,
    /// What each limit costs.
    pub costs: Vec<Cost>,
    /// The goal with k1 as given, off by minus and by plus its error, of each candidate in the order of [`Self::all`].
    pub detuned: Vec<[f64; 3]>,
    /// Mass of the lightest TMD that would keep the limits, kg, where that of the mass that is given does not.
    pub lightest: Option<f64>,
    /// How sure the one to build is.
    pub certificate: Option<Certificate>,
    /// How sure the SSVI NES is, where it would be better than the TMD.
    pub ssvi_certificate: Option<Certificate>,
}

/// What a limit costs.
#[derive(Debug)]
pub struct Cost {
    /// The limit.
    pub constraint: Constraint,
    /// The best TMD without it.
    pub tmd: Candidate,
    /// The best SSVI NES without it, where one is to be built that the limit holds back.
    pub ssvi: Option<Candidate>,
}

impl Comparison {
    /// Whether even the best damper hardly lowers the goal.
    pub fn is_in_vain(&self) -> bool {
        self.chosen().is_some_and(|chosen| self.none.goal < 1.001 * chosen.goal)
    }

    /// The dampers that were designed, the TMD first.
    pub fn dampers(&self) -> impl Iterator<Item = &Candidate> + Clone {
        std::iter::once(&self.tmd).chain(&self.ssvi)
    }

    /// All candidates, no damper first.
    pub fn all(&self) -> impl Iterator<Item = &Candidate> + Clone {
        std::iter::once(&self.none).chain(self.dampers())
    }

    /// Refuses a comparison of which no damper keeps the limits by [`Error::Infeasible`].
    pub fn check_limits(&self) -> Result<(), Error> {
        match self.choice {
            Some(_) => Ok(()),
            None => Err(Error::Infeasible {
                name: "design".to_owned(),
                words: "none was found that keeps them".to_owned(),
            }),
        }
    }

    /// The one to build.
    pub fn chosen(&self) -> Option<&Candidate> {
        self.choice.and_then(|what| self.dampers().find(|damper| damper.what == what))
    }
}

/// The TMD with this spring and dashpot.
fn tmd_of(study: &Study, [k2, c2]: [f64; 2]) -> Result<Candidate, Error> {
    let study = with_design(study, |parameter| match parameter {
        Parameter::K2 => k2,
        Parameter::C2 => c2,
        _ => f64::NAN,
    })?;
    Ok(Candidate::new(What::Tmd, &study)?)
}

fn by(requirements: &Requirements, study: &Study, formula: Formula) -> Result<(Formula, Candidate), Error> {
    let mut tmd = tmd_of(study, [formula.k2, formula.c2])?;
    tmd.feasible &= requirements.k2_max.is_none_or(|most| formula.k2 <= most);
    Ok((formula, tmd))
}

/// Makes the whole comparison; what is known is told at once.
pub(super) fn compare(
    requirements: &Requirements,
    [tmd_study, ssvi_study]: [&Study; 2],
    journal: &Journal,
    watch: &dyn Observer,
) -> Result<Comparison, Error> {
    let goal = requirements.goal;
    for line in question(requirements) {
        watch.result(&line)?;
    }
    let bare = Study { scene: Scene { damper: None, ..tmd_study.scene }, ..tmd_study.clone() };
    let none = Candidate::new(What::None, &bare)?;
    let formulas = Formula::all(requirements, &tmd_study.scene.primary);
    let tmd = tmd_of(tmd_study, tmd::best(tmd_study, &formulas)?)?;
    let formulas =
        formulas.into_iter().map(|formula| by(requirements, tmd_study, formula)).collect::<Result<_, _>>()?;
    let kept = if tmd.feasible { "" } else { " (breaks a limit)" };
    let (name, has) = (goal.name(), sized(tmd.goal, goal.unit()));
    let exact = if tmd.is_transient() { "" } else { ", exact" };
    watch.result(&format!("\nTMD{exact}: {name} {has}{kept}, {}", parameters(&tmd)))?;
    let (mut ssvi, mut tried, mut judged) = (None, None, None);
    if requirements.dampers != Dampers::Tmd {
        watch.result("SSVI NES, from known designs: some seconds (Ctrl-C leaves what stands above)")?;
        let found = ssvi::best(ssvi_study, &tmd, &[], (journal, "ssvi"), watch)?;
        tried = Some(found.tried);
        let mut all = striking(ssvi_study, &found);
        let rival = requirements.dampers == Dampers::Ssvi || !tmd.feasible;
        let best = first_feasible(&mut all)?;
        let least = best.as_ref().map(|(_, candidate)| candidate.goal);
        (ssvi, judged) = match best {
            Some(best) if best.1.feasible && (rival || tmd.goal > (1.0 + SAME) * best.1.goal) => {
                let (candidate, certificate) = trusted(best, all, watch)?;
                (Some(candidate), Some(certificate))
            }
            best => (best.map(|(_, candidate)| candidate), None),
        };
        ssvi::tell_compared(&found, ssvi.as_ref().zip(least), watch)?;
    }
    let other_sign = ssvi.as_ref().and_then(Candidate::with_other_sign);
    let much_better = |certificate: &Certificate| (1.0 + SAME) * worst_nearby(certificate) < tmd.goal;
    let is_trusted = judged
        .as_ref()
        .is_some_and(|found| doubt(found) <= 1 || requirements.run().is_some() && much_better(found))
        && !(requirements.driving.has_either_sign() && other_sign.is_some_and(|other| other > tmd.goal));
    let choice = choice(requirements, &tmd, ssvi.as_ref(), is_trusted);
    let built = ssvi.as_ref().filter(|_| choice == Some(What::Ssvi));
    let costs = costs(requirements, (&tmd, built), journal, watch)?;
    let all = [Some(&none), Some(&tmd), ssvi.as_ref()];
    let detuned = match requirements.k1_error {
        Some(error) => all.iter().flatten().map(|of| of.with_k1_off([0.0, -error, error])).collect(),
        None => Vec::new(),
    };
    let lightest = if tmd.feasible { None } else { lightest(requirements)? };
    let certificate = match choice {
        Some(What::Ssvi) => judged.clone(),
        Some(_) => Some(certified(&tmd.study)?),
        None => None,
    };
    let whole = |of: Candidate| if Some(of.what) == choice { of.with_start() } else { Ok(of) };
    Ok(Comparison {
        goal,
        none,
        formulas,
        tmd: whole(tmd)?,
        ssvi: ssvi.map(whole).transpose()?,
        tried,
        choice,
        other_sign,
        costs,
        detuned,
        lightest,
        certificate,
        ssvi_certificate: judged,
    })
}

/// The one to build: a damper without walls is simpler to build and easier to trust; one with walls must be much better, and hold where it
/// is a little off.
fn choice(
    requirements: &Requirements,
    tmd: &Candidate,
    ssvi: Option<&Candidate>,
    is_trusted: bool,
) -> Option<What> {
    let ssvi = ssvi.filter(|ssvi| ssvi.feasible);
    match (requirements.dampers, tmd.feasible, ssvi) {
        (Dampers::Ssvi, _, Some(_)) => Some(What::Ssvi),
        (_, true, Some(ssvi)) if is_trusted && tmd.goal > (1.0 + SAME) * ssvi.goal => Some(What::Ssvi),
        (_, true, _) => Some(What::Tmd),
        (_, false, Some(_)) => Some(What::Ssvi),
        (_, false, None) => None,
    }
}

/// What each limit costs the best TMD, and an SSVI NES that is to be built: the search without the limit goes on from the end of that with it.
fn costs(
    requirements: &Requirements,
    (tmd, built): (&Candidate, Option<&Candidate>),
    journal: &Journal,
    watch: &dyn Observer,
) -> Result<Vec<Cost>, Error> {
    let cost = |constraint: Constraint| {
        let free = requirements.without(constraint);
        let study = free.tmd()?;
        let formulas = Formula::all(&free, &study.scene.primary);
        let free_tmd = tmd_of(&study, tmd::best(&study, &formulas)?)?;
        let binds = |ssvi: &&Candidate| match constraint {
            Constraint::Of(limit) => ssvi.binding.iter().any(|(other, _)| *other == limit),
            Constraint::K2 => ssvi.k2() > 0.99 * requirements.allowed(constraint),
        };
        let free_ssvi = if let Some(ssvi) = built.filter(binds) {
            let study = free.ssvi()?;
            let own = |parameter: Parameter| ssvi.damper().map_or(f64::NAN, |damper| parameter.get(&damper));
            let start = Parameter::PAPER.map(own);
            let stage = format!("ssvi without {}", constraint.name());
            let found = ssvi::best(&study, tmd, &[start.to_vec()], (journal, &stage), watch)?;
            first_feasible(&mut striking(&study, &found))?.map(|(_, candidate)| candidate)
        } else {
            None
        };
        Ok(Cost { constraint, tmd: free_tmd, ssvi: free_ssvi })
    };
    requirements.constraints().into_iter().map(cost).collect()
}

/// Mass of the lightest TMD that keeps the limits, kg; none up to [`HEAVIEST`].
fn lightest(requirements: &Requirements) -> Result<Option<f64>, Error> {
    let keeps = |mass: f64| -> Result<bool, Error> {
        let heavier = Requirements { mass, ..requirements.clone() };
        let study = heavier.tmd()?;
        let formulas = Formula::all(&heavier, &study.scene.primary);
        Ok(tmd_of(&study, tmd::best(&study, &formulas)?)?.feasible)
    };
    let (mut low, mut high) = (requirements.mass, HEAVIEST * requirements.m1);
    if high <= low || !keeps(high)? {
        return Ok(None);
    }
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        if keeps(middle)? { high = middle } else { low = middle }
    }
    Ok(Some(high))
}

impl Serialize for Candidate {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let largest = |of: &dyn Fn(Measure) -> Need| -> Map<String, Value> {
            let one = |measure: Measure| {
                let Need { value, omega, k1, .. } = of(measure);
                let mut said = json!({ "value": value });
                if !self.is_transient() {
                    said["omega"] = json!(omega);
                }
                if self.study.objective().k1.is_some() {
                    said["k1"] = json!(k1);
                }
                (measure.name().to_owned(), said)
            };
            Measure::ALL.into_iter().map(one).collect()
        };
        let counts = if self.is_transient() { "in_window" } else { "steady" };
        let binding: Vec<Limit> = self.binding.iter().map(|(limit, _)| *limit).collect();
        let mut all = json!({
            "damper": self.what,
            "design": self.damper(),
            "keeps_limits": self.feasible,
            "binding": binding,
            counts: largest(&|measure| self.steady.get(measure)),
        });
        if let Some(from_rest) = &self.from_rest {
            all["from_rest"] = largest(&|measure| from_rest.get(measure)).into();
        }
        all.serialize(serializer)
    }
}

impl Serialize for Comparison {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let by = |(formula, damper): &(Formula, Candidate)| json!({ "name": formula.name, "damper": damper });
        let costs: Map<String, Value> = self
            .costs
            .iter()
            .map(|cost| {
                (
                    cost.constraint.name().to_owned(),
                    json!({ "TMD_without": cost.tmd, "SSVI_NES_without": cost.ssvi }),
                )
            })
            .collect();
        let mut all = json!({
            "goal": self.goal,
            "build": self.choice,
            "certificate": self.certificate.as_ref().map(Certificate::short),
            "SSVI_NES_certificate": self.ssvi_certificate.as_ref().map(Certificate::short),
            "candidates": self.all().collect::<Vec<_>>(),
            "formulas": self.formulas.iter().map(by).collect::<Vec<_>>(),
            "limits": costs,
            "k1_off": self.detuned,
            "lightest_TMD": self.lightest,
            "designs_evaluated": self.tried,
        });
        if let Some(value) = self.other_sign {
            all["SSVI_NES_with_other_sign"] = json!(value);
        }
        all.serialize(serializer)
    }
}
