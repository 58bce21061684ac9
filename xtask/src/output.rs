//! How tasks end.

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

/// The exit status of a task: 0 if everything is right, 1 if not, and 2, after a word to the person who started it, if
/// it could not be done.
pub fn ended(outcome: Result<bool, impl Display>) -> ExitCode {
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(why) => {
            let _ = writeln!(io::stderr(), "error: {why}");
            ExitCode::from(2)
        }
    }
}

/// The exit status of a task that could not write its output.
///
/// Whoever closes the pipe, as `head` does, has read enough: every task then ends at once, without a word and with
/// status 0. Any other failure is a status of 2.
pub fn failed(what: &str, why: &io::Error) -> ExitCode {
    if why.kind() == io::ErrorKind::BrokenPipe {
        return ExitCode::SUCCESS;
    }
    ended(Err(format!("{what}: {why}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whoever_closes_the_pipe_has_read_enough() {
        let status = |kind: io::ErrorKind| format!("{:?}", failed("cannot write", &kind.into()));
        assert_eq!(status(io::ErrorKind::BrokenPipe), format!("{:?}", ExitCode::SUCCESS), "a pipe that is closed");
        assert_eq!(status(io::ErrorKind::StorageFull), format!("{:?}", ExitCode::from(2)), "a disk that is full");
    }
}
