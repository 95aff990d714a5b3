//! The results of a run: one type for both JSON and text.

use crate::describe::{LEFT_OUT, forced};
use retune_model::{Damper, Design, Measure, Parameter, Positive, Scene, Source, energy_ratios};
use retune_optim::Objective;
use retune_solver::{Extreme, Method, Response, SceneKind, StructureMaxima, leaves_out_a_fast_part};
use retune_study::{Solver, Span, Study, counted, hertz_and_rpm, is_of_paper, over, rounded};
use serde::{Serialize, Serializer};

/// The observations in the window of a run. SI units; a ratio 0/0 is null.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    #[serde(flatten)]
    made_by: MadeBy,
    /// Largest energies, J.
    #[serde(flatten, serialize_with = "by_name")]
    energies: [(&'static str, Extreme); 2],
    #[serde(rename = "R1")]
    r1: f64,
    #[serde(rename = "R2")]
    r2: f64,
    /// Largest magnitudes of the structure's displacement, velocity and acceleration, and of its force on the ground.
    #[serde(flatten, serialize_with = "by_name")]
    structure: [(&'static str, Extreme); 4],
    impacts: Walls<u64>,
    /// Largest |x2 - x1| and |x2 - x1 - D|, m.
    relative_displacement_max: f64,
    spring_deflection_max: f64,
    force_max: Walls<f64>,
    pressure_max: Walls<f64>,
    final_state: FinalState,
    #[serde(skip)]
    response: Response,
    /// The smallest model that was exact.
    scene: SceneKind,
    steps: u64,
    rejected: u64,
    evaluations: u64,
    parameters: Scene,
}

/// Serialises each value by its name, and the time at which it is reached, s.
fn by_name<S: Serializer>(all: &[(&'static str, Extreme)], serializer: S) -> Result<S::Ok, S::Error> {
    let both =
        |(name, at): &(&str, Extreme)| [((*name).to_owned(), at.value), (format!("t_{name}"), at.time)];
    serializer.collect_map(all.iter().flat_map(both))
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
        write!(f, "t0 = {t0} s, T = {end} s; Retune {retune}, {method}")?;
        // Steps of a fixed length have no tolerance.
        if matches!(solver.method, Method::Rk4 | Method::Euler) {
            return Ok(());
        }
        write!(f, ", rtol {rtol:e}")?;
        solver.search_rtol.map_or(Ok(()), |search| write!(f, " (search {search:e})"))
    }
}

impl Summary {
    /// Collects the observations of a run of `scene` with the window and solver of `study`.
    pub fn new(study: &Study, scene: Scene, response: &Response) -> Self {
        let Response { e1_max, e2_max, impacts, final_state, scene: kind, work, .. } = *response;
        let StructureMaxima { displacement, velocity, acceleration, ground_force } = response.structure;
        let [r1, r2] = energy_ratios(e1_max.value, e2_max.value);
        let [x1, v1, x2, v2] = final_state;
        Self {
            made_by: MadeBy::run(study, &scene),
            energies: [("E1max", e1_max), ("E2max", e2_max)],
            r1,
            r2,
            structure: [
                ("x1max", displacement),
                ("v1max", velocity),
                ("a1max", acceleration),
                ("ground_force_max", ground_force),
            ],
            impacts: Walls::of(impacts),
            relative_displacement_max: response.relative_displacement_max,
            spring_deflection_max: response.spring_deflection_max,
            force_max: Walls::of(response.force_max),
            pressure_max: Walls::of(response.pressure_max),
            final_state: FinalState { x1, v1, x2, v2 },
            response: *response,
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
        let StructureMaxima { displacement, ground_force, .. } = self.response.structure;
        let share = forcing.transmissibility(displacement.value, ground_force.value);
        share.is_finite().then_some(share)
    }

    /// The largest value of a quantity in the window, in its SI unit.
    pub fn largest(&self, measure: Measure) -> f64 {
        self.response.largest(measure)
    }

    /// Impacts in the window, on the structure and on the obstacle.
    pub fn impacts(&self) -> [u64; 2] {
        [self.impacts.primary, self.impacts.obstacle]
    }

    /// The paper's name for the damper: a TMD touches no wall.
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
        for (name, Extreme { value, time }) in self.energies {
            writeln!(f, "{name:<12}{:<12} J at t = {time:.4} s", digits(value))?;
        }
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
                "force max   {} N on the primary structure, {} N on the obstacle",
                newtons(primary),
                newtons(obstacle)
            )?;
        }
        let (stroke, relative) = (self.spring_deflection_max, self.relative_displacement_max);
        let [stroke, relative] = [stroke, relative]
            .map(|value| if is_small(value) { digits(value) } else { format!("{value:.6}") });
        writeln!(f, "stroke      {stroke} m, the largest spring deflection |x2 - x1 - D|")?;
        writeln!(f, "rel. displ. {relative} m, the largest relative displacement |x2 - x1|")?;
        for ((name, Extreme { value, time }), unit) in self.structure.iter().zip(["m", "m/s", "m/s²"]) {
            writeln!(f, "{name:<12}{:<12} {unit} at t = {time:.4} s", digits(*value))?;
        }
        let Extreme { value, time } = self.response.structure.ground_force;
        let value = newtons(value);
        writeln!(f, "ground      {value:<12} N at t = {time:.4} s, the largest force on the ground")?;
        if let (Some(share), Source::Harmonic(of, _)) =
            (self.transmissibility(), self.parameters.forcing.source)
        {
            let by = of.transmissibility();
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

/// Whether a value is so small, as in a light test rig, that a fixed number of decimals would lose digits.
fn is_small(value: f64) -> bool {
    value != 0.0 && value.abs() < 1e-3
}

/// A force to three decimals, or to four significant digits if it is small.
fn newtons(value: f64) -> String {
    if value != 0.0 && value.abs() < 0.1 { rounded(value, 4) } else { format!("{value:.3}") }
}

/// A value to seven decimals, or with an exponent if it is small.
pub(crate) fn digits(value: f64) -> String {
    if is_small(value) { format!("{value:.7e}") } else { format!("{value:.7}") }
}

/// The damper of a study's scene in words: the paper's if it has the numbers of an optimum published there.
pub fn baseline(scene: &Scene) -> &'static str {
    if scene.damper.as_ref().is_some_and(is_of_paper) {
        "the paper's damper"
    } else {
        "the damper of the study"
    }
}

/// A ratio above 1 to three digits, or in words if it is huge.
pub fn how_many(times: f64) -> String {
    if times >= 1e6 { "over a million".to_owned() } else { rounded(times, 3) }
}

/// A ratio in words, to three digits.
pub fn as_much(ratio: f64) -> String {
    match how_many(ratio).as_str() {
        "1" => "as much".to_owned(),
        times => format!("{times} times as much"),
    }
}

/// A damper as in the paper's Table 2: m2 (kg) and its design.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TunedDamper {
    /// m2, mass, kg.
    #[serde(rename = "m2")]
    pub mass: Positive,
    /// k2, c2, D, C, and its other varied parameters.
    #[serde(flatten)]
    pub design: Design,
}

/// Whether a gap is practically zero: a search towards zero stops just above it, at 1e-16 m.
pub(crate) fn is_no_gap(parameter: Parameter, value: f64) -> bool {
    /// The smallest gap that can be built, m.
    const BUILT: f64 = 1e-9;
    [Parameter::D, Parameter::C].contains(&parameter) && value < BUILT
}

impl TunedDamper {
    /// From the damper of a scene, with its varied parameters.
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

    /// The parameters in words, each to the given digits: `m2 = 60 kg, k2 = 215 N/m, …`.
    pub fn words(&self, digits: impl Fn(Parameter) -> usize) -> String {
        let mass = [(Parameter::M2, self.mass.get())];
        let design = Parameter::VARIED.map(|parameter| (parameter, self.design.get(parameter)));
        let known = mass.into_iter().chain(design).filter(|(_, value)| !value.is_nan());
        let texts: Vec<String> = known
            .map(|(parameter, value)| {
                let value = if is_no_gap(parameter, value) { 0.0 } else { value };
                format!("{parameter} = {} {}", rounded(value, digits(parameter)), parameter.unit())
            })
            .collect();
        texts.join(", ") + if self.design.get(Parameter::D).is_nan() { ", no walls" } else { "" }
    }
}
