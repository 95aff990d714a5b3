//! A regime in a sentence.

use crate::regime::{Kind, Regime};

impl Regime {
    /// The motion in words that need no legend: "repeats every 2 periods of the force, with 1 impact on the structure and 3 on the
    /// obstacle".
    pub fn sentence(&self) -> String {
        let end = match (self.kind, self.period) {
            (Kind::Periodic, Some(n)) => {
                let periods = if n == 1 { "period".to_owned() } else { format!("{n} periods") };
                let impacts = match self.impacts.map(f64::round) {
                    [0.0, 0.0] => "touching no wall".to_owned(),
                    [on_structure, on_obstacle] => {
                        let noun = if on_structure == 1.0 { "impact" } else { "impacts" };
                        format!(
                            "with {on_structure} {noun} on the structure and {on_obstacle} on the obstacle"
                        )
                    }
                };
                format!("repeats every {periods} of the force, {impacts}")
            }
            (Kind::Chaotic, _) => "is irregular: chaotic".to_owned(),
            (Kind::Intermittent, _) => "is irregular: regular stretches between bursts".to_owned(),
            (Kind::AmplitudeModulated, _) => "never quite repeats: its amplitude is modulated".to_owned(),
            _ => "has not settled".to_owned(),
        };
        if self.transient.is_some() { format!("is irregular at first, then {end}") } else { end }
    }
}
