//! The primitive shapes. Each is centred on, or given in, its own frame; [`Posed`](crate::Posed) puts it elsewhere.

pub(crate) mod axial;
mod ball;
mod capsule;
mod cone;
mod cuboid;
mod cylinder;
mod ellipsoid;
pub(crate) mod planar_triangle;
mod point;
mod points;
#[cfg(feature = "alloc")]
mod polytope;
mod segment;
mod triangle;
pub(crate) mod triangle_point;

#[cfg(feature = "hull")]
pub(crate) use polytope::{PLANES, Planes, facet};

pub use ball::Ball;
pub use capsule::Capsule;
pub use cone::Cone;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use ellipsoid::Ellipsoid;
pub use point::Point;
#[cfg(feature = "hull")]
pub use polytope::Faceted;
#[cfg(feature = "alloc")]
pub use polytope::Polytope;
pub use segment::Segment;
pub use triangle::Triangle;
