//! The tables of the catalogue in docs/nomenclature.md: `RETUNE_CATALOGUE=write` writes them anew.

use retune_model::{Measure, Parameter};
use std::path::{Path, PathBuf};

const BEGIN: &str = "<!-- the catalogue -->\n";
const END: &str = "<!-- the end of the catalogue -->\n";

/// The tables as the catalogue has them.
fn tables() -> String {
    let mut text =
        "| parameter | what it is | unit | also in | varied by searches |\n| --- | --- | --- | --- | --- |\n"
            .to_owned();
    for parameter in Parameter::ALL {
        let units: Vec<&str> = parameter.units().iter().skip(1).map(|(name, _)| *name).collect();
        let unit = if parameter.unit().is_empty() { "1" } else { parameter.unit() };
        let varied = if Parameter::VARIED.contains(&parameter) { "yes" } else { "" };
        text += &format!(
            "| `{parameter}` | {} | {unit} | {} | {varied} |\n",
            parameter.words(),
            units.join(", ")
        );
    }
    text += "\n| quantity | what it is | unit |\n| --- | --- | --- |\n";
    for measure in Measure::every() {
        text += &format!("| `{}` | {} | {} |\n", measure.name(), measure.words(), measure.unit());
    }
    text + "\n"
}

#[test]
fn contract_the_nomenclature_has_the_tables_of_the_catalogue() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/nomenclature.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let (before, rest) = page.split_once(BEGIN).expect("where the tables begin");
    let (found, after) = rest.split_once(END).expect("where they end");
    if std::env::var("RETUNE_CATALOGUE").is_ok_and(|mode| mode == "write") {
        std::fs::write(&path, [before, BEGIN, &tables(), END, after].concat()).expect("the page is written");
        return;
    }
    assert_eq!(found, tables(), "write them anew with RETUNE_CATALOGUE=write");
}

/// Names, units and words of the catalogue are written once: the descriptions of the schema, which stand beside the fields of a scene, begin with them.
#[test]
fn contract_the_schema_describes_parameters_as_the_catalogue_does() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/study.schema.json");
    let schema: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(path).expect("a schema")).expect("JSON");
    let mut count = 0;
    for part in ["Primary", "Forcing", "Damper", "Surfaces", "Loss"] {
        for (name, field) in schema["$defs"][part]["properties"].as_object().expect("fields") {
            let Ok(parameter) = name.parse::<Parameter>() else { continue };
            let words = field["description"].as_str().unwrap_or_default();
            let expected = parameter.sentence();
            let expected = expected.trim_end_matches('.');
            assert!(words.starts_with(expected), "{part}.{name}: {words}; the catalogue has {expected}");
            count += 1;
        }
    }
    assert_eq!(count, Parameter::ALL.len());
}

/// The sources below a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let below = |path: PathBuf| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        match ending {
            _ if path.is_dir() => sources(&path),
            Some("rs" | "py" | "js") => vec![path],
            _ => Vec::new(),
        }
    };
    entries.flat_map(below).collect()
}

/// The words of the catalogue stand nowhere else in what makes screens, pages and files: a second list would drift.
#[test]
fn contract_no_second_list_of_words() {
    let words: Vec<&str> = Parameter::ALL
        .map(Parameter::words)
        .into_iter()
        .chain(Measure::every().map(Measure::words))
        .collect();
    let crates = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("..")).expect("the crates");
    let others = crates.flatten().map(|entry| entry.path()).filter(|path| !path.ends_with("model"));
    let all: Vec<PathBuf> = others
        .flat_map(|one| ["src", "page", "python"].map(|folder| sources(&one.join(folder))))
        .flatten()
        .collect();
    for path in &all {
        let text = std::fs::read_to_string(path).expect("a source");
        for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
            let again = words.iter().find(|words| line.contains(&format!("\"{words}\"")));
            assert!(again.is_none(), "{}: {line}", path.display());
        }
    }
    assert!(all.len() > 250, "{} files looked at", all.len());
}
