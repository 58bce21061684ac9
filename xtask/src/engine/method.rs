//! The `method` of a query.

use crate::wire::error::{Kind, Problem};

/// The variant of that name; the first where none is named.
pub(super) fn choose<M: Copy>(method: Option<&str>, methods: &[(&str, M)]) -> Result<M, Problem> {
    let Some(name) = method else { return Ok(methods[0].1) };
    methods.iter().find(|(known, _)| *known == name).map(|(_, variant)| *variant).ok_or_else(|| {
        let known: Vec<&str> = methods.iter().map(|(known, _)| *known).collect();
        Problem::new(Kind::Parse, format!("the method {name:?} is unknown; this query has {}", known.join(", ")))
    })
}
