//! Colours that remain distinct for colour-blind readers and keep their order in grey.

use plotters::style::RGBColor;

/// Viridis (S. van der Walt and N. Smith, matplotlib, 2015, CC0) at eighths.
const VIRIDIS: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [71.0, 44.0, 122.0],
    [59.0, 81.0, 139.0],
    [44.0, 113.0, 142.0],
    [33.0, 144.0, 141.0],
    [39.0, 173.0, 129.0],
    [92.0, 200.0, 99.0],
    [170.0, 220.0, 50.0],
    [253.0, 231.0, 37.0],
];

/// Blue of M. Okabe and K. Ito's palette (2008).
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
/// Where there is no value.
pub const NOTHING: RGBColor = RGBColor(200, 200, 200);

/// The colour of a share from 0 (dark) to 1 (bright).
pub fn viridis(share: f64) -> RGBColor {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let i = (place as usize).min(VIRIDIS.len() - 2);
    let part = place - i as f64;
    let [r, g, b] =
        [0, 1, 2].map(|c| (VIRIDIS[i][c] + part * (VIRIDIS[i + 1][c] - VIRIDIS[i][c])).round() as u8);
    RGBColor(r, g, b)
}
