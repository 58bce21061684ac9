//! What the formulas stand on: vectors and small matrices of `f64`, their factorisations, twofold arithmetic, and the
//! unit of length in which nothing leaves the range.

mod factor;
mod svd;
mod unit;
mod vector;

pub(crate) use convex_support::numerics::double_double::DoubleDouble;

pub(crate) use self::factor::Factor;
pub(crate) use self::svd::{Svd, svd};
pub(crate) use self::unit::power_of_two_near;
pub(crate) use self::vector::{Vec, add, combine, dot, load, load_columns, size, store, sub, unit};
