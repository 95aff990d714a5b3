//! Descriptions of study files in words, for `check`.

use retune_model::{
    Contact, Course, Forcing, Form, History, Loss, Measure, Of, Shape, Source, Spectrum, Sweep,
};
use retune_optim::{Part, Response, Stiffnesses};
use retune_solver::{Method, least_steps, leaves_out_a_fast_part};
use retune_study::{FrontsPlan, PaperStudy, Search, Study, counted, joined, over, short};

/// Describes a table of studies.
pub fn table2(rows: &[PaperStudy]) -> String {
    rows.iter().map(|row| format!("{}: {}", row.damper, study(&row.study))).collect::<Vec<_>>().join("\n")
}

/// Describes a study of Pareto fronts.
pub fn fronts(plan: &FrontsPlan) -> String {
    let dampers = plan.dampers.iter().map(|(damper, of)| format!("{damper}: {}", study(of)));
    let sweeps = plan.sweeps().into_iter().map(|sweep| {
        let values = joined(&plan.values(sweep), ", ");
        format!("each for {} at most {values} {}", sweep.name(), sweep.unit())
    });
    dampers.chain(sweeps).collect::<Vec<_>>().join("\n")
}

/// Describes a study.
pub fn study(study: &Study) -> String {
    let primary = study.scene.primary;
    let (name, k1, forced) = (study.name(), primary.stiffness.get(), forced(&study.scene.forcing));
    let (t0, end) = (study.window.t0.get(), study.window.end.get());
    let mut lines =
        vec![format!("study {name}: k1 = {k1} N/m, {forced}; maxima from t0 = {t0} s to T = {end} s")];
    match study.scene.damper {
        None => lines.push("no damper".to_owned()),
        Some(damper) => {
            let walls = damper.contact.map_or("no walls".to_owned(), |contact| walls(&contact));
            lines.push(format!("damper of {} kg; {walls}", damper.mass.get()));
        }
    }
    if let Ok(search) = study.search() {
        lines.push(format!("tunes {} from {}", joined(&search.variables, ", "), starts(&search)));
        lines.extend(goal(study));
    }
    lines.extend(steps(study));
    lines.extend(study.transient());
    lines.join("\n  ")
}

fn walls(contact: &Contact) -> String {
    let surfaces = match contact {
        Contact::Hertz(surfaces) => surfaces,
        Contact::Rigid(rigid) => {
            let e = short(rigid.restitution.get());
            return format!("rigid walls, restitution e = {e} at every speed");
        }
    };
    let stiffness = joined(&surfaces.stiffness().map(short), " and ");
    let hertz = format!("contact stiffnesses {stiffness} N/m^1.5");
    match surfaces.loss_obstacle {
        None => format!("{hertz}, {}", loss(&surfaces.loss)),
        Some(obstacle) => {
            format!("{hertz}, on the structure {}, on the obstacle {}", loss(&surfaces.loss), loss(&obstacle))
        }
    }
}

/// The loss of a contact in words.
fn loss(loss: &Loss) -> String {
    if loss.is_none() {
        return "Hertz without loss".to_owned();
    }
    let [slow, fast] = [0.1, 1.0].map(|speed| short(loss.restitution(speed)));
    match loss {
        Loss::Damping(lambda) => {
            let lambda = short(lambda.get());
            format!(
                "Hunt and Crossley's loss with lambda = {lambda} s/m: restitution {slow} at 0.1 m/s, {fast} at 1 m/s"
            )
        }
        Loss::Restoring(_) => format!("a loss with restitution {slow} at every speed"),
    }
}

/// The condition under which the default method takes longer steps.
pub(crate) const LEFT_OUT: &str =
    "the fast part of the motion, that of a strong dashpot, has decayed and is left out";

/// The number or length of the steps of a run by the default method; none for other methods and steady objectives.
fn steps(study: &Study) -> Option<String> {
    let settings = study.solver.settings();
    if settings.method != Method::Hybrid || study.objective().is_steady() {
        return None;
    }
    let (end, most) = (study.window.end.get(), settings.max_steps);
    let least = least_steps(&study.scene, end);
    if leaves_out_a_fast_part(&study.scene, end) {
        return Some(format!(
            "a run has steps of {} s in flight, longer ones once {LEFT_OUT}; max_steps is {most}",
            short(end / least)
        ));
    }
    let refused = if least > most as f64 { ": it is refused" } else { "" };
    let contacts = if study.scene.damper.is_some_and(|damper| damper.contact.is_some()) {
        ", and those of contacts"
    } else {
        ""
    };
    Some(format!(
        "a run takes {} steps in flight{contacts}; max_steps is {most}{refused}",
        short(least.ceil())
    ))
}

pub(crate) fn forced(forcing: &Forcing) -> String {
    let at = format!("at omega = {} rad/s", forcing.frequency.get());
    match forcing.source {
        Source::Harmonic(of, size) => {
            let (size, symbol, unit) = (size.get(), of.parameter().symbol(), of.parameter().unit());
            match of.is_of_base() {
                true => format!("on {} {size} {unit} {at}", of.words()),
                false => format!("forced by {symbol} = {size} {unit} {at}"),
            }
        }
        Source::Decay(_) => "decaying freely".to_owned(),
        Source::History(history) => given(&history),
    }
}

/// A forcing given in time, in words.
fn given(History { of, course }: &History) -> String {
    let of_what = match of {
        Of::Force => "a force on the structure",
        Of::BaseAcceleration => {
            "an acceleration of the base (x1, v1 and energies are relative to it, a1 is not)"
        }
    };
    let unit = of.units()[0].0;
    match course {
        Course::Pulse(pulse) => {
            let shape = match pulse.shape {
                Shape::HalfSine => "a half sine",
                Shape::Rectangle => "a rectangle",
                Shape::VersedSine => "a versed sine",
            };
            let (peak, duration) = (short(pulse.peak()), short(pulse.duration.get()));
            format!("under {shape} of {peak} {unit} for {duration} s, {of_what}")
        }
        Course::Made(made) => {
            let (recipe, samples) = (made.recipe(), made.samples());
            let what = match &recipe.form {
                Form::VersedSine(peak) => {
                    format!("a versed sine of {} {unit}", short(peak.get() * recipe.unit.1))
                }
                Form::Harmonics(harmonics) => counted(harmonics.len() as u64, "harmonic"),
                Form::Sweep(Sweep { from, rate, .. }) => {
                    let to = short(from.get() + rate.get() * recipe.duration.get());
                    format!("a sweep from {} to {to} rad/s", short(from.get()))
                }
                Form::Spectrum(Spectrum { seed, .. }) => {
                    format!("a random force of a spectrum (Shinozuka and Deodatis, seed {seed})")
                }
            };
            let ([most, _], end) = (samples.bounds(), short(samples.end()));
            let count = counted(samples.len() as u64, "sample");
            let error = short(recipe.error());
            format!(
                "under {what} for {end} s, at most {} {unit}, {of_what}; {count} that are off by at most {error} {unit}",
                short(most)
            )
        }
        Course::Record(record) => {
            let file = match record.source().file.as_str() {
                "" => "of the study itself",
                file => file,
            };
            let Some(samples) = record.samples() else {
                return format!("under the record {file}, {of_what}");
            };
            let ([most, _], end) = (samples.bounds(), short(samples.end()));
            let count = counted(samples.len() as u64, "sample");
            format!(
                "under the record {file}, {count} to {end} s with at most {} {unit}, {of_what}",
                short(most)
            )
        }
    }
}

fn starts(search: &Search) -> String {
    let mut from = Vec::new();
    if let Some((variables, grid)) = &search.surf {
        let points = counted(grid.len() as u64, "point");
        from.push(format!("a grid of {points} over {}", joined(variables, ", ")));
    }
    if let Some((global, ..)) = &search.global {
        let searches = counted(global.searches as u64, "CMA-ES search");
        from.push(format!("a global search ({}, {searches})", counted(global.samples.into(), "design")));
    }
    if !search.given.is_empty() {
        from.push(counted(search.given.len() as u64, "given design"));
    }
    if from.is_empty() { "the damper of the scene".to_owned() } else { from.join(" and ") }
}

/// The objective, if it is not E1max in the window at the scene's omega, and the limits.
fn goal(study: &Study) -> Vec<String> {
    let mut lines = Vec::new();
    let objective = study.objective();
    let omega = study.scene.forcing.frequency.get();
    let name = study.quantity().name();
    let steady = objective.response == Response::Steady;
    let band = objective.omega.map(|band| counted(band.samples as u64, "sample"));
    let band = band.map_or(String::new(), |samples| format!(", on {samples} and refined at their peaks"));
    let how = match objective.response {
        Response::Window => format!("in the window{band}"),
        Response::Settled => format!("settled{band}"),
        Response::Motions => "over all stable motions that are found".to_owned(),
        Response::Steady if matches!(objective.k1, Some(Stiffnesses::Range(_))) => {
            "steady, exact at each stiffness that is looked at".to_owned()
        }
        Response::Steady => "steady, exact".to_owned(),
    };
    if !objective.sum.is_empty() {
        lines.push(format!("for the {}", over(&objective, omega)));
        let part = |part: &Part| {
            format!("  {} times {name}, {}", short(part.weight.get()), over(&part.objective, omega))
        };
        lines.extend(objective.sum.iter().map(part));
    } else if objective.records.is_empty()
        && objective.ensemble.is_none()
        && objective.k1.is_none()
        && objective.restitution.is_none()
        && objective.omega.is_none()
    {
        lines.extend(match objective.response {
            Response::Steady => Some(format!("for the steady {name}")),
            Response::Settled => Some(format!("for the settled {name}")),
            Response::Motions => Some(format!("for the largest {name} of all stable motions that are found")),
            Response::Window if study.quantity() == Measure::Energy => None,
            Response::Window => Some(format!("for {name} in the window")),
        });
    } else {
        let words = over(&objective, omega).replacen("worst over", &format!("worst {name} over"), 1);
        lines.push(format!("for the {words}, {how}"));
    }
    let limits = study.goal().limits;
    let words: Vec<String> = limits
        .set()
        .filter_map(|limit| Some(format!("{limit} at most {} {}", short(limits.get(limit)?), limit.unit())))
        .collect();
    if !words.is_empty() {
        let when = match limits.also().map(|also| also.from) {
            None => String::new(),
            Some(_) if steady => ", of the steady motion".to_owned(),
            Some(0.0) => ", over the whole run".to_owned(),
            Some(from) => format!(", from {} s on", short(from)),
        };
        lines.push(format!("under limits: {}{when}", words.join(", ")));
    }
    lines
}
