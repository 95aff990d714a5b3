//! Text with subscripts and superscripts: parsing, width, line breaks.

use std::fmt::Write;

/// Letters that carry an index: `E1max`, `k2`, `c2`, `x1`, `a1`, `R1`, `t0`.
const SYMBOLS: &str = "EkcxvamRtF";
/// Size of an index relative to its text.
const INDEX: f64 = 0.72;
/// Depth of a subscript and height of a superscript, as shares of the size of the text.
const SHIFTS: [f64; 3] = [0.0, 0.2, -0.36];

/// The level of a piece of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Base,
    Sub,
    Super,
}

/// The digit or sign that a raised or lowered character stands for.
fn index(c: char) -> Option<(Level, char)> {
    let digit = |from: u32| char::from_digit(u32::from(c).wrapping_sub(from), 10);
    match c {
        '⁻' => Some((Level::Super, '−')),
        '¹' => Some((Level::Super, '1')),
        '²' => Some((Level::Super, '2')),
        '³' => Some((Level::Super, '3')),
        '⁰'..='⁹' => digit(0x2070).map(|d| (Level::Super, d)),
        '₀'..='₉' => digit(0x2080).map(|d| (Level::Sub, d)),
        _ => None,
    }
}

/// The end of the index of the symbol at `at`: digits, and `max`.
fn index_end(chars: &[char], at: usize) -> Option<usize> {
    let before = at.checked_sub(1).map(|i| chars[i]);
    if !SYMBOLS.contains(chars[at]) || before.is_some_and(|c| c.is_alphanumeric() || c == '_') {
        return None;
    }
    let digits = chars[at + 1..].iter().take_while(|c| c.is_ascii_digit()).count();
    let mut end = at + 1 + digits;
    if chars[end..].starts_with(&['m', 'a', 'x']) {
        end += 3;
    }
    let open = chars.get(end).is_none_or(|c| !c.is_alphabetic() && !c.is_ascii_digit() && *c != '_');
    (digits > 0 && open).then_some(end)
}

fn pieces(text: &str) -> Vec<(Level, String)> {
    let chars: Vec<char> = text.chars().collect();
    let mut all: Vec<(Level, String)> = Vec::new();
    let mut add = |level: Level, c: char| match all.last_mut() {
        Some((last, text)) if *last == level => text.push(c),
        _ => all.push((level, c.to_string())),
    };
    let mut i = 0;
    while i < chars.len() {
        if let Some((level, c)) = index(chars[i]) {
            add(level, c);
        } else {
            add(Level::Base, chars[i]);
            if let Some(end) = index_end(&chars, i) {
                chars[i + 1..end].iter().for_each(|c| add(Level::Sub, *c));
                i = end - 1;
            }
        }
        i += 1;
    }
    all
}

/// Text as SVG markup: escaped, with indices lowered and powers raised.
pub(crate) fn markup(text: &str) -> String {
    let mut out = String::new();
    let mut at = 0.0;
    for (level, piece) in pieces(text) {
        let (target, size) = match level {
            Level::Base => (SHIFTS[0], 1.0),
            Level::Sub => (SHIFTS[1], INDEX),
            Level::Super => (SHIFTS[2], INDEX),
        };
        let piece = escape(&piece);
        let shift = (target - at) / size;
        at = target;
        let _ = match (shift == 0.0, level) {
            (true, _) => write!(out, "{piece}"),
            (_, Level::Base) => write!(out, "<tspan dy=\"{shift:.2}em\">{piece}</tspan>"),
            _ => {
                write!(out, "<tspan dy=\"{shift:.2}em\" font-size=\"{:.0}%\">{piece}</tspan>", 100.0 * INDEX)
            }
        };
    }
    out
}

/// Text escaped for XML, without the characters that XML cannot hold.
pub(crate) fn escape(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A conservative estimate of the width, as a multiple of the font size: that of the wide DejaVu Sans.
pub(crate) fn ems(text: &str) -> f64 {
    let glyph = |c: char| match c {
        'i' | 'j' | 'l' | '\'' | '|' => 0.29,
        ' ' | '.' | ',' | ':' | ';' | '·' | '!' => 0.32,
        'f' | 't' | 'r' | 'I' | '/' | '(' | ')' | '[' | ']' | '-' => 0.4,
        'm' | 'M' | 'w' | 'W' | '%' | '@' | '✓' | '✗' => 0.97,
        '−' | '+' | '=' | '<' | '>' | '×' | '≈' | '±' | 'ω' | '–' => 0.84,
        'A'..='Z' => 0.72,
        _ => 0.63,
    };
    let width = |(level, piece): (Level, String)| {
        piece.chars().map(glyph).sum::<f64>() * if level == Level::Base { 1.0 } else { INDEX }
    };
    pieces(text).into_iter().map(width).sum()
}

/// Breaks a text of height `size` into lines no wider than `width`; a single word may be wider.
pub(crate) fn lines(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match all.last_mut() {
            Some(line) if size * ems(&format!("{line} {word}")) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => all.push(word.to_owned()),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(text: &str) -> String {
        let sign = |(level, piece): (Level, String)| match level {
            Level::Base => piece,
            Level::Sub => format!("_{{{piece}}}"),
            Level::Super => format!("^{{{piece}}}"),
        };
        pieces(text).into_iter().map(sign).collect()
    }

    #[test]
    fn contract_symbols_carry_their_index_and_other_words_keep_theirs() {
        assert_eq!(flat("worst E1max, J over k1"), "worst E_{1max}, J over k_{1}");
        assert_eq!(flat("a1max, m/s²"), "a_{1max}, m/s^{2}");
        assert_eq!(flat("k₂, c₂; x1 and R2, t0 = 50 s"), "k_{2}, c_{2}; x_{1} and R_{2}, t_{0} = 50 s");
        assert_eq!(flat("10⁻¹⁵ m², c2² = 4 k2 m2"), "10^{−15} m^{2}, c_{2}^{2} = 4 k_{2} m_{2}");
        for plain in ["ode45, rk4, dop853", "3.95e4 N/m", "2T, 1, 0", "rtol 1e-10", "k2x", "Ek1", "max"] {
            assert_eq!(flat(plain), plain);
        }
    }

    #[test]
    fn contract_markup_returns_to_the_line_and_is_escaped() {
        assert_eq!(
            markup("E1 < k2"),
            "E<tspan dy=\"0.28em\" font-size=\"72%\">1</tspan><tspan dy=\"-0.20em\"> &lt; k</tspan>\
             <tspan dy=\"0.28em\" font-size=\"72%\">2</tspan>"
        );
        assert_eq!(markup("a & \"b\"\u{7}"), "a &amp; &quot;b&quot; ");
    }

    #[test]
    fn contract_lines_hold_every_word_within_the_width() {
        let text = "study ssvi, omega = 6.28 rad/s, t0 = 50 s, T = 100 s; Retune, hybrid, rtol 1e-10";
        let broken = lines(text, 8.0, 100.0);
        assert_eq!(broken.join(" "), text);
        assert!(broken.len() > 2 && broken.iter().all(|line| 8.0 * ems(line) <= 100.0), "{broken:?}");
        assert_eq!(lines("antidisestablishmentarianism", 8.0, 10.0).len(), 1);
        assert!(lines("", 8.0, 10.0).is_empty());
    }
}
