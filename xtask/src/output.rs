//! What becomes of a task whose output nobody takes.

use std::io::{self, Write};
use std::process::ExitCode;

/// The exit status of a task that could not write its output, after its word to the person who started it.
///
/// Whoever closes the pipe, as `head` does, has read enough: every task then ends at once, without a word and with
/// status 0. Any other failure is a status of 2.
pub(crate) fn failed(what: &str, why: &io::Error) -> ExitCode {
    if why.kind() == io::ErrorKind::BrokenPipe {
        return ExitCode::SUCCESS;
    }
    let _ = writeln!(io::stderr(), "error: {what}: {why}");
    ExitCode::from(2)
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
