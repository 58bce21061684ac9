//! What this crate's traits of numbers, vectors and rotations are sealed by: bounds rest on what their types compute,
//! plain Euclidean vectors of IEEE-754 numbers and rotations of stated errors, and methods will be added.

pub trait Sealed {}

impl Sealed for f32 {}
impl Sealed for f64 {}
impl Sealed for glam::Quat {}
impl Sealed for glam::DQuat {}
