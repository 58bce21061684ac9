//! The query format: JSON lines in, JSON lines out. Nothing but this module and its children knows JSON's shape.

pub(crate) mod answer;
pub(crate) mod error;
mod form;
pub(crate) mod json;
pub(crate) mod query;
pub(crate) mod reader;
pub(crate) mod shape;
