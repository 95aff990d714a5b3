//! Records that a study names: read from their files, line by line.

use super::format::Study;
use super::rule::Rule;
use retune_model::{Column, Forcing, Of, Record, RecordFile, Samples, Scene, Spacing, Unit, unit};
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read, Seek};
use std::path::Path;

/// Reads the record of a scene, if it names a file with one; a path that is not absolute begins at `base`.
pub(super) fn read(scene: &mut Scene, base: &Path) -> Result<(), Rule> {
    read_forcing(&mut scene.forcing, false, base)
}

/// Like [`read`], for all records of a study.
pub(super) fn read_all(study: &mut Study, base: &Path) -> Result<(), Rule> {
    read(&mut study.scene, base)?;
    each(study, &mut |forcing| read_forcing(forcing, true, base))
}

/// Applies `change` to each record of the objective of a study, until one fails.
pub(super) fn each<E>(
    study: &mut Study,
    change: &mut impl FnMut(&mut Forcing) -> Result<(), E>,
) -> Result<(), E> {
    let Some(optimize) = &mut study.optimize else { return Ok(()) };
    let mut done = Ok(());
    optimize.objective.for_each_term(&mut |term| {
        for forcing in &mut term.records {
            if done.is_ok() {
                done = change(forcing);
            }
        }
    });
    done
}

fn read_forcing(forcing: &mut Forcing, listed: bool, base: &Path) -> Result<(), Rule> {
    named(forcing, base).map_err(|(file, problem)| Rule::Record { listed, file, problem })
}

/// Reads the record of a forcing, if it names a file with one; a path that is not absolute begins at `base`.
///
/// # Errors
/// The file, and why it is no record.
pub fn read_record(forcing: &mut Forcing, base: &Path) -> Result<(), String> {
    named(forcing, base).map_err(|(file, problem)| format!("{file}: {problem}"))
}

fn named(forcing: &mut Forcing, base: &Path) -> Result<(), (String, String)> {
    let Some((of, record)) = forcing.record_mut() else { return Ok(()) };
    if record.samples().is_none() {
        *record = whole(of, record, base).map_err(|problem| (record.source().file.clone(), problem))?;
    }
    Ok(())
}

fn whole(of: Of, record: &Record, base: &Path) -> Result<Record, String> {
    let source = record.source();
    let path = base.join(&source.file);
    let file = File::open(&path).map_err(|error| format!("cannot be read: {error}"))?;
    Ok(record.with(samples(of, source, file)?))
}

/// The samples of a file, by the ending of its name.
fn samples(of: Of, source: &RecordFile, file: impl Read + Seek) -> Result<Samples, String> {
    let extension = Path::new(&source.file).extension();
    let is_at2 = extension.is_some_and(|extension| extension.eq_ignore_ascii_case("at2"));
    if is_at2 { at2(of, source, Lines::of(file)) } else { csv(of, source, file) }
}

/// Reads the record of a forcing, if it names a file with one, from that file's text. The study then contains the samples.
///
/// # Errors
/// The text holds no record: the line, and what is wrong with it.
pub fn read_record_text(forcing: &mut Forcing, text: &str) -> Result<(), String> {
    let Some((of, record)) = forcing.record_mut() else { return Ok(()) };
    *record = record.with(samples(of, record.source(), Cursor::new(text))?).whole();
    Ok(())
}

/// The lines of a file, one at a time.
struct Lines<R> {
    file: BufReader<R>,
    line: String,
    number: usize,
}

impl<R: Read> Lines<R> {
    fn of(file: R) -> Self {
        Self { file: BufReader::new(file), line: String::new(), number: 0 }
    }

    /// The next non-blank line.
    fn next(&mut self) -> Result<Option<&str>, String> {
        loop {
            self.line.clear();
            self.number += 1;
            let read = self.file.read_line(&mut self.line);
            match read.map_err(|error| format!("line {}: {error}", self.number))? {
                0 => return Ok(None),
                _ if self.line.trim().is_empty() => {}
                _ => return Ok(Some(self.line.trim().trim_start_matches('\u{feff}'))),
            }
        }
    }
}

/// The factor from the numbers of a file to the unit of the record.
fn factor(source: &RecordFile, own: Unit) -> f64 {
    let (_, size) = source.unit.unwrap_or(own);
    size * source.scale.map_or(1.0, |scale| scale.get())
}

/// Reads CSV with a header and the time in the first column. Times are stored only if they are not equidistant: the file is then
/// read a second time.
fn csv(of: Of, source: &RecordFile, mut file: impl Read + Seek) -> Result<Samples, String> {
    let factor = factor(source, of.units()[0]);
    let delimiter = separator(&mut file)?;
    let mut table = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .flexible(true)
        .trim(csv::Trim::Headers)
        .from_reader(file);
    let names = table.headers().map_err(|error| error.to_string())?.clone();
    if names.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err("line 1: is no header: give the names of its columns, the time first".to_owned());
    }
    let place = column(source.column.as_ref(), &names)?;
    units_of(&names, place, of, source)?;
    let begin = table.position().clone();
    let (mut spacing, mut values) = (Spacing::default(), Vec::new());
    let even = rows(&mut table, place, |t, value| {
        values.push(value);
        spacing.push(t)
    })?;
    let samples = match spacing.even().filter(|_| even) {
        Some([first, step]) => Samples::every(first, step, values),
        None => {
            table.seek(begin).map_err(|error| error.to_string())?;
            let mut times = Vec::new();
            values.clear();
            rows(&mut table, place, |t, value| {
                times.push(t);
                values.push(value);
                true
            })?;
            Samples::at(times, values)
        }
    };
    samples.and_then(|samples| samples.times(factor)).map_err(|bad| bad.to_string())
}

/// Units of time other than s, as spelled in headers.
const NOT_SECONDS: [&str; 5] = ["ms", "msec", "us", "µs", "min"];

/// Refuses a header whose units differ from those in which the columns are read.
fn units_of(names: &csv::StringRecord, place: usize, of: Of, source: &RecordFile) -> Result<(), String> {
    // `a (g)`, `t [ms]`
    fn unit_in(name: &str) -> Option<&str> {
        let (_, unit) = name.strip_suffix([')', ']'])?.rsplit_once(['(', '['])?;
        Some(unit.trim())
    }
    if let Some(unit) = unit_in(&names[0]).filter(|unit| NOT_SECONDS.contains(unit)) {
        return Err(format!("line 1: \"{}\" is in {unit}: give times in s", &names[0]));
    }
    let (name, own) = (&names[place], of.units()[0]);
    let known = unit_in(name).and_then(|text| unit::named(text, of.units()));
    match known.filter(|unit| source.unit.is_none() && unit.1 != own.1) {
        None => Ok(()),
        Some((unit, _)) => Err(format!("line 1: \"{name}\" is in {unit}: say so, \"unit\": \"{unit}\"")),
    }
}

/// Passes the time and the value of each row to `each`, until it returns false; returns whether all rows were passed.
fn rows(
    table: &mut csv::Reader<impl Read>,
    place: usize,
    mut each: impl FnMut(f64, f64) -> bool,
) -> Result<bool, String> {
    let mut row = csv::StringRecord::new();
    while table.read_record(&mut row).map_err(|error| error.to_string())? {
        let line = row.position().map_or(0, csv::Position::line);
        let at = |place: usize| {
            let field = row.get(place).ok_or_else(|| format!("line {line}: too few columns"))?.trim();
            field.parse::<f64>().map_err(|_| format!("line {line}: \"{field}\" is not a number"))
        };
        if !each(at(0)?, at(place)?) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The column delimiter, guessed from the first line. Rewinds the file.
fn separator(file: &mut (impl Read + Seek)) -> Result<u8, String> {
    let mut lines = Lines::of(&mut *file);
    let head = lines.next()?.ok_or("is empty")?;
    let delimiter = [',', ';', '\t'].into_iter().find(|delimiter| head.contains(*delimiter)).unwrap_or(',');
    file.rewind().map_err(|error| format!("cannot be read: {error}"))?;
    Ok(delimiter as u8)
}

/// The index of the column of the values.
fn column(wanted: Option<&Column>, names: &csv::StringRecord) -> Result<usize, String> {
    if let Some(Column::Name(wanted)) = wanted {
        let same: Vec<String> =
            (1..).zip(names).filter(|(_, name)| name == wanted).map(|(i, _)| i.to_string()).collect();
        if let [first, second, ..] = &*same {
            return Err(format!(
                "its columns {first} and {second} are both called \"{wanted}\": give the number of the column"
            ));
        }
    }
    let place = match wanted {
        None => Some(1),
        Some(Column::Number(number)) => number.checked_sub(1),
        Some(Column::Name(wanted)) => names.iter().position(|name| name == wanted),
    };
    place.filter(|place| (1..names.len()).contains(place)).ok_or_else(|| {
        let wanted = match wanted {
            None => "no second column".to_owned(),
            Some(Column::Number(number)) => format!("no values in a column {number}"),
            Some(Column::Name(name)) => format!("no values in a column \"{name}\""),
        };
        let names: Vec<String> =
            names.iter().enumerate().map(|(i, name)| format!("{} \"{name}\"", i + 1)).collect();
        format!("has {wanted}: its columns are {}, the first that of the time", names.join(", "))
    })
}

/// Reads PEER's AT2: accelerations in g after a header of four lines, the last of which gives the number of samples and their spacing.
fn at2(of: Of, source: &RecordFile, mut lines: Lines<impl Read>) -> Result<Samples, String> {
    if of != Of::BaseAcceleration {
        return Err("an AT2 file holds accelerations: give \"of\": \"base acceleration\"".to_owned());
    }
    if source.column.is_some() {
        return Err("an AT2 file has no columns: leave out `column`".to_owned());
    }
    let g = unit::named("g", of.units()).unwrap_or(("g", f64::NAN));
    let factor = factor(source, g);
    let mut head = None;
    for _ in 0..4 {
        head = lines.next()?.and_then(spacing);
        if head.is_some() {
            break;
        }
    }
    let (count, step) =
        head.ok_or("its first four lines do not tell NPTS and DT, as those of an AT2 file do")?;
    let mut values = Vec::new();
    loop {
        let number = lines.number + 1;
        let Some(line) = lines.next()? else { break };
        for field in line.split_whitespace() {
            let value: Result<f64, _> = field.parse();
            values.push(value.map_err(|_| format!("line {number}: \"{field}\" is not a number"))?);
        }
    }
    if values.len() != count {
        return Err(format!("has {} values, but says NPTS = {count}", values.len()));
    }
    Samples::every(0.0, step, values).and_then(|samples| samples.times(factor)).map_err(|bad| bad.to_string())
}

/// Number and spacing (s) of the samples: `NPTS= 4000, DT= .0050 SEC`, or in older files `4000 .0050 NPTS, DT`.
fn spacing(line: &str) -> Option<(usize, f64)> {
    let upper = line.to_uppercase();
    if !(upper.contains("NPTS") && upper.contains("DT")) {
        return None;
    }
    let mut numbers = upper
        .split(|c: char| c.is_whitespace() || c == ',' || c == '=')
        .filter_map(|word| word.trim_end_matches("SEC").parse::<f64>().ok());
    let (count, step) = (numbers.next()?, numbers.next()?);
    (count >= 0.0 && count.fract() == 0.0).then_some((count as usize, step))
}

#[cfg(test)]
mod tests {
    use super::*;
    use retune_model::Course;

    fn file(name: &str, text: &str) -> std::path::PathBuf {
        let place = std::env::temp_dir().join(format!("retune-records-{}", std::process::id()));
        std::fs::create_dir_all(&place).expect("a directory");
        let path = place.join(name);
        std::fs::write(&path, text).expect("a file");
        path
    }

    fn scene(record: serde_json::Value) -> Scene {
        let primary = serde_json::json!({ "m1": 1.0, "c1": 0.0, "k1": 1.0 });
        serde_json::from_value(serde_json::json!({ "primary": primary, "forcing": record })).expect("a scene")
    }

    fn values(samples: Samples) -> Vec<f64> {
        samples.values().collect()
    }

    fn samples(name: &str, text: &str, more: serde_json::Value) -> Result<Samples, String> {
        let path = file(name, text);
        let mut forcing = serde_json::json!({ "record": name, "of": "base acceleration" });
        forcing.as_object_mut().expect("an object").extend(more.as_object().expect("an object").clone());
        let mut scene = scene(forcing);
        read(&mut scene, path.parent().expect("a directory")).map_err(|rule| rule.to_string())?;
        let retune_model::Source::History(history) = scene.forcing.source else { panic!("a history") };
        let Course::Record(record) = history.course else { panic!("a record") };
        Ok(record.samples().expect("read"))
    }

    #[test]
    fn exact_records_are_read_in_si_units() {
        let none = serde_json::json!({});
        let found = samples("si.csv", "t,a,b\n0,1,4\n0.5,-2,5\n2,3,6\n", none.clone()).expect("a record");
        assert_eq!((values(found), found.time(1), found.end()), (vec![1.0, -2.0, 3.0], 0.5, 2.0));
        let more = serde_json::json!({ "column": "b", "unit": "g", "scale": -2.0 });
        let found = samples("b.csv", "\u{feff}t;a;\"b\"\n\n0;1;4\n0.1;2;5\n", more).expect("a record");
        assert_eq!(values(found), [-2.0 * 9.80665 * 4.0, -2.0 * 9.80665 * 5.0]);
        let found =
            samples("c.csv", "t (s),a (g),b (m/s²)\n0,1,4\n0.1,2,5\n", serde_json::json!({ "column": 3 }));
        assert_eq!(values(found.expect("a record")), [4.0, 5.0]);
        for head in ["NPTS=   5, DT=   .0050 SEC", "   5   .0050   NPTS, DT"] {
            let text =
                format!("PEER\nA QUAKE 2\nACCELERATION IN UNITS OF G\n{head}\n .1E-01 -.2E-01\n 0 1 2\n");
            let found = samples("d.AT2", &text, none.clone()).expect("a record");
            assert_eq!(found.even(), Some([0.0, 0.005]));
            assert_eq!(found.value(1), 9.80665 * -0.02);
        }
        // Times rounded to decimals count as equidistant.
        let text: String = (0..500).map(|i| format!("{:.3},{i}\n", 0.005 * f64::from(i))).collect();
        let found = samples("e.csv", &format!("t,a\n{text}"), none).expect("a record");
        assert!(found.even().is_some_and(|[_, step]| (step - 0.005).abs() < 1e-15));
    }

    #[test]
    fn contract_what_is_no_record_is_refused_with_the_file() {
        let none = serde_json::json!({});
        let column = serde_json::json!({ "column": "c" });
        let first = serde_json::json!({ "column": 1 });
        let same = serde_json::json!({ "column": "a" });
        let head = "a\nb\nc\nNPTS= 3, DT= .01 SEC\n";
        for (name, text, more, said) in [
            ("a.csv", "", &none, "is empty"),
            ("a.csv", "t,a\n", &none, "it has 0 samples: give at least two"),
            ("a.csv", "t,a\n0,1\n", &none, "it has 1 sample:"),
            ("a.csv", "0,1\n1,2\n", &none, "line 1: is no header"),
            ("a.csv", "t,a\n0,1\n1,x\n", &none, "line 3: \"x\" is not a number"),
            ("a.csv", "t,a\n0,1\n\n1\n", &none, "too few columns"),
            ("a.csv", "t,a\n0,1\n1,NaN\n", &none, "sample 2: NaN is not allowed"),
            ("a.csv", "t,a\n1,1\n0,1\n", &none, "sample 2: the time 0 s does not come after"),
            (
                "a.csv",
                "t,a\n0,1\n1,2\n",
                &column,
                "no values in a column \"c\": its columns are 1 \"t\", 2 \"a\"",
            ),
            ("a.csv", "t,a\n0,1\n1,2\n", &first, "no values in a column 1"),
            ("a.csv", "t,a,a\n0,1,2\n1,2,2\n", &same, "its columns 2 and 3 are both called \"a\""),
            ("a.csv", "t,a\n0,1\n1e-320,2\n1,2\n", &none, "sample 2: it comes only 1e-320 s after"),
            ("a.csv", "t\n0\n1\n", &none, "no second column"),
            ("a.csv", "t [ms],a\n0,1\n1,2\n", &none, "line 1: \"t [ms]\" is in ms: give times in s"),
            ("a.csv", "t (s),a (g)\n0,1\n1,2\n", &none, "\"a (g)\" is in g: say so, \"unit\": \"g\""),
            ("a.at2", "1\n2\n3\n4\n5\n", &none, "do not tell NPTS and DT"),
            ("a.at2", &format!("{head}1 2"), &none, "has 2 values, but says NPTS = 3"),
            ("a.at2", &format!("{head}1 2 3x"), &none, "line 5: \"3x\" is not a number"),
            ("a.at2", &format!("{head}1 2 3"), &column, "has no columns"),
        ] {
            let error = samples(name, text, more.clone()).expect_err(said);
            assert!(error.contains(said) && error.starts_with("scene.forcing.record: a."), "{error}");
        }
        let mut missing = scene(serde_json::json!({ "record": "none.csv", "of": "force" }));
        let error = read(&mut missing, Path::new("")).expect_err("no file").to_string();
        assert!(error.starts_with("scene.forcing.record: none.csv: cannot be read"), "{error}");
    }
}
