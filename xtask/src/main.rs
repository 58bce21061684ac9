//! The workspace's tasks: `cargo xtask --help`.

mod book2d;
mod docs;
mod engine;
mod footprint;
mod fuzz;
mod mesh;
mod plot;
mod query;
mod render;
mod scene;
mod sweep;
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
    /// The queries, shapes, and answers are described in `xtask/README.md`; try
    /// `echo '{"query":"distance","a":{"type":"ball","radius":1},"b":{"type":"point","at":[3,0,0]}}' | cargo xtask query -`.
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
    Validate(validate::Scope),
    /// Move a robot along its trajectory among obstacles: ellipsoids first, exact distances where they cannot decide.
    ///
    /// Exit status: 0, or 1 where an answer differs from the truth given, or 2 where a file could not be read.
    Scene(scene::Choice),
    /// Cast rays at every scale, and hold them against references in thirty digits; the same for linear casts and distances.
    ///
    /// Exit status: 0 where everything is right, 1 where some answer is wrong, 2 where the table could not be written.
    Sweep(sweep::Scope),
    /// Try damaged query lines, and hulls of integers against an exact oracle, for a bounded time.
    ///
    /// Exit status: 0 where nothing failed, 1 where something did, 2 where the suite could not be read.
    Fuzz(fuzz::Scope),
    /// Draw the descent of GJK in the plane, step by step.
    Book2d {
        /// Where the drawings go.
        #[arg(long, value_name = "FOLDER", default_value = "target/book2d")]
        output: PathBuf,
    },
    /// Render a picture by GJK ray casts.
    Render {
        /// The picture.
        #[arg(value_name = "PNG", default_value = "target/render.png")]
        file: PathBuf,
        /// Its width in pixels; the height is 9/16 of it.
        #[arg(long, default_value_t = 1280, value_parser = clap::value_parser!(u32).range(16..=16384))]
        width: u32,
    },
    /// Build the API documentation of the libraries as docs.rs does, and check that no link leads nowhere.
    ///
    /// Exit status: 0, or 1 where a note or page refers to what is not there, or 2 where the documentation does not build.
    Docs,
    /// Measure what importing each crate alone costs, and write `docs/footprint.md`: packages, build time, code size.
    Footprint {
        /// Where the programs are built; emptied first.
        #[arg(long, value_name = "FOLDER", default_value = "target/footprint")]
        output: PathBuf,
    },
}

fn main() -> ExitCode {
    match Arguments::parse().task {
        Task::Query { files } => query::run(&files),
        Task::Validate(scope) => validate::run(&scope),
        Task::Sweep(scope) => sweep::run(&scope),
        Task::Fuzz(scope) => fuzz::run(&scope),
        Task::Book2d { output } => book2d::run(&output),
        Task::Render { file, width } => render::run(&file, width),
        Task::Docs => docs::run(),
        Task::Footprint { output } => footprint::run(&output),
        Task::Scene(choice) => scene::run(&choice),
    }
}
