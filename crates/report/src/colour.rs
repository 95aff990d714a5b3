//! One palette, which colour-blind readers can tell apart, and its counterpart on a dark page.

/// A colour as SVG writes it.
pub type Colour = &'static str;

/// Black. The colours below are those of M. Okabe and K. Ito's palette (2008).
pub const BLACK: Colour = "#000000";
/// Orange.
pub const ORANGE: Colour = "#E69F00";
/// Sky blue.
pub const SKY: Colour = "#56B4E9";
/// Bluish green.
pub const GREEN: Colour = "#009E73";
/// Blue.
pub const BLUE: Colour = "#0072B2";
/// Vermilion.
pub const VERMILION: Colour = "#D55E00";
/// Reddish purple; pale, the pink of the paper's bilateral zones.
pub const PURPLE: Colour = "#CC79A7";
/// Yellow.
pub const YELLOW: Colour = "#F0E442";
/// For points of less interest.
pub const GREY: Colour = "#999999";

/// The paper.
pub const PAPER: Colour = "#FFFFFF";
/// Where a map has no value.
pub(crate) const NOTHING: &str = "#C8C8C8";

/// Colours that are replaced on a dark page. Blue and vermilion would be too dark there.
pub const DARK: [(Colour, &str); 5] =
    [(BLACK, "#E8EAEE"), (PAPER, "#14161A"), (BLUE, "#4AA8E0"), (VERMILION, "#FF8A3D"), (GREEN, "#2FC79B")];

/// Colours of a map of categories: as many as a reader can tell apart; all further categories share [`OTHERS`]. Blue, orange, bluish green,
/// reddish purple and yellow of the palette, and a dark brown, which readers who see no red or no green also tell apart (tested). Lower
/// case, so that [`style`] does not match them: a map keeps its colours on a dark page.
pub const CATEGORIES: [Colour; 6] = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#f0e442", "#5a2d0c"];
/// The colour of all further categories.
pub const OTHERS: Colour = "#f2f2f2";

/// The style sheet of a figure: replaces colours in dark mode. It applies only within elements of the class `figure`, so it can be embedded
/// in an HTML page. Maps keep their colours.
pub(crate) fn style() -> String {
    let rule = |(light, dark): (Colour, &str)| {
        format!(".figure [fill=\"{light}\"]{{fill:{dark}}}.figure [stroke=\"{light}\"]{{stroke:{dark}}}")
    };
    let [(_, ink), ..] = DARK;
    let rules: String = DARK.into_iter().map(rule).collect();
    format!("<style>@media (prefers-color-scheme:dark){{.figure{{fill:{ink}}}{rules}}}</style>\n")
}

/// Viridis (S. van der Walt and N. Smith, matplotlib, 2015, CC0) at eighths.
pub const VIRIDIS: [[f64; 3]; 9] = [
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

/// The colour of a fraction from 0 (dark) to 1 (bright), in 256 steps; grey if it is not finite.
pub(crate) fn viridis(fraction: f64) -> String {
    if !fraction.is_finite() {
        return NOTHING.to_owned();
    }
    let place = (255.0 * fraction.clamp(0.0, 1.0)).round() / 255.0 * (VIRIDIS.len() - 1) as f64;
    let i = (place as usize).min(VIRIDIS.len() - 2);
    let part = place - i as f64;
    let [r, g, b] =
        [0, 1, 2].map(|c| (VIRIDIS[i][c] + part * (VIRIDIS[i + 1][c] - VIRIDIS[i][c])).round() as u8);
    format!("#{r:02X}{g:02X}{b:02X}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_viridis_begins_and_ends_as_published() {
        assert_eq!([viridis(0.0), viridis(1.0)], ["#440154", "#FDE725"]);
        assert_eq!([viridis(-3.0), viridis(9.0)], ["#440154", "#FDE725"]);
        assert_eq!([viridis(f64::NAN), viridis(f64::INFINITY)], [NOTHING, NOTHING]);
    }

    /// Relative luminance and contrast as in WCAG 2.1.
    fn contrast(a: &str, b: &str) -> f64 {
        let channel = |text: &str, i: usize| {
            let value = f64::from(u8::from_str_radix(&text[i..i + 2], 16).expect("a colour")) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        };
        let light = |c: &str| 0.2126 * channel(c, 1) + 0.7152 * channel(c, 3) + 0.0722 * channel(c, 5) + 0.05;
        (light(a) / light(b)).max(light(b) / light(a))
    }

    /// The distance of two colours in CIELAB (1976) as seen by colour-blind readers: matrices of G. M. Machado et al. (2009) at severity 1,
    /// in linear sRGB.
    fn apart(a: &str, b: &str, seen: [[f64; 3]; 3]) -> f64 {
        let lab = |colour: &str| {
            let linear = [1, 3, 5].map(|i| {
                let value = f64::from(u8::from_str_radix(&colour[i..i + 2], 16).expect("a colour")) / 255.0;
                if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
            });
            let times = |row: [f64; 3], of: [f64; 3]| (0..3).map(|i| row[i] * of[i]).sum::<f64>();
            let rgb = seen.map(|row| times(row, linear).clamp(0.0, 1.0));
            let xyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
                .map(|row| times(row, rgb));
            let f = |t: f64| if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
            let [x, y, z] = [xyz[0] / 0.9505, xyz[1], xyz[2] / 1.089].map(f);
            [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
        };
        let (a, b) = (lab(a), lab(b));
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn contract_categories_stay_apart_for_readers_who_see_no_red_or_no_green() {
        let all = [&CATEGORIES[..], &[OTHERS, NOTHING]].concat();
        let usual = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let no_red = [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ];
        let no_green = [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ];
        for seen in [usual, no_red, no_green] {
            for (i, a) in all.iter().enumerate() {
                for b in &all[..i] {
                    assert!(apart(a, b, seen) > 14.0, "{a} and {b}: {}", apart(a, b, seen));
                }
            }
        }
        for colour in CATEGORIES {
            assert!(DARK.iter().all(|(light, _)| *light != colour), "{colour} would turn dark");
        }
    }

    #[test]
    fn contract_lines_and_text_stand_out_on_light_and_on_dark_paper() {
        let dark = |colour: Colour| DARK.iter().find(|pair| pair.0 == colour).map_or(colour, |pair| pair.1);
        assert!(contrast(BLACK, PAPER) > 15.0 && contrast(dark(BLACK), dark(PAPER)) > 12.0);
        for colour in [ORANGE, SKY, GREEN, BLUE, VERMILION, PURPLE, GREY] {
            assert!(contrast(colour, PAPER) > 2.0, "{colour}: {}", contrast(colour, PAPER));
            assert!(contrast(dark(colour), dark(PAPER)) > 5.0, "{colour} on dark paper");
        }
    }
}
