//! Ctrl-C and SIGTERM. All that was computed is in the journal at any moment, so there is nothing to save: the process says how
//! to go on, and ends. (Where there are no signals, Ctrl-C ends it without a word, and nothing is lost either.)

/// The exit code of a run that was stopped.
#[cfg(unix)]
const STOPPED: i32 = 130;

/// From now on, Ctrl-C ends the process with the command that goes on.
#[cfg(unix)]
pub fn say_how_to_go_on() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::io::Write;
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        // SIGHUP is not among them: `nohup` must keep its meaning, and without it the run ends and can go on all the same.
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else { return };
        let wait = move || {
            if signals.forever().next().is_some() {
                let words = crate::screen::visible(&go_on(std::env::args())).into_owned();
                let _ =
                    writeln!(std::io::stderr(), "\nstopped; what was computed is kept. To go on:\n  {words}");
                std::process::exit(STOPPED);
            }
        };
        let _ = std::thread::Builder::new().name("signals".to_owned()).spawn(wait);
    });
}

/// From now on, Ctrl-C ends the process with the command that goes on.
#[cfg(not(unix))]
pub fn say_how_to_go_on() {}

/// The command line that goes on with the work of this one.
#[cfg_attr(not(unix), allow(dead_code))]
fn go_on(arguments: impl Iterator<Item = String>) -> String {
    let mut words: Vec<String> =
        arguments.filter(|word| word != "--resume" && word != "--restart").map(quoted).collect();
    words.push("--resume".to_owned());
    words.join(" ")
}

/// A word as a shell takes it.
#[cfg_attr(not(unix), allow(dead_code))]
fn quoted(word: String) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::go_on;

    #[test]
    fn exact_the_command_that_goes_on_is_one_that_a_shell_takes() {
        let said = |words: &[&str]| go_on(words.iter().map(|word| (*word).to_owned()));
        assert_eq!(said(&["retune", "optimize", "a.json"]), "retune optimize a.json --resume");
        assert_eq!(
            said(&["retune", "optimize", "my study.json", "--restart", "--out", "it's"]),
            "retune optimize 'my study.json' --out 'it'\\''s' --resume"
        );
        assert_eq!(said(&["retune", "retune", "3e4", "--resume"]), "retune retune 3e4 --resume");
    }
}
