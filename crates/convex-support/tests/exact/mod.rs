//! Shapes as what they stand for: trees of the numbers that are given to constructors, whose support values are
//! computed to a hundred digits and more, by formulas of their own.

mod fixed;
mod shape;

pub(crate) use fixed::{Fixed, dot, norm};
pub(crate) use shape::{Random, Space, Tree};
