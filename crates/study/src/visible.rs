//! Text that is safe to show on a terminal.

use std::borrow::Cow;

/// The text with control characters escaped: the name of a file or a study must not control the terminal. Line ends and tabs
/// stay. The escapes are those of JSON, so a JSON text keeps its meaning.
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_control) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_control(c) {
            shown += &format!("\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    shown.into()
}

/// Whether a character may control a terminal: control characters, and those that change the direction of writing.
fn is_control(c: char) -> bool {
    const TURNS: [std::ops::RangeInclusive<char>; 3] =
        ['\u{200e}'..='\u{200f}', '\u{202a}'..='\u{202e}', '\u{2066}'..='\u{2069}'];
    c.is_control() && !['\n', '\t'].contains(&c) || TURNS.iter().any(|turns| turns.contains(&c))
}

#[cfg(test)]
mod tests {
    use super::visible;

    #[test]
    fn contract_control_characters_are_escaped() {
        assert_eq!(visible("a\tb\nÄ √ N·s/m"), "a\tb\nÄ √ N·s/m");
        assert_eq!(
            visible("\u{1b}[2Jx\r\u{7}\u{9b}\u{7f}\u{202e}"),
            "\\u001b[2Jx\\u000d\\u0007\\u009b\\u007f\\u202e"
        );
        for c in (0..=0x10_ffff).filter_map(char::from_u32).filter(|c| c.is_control()) {
            assert_eq!(visible(&c.to_string()) == c.to_string(), c == '\n' || c == '\t', "{c:?}");
        }
        let json = serde_json::to_string("a\u{1b}\u{9b}\u{7f}\r\n\u{202e}").expect("JSON");
        let read: String = serde_json::from_str(&visible(&json)).expect("JSON still");
        assert_eq!(read, "a\u{1b}\u{9b}\u{7f}\r\n\u{202e}");
    }
}
