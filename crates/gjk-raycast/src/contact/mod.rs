//! Contact: how far apart two shapes are or how deep in one another, and along which normal.

mod clip;
#[allow(clippy::module_inception, reason = "a file is a public function, and the folder has the name of the subject")]
mod contact;
mod manifold;
mod outline;
mod reduction;
mod result;
mod surface;

pub(crate) use contact::contact_of;
pub use contact::{contact, contact_after};
pub(crate) use manifold::manifold_over_plane;
pub(crate) use outline::{ContactPlane, Corner, Ellipse, Outline};
pub use result::{Contact, ContactPoint};
