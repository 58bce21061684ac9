//! The workspace's tasks: `cargo xtask --help`.
//!
//! What is asked of every newcomer's machine is small: queries, cases, proofs, documentation. Studies, which
//! compile the algorithms for hundreds of types or draw pictures, are a package of their own, built when one of them is
//! asked for.

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::{Command, ExitCode};

use clap::{Args, Parser, Subcommand};
use xtask::{docs, follow, footprint, museum, page, paths, prove, query, validate};

/// Answers query files, validates the crates against true answers, and draws what they do.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Answer the queries in files: one JSON line is written for each line read.
    ///
    /// The queries, shapes, and answers are described in `xtask/README.md`; try `echo
    /// '{"query":"distance","a":{"type":"ball","radius":1},"b":{"type":"point","at":[3,0,0]}}' | cargo xtask query -`.
    ///
    /// Exit status: 0 if every line was answered, 1 if the answer to some line is an error, 2 if a file
    /// could not be read or the arguments are wrong.
    Query(query::Choice),
    /// Compare answers with the truth, and write the report: error against run time.
    ///
    /// Exit status: 0 if everything is right, 1 if some answer is wrong, 2 if a file could not be read.
    Validate(validate::Scope),
    /// Ask whether the edges of `path` queries are free, and print a table: what is free and what is not, in which
    /// time, and beside it how many of the edges that touch something sampling takes for free.
    ///
    /// Exit status: 0, or 2 if a file could not be read or a path is none.
    Path(paths::Choice),
    /// Prove answers by their certificates, in interval arithmetic that shares no solver and no shape with the crates.
    ///
    /// `cargo xtask query --certify FILE | cargo xtask prove -`; `docs/evidence.md` says what is proved, and how.
    ///
    /// Exit status: 0 if every line is proved, 1 if some line is not proved or is disproved, 2 if a file could not be
    /// read.
    Prove(prove::Choice),
    /// Ask about poses out of public trackers, where this or that library was wrong.
    ///
    /// Exit status: 0 if every answer is right, 1 if some answer is wrong, 2 if a file could not be read or written.
    Museum(museum::Choice),
    /// Build the page in the browser into `target/page`: drag two bodies, and see the proof.
    ///
    /// Exit status: 0, or 2 if it does not build, as where the target wasm32-unknown-unknown is missing.
    Page(page::Choice),
    /// Build the API documentation of the libraries as docs.rs does, and check that no link leads nowhere.
    ///
    /// Exit status: 0, or 1 if a note or page has a link that leads nowhere, or 2 if the documentation does not build.
    Docs,
    /// Measure what importing each crate alone costs, and write the table of `docs/choosing-a-method.md`: packages,
    /// build time, code size.
    Footprint(footprint::Choice),
    /// Compare with a committed table how many files of gjk-raycast one reads to follow a question, and circles of
    /// imports in all libraries.
    ///
    /// Exit status: 0, or 1 if something got longer, or 2 if a file could not be read.
    Follow(follow::Choice),
    /// Try damaged query lines, hulls of integers, and what answers say of themselves, for a bounded time (a study).
    #[command(disable_help_flag = true)]
    Fuzz(Passed),
    /// Compare the hashes of answers to questions from fixed seeds with those that every machine is to have (a study).
    #[command(disable_help_flag = true)]
    Bits(Passed),
    /// Move a robot along its trajectory among obstacles (a study).
    #[command(disable_help_flag = true)]
    Scene(Passed),
    /// Ask whether the pairs of links that a robot's planner does not look at ever meet (a study).
    #[command(disable_help_flag = true)]
    Matrix(Passed),
    /// Compare casts, distances and derivatives with references in thirty digits, at every scale (a study).
    #[command(disable_help_flag = true)]
    Sweep(Passed),
    /// Compare the answers of parry, and of others from files, with brackets that are proved (a study).
    #[command(disable_help_flag = true)]
    Judge(Passed),
    /// Draw how the time of a question to a scene grows with its bodies, and parry's beside it (a study).
    #[command(disable_help_flag = true)]
    Growth(Passed),
    /// Draw the descent of GJK in the plane, step by step (a study).
    #[command(disable_help_flag = true)]
    Book2d(Passed),
    /// Render a picture by GJK ray casts (a study).
    #[command(disable_help_flag = true)]
    Render(Passed),
}

/// What a study is told: `--help` says it.
#[derive(Debug, Args)]
struct Passed {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    _arguments: Vec<OsString>,
}

fn main() -> ExitCode {
    match Arguments::parse().task {
        Task::Query(choice) => query::run(&choice),
        Task::Validate(scope) if scope.is_study() => study(scope.features()),
        Task::Validate(scope) => validate::run(&scope, &validate::QUICK),
        Task::Path(choice) => paths::run(&choice),
        Task::Prove(choice) => prove::run(&choice),
        Task::Museum(choice) => museum::run(choice),
        Task::Page(choice) => page::run(&choice),
        Task::Docs => docs::run(),
        Task::Footprint(choice) => footprint::run(&choice),
        Task::Follow(choice) => follow::run(&choice),
        Task::Judge(_) | Task::Growth(_) => study("peers"),
        Task::Fuzz(_)
        | Task::Bits(_)
        | Task::Scene(_)
        | Task::Matrix(_)
        | Task::Sweep(_)
        | Task::Book2d(_)
        | Task::Render(_) => study(""),
    }
}

/// Builds the studies with these features, and gives them the arguments of this program.
fn study(features: &str) -> ExitCode {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(["run", "--release", "--package", "studies", "--features", features]);
    command.args(["--manifest-path", concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.toml"), "--"]);
    match command.args(std::env::args_os().skip(1)).status() {
        Ok(status) => status.code().and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from),
        Err(why) => {
            let _ = writeln!(io::stderr(), "error: cannot run cargo: {why}");
            ExitCode::from(2)
        }
    }
}
