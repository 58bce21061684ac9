//! The query format: JSON lines in, JSON lines out. Nothing but this module and its children knows JSON's shape.

pub(crate) mod answer;
pub(crate) mod error;
pub(crate) mod query;
pub(crate) mod reader;
pub(crate) mod shape;
