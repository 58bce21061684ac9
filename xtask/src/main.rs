//! The workspace's tasks: `cargo xtask --help`.

mod engine;
mod mesh;
mod plot;
mod query;
mod validate;
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
    /// Compare answers with the truth, and write the report: error against run time.
    ///
    /// Exit status: 0 where everything is right, 1 where some answer is wrong, 2 where a file could not be read.
    Validate {
        /// Query files with `expect`; without any, the embedded suite.
        #[arg(value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Where the report goes.
        #[arg(long, value_name = "FOLDER", default_value = "target/report")]
        report: PathBuf,
    },
}

fn main() -> ExitCode {
    match Arguments::parse().task {
        Task::Query { files } => query::run(&files),
        Task::Validate { files, report } => validate::run(&files, &report),
    }
}
