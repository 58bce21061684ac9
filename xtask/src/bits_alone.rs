//! `cargo xtask bits` alone: the program that `.ci/bits` compiles for each of its targets, without what validates,
//! judges and draws, which would double the time.
#![allow(dead_code, missing_docs, reason = "its modules are those of xtask")]

mod bits;
mod draw;
mod engine;
mod mesh;
mod output;
mod wire;

use std::process::ExitCode;

use clap::Parser;

#[derive(Debug, Parser)]
struct Arguments {
    #[command(flatten)]
    choice: bits::Choice,
}

fn main() -> ExitCode {
    bits::run(&Arguments::parse().choice)
}
