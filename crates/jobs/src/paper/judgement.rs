//! The names of motions in words, with the thresholds of the classifier and the reason for each.

use super::item::Grid;
use retune_dynamics::regime::{
    ARRIVED, FALLING, FLOOR, LAMINAR, LAMINAR_PERIOD, LAMINAR_PHASE, LONGEST, MARGIN, MOSTLY, NEARING,
    PARTED, SAME,
};

/// A row for each name.
pub fn definitions() -> Grid {
    let mut grid = Grid::new(
        "How motions are named: from states at the crests of the force, impact counts and the largest Lyapunov exponent",
        &["name", "definition", "why these numbers"],
    );
    let rows = [
        (
            "periodic nT, m, k",
            format!(
                "States n periods of the force apart agree to {SAME:e} of the motion's size over the whole settled stretch, n ≤ {LONGEST} the least such number; or to {NEARING:e} and {} times nearer in its second half than in its first. m and k are the impacts on the PS and on the obstacle in n periods.",
                1.0 / FALLING
            ),
            "1e-6 is far above the error of a run and far below what can be seen; 64 periods fit seven times into the 500 that are judged.".to_owned(),
        ),
        (
            "chaotic",
            format!("Not periodic, and neighbours part: largest exponent above {FLOOR} /s."),
            "In a motion whose exponent is zero, neighbours may part in proportion to time; over 500 periods that looks like ln(500)/500 s = 0.012 /s.".to_owned(),
        ),
        (
            "amplitude-modulated",
            format!("Not periodic, and neighbours keep their distance: exponent within ±{FLOOR} /s (a quasi-periodic motion)."),
            "As above.".to_owned(),
        ),
        (
            "intermittent",
            format!(
                "Chaotic, and more than {MOSTLY} of the time in laminar phases that bursts end again and again (Pomeau & Manneville 1980). A phase is laminar where states at most {LAMINAR_PERIOD} periods apart agree to {LAMINAR} of the motion's size for {LAMINAR_PHASE} periods and three of its own or more."
            ),
            "The paper does not define it. A chaotic motion comes within 5 % of itself by chance one time in twenty or less, ten times in a row practically never. That the phases recur is judged by the number of bursts: one or two could be a transient.".to_owned(),
        ),
        (
            "transient chaos, then …",
            format!(
                "Periodic in the end, but before it came within {ARRIVED} of its size of its period neighbours parted by a factor of {PARTED:e} or more, at a mean rate above {FLOOR} /s and {MARGIN} standard errors above zero (Grebogi, Ott & Yorke 1983)."
            ),
            "The paper does not define it. On the way to a period neighbours part for a while without chaos too, in Figure 4 by up to 2e4; an approach that only creeps never parts them.".to_owned(),
        ),
        (
            "still settling",
            "Not periodic, yet neighbours meet: the record is too short.".to_owned(),
            String::new(),
        ),
        (
            "confidence",
            "The probability that the name is right: by the standard error of the exponent (from ten blocks of time) against the limits above, and for intermittency also by the number of bursts and the share of laminar time.".to_owned(),
            "0.5 is a toss-up. It covers the length of the record, not what the paper leaves out: for that the judgement is repeated at other radii R and nearby ω.".to_owned(),
        ),
    ];
    grid.rows = rows.into_iter().map(|(name, what, why)| vec![name.to_owned(), what, why]).collect();
    grid
}
