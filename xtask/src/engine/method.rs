//! The `method` of a query.

use crate::wire::error::{Kind, Problem};

/// The methods of the papers, which are in the engine with the feature `paper` only.
const PAPER: [&str; 2] = ["eigen", "inverse"];

/// The variant of that name; the first where none is named.
pub(super) fn choose<M: Copy>(method: Option<&str>, methods: &[(&str, M)]) -> Result<M, Problem> {
    let Some(name) = method else { return Ok(methods[0].1) };
    methods.iter().find(|(known, _)| *known == name).map(|(_, variant)| *variant).ok_or_else(|| {
        let known: Vec<&str> = methods.iter().map(|(known, _)| *known).collect();
        let known = known.join(", ");
        let message = if PAPER.contains(&name) && cfg!(not(feature = "paper")) {
            format!("the method {name:?} is not built in (cargo run --release -p xtask --features paper -- …); else there is {known}")
        } else {
            format!("the method {name:?} is unknown; this query has {known}")
        };
        Problem::new(Kind::Parse, message)
    })
}
