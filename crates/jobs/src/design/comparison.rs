//! The comparison: no damper, the best TMD, an SSVI NES, what each limit costs, and how sure the recommended one is.

use super::candidate::{Candidate, OtherSign, What, with_design};
use super::requirements::{Constraint, Dampers, Requirements};
use super::trust::{certified, doubt, first_feasible, is_sensitive, striking, trusted, worst_nearby};
use super::words::{parameters, question, sized};
use super::{Formula, ssvi, tmd};
use crate::certify::Certificate;
use crate::contacts::Contacts;
use crate::{Error, Observer};
use retune_model::{Measure, Parameter, Scene};
use retune_optim::{Limit, Limits, Need};
use retune_store::Journal;
use retune_study::Study;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

/// A goal that is larger by less than this share is as good: the damper without walls is recommended.
const SAME: f64 = 0.05;
/// A stroke that is this share of the best TMD's without limits is kept small by them.
const SMALL: f64 = 0.5;
/// Halvings of the mass that would keep the limits, as a share of the structure's, in closed form and in time; and the largest that is looked at.
const HALVINGS: [usize; 2] = [12, 5];
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
    pub other_sign: Option<OtherSign>,
    /// Where the law of its walls is used outside of what it holds for.
    pub warnings: Vec<String>,
    /// Whether the structure is one mode of many, whose force on the ground is not that of the whole.
    pub of_mode: bool,
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

    /// The quantities of which largest values are told: of one mode of many the force on the ground is not.
    pub fn measures(&self) -> impl Iterator<Item = Measure> + use<> {
        let of_mode = self.of_mode;
        Measure::ALL.into_iter().filter(move |measure| !of_mode || *measure != Measure::GroundForce)
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

/// The best TMD for some requirements.
fn best_tmd(requirements: &Requirements) -> Result<Candidate, Error> {
    let study = requirements.tmd()?;
    let formulas = Formula::all(requirements, &study.scene.primary);
    tmd_of(&study, tmd::best(&study, &formulas)?)
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
    let mut none = Candidate::new(What::None, &bare)?;
    let formulas = Formula::all(requirements, &tmd_study.scene.primary);
    let mut tmd = tmd_of(tmd_study, tmd::best(tmd_study, &formulas)?)?;
    let formulas =
        formulas.into_iter().map(|formula| by(requirements, tmd_study, formula)).collect::<Result<_, _>>()?;
    let kept = if tmd.feasible { "" } else { " (breaks a limit)" };
    let (name, has) = (goal.name(), sized(tmd.goal, goal.unit()));
    let exact = if tmd.is_transient() { "" } else { ", exact" };
    watch.result(&format!("\nTMD{exact}: {name} {has}{kept}, {}", parameters(&tmd)))?;
    let (mut ssvi, mut tried, mut judged) = (None, None, None);
    if requirements.dampers != Dampers::Tmd {
        watch.result("SSVI NES, from known designs: some seconds (Ctrl-C leaves what stands above)")?;
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
        ssvi::tell_compared(&found, ssvi.as_ref().zip(least), watch)?;
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
        Some(What::Ssvi) => judged.clone(),
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

/// The strokes by which the gaps of known designs are scaled: that of the best TMD, and, where limits keep it small, that of the best without them.
fn strokes(requirements: &Requirements, tmd: &Candidate) -> Result<Vec<f64>, Error> {
    let own = tmd.value(Measure::Stroke);
    if requirements.constraints().is_empty() {
        return Ok(vec![own]);
    }
    let free = Requirements { limits: Limits::default(), k2_max: None, ..requirements.clone() };
    let other = best_tmd(&free)?.value(Measure::Stroke);
    Ok(if own < SMALL * other { vec![own, other] } else { vec![own] })
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

/// A candidate as data, with its largest value of these quantities.
fn data(of: &Candidate, measures: &[Measure]) -> Value {
    let largest = |need: &dyn Fn(Measure) -> Need| -> Map<String, Value> {
        let one = |measure: &Measure| {
            let Need { value, omega, k1, .. } = need(*measure);
            let mut said = json!({ "value": value });
            if !of.is_transient() {
                said["omega"] = json!(omega);
            }
            if of.study.objective().k1.is_some() {
                said["k1"] = json!(k1);
            }
            (measure.name().to_owned(), said)
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
        let by = |(formula, damper): &(Formula, Candidate)| json!({ "name": formula.name, "damper": data(damper) });
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
            "formulas": self.formulas.iter().map(by).collect::<Vec<_>>(),
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
