//! The query format: lines of JSON, their fields, shapes, answers and errors.

pub mod answer;
pub mod body;
pub mod error;
pub mod fields;
pub mod json;
pub mod linkage;
pub mod motion;
pub mod names;
pub mod shape;
