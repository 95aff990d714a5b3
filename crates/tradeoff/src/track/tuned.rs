//! Dampers tuned for several stiffnesses of the structure, and their E1max along k1.

use rayon::prelude::*;
use retune_model::{NonNegative, Scene};
use retune_study::Study;
use retune_workbench::designs::quoted;
use retune_workbench::tune::Found;

/// The table of the designs.
pub(super) const DESIGNS: &str = "retune.csv";
/// Number of equidistant stiffnesses at which the curves are computed, besides those that were tuned for.
const ALONG: usize = 61;

/// A damper tuned for several stiffnesses.
#[derive(Debug)]
pub struct Tuned {
    /// Its name.
    pub name: String,
    /// Its study.
    pub study: Study,
    /// The stiffness of its study, N/m.
    pub nominal: f64,
    /// The design for it.
    pub nominal_design: Found,
    /// A design for each stiffness, N/m, in their order.
    pub designs: Vec<(f64, Found)>,
}

/// E1max along k1.
#[derive(Debug)]
pub struct Curves {
    /// The stiffnesses, N/m.
    pub k1: Vec<f64>,
    /// Without a damper, J, by the objective of the first study.
    pub none: Vec<f64>,
    /// Of each damper as tuned for its study's own k1, J.
    pub kept: Vec<Vec<f64>>,
}

/// E1max of the dampers along k1, and without one.
pub fn retention(tuned: &[Tuned]) -> Curves {
    let at = |damper: &Tuned| damper.designs.iter().map(|(k1, _)| *k1).collect::<Vec<f64>>();
    let stops: Vec<f64> = tuned.iter().flat_map(at).collect();
    let [low, high] = [f64::min, f64::max].map(|pick| stops.iter().copied().reduce(pick).unwrap_or_default());
    let along = (0..ALONG).map(|i| low + (high - low) * (i as f64 / (ALONG - 1) as f64));
    let mut k1: Vec<f64> = stops.iter().copied().chain(along).collect();
    k1.sort_by(f64::total_cmp);
    k1.dedup();
    let curve = |study: &Study, scene: Scene| -> Vec<f64> {
        k1.par_iter().map(|&k1| energy(study, scene, k1).unwrap_or(f64::NAN)).collect()
    };
    let none = tuned.first().map(|first| curve(&first.study, Scene { damper: None, ..first.study.scene }));
    let kept = |damper: &Tuned| {
        let scene = damper.study.scene_at(&damper.nominal_design.damper.design);
        scene.map_or(vec![f64::NAN; k1.len()], |scene| curve(&damper.study, scene))
    };
    let (none, kept) = (none.unwrap_or_default(), tuned.iter().map(kept).collect());
    Curves { k1, none, kept }
}

/// E1max by the objective of a study for a scene at another stiffness, N/m, in J; none where it cannot be run.
pub fn energy(study: &Study, mut scene: Scene, k1: f64) -> Option<f64> {
    scene.primary.stiffness = NonNegative::new(k1).ok()?;
    study.energy(&scene)
}

impl Tuned {
    /// E1max of the design for a stiffness at it, J, if it is one of those tuned for.
    fn retuned(&self, k1: f64) -> Option<f64> {
        self.designs.iter().find(|(other, _)| *other == k1).map(|(_, found)| found.e1_max)
    }
}

/// The name of the column of a damper as it was tuned for the stiffness of its study, N/m.
pub fn column(name: &str, nominal: f64) -> String {
    format!("{name} tuned for {nominal}")
}

/// A row for each stiffness; what has no value is an empty field.
pub fn csv(tuned: &[Tuned], curves: &Curves) -> String {
    let columns = tuned.iter().map(|Tuned { name, nominal, .. }| {
        let columns = [column(name, *nominal), format!("{name} re-tuned")];
        columns.map(|column| quoted(&column)).join(",")
    });
    let mut text = format!("k1,none,{}\n", columns.collect::<Vec<_>>().join(","));
    let field = |value: f64| if value.is_finite() { value.to_string() } else { String::new() };
    for (i, &k1) in curves.k1.iter().enumerate() {
        let mut fields = vec![k1.to_string(), field(curves.none[i])];
        for (damper, kept) in tuned.iter().zip(&curves.kept) {
            fields.extend([field(kept[i]), field(damper.retuned(k1).unwrap_or(f64::NAN))]);
        }
        text += &(fields.join(",") + "\n");
    }
    text
}
