//! Counts the loads that wait for a store, in a trace of memory from `valgrind --tool=lackey --trace-mem=yes`:
//! `blocked BEGIN END < TRACE`, of the instructions between those at two addresses. `benches/blocked.sh` runs it.
//!
//! A processor forwards a store that is not yet in the cache to a later load, if the store wrote all that the load
//! reads. If it wrote only a part, as where two numbers are stored one by one and then copied at once, the load waits
//! until the store is in the cache: some 12 cycles. Counts of instructions do not show this, and clocks hardly do. A
//! load counts here if the newest of the stores that wrote any of its bytes did not write all of them, and is no more
//! than [`RECENT`] instructions old.
#![allow(clippy::print_stdout, reason = "printing is what it is for")]

use std::collections::VecDeque;
use std::error::Error;
use std::io::{self, BufRead as _};
use std::ops::Range;

/// Instructions after which a store counts as being in the cache.
const RECENT: u64 = 100;

/// The loads and the recent stores of a program.
#[derive(Debug, Default)]
struct Memory {
    instructions: u64,
    blocked: u64,
    /// The newest last, each with the number of its instruction and its bytes.
    stores: VecDeque<(u64, Range<u64>)>,
}

impl Memory {
    fn step(&mut self) {
        self.instructions += 1;
        while self.stores.front().is_some_and(|(at, _)| at + RECENT < self.instructions) {
            self.stores.pop_front();
        }
    }

    fn load(&mut self, read: &Range<u64>) {
        let of_load = |(_, written): &&(u64, Range<u64>)| written.start < read.end && read.start < written.end;
        let newest = self.stores.iter().rev().find(of_load);
        let is_whole = newest.is_none_or(|(_, written)| written.start <= read.start && read.end <= written.end);
        self.blocked += u64::from(!is_whole);
    }

    fn store(&mut self, written: Range<u64>) {
        self.stores.push_back((self.instructions, written));
    }
}

fn hexadecimal(digits: &str) -> Result<u64, Box<dyn Error>> {
    Ok(u64::from_str_radix(digits.trim_start_matches("0x"), 16).map_err(|error| format!("{digits:?}: {error}"))?)
}

/// What a line of the trace says, `I  ADDRESS,SIZE` or ` L`, ` S` or ` M` likewise; `None` for lines of the program.
fn access(line: &str) -> Option<(&str, Range<u64>)> {
    let (kind, bytes) = line.trim().split_once(' ')?;
    let (start, size) = bytes.trim().split_once(',')?;
    let (start, size) = (u64::from_str_radix(start, 16).ok()?, size.parse::<u64>().ok()?);
    matches!(kind, "I" | "L" | "S" | "M").then_some((kind, start..start + size))
}

fn main() -> Result<(), Box<dyn Error>> {
    let addresses = std::env::args().skip(1).collect::<Vec<_>>();
    let [begin, end] = addresses.as_slice() else { return Err("two addresses are wanted: BEGIN END".into()) };
    let (begin, end) = (hexadecimal(begin)?, hexadecimal(end)?);
    let (mut memory, mut is_counted, mut is_done) = (Memory::default(), false, false);
    for line in io::stdin().lock().lines() {
        let line = line?;
        let Some((kind, bytes)) = access(&line) else { continue };
        if kind == "I" {
            is_done |= is_counted && bytes.start == end;
            is_counted |= bytes.start == begin;
        }
        match kind {
            _ if !is_counted || is_done => {}
            "I" => memory.step(),
            "L" => memory.load(&bytes),
            "S" => memory.store(bytes),
            _ => {
                memory.load(&bytes);
                memory.store(bytes);
            }
        }
    }
    if !is_done {
        return Err("the trace does not run from the one address to the other".into());
    }
    println!("{}", memory.blocked);
    Ok(())
}
