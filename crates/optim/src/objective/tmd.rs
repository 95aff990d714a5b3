//! Where searches for the best TMD begin: in the valleys of a grid over its spring and dashpot.

use super::design_objective::DesignObjective;
use crate::search::fminsearch::Bounds;
use rayon::prelude::*;
use retune_model::Parameter;

/// The ranges of spring and dashpot of the grid for a best TMD without limits, in multiples of Den Hartog's.
pub const TUNINGS: [[f64; 2]; 2] = [[0.05, 5.0], [0.05, 300.0]];
/// Points of the grid along an axis that is not widened for a band.
const POINTS: usize = 16;
/// Factor by which the grid extends beyond dampers tuned to the ends of a band.
const ROOM: f64 = 3.0;
/// Ends of a band are clamped to this factor from the natural frequency.
const FAR: f64 = 1000.0;

/// The ends of a band in multiples of a natural frequency (rad/s) above zero.
pub fn over_natural(band: [f64; 2], natural: f64) -> [f64; 2] {
    band.map(|omega| (omega / natural).clamp(1.0 / FAR, FAR))
}

/// A range of k2 in multiples of Den Hartog's, widened to include, with a margin, the springs of dampers tuned anywhere in a band: the best
/// TMD of a structure that is driven off its resonance is tuned to where it is driven. The band is in [multiples of the natural
/// frequency](over_natural).
pub fn springs_for([from, to]: [f64; 2], [lowest, highest]: [f64; 2]) -> [f64; 2] {
    [from.min(lowest.powi(2) / ROOM), to.max(ROOM * highest.powi(2))]
}

impl DesignObjective {
    /// The lowest and the highest frequency at which the structure is driven, in multiples of its natural one; 1 where the forcing has none.
    pub(super) fn driven(&self) -> [f64; 2] {
        let (primary, forcing) = (&self.scene.primary, &self.scene.forcing);
        if !forcing.source.is_harmonic() || primary.stiffness.get() == 0.0 {
            return [1.0; 2];
        }
        let bands = self.goal().objective.terms().into_iter().map(|(_, term)| match term.omega {
            Some(band) => {
                let band = band.of(primary);
                [band.from, band.to]
            }
            None => [forcing.frequency.get(); 2],
        });
        let all = bands.fold([f64::INFINITY, 0.0], |all, band| [all[0].min(band[0]), all[1].max(band[1])]);
        over_natural(all, primary.natural_frequency())
    }

    /// The local minima of a grid over spring and dashpot, best first, each with its value. The grid is logarithmic over these multiples of
    /// Den Hartog's k2 and c2, widened for the band ([`springs_for`]) and clamped to `bounds`. The objective varies one of them, or both.
    pub fn valleys(&self, ranges: [[f64; 2]; 2], bounds: &[Bounds]) -> Vec<(f64, Vec<f64>)> {
        let (scales, driven) = (self.den_hartog(), self.driven());
        let axis = |(variable, bounds): (&Parameter, &Bounds)| -> Vec<f64> {
            let which = usize::from(*variable == Parameter::C2);
            let [from, to] = ranges[which];
            let wide =
                if which == 0 { springs_for(ranges[0], driven) } else { [from.min(driven[0] / ROOM), to] };
            let ratio = (wide[1] / wide[0]).ln() / (to / from).ln();
            let steps = ((POINTS - 1) as f64 * ratio).ceil();
            let value = |step: usize| scales[which] * wide[0] * (wide[1] / wide[0]).powf(step as f64 / steps);
            let within = |value: f64| {
                value.max(bounds.lower.unwrap_or(0.0)).min(bounds.upper.unwrap_or(f64::INFINITY))
            };
            (0..=steps as usize).map(|step| within(value(step))).collect()
        };
        let axes: Vec<Vec<f64>> = self.variables().iter().zip(bounds).map(axis).collect();
        let [across, along] = [0, 1].map(|i| axes.get(i).map_or(1, Vec::len));
        let design = |number: usize| -> Vec<f64> {
            let steps = [number % across, number / across];
            axes.iter().zip(steps).map(|(axis, step)| axis[step]).collect()
        };
        let grid: Vec<(f64, Vec<f64>)> = (0..across * along)
            .into_par_iter()
            .map(design)
            .map(|x| (self.value(&x, f64::INFINITY), x))
            .collect();
        let is_least = |number: &usize| {
            let (i, j) = (number % across, number / across);
            let around = |at: usize, count: usize| at.saturating_sub(1)..=(at + 1).min(count - 1);
            around(j, along).all(|j| around(i, across).all(|i| grid[*number].0 <= grid[j * across + i].0))
        };
        let mut valleys: Vec<_> =
            (0..grid.len()).filter(is_least).map(|number| grid[number].clone()).collect();
        valleys.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Clamping to bounds may make designs equal.
        valleys.dedup_by(|a, b| a.1 == b.1);
        valleys
    }
}
