//! The comparison: no damper, the best TMD, an SSVI NES, the cost of each limit, and the certificate of the recommended one.

use super::candidate::{Candidate, OtherSign, What, with_design};
use super::requirements::{Constraint, Dampers, Requirements};
use super::trust::{certified, doubt, first_feasible, is_sensitive, striking, trusted, worst_nearby};
use super::words::{parameters, question, sized};
use super::{Formula, ssvi, tmd};
use crate::certify::{Certificate, between_other_walls};
use crate::contacts::Contacts;
use crate::{Error, Observer};
use retune_model::{Measure, Parameter, Scene};
use retune_optim::{Limit, Limits, Need};
use retune_store::Journal;
use retune_study::Study;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

/// Goals that differ by less than this share count as equal; then the damper without walls is recommended.
const SAME: f64 = 0.05;
/// Limits restrict the stroke if it is below this share of the stroke of the best TMD without limits.
const SMALL: f64 = 0.5;
/// Bisection steps for the lightest mass that keeps the limits, in closed form and by runs in time; and the largest mass tried, as a share
/// of the structure's.
const HALVINGS: [usize; 2] = [12, 5];
const HEAVIEST: f64 = 0.3;

/// The candidates and the conclusions.
#[derive(Debug)]
pub struct Comparison {
    /// The quantity to minimise.
    pub goal: Measure,
    /// The structure alone.
    pub none: Candidate,
    /// The formulas for the goal, each with its TMD.
    pub formulas: Vec<(Formula, Candidate)>,
    /// The best TMD.
    pub tmd: Candidate,
    /// The best SSVI NES found that strikes its walls.
    pub ssvi: Option<Candidate>,
    /// Number of SSVI NES designs evaluated; none if only a TMD was wanted.
    pub tried: Option<usize>,
    /// The recommended damper; none where none keeps the limits.
    pub choice: Option<What>,
    /// The SSVI NES under the shock or record with the opposite sign, which matters since its walls are not symmetric.
    pub other_sign: Option<OtherSign>,
    /// Warnings where the contact law of its walls is used outside its range of validity.
    pub warnings: Vec<String>,
    /// Whether the structure is one of several modes, so that its force on the ground is not the total one.
    pub of_mode: bool,
    /// The cost of each limit.
    pub costs: Vec<Cost>,
    /// The goal of each candidate, in the order of [`Self::all`], with k1 as given, minus and plus its error.
    pub detuned: Vec<[f64; 3]>,
    /// Mass of the lightest TMD that would keep the limits, kg, if that of the given mass does not.
    pub lightest: Option<f64>,
    /// The certificate of the recommended damper.
    pub certificate: Option<Certificate>,
    /// The certificate of the SSVI NES, where its goal is better than the TMD's.
    pub ssvi_certificate: Option<Certificate>,
}

/// The cost of a limit.
#[derive(Debug)]
pub struct Cost {
    /// The limit.
    pub constraint: Constraint,
    /// The best TMD without it.
    pub tmd: Candidate,
    /// The best SSVI NES without it, if an SSVI NES is recommended on which the limit is active.
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

    /// Fails with [`Error::Infeasible`] if no damper keeps the limits.
    pub fn check_limits(&self) -> Result<(), Error> {
        match self.choice {
            Some(_) => Ok(()),
            None => Err(Error::Infeasible {
                name: "design".to_owned(),
                words: "none was found that keeps them".to_owned(),
            }),
        }
    }

    /// The quantities that are reported; the force on the ground is left out for one of several modes.
    pub fn measures(&self) -> impl Iterator<Item = Measure> + use<> {
        let of_mode = self.of_mode;
        Measure::ALL.into_iter().filter(move |measure| !of_mode || *measure != Measure::GroundForce)
    }

    /// The recommended damper.
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

/// The best TMD for some requirements.
fn best_tmd(requirements: &Requirements) -> Result<Candidate, Error> {
    let study = requirements.tmd()?;
    let formulas = Formula::all(requirements, &study.scene.primary);
    tmd_of(&study, tmd::best(&study, &formulas)?)
}

fn by_formula(
    requirements: &Requirements,
    study: &Study,
    formula: Formula,
) -> Result<(Formula, Candidate), Error> {
    let mut tmd = tmd_of(study, [formula.k2, formula.c2])?;
    tmd.feasible &= requirements.k2_max.is_none_or(|most| formula.k2 <= most);
    Ok((formula, tmd))
}

/// Makes the whole comparison and reports partial results at once.
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
    let mut none = Candidate::new(What::None, &bare)?;
    let formulas = Formula::all(requirements, &tmd_study.scene.primary);
    let mut tmd = tmd_of(tmd_study, tmd::best(tmd_study, &formulas)?)?;
    let formulas = formulas
        .into_iter()
        .map(|formula| by_formula(requirements, tmd_study, formula))
        .collect::<Result<_, _>>()?;
    let kept = if tmd.feasible { "" } else { " (breaks a limit)" };
    let (name, has) = (goal.name(), sized(tmd.goal, goal.unit()));
    let exact = if tmd.is_transient() { "" } else { ", exact" };
    watch.result(&format!("\nTMD{exact}: {name} {has}{kept}, {}", parameters(&tmd)))?;
    let (mut ssvi, mut tried, mut judged) = (None, None, None);
    if requirements.dampers != Dampers::Tmd {
        watch.result("SSVI NES: seconds to minutes (after Ctrl-C the lines already printed still hold)")?;
        let strokes = strokes(requirements, &tmd)?;
        let found = ssvi::best(ssvi_study, (&tmd, &strokes), &[], (journal, "ssvi"), watch)?;
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
        ssvi::report_compared(&found, ssvi.as_ref().zip(least), watch)?;
    }
    let other_sign = ssvi.as_ref().and_then(Candidate::with_other_sign);
    let much_better = |certificate: &Certificate| (1.0 + SAME) * worst_nearby(certificate) < tmd.goal;
    let is_trusted = judged.as_ref().is_some_and(|found| {
        let weighed = requirements.run().is_some() || is_sensitive(found);
        doubt(found) <= 1 || weighed && much_better(found)
    }) && !(requirements.driving.has_either_sign()
        && other_sign.as_ref().is_some_and(|other| other.goal > tmd.goal || !other.broken.is_empty()));
    let choice = choice(requirements, &tmd, ssvi.as_ref(), is_trusted);
    let built = ssvi.as_ref().filter(|_| choice == Some(What::Ssvi));
    let costs = costs(requirements, (&tmd, built), journal, watch)?;
    let all = [Some(&mut none), Some(&mut tmd), ssvi.as_mut()];
    let detuned = match requirements.k1_error {
        Some(error) => all.into_iter().flatten().map(|of| of.with_k1_off([0.0, -error, error])).collect(),
        None => Vec::new(),
    };
    let lightest = if tmd.feasible { None } else { lightest(requirements, watch)? };
    let certificate = match choice {
        Some(What::Ssvi) => {
            ssvi.as_ref().zip(judged.clone()).map(|(ssvi, judged)| between_other_walls(&ssvi.study, judged))
        }
        Some(_) => Some(certified(&tmd.study)?),
        None => None,
    };
    let whole =
        |of: Candidate| if Some(of.what) == choice || of.is_transient() { of.with_start() } else { Ok(of) };
    let ssvi = ssvi.map(whole).transpose()?;
    let hardest =
        |of: &Candidate| Contacts::hardest(&of.study, &of.study.scene, of.most().get(Measure::ContactForce));
    let warnings = ssvi.as_ref().and_then(hardest).map_or(Vec::new(), |contacts| contacts.warnings());
    Ok(Comparison {
        goal,
        none: whole(none)?,
        formulas,
        tmd: whole(tmd)?,
        ssvi,
        warnings,
        of_mode: requirements.of_mode,
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

/// The strokes by which the gaps of known designs are scaled: that of the best TMD and, where limits restrict it, that of the best TMD
/// without limits.
fn strokes(requirements: &Requirements, tmd: &Candidate) -> Result<Vec<f64>, Error> {
    let limited = tmd.value(Measure::Stroke);
    if requirements.constraints().is_empty() {
        return Ok(vec![limited]);
    }
    let free = Requirements { limits: Limits::default(), k2_max: None, ..requirements.clone() };
    let unlimited = best_tmd(&free)?.value(Measure::Stroke);
    Ok(if limited < SMALL * unlimited { vec![limited, unlimited] } else { vec![limited] })
}

/// The recommendation. A damper without walls is simpler to build and easier to trust; one with walls must be clearly better and tolerate
/// small errors.
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

/// The cost of each limit for the best TMD, and for the SSVI NES if recommended: its search without the limit starts from the design with
/// it.
fn costs(
    requirements: &Requirements,
    (tmd, built): (&Candidate, Option<&Candidate>),
    journal: &Journal,
    watch: &dyn Observer,
) -> Result<Vec<Cost>, Error> {
    let cost = |constraint: Constraint| {
        let free = requirements.without(constraint);
        let free_tmd = best_tmd(&free)?;
        let binds = |ssvi: &&Candidate| match constraint {
            Constraint::Of(limit) => ssvi.binding.iter().any(|(other, _)| *other == limit),
            Constraint::K2 => ssvi.k2() > 0.99 * requirements.allowed(constraint),
        };
        let free_ssvi = if let Some(ssvi) = built.filter(binds) {
            let study = free.ssvi()?;
            let own = |parameter: Parameter| ssvi.damper().map_or(f64::NAN, |damper| parameter.get(&damper));
            let start = Parameter::PAPER.map(own);
            let stage = format!("ssvi without {}", constraint.name());
            let found = ssvi::best(&study, (tmd, &[]), &[start.to_vec()], (journal, &stage), watch)?;
            first_feasible(&mut striking(&study, &found))?.map(|(_, candidate)| candidate)
        } else {
            None
        };
        Ok(Cost { constraint, tmd: free_tmd, ssvi: free_ssvi })
    };
    requirements.constraints().into_iter().map(cost).collect()
}

/// Mass of the lightest TMD that keeps the limits, kg; none up to [`HEAVIEST`].
fn lightest(requirements: &Requirements, watch: &dyn Observer) -> Result<Option<f64>, Error> {
    let halvings = HALVINGS[usize::from(requirements.run().is_some())];
    let bar = watch.progress("lightest TMD that keeps the limits", 1 + halvings as u64);
    let keeps = |mass: f64| -> Result<bool, Error> {
        let keeps = best_tmd(&Requirements { mass, ..requirements.clone() })?.feasible;
        bar.inc(1);
        Ok(keeps)
    };
    let (mut low, mut high) = (requirements.mass, HEAVIEST * requirements.m1);
    if high <= low || !keeps(high)? {
        bar.finish();
        return Ok(None);
    }
    for _ in 0..halvings {
        let middle = (low * high).sqrt();
        if keeps(middle)? { high = middle } else { low = middle }
    }
    bar.finish();
    Ok(Some(high))
}

/// A candidate as data, with its largest values of `measures`.
fn data(of: &Candidate, measures: &[Measure]) -> Value {
    let largest = |need: &dyn Fn(Measure) -> Need| -> Map<String, Value> {
        let one = |measure: &Measure| {
            let Need { value, omega, k1, .. } = need(*measure);
            let mut entry = json!({ "value": value });
            if !of.is_transient() {
                entry["omega"] = json!(omega);
            }
            if of.study.objective().k1.is_some() {
                entry["k1"] = json!(k1);
            }
            (measure.name().to_owned(), entry)
        };
        measures.iter().map(one).collect()
    };
    let counts = if of.is_transient() { "in_window" } else { "steady" };
    let binding: Vec<Limit> = of.binding.iter().map(|(limit, _)| *limit).collect();
    let mut all = json!({
        "damper": of.what,
        "design": of.damper(),
        "keeps_limits": of.feasible,
        "binding": binding,
        counts: largest(&|measure| of.steady.get(measure)),
    });
    if let Some(from_rest) = &of.from_rest {
        all["from_rest"] = largest(&|measure| from_rest.get(measure)).into();
    }
    all
}

impl Serialize for Comparison {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let measures: Vec<Measure> = self.measures().collect();
        let data = |of: &Candidate| data(of, &measures);
        let by_formula = |(formula, damper): &(Formula, Candidate)| json!({ "name": formula.name, "damper": data(damper) });
        let costs: Map<String, Value> = self
            .costs
            .iter()
            .map(|cost| {
                (
                    cost.constraint.name().to_owned(),
                    json!({ "TMD_without": data(&cost.tmd), "SSVI_NES_without": cost.ssvi.as_ref().map(data) }),
                )
            })
            .collect();
        let mut all = json!({
            "goal": self.goal,
            "build": self.choice.filter(|_| !self.is_in_vain()),
            "in_vain": self.is_in_vain(),
            "certificate": self.certificate.as_ref().filter(|_| !self.is_in_vain()).map(Certificate::short),
            "SSVI_NES_certificate": self.ssvi_certificate.as_ref().map(Certificate::short),
            "candidates": self.all().map(data).collect::<Vec<_>>(),
            "formulas": self.formulas.iter().map(by_formula).collect::<Vec<_>>(),
            "limits": costs,
            "k1_off": self.detuned,
            "lightest_TMD": self.lightest,
            "designs_evaluated": self.tried,
        });
        if let Some(OtherSign { goal, broken }) = &self.other_sign {
            all["SSVI_NES_with_other_sign"] = json!(goal);
            all["SSVI_NES_breaks_with_other_sign"] =
                broken.iter().map(|(limit, value)| (limit.name().to_owned(), json!(value))).collect();
        }
        all.serialize(serializer)
    }
}
