//! Runs the command in a folder of its own.

use std::{
    collections::BTreeMap,
    ffi::OsStr,
    fs,
    io::Write,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};
use tempfile::TempDir;

/// A folder in which the command runs.
pub struct Folder(TempDir);

/// What the command did.
#[derive(Debug)]
pub struct Outcome {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) -> &Self {
        fs::write(self.path(name), text).unwrap();
        self
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.read(name)).unwrap()
    }

    /// The command, to be started by the caller.
    pub fn command(&self, arguments: &[impl AsRef<OsStr>]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_nearfield"));
        command.args(arguments).current_dir(self.0.path()).env("RAYON_NUM_THREADS", "2").env_remove("RUST_BACKTRACE");
        // Not the user's own; there is none where a test writes none.
        command.env("NEARFIELD_PROFILE", "profile.toml");
        command
    }

    pub fn run(&self, line: &str) -> Outcome {
        self.run_with_input(line, "")
    }

    /// Runs the words of `line` as arguments, with `input` on standard input.
    pub fn run_with_input(&self, line: &str, input: &str) -> Outcome {
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut command = self.command(&words);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // The command may refuse before it has read everything.
        let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
        let output = child.wait_with_output().unwrap();
        let outcome = Outcome {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        };
        assert!(!outcome.stderr.contains("panicked"), "nearfield {line}: {}", outcome.stderr);
        outcome
    }

    /// Runs what must succeed.
    pub fn succeed(&self, line: &str) -> Outcome {
        let outcome = self.run(line);
        assert_eq!(outcome.code, Some(0), "nearfield {line}: {}", outcome.stderr);
        outcome
    }

    /// Runs what must fail with this code, saying each of `words` on stderr and nothing on stdout.
    pub fn fail(&self, code: i32, line: &str, words: &[&str]) -> Outcome {
        let outcome = self.run(line);
        let Outcome { stdout, stderr, .. } = &outcome;
        assert_eq!(outcome.code, Some(code), "nearfield {line}: {stderr}");
        assert!(stderr.contains("error: "), "nearfield {line}: {stderr}");
        for word in words {
            assert!(stderr.contains(word), "nearfield {line}: expected `{word}` in `{stderr}`");
        }
        assert_eq!(stdout, "", "nearfield {line}");
        outcome
    }

    /// Runs a wrong request: exit code 2, each of `words` on stderr, and no file written, changed or lost.
    pub fn refuse(&self, line: &str, words: &[&str]) {
        let before = self.contents();
        self.fail(2, line, words);
        assert_eq!(self.contents(), before, "nearfield {line}");
    }

    /// Every file below the folder with its content, and every folder.
    pub fn contents(&self) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        fn collect(folder: &Path, into: &mut BTreeMap<PathBuf, Option<Vec<u8>>>) {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    collect(&path, into);
                    into.insert(path, None);
                } else {
                    let content = fs::read(&path).unwrap();
                    into.insert(path, Some(content));
                }
            }
        }
        let mut all = BTreeMap::new();
        collect(self.0.path(), &mut all);
        all
    }
}
