//! A start away from rest, as it is typed, and who begins at rest.

use crate::{Rule, SettingError, Study};
use retune_model::{Finite, Start};

/// A state at t = 0 from `x1,v1,x2,v2` (m, m/s), or from `x1,v1`, where the damper's spring is at rest.
///
/// # Errors
/// It is something else.
pub fn start(text: &str) -> Result<Start, SettingError> {
    let refused = || SettingError::Start { text: text.to_owned() };
    let number = |text: &str| text.trim().parse().ok().and_then(|value| Finite::new(value).ok());
    let numbers: Option<Vec<Finite>> = text.split(',').map(number).collect();
    match numbers.ok_or_else(refused)?.as_slice() {
        [x1, v1] => Ok(Start { x1: *x1, v1: *v1, ..Start::default() }),
        [x1, v1, x2, v2] => Ok(Start { x1: *x1, v1: *v1, x2: Some(*x2), v2: *v2 }),
        _ => Err(refused()),
    }
}

impl Study {
    /// Refuses a scene whose forced motion does not begin at rest, for whoever compares with runs from rest.
    ///
    /// # Errors
    /// The scene has a start beside its force.
    pub fn begins_at_rest(&self) -> Result<(), Rule> {
        match self.scene.forcing.start {
            None => Ok(()),
            Some(_) => Err(Rule::NotAllowed {
                field: "scene.forcing.start".to_owned(),
                value: "a start beside a force".to_owned(),
                allowed: "none, for this compares with runs from rest; `simulate` and `sweep` begin anywhere",
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_start_is_two_or_four_numbers() {
        let state = start("0.1, -2e-1,0.3,4").expect("a start");
        assert_eq!([state.x1.get(), state.v1.get(), state.v2.get()], [0.1, -0.2, 4.0]);
        assert_eq!(state.x2.map(Finite::get), Some(0.3));
        assert_eq!(start("1,2").expect("a start").x2, None);
        for text in ["", "1", "1,2,3", "1,2,3,4,5", "a,b", "1,inf"] {
            let said = start(text).expect_err(text).to_string();
            assert!(said.contains("give x1,v1,x2,v2"), "{said}");
        }
    }
}
