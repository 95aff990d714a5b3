//! Runs the program as a user would, in a directory of its own.

pub use retune_testkit::desk::Desk;
use retune_testkit::desk::count_lines;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// The output of the program.
pub struct Answer {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl From<Output> for Answer {
    fn from(Output { status, stdout, stderr }: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self { code: status.code(), stdout: text(stdout), stderr: text(stderr) }
    }
}

/// The program run in a directory.
pub trait Program {
    fn command(&self, arguments: &[&str]) -> Command;

    fn run(&self, arguments: &[&str]) -> Answer;

    /// Runs a command that must succeed.
    fn good(&self, arguments: &[&str]) -> String;

    /// Runs a command that must be refused without a result; returns its message.
    #[track_caller]
    fn refused(&self, arguments: &[&str]) -> String;
}

impl Program for Desk {
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_retune"));
        // A `just test` must not be told from the tests.
        command.args(arguments).current_dir(self.path(".")).env_remove("RETUNE_RUN_AS");
        command
    }

    fn run(&self, arguments: &[&str]) -> Answer {
        self.command(arguments).output().expect("the program").into()
    }

    fn good(&self, arguments: &[&str]) -> String {
        let Answer { code, stdout, stderr } = self.run(arguments);
        assert_eq!((code, stderr.as_str()), (Some(0), ""), "{arguments:?}");
        stdout
    }

    #[track_caller]
    fn refused(&self, arguments: &[&str]) -> String {
        let Answer { code, stdout, stderr } = self.run(arguments);
        assert_eq!((code, stdout.as_str()), (Some(2), ""), "{arguments:?}: {stderr}");
        stderr
    }
}

/// Starts a run and waits until its journal has `lines` lines.
pub fn begun(desk: &Desk, arguments: &[&str], out: &str, lines: usize) -> Child {
    started(desk.command(arguments), desk, out, lines)
}

/// The same for any command.
pub fn started(mut command: Command, desk: &Desk, out: &str, lines: usize) -> Child {
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program");
    let journal = desk.path(out).join("unfinished/journal");
    let patience = Instant::now();
    while count_lines(&journal) < lines {
        assert!(patience.elapsed() < Duration::from_secs(60), "the run does not begin");
        std::thread::sleep(Duration::from_millis(2));
    }
    child
}
