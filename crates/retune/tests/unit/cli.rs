//! The options of the commands.

use super::Cli;
use clap::CommandFactory;

/// Every command that computes has the options that mean the same everywhere, with the same words, and those that make results have a place
/// for them.
#[test]
fn contract_common_options_mean_the_same_of_every_command() {
    let cli = Cli::command();
    let words = |command: &str, option: &str| {
        let command = cli.find_subcommand(command).expect("a command");
        let argument = command.get_arguments().find(|argument| argument.get_long() == Some(option))?;
        argument.get_help().map(ToString::to_string)
    };
    let prints_text = ["explore", "schema", "completions", "help"];
    let makes_no_directory = ["verify", "simulate", "check", "evaluate", "prove"];
    let mut seen = 0;
    for command in
        cli.get_subcommands().map(clap::Command::get_name).filter(|name| !prints_text.contains(name))
    {
        for option in ["threads", "quiet", "json"] {
            let own = command == "evaluate"; // it answers line by line, and says so
            assert!(words(command, option).is_some(), "{command} --{option}");
            assert!(own || words(command, option) == words("optimize", option), "{command} --{option}");
        }
        if !makes_no_directory.contains(&command) {
            assert_eq!(words(command, "out"), words("optimize", "out"), "{command}");
            seen += 1;
        }
    }
    assert_eq!(words("explore", "threads"), words("optimize", "threads"));
    assert!(seen >= 12, "{seen}");
}

/// What a shell completes are the names of the catalogue; what is typed wrong is refused in its words, without the list of the shell's.
#[test]
fn contract_values_are_completed() {
    let mut script = Vec::new();
    clap_complete::generate(clap_complete::Shell::Bash, &mut Cli::command(), "retune", &mut script);
    let script = String::from_utf8(script).expect("text");
    let completed = |option: &str, word: &str| {
        let case = format!("--{option})");
        let choices = script.split(&case).skip(1).filter_map(|rest| rest.split('"').nth(1));
        choices.filter(|names| names.split(' ').any(|name| name == word)).count()
    };
    assert_eq!((completed("over", "omega"), completed("over", "m1")), (2, 1), "sweep and branches");
    assert_eq!(completed("quantity", "contact_pressure"), 1);
    assert_eq!(completed("set", "restitution="), 2, "simulate and prove");
    assert_eq!(
        [("goal", "a1max"), ("limit", "stroke="), ("damper", "ssvi")]
            .map(|(option, word)| completed(option, word)),
        [1; 3]
    );
    let refused =
        |words: &[&str]| <Cli as clap::Parser>::try_parse_from(words).expect_err("wrong").to_string();
    let said = refused(&["retune", "sweep", "a.json", "--over", "omga", "--from", "1", "--to", "2"]);
    assert!(said.contains("omga") && !said.contains("possible values"), "{said}");
    let said = refused(&["retune", "simulate", "a.json", "--set", "k3=1"]);
    assert!(said.contains("k3") && !said.contains("possible values"), "{said}");
}
