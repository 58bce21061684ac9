//! The `method` of a query.

use crate::wire::error::{Kind, Problem};
use crate::wire::names;

/// The methods of the papers, which are in the engine with the feature `paper` only.
const PAPER: [&str; 2] = ["eigen", "inverse"];

/// The variant of that name; the first where none is named.
pub(super) fn choose<M: Copy>(method: Option<&str>, methods: &[(&'static str, M)]) -> Result<M, Problem> {
    let Some(name) = method else { return Ok(methods[0].1) };
    names::choose(name, methods.iter().copied()).map_err(|unknown| {
        let message = if PAPER.contains(&name) && cfg!(not(feature = "paper")) {
            format!("the method {name:?} is not built in (cargo run --release -p xtask --features paper -- …)")
        } else {
            format!("the method {unknown}")
        };
        Problem::new(Kind::Parse, message)
    })
}
