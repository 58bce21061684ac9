//! Contact: how far apart two shapes are or how deep in one another, and which way out.

mod basin;
mod boundary;
mod clip;
#[allow(clippy::module_inception, reason = "a file is a public function, and the folder has the name of the subject")]
mod contact;
mod cores;
mod direct;
mod expansion;
mod manifold;
mod met;
mod newton;
mod options;
mod orientation;
mod outline;
mod peeled;
mod reduction;
mod result;
mod separation;
mod signed_distance;
mod start;
mod surface;
mod witness;
mod zonotope;

pub use contact::{contact, contact_after};
pub(crate) use cores::{Cores, Uncertainty};
pub(crate) use direct::direct;
pub(crate) use manifold::manifold_over_plane;
pub use options::SignedDistanceOptions;
pub(crate) use outline::{ContactPlane, Corner, Ellipse, Outline};
pub use result::{Contact, ContactPoint, SignedDistance};
pub(crate) use separation::{OfOverlap, Wanted, separation};
pub use signed_distance::{signed_distance, signed_distance_with};
pub(crate) use signed_distance::{signed_distance_and_axis, signed_distance_of_any};
