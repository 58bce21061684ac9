//! Contact: how far apart two shapes are or how deep in one another, and which way out.

mod basin;
mod boundary;
mod clip;
#[allow(clippy::module_inception, reason = "a file is a public function, and the folder has the name of the subject")]
mod contact;
mod cores;
mod expansion;
mod manifold;
mod newton;
mod options;
mod orientation;
mod outline;
mod result;
mod signed_distance;
mod start;
mod witness;

pub use contact::contact;
pub use options::SignedDistanceOptions;
pub use result::{Contact, ContactPoint, SignedDistance};
pub use signed_distance::{signed_distance, signed_distance_with};
