//! The numbers that the documents quote are those of the files that they cite.
//!
//! A comment behind numbers says where they are: `226 J<!-- results/ssvi/optimum.json E1max -->`. With several fields, separated by
//! ` & `, the first is that of the first of as many numbers before the comment; `same` is the field before it. A field is
//! - of a JSON file, the names on the way to it: `refine.runs.0.E1max`;
//! - of a table, a column and what the other columns of its row hold: `E1max[damper=SSVI NES;k2=600]`;
//! - of a text, words of its line in quotes, `"Table 2's row"`: one of the numbers of that line.
//!
//! `* 1000` or `/ 60` behind a field scales it. A number holds if it is the field's at the digits that are printed.

use std::ops::Range;
use std::path::Path;

/// The documents, and the least comments in each.
const DOCUMENTS: [(&str, usize); 6] = [
    ("README.md", 0),
    ("docs/decisions.md", 10),
    ("docs/theory.md", 0),
    ("docs/performance.md", 1),
    ("docs/proof.md", 3),
    ("docs/tuning.md", 1),
];

/// A number of a text as it is printed: its value, its digits behind the point, its power of ten, and where it stands.
#[derive(Clone, Debug, PartialEq)]
struct Printed {
    value: f64,
    decimals: usize,
    power: Option<i32>,
    place: Range<usize>,
}

/// The numbers of a text in their order: `22,000`, `1.5e-4`, `-0.07`. Digits in a word (`k2`) are none.
fn numbers(text: &str) -> Vec<Printed> {
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let (mut found, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        if !digit(at) {
            at += 1;
            continue;
        }
        let in_word = at > 0 && (bytes[at - 1].is_ascii_alphanumeric() || bytes[at - 1] == b'_');
        let begin = at;
        let (mut plain, mut decimals, mut power) = (String::new(), 0, None);
        loop {
            if digit(at) {
                plain.push(char::from(bytes[at]));
                at += 1;
            } else if bytes.get(at) == Some(&b',') && (1..=3).all(|i| digit(at + i)) && !digit(at + 4) {
                at += 1; // of thousands
            } else {
                break;
            }
        }
        if bytes.get(at) == Some(&b'.') && digit(at + 1) {
            plain.push('.');
            at += 1;
            while digit(at) {
                plain.push(char::from(bytes[at]));
                (at, decimals) = (at + 1, decimals + 1);
            }
        }
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'-' | b'+')));
        if bytes.get(at) == Some(&b'e') && digit(at + 1 + sign) {
            let end = (at + 1 + sign..).find(|&i| !digit(i)).unwrap_or(bytes.len());
            power = Some(text[at + 1..end].parse().expect("a power of ten"));
            at = end;
        }
        if in_word {
            continue;
        }
        let minus =
            begin > 0 && bytes[begin - 1] == b'-' && (begin < 2 || !bytes[begin - 2].is_ascii_alphanumeric());
        let value: f64 = format!("{plain}e{}", power.unwrap_or(0)).parse().expect("a number");
        let place = begin - usize::from(minus)..at;
        found.push(Printed { value: if minus { -value } else { value }, decimals, power, place });
    }
    found
}

impl Printed {
    fn is(&self, value: f64) -> bool {
        let half = 0.5 * 10f64.powi(self.power.unwrap_or(0) - self.decimals as i32);
        (self.value - value).abs() <= half * (1.0 + 1e-6)
    }

    /// Another value in its place.
    fn with(&self, value: f64) -> String {
        let decimals = self.decimals;
        if self.power.is_some() {
            return format!("{value:.decimals$e}");
        }
        let plain = format!("{value:.decimals$}");
        let whole = plain.split('.').next().unwrap_or_default().trim_start_matches('-').len();
        let digits = |(at, c): (usize, char)| {
            let comma = whole > 4 && at > 0 && at < whole && (whole - at).is_multiple_of(3);
            comma.then_some(',').into_iter().chain([c]).collect::<Vec<char>>()
        };
        let sign = if plain.starts_with('-') { "-" } else { "" };
        sign.to_owned()
            + &plain.trim_start_matches('-').chars().enumerate().flat_map(digits).collect::<String>()
    }
}

/// The numbers that a field may be: one, but for a line of a text.
fn values(file: &str, field: &str) -> Vec<f64> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{file}: {error}"));
    if let Some(words) = field.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
        let lines: Vec<&str> = text.lines().filter(|line| line.contains(words)).collect();
        assert_eq!(lines.len(), 1, "{file}: lines with {field}");
        return numbers(lines[0]).into_iter().map(|number| number.value).collect();
    }
    if file.ends_with(".json") {
        let whole: serde_json::Value = serde_json::from_str(&text).expect(file);
        let found = field.split('.').fold(&whole, |at, name| match name.parse::<usize>() {
            Ok(place) if at.is_array() => &at[place],
            _ => &at[name],
        });
        return vec![found.as_f64().unwrap_or_else(|| panic!("{file} has no number {field}: {found}"))];
    }
    let (column, rest) = field.split_once('[').unwrap_or_else(|| panic!("{field} of {file} names no row"));
    let wanted: Vec<(&str, &str)> = rest
        .trim_end_matches(']')
        .split(';')
        .map(|pair| pair.split_once('=').unwrap_or_else(|| panic!("{field}: {pair}")))
        .collect();
    let mut table = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
    let names = table.headers().expect(file).clone();
    let place = |name: &str| {
        names.iter().position(|n| n == name).unwrap_or_else(|| panic!("{file}: no column {name}"))
    };
    let same = |found: &str, said: &str| match (found.parse::<f64>(), said.parse::<f64>()) {
        (Ok(found), Ok(said)) => found == said,
        _ => found == said,
    };
    let rows: Vec<csv::StringRecord> = table
        .records()
        .map(|row| row.expect(file))
        .filter(|row| wanted.iter().all(|(name, said)| same(&row[place(name)], said)))
        .collect();
    assert_eq!(rows.len(), 1, "{file}: rows of {field}");
    vec![rows[0][place(column)].parse().unwrap_or_else(|_| panic!("{file}: {field} is no number"))]
}

/// The field and the factor of `E1max * 1000`.
fn scaled(field: &str) -> (&str, f64) {
    for (sign, power) in [(" * ", 1), (" / ", -1)] {
        if let Some((field, by)) = field.rsplit_once(sign) {
            let by: f64 = by.trim().parse().unwrap_or_else(|_| panic!("{field}: {by}"));
            return (field.trim(), by.powi(power));
        }
    }
    (field, 1.0)
}

/// What a text says of the files that it cites.
#[derive(Debug, Default, PartialEq)]
struct Checked {
    /// The comments that name a file.
    count: usize,
    wrong: Vec<String>,
    /// The text with the numbers of the files.
    right: String,
}

fn check(document: &str, text: &str) -> Checked {
    let mut checked = Checked::default();
    let mut pieces = text.split("<!--");
    let mut before = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (comment, rest) = piece.split_once("-->").unwrap_or((piece, ""));
        let is_file = |(file, _): &(&str, &str)| file.starts_with("results/") || file.starts_with("tests/");
        if let Some((file, fields)) = comment.trim().split_once(' ').filter(is_file) {
            checked.count += 1;
            let mut fields: Vec<&str> = fields.split(" & ").map(str::trim).collect();
            for at in 1..fields.len() {
                if fields[at] == "same" {
                    fields[at] = fields[at - 1];
                }
            }
            let printed = numbers(&before);
            let first =
                printed.len().checked_sub(fields.len()).unwrap_or_else(|| panic!("{document}: {comment}"));
            for (printed, field) in printed[first..].iter().zip(fields).rev() {
                let (name, by) = scaled(field);
                let found: Vec<f64> = values(file, name).into_iter().map(|value| value * by).collect();
                if !found.iter().any(|value| printed.is(*value)) {
                    checked
                        .wrong
                        .push(format!("{document} says {}, {file} has {found:?} ({field})", printed.value));
                    if let [value] = found[..] {
                        before.replace_range(printed.place.clone(), &printed.with(value));
                    }
                }
            }
        }
        checked.right += &format!("{before}<!--{comment}-->");
        before = rest.to_owned();
    }
    checked.right += &before;
    checked
}

/// With RETUNE_NUMBERS=write the numbers in the documents become those of the files, but for those of lines of texts.
#[test]
fn contract_numbers_of_the_documents_are_those_of_the_files_that_they_cite() {
    let mut all = Vec::new();
    for (document, least) in DOCUMENTS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(document);
        let found = check(document, &std::fs::read_to_string(&path).expect(document));
        assert!(found.count >= least, "{document}: {} comments name files, not {least}", found.count);
        if std::env::var("RETUNE_NUMBERS").is_ok_and(|what| what == "write") && !found.wrong.is_empty() {
            std::fs::write(&path, found.right).expect(document);
        }
        all.extend(found.wrong);
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
}

#[test]
fn contract_a_wrong_number_is_seen() {
    let value = values("results/ssvi/optimum.json", "E1max")[0];
    let text = |said: f64, digits: usize| {
        format!("k2 is 600 and E1max {said:.digits$} J<!-- results/ssvi/optimum.json E1max -->.")
    };
    for digits in 0..9 {
        let right = text(value, digits);
        assert_eq!(check("text", &right), Checked { count: 1, wrong: Vec::new(), right: right.clone() });
        let next = check("text", &text(value + 10f64.powi(-(digits as i32)), digits));
        assert_eq!((next.wrong.len(), next.right), (1, right), "{digits}");
    }
    let kilojoules = format!(
        "{:.4} kJ and {value:.1}<!-- results/ssvi/optimum.json E1max / 1000 & E1max -->",
        value / 1000.0
    );
    assert_eq!(check("text", &kilojoules).wrong, Vec::<String>::new());
    assert_eq!(numbers("22,000")[0].with(14720.3), "14,720");
    let read: Vec<f64> =
        numbers("k2 of 22,000 N/m, -0.07 to 1.5e-4; 5-8").into_iter().map(|number| number.value).collect();
    assert_eq!(read, [22000.0, -0.07, 1.5e-4, 5.0, 8.0]);
}
