//! Ctrl-C and SIGTERM. The journal already holds everything computed so far, so nothing needs to be saved: the process prints the
//! command that resumes the work and exits. (On systems without signals, Ctrl-C ends it without a message, and nothing is lost either.)

use std::ffi::OsString;
use std::sync::OnceLock;

/// An environment variable that replaces the program's name in printed commands. The justfile sets it to `just`, since its recipes are
/// named like the commands.
pub const RUN_AS: &str = "RETUNE_RUN_AS";

/// The words of the command line of this process.
static WORDS: OnceLock<Vec<OsString>> = OnceLock::new();

/// Remembers the words of the command line, for the command that resumes the work.
pub fn remember(words: Vec<OsString>) {
    let _ = WORDS.set(words);
}

/// From now on, Ctrl-C ends the process and prints the command that resumes the work.
#[cfg(unix)]
pub fn say_how_to_resume() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::io::Write;
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        // SIGHUP is not handled, so that `nohup` works as usual. Without `nohup` it ends the run, which can still be resumed.
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else { return };
        let wait = move || {
            if signals.forever().next().is_some() {
                let words =
                    resume_command(std::env::var(RUN_AS).ok(), WORDS.get().into_iter().flatten().cloned());
                let words = retune_study::visible(&words).into_owned();
                let _ = writeln!(
                    std::io::stderr(),
                    "\nstopped; what was computed is kept. To resume:\n  {words}"
                );
                std::process::exit(crate::exit::STOPPED.into());
            }
        };
        let _ = std::thread::Builder::new().name("signals".to_owned()).spawn(wait);
    });
}

/// From now on, Ctrl-C ends the process and prints the command that resumes the work.
#[cfg(not(unix))]
pub fn say_how_to_resume() {}

/// The command line that resumes the work of this one. `run_as` replaces the program's name, if it is given.
#[cfg(unix)]
fn resume_command(run_as: Option<String>, mut arguments: impl Iterator<Item = OsString>) -> String {
    let program = arguments.next().unwrap_or_else(|| "retune".into());
    let mut words = vec![run_as.unwrap_or_else(|| quoted(&program))];
    words
        .extend(arguments.filter(|word| word != "--resume" && word != "--restart").map(|word| quoted(&word)));
    words.push("--resume".to_owned());
    words.join(" ")
}

/// A word quoted for a shell and safe for a terminal: control characters and bytes that are not UTF-8 as `$'\x1b'`.
#[cfg(unix)]
fn quoted(word: &std::ffi::OsStr) -> String {
    use std::os::unix::ffi::OsStrExt;
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
    match word.to_str() {
        Some(text) if !text.is_empty() && text.chars().all(plain) => text.to_owned(),
        Some(text) if !text.contains(char::is_control) => format!("'{}'", text.replace('\'', "'\\''")),
        _ => {
            let byte = |byte: &u8| match byte {
                b' '..=b'~' if !b"'\\".contains(byte) => char::from(*byte).to_string(),
                _ => format!("\\x{byte:02x}"),
            };
            format!("$'{}'", word.as_bytes().iter().map(byte).collect::<String>())
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::resume_command;
    use std::ffi::{OsStr, OsString};
    use std::os::unix::ffi::OsStrExt;

    fn said(run_as: Option<&str>, words: &[&[u8]]) -> String {
        resume_command(
            run_as.map(str::to_owned),
            words.iter().map(|word| OsString::from(OsStr::from_bytes(word))),
        )
    }

    #[test]
    fn contract_the_command_that_resumes_is_valid_in_a_shell() {
        assert_eq!(said(None, &[b"retune", b"optimize", b"a.json"]), "retune optimize a.json --resume");
        assert_eq!(
            said(
                None,
                &[b"/opt/my tools/retune", b"optimize", b"my study.json", b"--restart", b"--out", b"it's"]
            ),
            "'/opt/my tools/retune' optimize 'my study.json' --out 'it'\\''s' --resume"
        );
        assert_eq!(
            said(None, &[b"retune", b"retention", b"3e4", b"--resume"]),
            "retune retention 3e4 --resume"
        );
        assert_eq!(
            said(
                Some("just"),
                &[b"target/release/retune", b"optimize", b"studies/ssvi.json", b"--threads", b"1"]
            ),
            "just optimize studies/ssvi.json --threads 1 --resume"
        );
    }

    /// A shell parses the quoted words back to the originals.
    #[test]
    fn contract_any_argument_survives_a_shell() {
        let words: [&[u8]; 6] = [b"printf", b"%s|", b"it's", b"\x1b[31m", b"\xff\xfe\\'", b"tab\tand\nline"];
        let line = said(None, &words);
        assert!(!line.contains(char::is_control), "{line}");
        let output = std::process::Command::new("bash").args(["-c", &line]).output().expect("bash");
        let expected = [&words[2..].join(&b'|'), b"|--resume|".as_slice()].concat();
        assert_eq!(output.stdout, expected, "{line}");
    }
}
