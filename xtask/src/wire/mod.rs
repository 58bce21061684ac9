//! The query format: JSON lines in, JSON lines out. Nothing but this module and its children knows JSON's shape.

pub mod answer;
pub mod error;
mod form;
pub mod json;
pub mod query;
pub mod reader;
pub mod shape;
