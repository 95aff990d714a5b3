use retune_dynamics::periodic::{Branches, branches, branches::Plan};
use retune_dynamics::Parameter;
use retune_model::Scene;
use std::time::Instant;
fn main() {
    let a: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let [k2, c2, d, c, samples, starts] = a[..6].try_into().unwrap();
    let text = format!(r#"{{ "primary": {{ "m1": 1000, "c1": 452, "k1": 39500 }}, "forcing": {{ "P": 800, "omega": 6.28 }},
      "damper": {{ "m2": 60, "k2": {k2}, "c2": {c2}, "D": {d}, "C": {c}, "contact": {{ "R": 2, "q": 0.318,
      "E1": 2.1e11, "nu1": 0.3, "E2": 2.21e7, "nu2": 0.4, "E3": 2.1e11, "nu3": 0.3, "E4": 2.05e7, "nu4": 0.4 }} }} }}"#);
    let scene: Scene = serde_json::from_str(&text).unwrap();
    let plan = Plan { parameter: Parameter::Omega, range: [5.0, 8.0], samples: samples as usize, starts: starts as usize };
    let t = Instant::now();
    let found = branches(&scene, plan, &Default::default(), || ()).unwrap();
    println!("{:?}", t.elapsed());
    for (i, b) in found.branches.iter().enumerate() {
        let stable = b.points.iter().filter(|p| p.is_stable()).count();
        let v: Vec<f64> = b.points.iter().map(|p| p.value).collect();
        let lo = v.iter().copied().fold(f64::INFINITY, f64::min); let hi = v.iter().copied().fold(0.0, f64::max);
        let l = Branches::largest(b, |o| o.e1_max).map(|o| (o.e1_max, o.value));
        println!("branch {i}: {}T {} points {stable} stable, {lo:.5}..{hi:.5} {:?} largest {l:?} labels {:?}", b.shooting.periods, b.points.len(), b.ends, b.points[b.points.len()/2].impacts);
        for e in b.events.iter().take(14) { println!("    {} {:.10} {:?} {:?}", e.kind.name(), e.orbit.value, e.orbit.multipliers.map(|m| (m.norm()*1e6).round()/1e6), e.orbit.impacts); }
    }
    let [s, irr] = found.stable_and_irregular();
    println!("stable {s:?}\nirregular {irr:?}");
    for s in &found.samples {
        println!("{:.3}: {:?} irregular {} {:?}", s.value, s.attractors.iter().map(|a| (a.branch, a.orbit.periods, a.starts, a.from_rest, (a.orbit.e1_max*10.0).round()/10.0, a.orbit.impacts.as_str())).collect::<Vec<_>>(), s.irregular.len(), s.irregular.first());
    }
}
