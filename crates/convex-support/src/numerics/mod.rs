//! Arithmetic shared by the crates of this workspace. It is no part of the interface: it may change with any version.

pub mod angular;
pub mod bound;
pub mod bounded;
pub mod coordinates;
pub mod double_double;
pub mod elementary;
pub mod jacobi;
pub mod orientation;
pub mod range;
pub mod twofold;
pub mod widest;
