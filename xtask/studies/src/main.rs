//! What takes long to compile or to run: the whole report of `cargo xtask validate`, fuzzing, sweeps, a robot's scene,
//! pictures.
//!
//! `cargo xtask` builds and starts it when one of these is asked for.

mod book2d;
mod judge;
mod matrix;
mod render;
mod report;
mod scene;
mod scene_growth;
mod sweep;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use xtask::{bits, fuzz, validate};

/// The studies of the workspace.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Compare answers with the truth, and write the report: error against run time.
    ///
    /// Exit status: 0 if everything is right, 1 if some answer is wrong, 2 if a file could not be read.
    Validate(validate::Scope),
    /// Try damaged query lines, and hulls of integers against an exact oracle, for a bounded time.
    ///
    /// Exit status: 0 if nothing failed, 1 if something did, 2 if the suite could not be read.
    Fuzz(fuzz::Scope),
    /// Answer questions from fixed seeds, and compare the hashes of the answers with those that every machine is to
    /// have.
    ///
    /// Exit status: 0 if every hash is equal, 1 if some are not, 2 if the file of hashes could not be read or written.
    Bits(bits::Choice),
    /// Move a robot along its trajectory among obstacles: ellipsoids first, exact distances where they cannot decide.
    ///
    /// Exit status: 0, or 1 if an answer differs from the given truth, or 2 if a file could not be read.
    Scene(scene::Choice),
    /// Ask whether the pairs of links that a robot's planner does not look at ever meet, within the limits of its
    /// joints.
    ///
    /// Exit status: 0, or 2 if a file could not be read or written.
    Matrix(matrix::Choice),
    /// Compare ray casts, linear casts, distances and derivatives with references in thirty digits, at every scale.
    ///
    /// Exit status: 0 if everything is right, 1 if some answer is wrong, 2 if the table could not be written.
    Sweep(sweep::Scope),
    /// Hold the answers of other libraries, and ours, against what is proved; one table and one figure.
    ///
    /// Exit status: 0, or 1 if a bracket of ours does not hold the truth or a claim of ours is disproved, or 2 if a
    /// file could not be read or written.
    Judge(judge::Scope),
    /// Measure how the time of each question to a scene grows with the number of its bodies, and draw it.
    ///
    /// Exit status: 0, or 2 if a file could not be written.
    Growth(scene_growth::Choice),
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
        /// By night, for dark pages.
        #[arg(long)]
        night: bool,
    },
}

fn main() -> ExitCode {
    match Arguments::parse().task {
        Task::Validate(scope) => validate::run(&scope, &report::CHAPTERS),
        Task::Fuzz(scope) => fuzz::run(&scope),
        Task::Bits(choice) => bits::run(&choice),
        Task::Scene(choice) => scene::run(&choice),
        Task::Matrix(choice) => matrix::run(&choice),
        Task::Sweep(scope) => sweep::run(&scope),
        Task::Judge(scope) => judge::run(&scope),
        Task::Growth(choice) => scene_growth::run(&choice),
        Task::Book2d { output } => book2d::run(&output),
        Task::Render { file, width, night } => render::run(&file, width, night),
    }
}
