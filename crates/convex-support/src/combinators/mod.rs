//! Shapes made of shapes. Each is the formula for its support mapping, and they nest freely.

mod affine;
mod difference;
mod hull;
mod minkowski_sum;
mod placement;
mod posed;
mod reflected;
mod rounded;

pub use affine::Affine;
pub use difference::Difference;
pub use hull::Hull;
pub use minkowski_sum::MinkowskiSum;
pub use posed::Posed;
pub use rounded::Rounded;
