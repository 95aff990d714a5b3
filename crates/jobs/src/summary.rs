//! The results of a run: one type, from which JSON and text are made.

use crate::describe::{LEFT_OUT, forced};
use retune_model::{Damper, Design, Measure, Parameter, PerMeasure, Positive, Scene, Source, energy_ratios};
use retune_optim::Objective;
use retune_solver::{Method, Response, SceneKind, StructureMaxima, leaves_out_a_fast_part};
use retune_study::{Solver, Span, Study, counted, hertz_and_rpm, is_of_paper, over, rounded};
use serde::Serialize;

/// The observations in the window of a run. SI units; a ratio 0/0 is null.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    #[serde(flatten)]
    made_by: MadeBy,
    #[serde(rename = "E1max")]
    e1_max: f64,
    #[serde(rename = "t_E1max")]
    t_e1_max: f64,
    #[serde(rename = "E2max")]
    e2_max: f64,
    #[serde(rename = "t_E2max")]
    t_e2_max: f64,
    #[serde(rename = "R1")]
    r1: f64,
    #[serde(rename = "R2")]
    r2: f64,
    #[serde(flatten)]
    structure: Structure,
    impacts: Walls<u64>,
    /// Largest |x2 - x1| and |x2 - x1 - D|, m.
    relative_displacement_max: f64,
    spring_deflection_max: f64,
    force_max: Walls<f64>,
    pressure_max: Walls<f64>,
    final_state: FinalState,
    #[serde(skip)]
    largest: PerMeasure<f64>,
    /// The smallest model that was exact.
    scene: SceneKind,
    steps: u64,
    rejected: u64,
    evaluations: u64,
    parameters: Scene,
}

/// Largest sizes of the structure's displacement, velocity and acceleration and of its force on the ground, and when, s.
#[derive(Clone, Copy, Debug, Serialize)]
struct Structure {
    /// |x1|, m.
    x1max: f64,
    #[serde(rename = "t_x1max")]
    t_x1: f64,
    /// |v1|, m/s.
    v1max: f64,
    #[serde(rename = "t_v1max")]
    t_v1: f64,
    /// |a1|, m/s².
    a1max: f64,
    #[serde(rename = "t_a1max")]
    t_a1: f64,
    /// |k1 x1 + c1 v1|, N.
    ground_force_max: f64,
    #[serde(rename = "t_ground_force_max")]
    t_ground_force: f64,
}

impl Structure {
    fn new(largest: &StructureMaxima) -> Self {
        let StructureMaxima { displacement, velocity, acceleration, ground_force } = largest;
        Self {
            x1max: displacement.value,
            t_x1: displacement.time,
            v1max: velocity.value,
            t_v1: velocity.time,
            a1max: acceleration.value,
            t_a1: acceleration.time,
            ground_force_max: ground_force.value,
            t_ground_force: ground_force.time,
        }
    }
}

/// The origin of a result.
#[derive(Clone, Debug, Serialize)]
pub struct MadeBy {
    retune: &'static str,
    study: String,
    omega: f64,
    window: Span,
    solver: Solver,
    /// The objective; for a run, the default.
    #[serde(skip)]
    objective: Objective,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct Walls<T> {
    primary: T,
    obstacle: T,
}

impl<T> Walls<T> {
    fn of([primary, obstacle]: [T; 2]) -> Self {
        Self { primary, obstacle }
    }
}

#[derive(Clone, Copy, Debug, Serialize)]
struct FinalState {
    x1: f64,
    v1: f64,
    x2: f64,
    v2: f64,
}

impl MadeBy {
    /// The origin of the results of `study`.
    pub fn new(study: &Study) -> Self {
        let (window, solver) = (study.window, study.solver);
        let omega = study.scene.forcing.frequency.get();
        let (study, objective) = (study.name().to_owned(), study.objective());
        Self { retune: env!("CARGO_PKG_VERSION"), study, omega, window, solver, objective }
    }

    /// The name of the study.
    pub fn study(&self) -> &str {
        &self.study
    }

    /// The origin of a run of `scene` under `study`.
    fn run(study: &Study, scene: &Scene) -> Self {
        let omega = scene.forcing.frequency.get();
        Self { omega, objective: Objective::default(), ..Self::new(study) }
    }
}

impl std::fmt::Display for MadeBy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { retune, study, omega, window, solver, objective } = self;
        let method = format!("{:?}", solver.method).to_lowercase();
        let (t0, end) = (window.t0.get(), window.end.get());
        let rtol = solver.rtol;
        write!(f, "study {study}, ")?;
        let over = over(objective, *omega);
        if !over.is_empty() {
            write!(f, "{over}, ")?;
        }
        if objective.is_steady() {
            return write!(f, "steady; Retune {retune}");
        }
        write!(f, "t0 = {t0} s, T = {end} s; Retune {retune}, {method}, rtol {rtol:e}")?;
        solver.search_rtol.map_or(Ok(()), |search| write!(f, " (search {search:e})"))
    }
}

impl Summary {
    /// Collects the observations of a run of `scene` with the window and solver of `study`.
    pub fn new(study: &Study, scene: Scene, response: &Response) -> Self {
        let Response { e1_max, e2_max, impacts, final_state, scene: kind, work, .. } = *response;
        let Response { relative_displacement_max, spring_deflection_max, .. } = *response;
        let [r1, r2] = energy_ratios(e1_max.value, e2_max.value);
        let [x1, v1, x2, v2] = final_state;
        Self {
            made_by: MadeBy::run(study, &scene),
            e1_max: e1_max.value,
            t_e1_max: e1_max.time,
            e2_max: e2_max.value,
            t_e2_max: e2_max.time,
            r1,
            r2,
            structure: Structure::new(&response.structure),
            impacts: Walls::of(impacts),
            relative_displacement_max,
            spring_deflection_max,
            force_max: Walls::of(response.force_max),
            pressure_max: Walls::of(response.pressure_max),
            final_state: FinalState { x1, v1, x2, v2 },
            largest: PerMeasure(Measure::ALL.map(|measure| response.largest(measure))),
            scene: kind,
            steps: work.steps,
            rejected: work.rejected,
            evaluations: work.evaluations,
            parameters: scene,
        }
    }

    /// The angular frequency of the run, rad/s.
    pub fn omega(&self) -> f64 {
        self.made_by.omega
    }

    /// Whether the damper strikes a wall in the window.
    pub fn has_impacts(&self) -> bool {
        self.impacts.primary + self.impacts.obstacle > 0
    }

    /// The transmissibility of the motion in the window, see [`retune_model::Forcing::transmissibility`]. None without a force.
    pub fn transmissibility(&self) -> Option<f64> {
        let forcing = self.parameters.forcing;
        let share = forcing.transmissibility(self.structure.x1max, self.structure.ground_force_max);
        share.is_finite().then_some(share)
    }

    /// The largest value of a quantity in the window, in its SI unit.
    pub fn largest(&self, measure: Measure) -> f64 {
        self.largest.get(measure)
    }

    /// Impacts in the window, on the structure and on the obstacle.
    pub fn impacts(&self) -> [u64; 2] {
        [self.impacts.primary, self.impacts.obstacle]
    }

    /// The paper's name for the damper: a TMD never touches.
    pub fn damper_type(&self) -> &'static str {
        match self.scene {
            SceneKind::Contact => "SSVI NES",
            SceneKind::Linear => "TMD",
            SceneKind::Bare => "none",
        }
    }
}

impl std::fmt::Display for Summary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let model = match self.scene {
            SceneKind::Bare => "no damper, one degree of freedom",
            SceneKind::Linear => "the damper touched nothing, linear",
            SceneKind::Contact => "with contacts",
        };
        writeln!(f, "{}", self.made_by)?;
        let omega = self.omega();
        let [hertz, rpm] = hertz_and_rpm(omega).map(|value| rounded(value, 5));
        if self.parameters.forcing.is_transient() {
            writeln!(f, "forcing     {}", forced(&self.parameters.forcing))?;
        } else {
            writeln!(f, "frequency   {} rad/s = {hertz} Hz = {rpm} rpm", rounded(omega, 5))?;
        }
        writeln!(f, "E1max       {:<12} J at t = {:.4} s", digits(self.e1_max), self.t_e1_max)?;
        writeln!(f, "E2max       {:<12} J at t = {:.4} s", digits(self.e2_max), self.t_e2_max)?;
        if self.r1.is_nan() {
            writeln!(f, "R1, R2      none: nothing has energy in the window")?;
        } else {
            writeln!(f, "R1, R2      {:.5}, {:.5}", self.r1, self.r2)?;
        }
        let Walls { primary, obstacle } = self.impacts;
        writeln!(f, "impacts     {primary} on the primary structure, {obstacle} on the obstacle")?;
        let Walls { primary, obstacle } = self.force_max;
        if primary.max(obstacle).is_infinite() {
            writeln!(f, "force max   without bound: an impact with a rigid wall is an impulse")?;
        } else {
            writeln!(
                f,
                "force max   {primary:.3} N on the primary structure, {obstacle:.3} N on the obstacle"
            )?;
        }
        let (stroke, relative) = (self.spring_deflection_max, self.relative_displacement_max);
        let [stroke, relative] = [stroke, relative]
            .map(|value| if is_small(value) { digits(value) } else { format!("{value:.6}") });
        writeln!(f, "stroke      {stroke} m, the largest spring deflection |x2 - x1 - D|")?;
        writeln!(f, "rel. displ. {relative} m, the largest relative displacement |x2 - x1|")?;
        let Structure { x1max, t_x1, v1max, t_v1, a1max, t_a1, ground_force_max, t_ground_force } =
            self.structure;
        writeln!(f, "x1max       {:<12} m at t = {t_x1:.4} s", digits(x1max))?;
        writeln!(f, "v1max       {:<12} m/s at t = {t_v1:.4} s", digits(v1max))?;
        writeln!(f, "a1max       {:<12} m/s² at t = {t_a1:.4} s", digits(a1max))?;
        writeln!(
            f,
            "ground      {ground_force_max:<12.3} N at t = {t_ground_force:.4} s, the largest force on the ground"
        )?;
        if let Some(share) = self.transmissibility() {
            let by = match self.parameters.forcing.source {
                Source::Imbalance(_) => "that force / (imbalance omega²)",
                Source::Base(_) => "x1max / base",
                Source::BaseAcceleration(_) => "x1max omega² / base_acceleration",
                Source::Force(_) | Source::Decay(_) | Source::History(_) => "that force / P",
            };
            writeln!(f, "transmiss.  {share:<12.5} the transmissibility: {by}")?;
        }
        write!(f, "model       {model}")?;
        let MadeBy { window, solver, .. } = &self.made_by;
        if solver.method == Method::Hybrid && leaves_out_a_fast_part(&self.parameters, window.end.get()) {
            write!(f, "; longer steps once {LEFT_OUT}")?;
        }
        writeln!(f)?;
        let (steps, evaluations) = (counted(self.steps, "step"), counted(self.evaluations, "evaluation"));
        write!(f, "work        {steps}, {} rejected, {evaluations}", self.rejected)
    }
}

/// Whether a value that is not zero would lose digits with a fixed number of decimals, as those of a light rig.
fn is_small(value: f64) -> bool {
    value != 0.0 && value.abs() < 1e-3
}

/// A value to seven decimals, or, where it is small, to as many digits.
fn digits(value: f64) -> String {
    if is_small(value) { format!("{value:.7e}") } else { format!("{value:.7}") }
}

/// The damper of a study's scene: the paper's where it has the numbers of an optimum that the paper publishes.
pub fn baseline(scene: &Scene) -> &'static str {
    if scene.damper.as_ref().is_some_and(is_of_paper) {
        "the paper's damper"
    } else {
        "the damper of the study"
    }
}

/// A ratio above 1 in three digits, or in words where nobody would read its digits.
pub fn how_many(times: f64) -> String {
    if times >= 1e6 { "over a million".to_owned() } else { rounded(times, 3) }
}

/// A damper as in the paper's Table 2: m2 (kg) and its design.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TunedDamper {
    /// m2, mass, kg.
    #[serde(rename = "m2")]
    pub mass: Positive,
    /// k2, c2, D, C, and what else is varied of it.
    #[serde(flatten)]
    pub design: Design,
}

impl TunedDamper {
    /// From a damper of a scene, with what is varied of it.
    pub fn of(damper: &Damper, varied: &[Parameter]) -> Self {
        let others: Vec<Parameter> =
            varied.iter().copied().filter(|parameter| *parameter != Parameter::M2).collect();
        Self { mass: damper.mass, design: Design::of_varied(damper, &others) }
    }

    /// The design, with the mass where that is varied.
    pub fn design_of(&self, varied: &[Parameter]) -> Design {
        let mass = |parameter| parameter == Parameter::M2 && varied.contains(&parameter);
        let value = |parameter| if mass(parameter) { self.mass.get() } else { self.design.get(parameter) };
        Design::new(value).unwrap_or(self.design)
    }

    /// The numbers in words, each to its digits: `m2 = 60 kg, k2 = 215 N/m, …`.
    pub fn words(&self, digits: impl Fn(Parameter) -> usize) -> String {
        let mass = [(Parameter::M2, self.mass.get())];
        let design = Parameter::VARIED.map(|parameter| (parameter, self.design.get(parameter)));
        let known = mass.into_iter().chain(design).filter(|(_, value)| !value.is_nan());
        let said: Vec<String> = known
            .map(|(parameter, value)| {
                format!("{parameter} = {} {}", rounded(value, digits(parameter)), parameter.unit())
            })
            .collect();
        said.join(", ") + if self.design.get(Parameter::D).is_nan() { ", no walls" } else { "" }
    }

    /// m2, k2, c2, D and C, in SI units; NaN for the gaps of a damper without walls.
    pub fn values(&self) -> [f64; 5] {
        let [k2, c2, d, c] = self.design.values();
        [self.mass.get(), k2, c2, d, c]
    }
}
