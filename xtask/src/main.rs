//! The workspace's tasks: `cargo xtask --help`.

mod engine;
mod mesh;
mod query;
mod wire;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Answers query files, validates the crates against true answers, and draws what they do.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Answer the queries in files, one JSON line out per line in.
    ///
    /// Exit status: 0 where every line was answered, 1 where some line got an error in place of an answer, 2 where a file
    /// could not be read or the arguments are wrong.
    Query {
        /// Query files; `-` is standard input.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
}

fn main() -> ExitCode {
    match Arguments::parse().task {
        Task::Query { files } => query::run(&files),
    }
}
