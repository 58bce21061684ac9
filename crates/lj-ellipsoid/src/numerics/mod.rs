//! The arithmetic of both problems: small dense matrices, and sums in twice the working precision.

pub(crate) mod dimension;
pub(crate) mod linalg;
pub(crate) mod twofold;
