//! Figure 7: three irregular motions and their regimes.

use super::item::Item;
use super::measures::{ends, recorded, rounded};
use super::plan::{Plan, stiffness};
use crate::Error;
use crate::rows::of_each;
use retune_dynamics::regime::{
    ARRIVED, FALLING, FLOOR, LAMINAR, LAMINAR_PERIOD, LAMINAR_PHASE, LONGEST, MARGIN, MOSTLY, NEARING,
    PARTED, SAME,
};
use retune_dynamics::{Kind, Parameter, Regime, Stretch, Zone, classify, follow};
use retune_model::Scene;
use retune_report::colour::{BLACK, BLUE, GREEN};
use retune_report::document::Verdict;
use retune_report::table::{Cell, Table};
use retune_report::{Axis, Chart, Dash, Key, Layer, Sheet, Stroke, cells};
use retune_solver::{Response, Sample, Window, simulate};
use retune_study::joined;

struct Case {
    letter: &'static str,
    k1: f64,
    omega: f64,
    paper: &'static str,
    zone: Zone,
}

const CASES: [Case; 3] = [
    Case::new("a", 3.95e4, 6.65, "Intermittency with unilateral impacts", Zone::PrimaryOnly),
    Case::new("b", 3.00e4, 6.10, "Transient chaos with unilateral impacts", Zone::PrimaryOnly),
    Case::new("c", 5.00e4, 7.10, "Chaotic motion with bilateral impacts", Zone::Bilateral),
];

/// Distances from the frequency of a case at which the classification is repeated, rad/s.
const NEAR: [f64; 4] = [-0.02, -0.01, 0.01, 0.02];
/// Seconds between the points that are drawn.
const INTERVAL: f64 = 0.0025;
/// Time, s, for which the motions are shown beyond the end of the paper's studies, since bursts are rare.
const MORE: f64 = 100.0;

impl Case {
    const fn new(letter: &'static str, k1: f64, omega: f64, paper: &'static str, zone: Zone) -> Self {
        Self { letter, k1, omega, paper, zone }
    }

    /// Whether a regime agrees with the paper's name for it.
    fn agrees(&self, regime: &Regime) -> bool {
        match self.letter {
            "a" => regime.kind == Kind::Intermittent,
            "b" => regime.transient.is_some(),
            _ => regime.kind == Kind::Chaotic,
        }
    }

    /// Frequency and stiffness in words.
    fn place(&self) -> String {
        format!("ω = {:.2} rad/s, k1 = {} N/m", self.omega, stiffness(self.k1))
    }
}

pub fn figure7(plan: &Plan) -> Result<Item, Error> {
    let mut item = Item::new(plan.made_by("Shown from t0 to T + 100 s of a run from rest; judged over 2000 periods, of which the last 1000 count as settled."));
    let mut table = Table::headed(
        "case | R, m | ω, rad/s | motion | largest exponent, 1/s | laminar share | bursts | confidence",
    );
    let radius_of_plan = plan.radius();
    let bar =
        plan.watch.progress("figure 7", (CASES.len() * (plan.other_radii().count() + NEAR.len())) as u64);
    for case in &CASES {
        let scene = Parameter::Omega.at(plan.scenes(case.k1)?[1], case.omega)?;
        draw(plan, case, &scene, &mut item)?;
        let mut variants = vec![(radius_of_plan, case.omega)];
        if !plan.is_brief {
            variants.extend(NEAR.map(|shift| (radius_of_plan, case.omega + shift)));
            variants.extend(plan.other_radii().map(|radius| (radius, case.omega)));
        }
        let judged = of_each(&variants, &*bar, |&(radius, omega)| {
            let values = [(Parameter::K1, case.k1), (Parameter::Omega, omega), (Parameter::R, radius)];
            let stretch = Stretch { settle: 1000, observe: 1000 };
            Ok(classify(&follow(&plan.ssvi_with(&values)?, None, stretch, &plan.settings())?))
        })?;
        for (&(radius, omega), regime) in variants.iter().zip(&judged) {
            table.push(cells![
                case.letter,
                radius,
                format!("{omega:.2}"),
                regime.label(),
                format!("{:.3} ± {:.3}", regime.exponent.value, regime.exponent.error),
                format!("{:.2}", regime.laminar),
                regime.bursts,
                format!("{:.2}", regime.confidence),
            ]);
        }
        let others = variants.iter().zip(&judged).skip(1).filter(|(_, regime)| case.agrees(regime));
        let others: Vec<String> =
            others.map(|((radius, omega), _)| format!("R = {radius} m, ω = {omega:.2}")).collect();
        let run = simulate(&scene, plan.window(), &plan.settings())?;
        state(case, &run, &others, &judged[0], plan.window(), &mut item);
        item.notes.extend(creeping(case, &judged[0]));
    }
    bar.finish();
    item.table("Our judgement of each case, and how it depends on what the paper leaves out", table);
    item.table(
        "How motions are named: from states at the crests of the force, impact counts and the largest Lyapunov exponent",
        definitions(),
    );
    Ok(item)
}

/// A note on the rate of a slow approach to a periodic orbit, which can look like transient chaos.
fn creeping(case: &Case, regime: &Regime) -> Option<String> {
    let slow = regime.kind == Kind::Periodic && regime.transient.is_none() && regime.exponent.value < 0.0;
    let (letter, name, rate) = (case.letter, regime.label(), regime.exponent.value);
    let time = -1.0 / rate;
    slow.then(|| format!("Case ({letter}): the motion from rest creeps towards {name}, and its exponent is the rate of that: with {rate:.3} /s it takes {time:.0} s to come e times nearer, so in a run of 100 s it need not look periodic; but neighbours do not part at any time, which transient chaos would need."))
}

fn state(case: &Case, run: &Response, others: &[String], regime: &Regime, window: Window, item: &mut Item) {
    let none = "none of the other settings tried".to_owned();
    let others = if others.is_empty() { none } else { joined(others, "; ") };
    let (name, exponent, error) = (regime.label(), regime.exponent.value, regime.exponent.error);
    let (laminar, confidence) = (100.0 * regime.laminar, regime.confidence);
    let ([ps, obstacle], Window { from, to }) = (run.impacts, window);
    item.statement(
        &format!("({}) {} at {}", case.letter, case.paper, case.place()),
        "Holds if the motion from rest has this name by our definitions (table below) and strikes the walls that the paper says; in part if only one is so.",
        Verdict::of_all(&[case.agrees(regime), Zone::of(run.impacts) == case.zone]),
        format!("{name} (exponent {exponent:.3} ± {error:.3} /s, laminar {laminar:.0} % of the time, confidence {confidence:.2}); {ps} impacts on the PS and {obstacle} on the obstacle in {from}–{to} s; the paper's word fits also at: {others}"),
    );
}

fn draw(plan: &Plan, case: &Case, scene: &Scene, item: &mut Item) -> Result<(), Error> {
    let window = Window { to: plan.window().to + MORE, ..plan.window() };
    let samples = recorded(plan, scene, window, INTERVAL)?;
    let range = |value: fn(&Sample) -> f64| {
        let [low, high] = ends(samples.iter().map(value));
        let room = 0.06 * (high - low).max(1e-9);
        (low - room, high + room)
    };
    let top = samples.iter().map(|s| s.forces[0].max(s.forces[1])).fold(1.0, f64::max) * 1.06;
    let thin = |colour, width| Stroke::new(colour, width, Dash::Solid);
    let force = |side: usize, colour| {
        let struck = samples.windows(3).filter(move |near| near.iter().any(|s| s.forces[side] > 0.0));
        Layer::line(struck.map(|near| (near[1].t, near[1].forces[side])), thin(colour, 0.6))
    };
    let x2 = Layer::line(samples.iter().map(|s| (s.t, s.state[2])), thin(BLACK, 0.6));
    let phase = samples.iter().step_by(2).map(|s| (s.state[2], s.state[3]));
    let phase = Layer::line(phase, thin(BLACK, 0.3));
    let time = Axis::linear("t, s", (window.from, window.to));
    let displacement = Axis::linear("x2, m", range(|s| s.state[2]));
    let [forces, velocity] =
        [Axis::linear("F, N", (0.0, top)), Axis::linear("v2, m/s", range(|s| s.state[3]))];
    let title = format!("({}) {}", case.letter, case.place());
    let chart = |title: &str, x: &Axis, y: &Axis, layers| Chart {
        title: title.to_owned(),
        ..Chart::of(x.clone(), y.clone(), layers, 135.0)
    };
    let charts = vec![
        chart(&title, &time, &displacement, vec![x2]),
        chart("Contact forces", &time, &forces, vec![force(0, BLUE), force(1, GREEN)]),
        chart("Phase trajectory", &displacement, &velocity, vec![phase]),
    ];
    let description =
        format!("x2 and the contact forces over time, and the phase trajectory. The paper: {}.", case.paper);
    let key = |colour, words: &str| (Key::Line(Stroke::solid(colour)), words.to_owned());
    let sheet = Sheet {
        legend: vec![key(BLUE, "force on the PS"), key(GREEN, "force on the obstacle")],
        ..Sheet::page(title, description, charts)
    };
    let name = format!("figure7-{}", case.letter);
    item.picture(&name, &sheet, &format!("({}) The paper: {}.", case.letter, case.paper));
    let row = |&Sample { t, state: [x1, v1, x2, v2], forces: [ps, obstacle], .. }: &Sample| {
        cells![rounded(t), x1, v1, x2, v2, ps, obstacle]
    };
    let rows = samples.iter().step_by(16).map(row);
    let table = Table::named("t_s,x1_m,v1_m_per_s,x2_m,v2_m_per_s,F_PS_N,F_obstacle_N");
    item.data(&name, table.with(rows));
    Ok(())
}

/// The names of motions in words, with the thresholds of the classifier and the reason for each.
fn definitions() -> Table {
    let table = Table::headed("name | definition | why these numbers");
    let nearer = 1.0 / FALLING;
    let rows = format!(
        "\
periodic nT, m, k | States n periods of the force apart agree to {SAME:e} of the motion's size over the whole settled stretch, n ≤ {LONGEST} the least such number; or to {NEARING:e} and {nearer} times nearer in its second half than in its first. m and k are the impacts on the PS and on the obstacle in n periods. | 1e-6 is far above the error of a run and far below what can be seen; 64 periods fit seven times into the 500 that are judged.
chaotic | Not periodic, and neighbours part: largest exponent above {FLOOR} /s. | In a motion whose exponent is zero, neighbours may part in proportion to time; over 500 periods that looks like ln(500)/500 s = 0.012 /s.
amplitude-modulated | Not periodic, and neighbours keep their distance: exponent within ±{FLOOR} /s (a quasi-periodic motion). | As above.
intermittent | Chaotic, and more than {MOSTLY} of the time in laminar phases that bursts end again and again (Pomeau & Manneville 1980). A phase is laminar where states at most {LAMINAR_PERIOD} periods apart agree to {LAMINAR} of the motion's size for {LAMINAR_PHASE} periods and three of its own or more. | The paper does not define it. A chaotic motion comes within 5 % of itself by chance one time in twenty or less, ten times in a row practically never. That the phases recur is judged by the number of bursts: one or two could be a transient.
transient chaos, then … | Periodic in the end, but before it came within {ARRIVED} of its size of its period neighbours parted by a factor of {PARTED:e} or more, at a mean rate above {FLOOR} /s and {MARGIN} standard errors above zero (Grebogi, Ott & Yorke 1983). | The paper does not define it. On the way to a period neighbours part for a while without chaos too, in Figure 4 by up to 2e4; an approach that only creeps never parts them.
still settling | Not periodic, yet neighbours meet: the record is too short. |
confidence | The probability that the name is right: by the standard error of the exponent (from ten blocks of time) against the limits above, and for intermittency also by the number of bursts and the share of laminar time. | 0.5 is a toss-up. It covers the length of the record, not what the paper leaves out: for that the judgement is repeated at other radii R and nearby ω."
    );
    table.with(rows.lines().map(|row| row.split('|').map(|text| Cell::from(text.trim())).collect()))
}
