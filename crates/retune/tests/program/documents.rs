//! The files, commands and studies that the documents name exist.

use retune_testkit::desk::committed;
use retune_testkit::scenes;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn text(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The texts between backticks: every second piece.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

const DOCUMENTS: [&str; 16] = [
    "README.md",
    "ARCHITECTURE.md",
    "docs/decisions.md",
    "docs/tuning.md",
    "docs/scale.md",
    "docs/theory.md",
    "docs/nomenclature.md",
    "docs/tutorial.md",
    "docs/bounds.md",
    "docs/proof.md",
    "docs/performance.md",
    "docs/python.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "results/robustness/README.md",
];

#[test]
fn contract_every_path_of_the_documents_exists() {
    for (document, least) in DOCUMENTS.into_iter().zip([3, 15, 1, 1, 2, 0, 0, 1, 0, 0, 0, 0, 0, 2, 0, 0]) {
        let text = text(document);
        let places = ["crates/", "deploy/", "docs/", "results/", "studies/", "tests/"];
        let linked = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let paths: Vec<&str> = quoted(&text)
            .chain(linked)
            .filter(|word| {
                places.iter().any(|place| word.starts_with(place) || *word == place.trim_end_matches('/'))
            })
            .filter(|word| !word.contains(['<', '*', ' ']))
            .collect();
        assert!(paths.len() >= least, "{document}: {paths:?}");
        for path in paths {
            let file = path.split('#').next().unwrap_or_default();
            assert!(root().join(file).exists(), "{document} names {path}");
        }
    }
}

/// The recipes of a justfile, with their aliases.
fn recipes(justfile: &str) -> Vec<String> {
    let text = text(justfile);
    let aliases = text.lines().filter_map(|line| line.strip_prefix("alias ")?.split(" :=").next());
    text.lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_lowercase()) && !line.contains(":="))
        .filter(|line| line.contains(':'))
        .filter_map(|line| line.split([' ', ':']).next())
        .chain(aliases)
        .map(str::to_owned)
        .collect()
}

#[test]
fn contract_every_recipe_of_the_documents_exists() {
    let (top, lab) = (recipes("justfile"), recipes("lab.just"));
    assert!(text("justfile").contains("\nmod lab 'lab.just'\n"));
    let mut seen = 0;
    for document in DOCUMENTS {
        let text = text(document);
        let commands = quoted(&text).chain(text.lines().filter_map(|line| line.split("&& ").nth(1)));
        for command in commands.filter_map(|command| command.strip_prefix("just ")) {
            let (among, command) = match command.strip_prefix("lab ") {
                Some(rest) => (&lab, rest),
                None => (&top, command),
            };
            let recipe = command.split_whitespace().next().unwrap_or_default();
            let exists = recipe == "lab" || among.iter().any(|known| known == recipe);
            assert!(exists, "{document} names `just {command}`, not among {among:?}");
            seen += 1;
        }
    }
    assert!(seen >= 12, "{seen}");
}

/// A command run through just accepts options, `--resume` among them; and the command that resumes a run, which
/// then begins with `just`, is a recipe.
#[test]
fn contract_every_recipe_takes_options_and_a_stopped_run_has_a_recipe_to_go_on_with() {
    let justfile = text("justfile");
    assert!(justfile.contains("\nset positional-arguments\n"));
    assert!(justfile.contains("\nexport RETUNE_RUN_AS := \"just\"\n"));
    let commands: Vec<&str> =
        justfile.lines().filter_map(|line| line.strip_prefix("    {{retune}} ")).collect();
    let of = |command: &str| commands.iter().filter(|line| line.starts_with(&format!("{command} "))).count();
    assert!(of("optimize") >= 3, "{commands:?}");
    for line in
        commands.iter().filter(|line| !["schema ", "prove results/"].iter().any(|of| line.starts_with(of)))
    {
        assert!(line.ends_with(" \"$@\""), "{line}");
    }
    for command in [
        "optimize",
        "design",
        "merge",
        "certify",
        "table2",
        "retention",
        "fronts",
        "branches",
        "reproduce",
        "figure",
        "table",
    ] {
        let body = format!("\n    {{{{retune}}}} {command} \"$@\"\n");
        let recipe =
            justfile.split(&body).next().and_then(|before| before.lines().last()).unwrap_or_default();
        assert!(recipe.starts_with(&format!("{command} ")), "{command}: {recipe}");
        assert!(recipe.contains(" *OPTIONS:") || recipe.contains(" +K1:"), "{recipe}");
    }
}

/// The tests' own scene of the paper is that of the studies.
#[test]
fn contract_the_scene_of_the_tests_is_that_of_the_studies() {
    for (name, numbers) in [("ssvi-resonance.json", scenes::SSVI), ("tmd-resonance.json", scenes::TMD)] {
        let scene: retune_model::Scene =
            serde_json::from_value(committed(name)["scene"].clone()).expect("a scene");
        assert_eq!(scene, numbers.scene(), "{name}");
    }
}
