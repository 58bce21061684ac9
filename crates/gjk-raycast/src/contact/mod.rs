//! Contact: how far apart two shapes are or how deep in one another, and along which normal.

mod clip;
mod contact_point;
mod manifold;
mod outline;
mod reduction;
mod surface;

use convex_support::{SupportMap, Vector};
use num_traits::Float as _;

use crate::{SignedDistanceOptions, signed_distance};
pub(crate) use clip::{ClippedCorners, clip, cut};
pub(crate) use contact_point::MANIFOLD_POINTS;
pub use contact_point::{Contact, ContactPoint};
use manifold::manifold;
pub(crate) use manifold::manifold_over_plane;
pub(crate) use outline::{ContactPart, ContactPlane, Corner, Ellipse, Outline};
pub(crate) use surface::Level;

/// The contact of two shapes; `None` if they are farther apart than `within`. The options are those of the signed
/// distance, but `within` replaces the limit; with NaN there is no contact. The normal of the last frame is a good
/// first [`axis`](SignedDistanceOptions::axis).
///
/// ```
/// use convex_support::{Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{SignedDistanceOptions, contact};
///
/// // A box of half extent 0.5 stands on the floor, over its edge by half.
/// let floor = Cuboid::new(DVec3::new(5.0, 1.0, 5.0))?;
/// let parcel = Posed::translated(Cuboid::new(DVec3::splat(0.5))?, DVec3::new(5.0, 1.5, 0.0))?;
/// let contact =
///     contact(&parcel, &floor, 0.01, SignedDistanceOptions::default()).expect("they touch");
/// assert_eq!(contact.normal, DVec3::Y);
/// assert_eq!(contact.points().len(), 4);
/// assert!(
///     contact.points().iter().all(|p| p.point_a.x <= 5.0 && p.signed_distance.abs() < 1e-15)
/// );
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// The features of both shapes that face each other, each a vertex, an edge or a face
/// ([`core_support_feature`](SupportMap::core_support_feature)), are clipped against each other in the plane of
/// contact. A corner of their overlap belongs to the contact if the surfaces there overlap or are no farther apart
/// than `within`, but for a thousandth of the smaller shape's size. At most four corners are kept, in 2D two: those
/// that span the overlap well, and one as deep as the shapes are, but for a thousandth of the size.
#[doc(alias("contact_manifold", "manifold", "collide"))]
pub fn contact<A, B>(
    a: &A,
    b: &B,
    within: <A::Vector as Vector>::Scalar,
    options: SignedDistanceOptions<A::Vector>,
) -> Option<Contact<A::Vector>>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    contact_of(a, b, within, options, None)
}

/// [`contact`] of shapes that were in contact before. It keeps those points of the `last` contact that are still
/// valid.
///
/// A point is recognised by the numbers of its features. It is kept while the shapes are apart there by no more than
/// twice the thousandth of their size that other points may have, and while no other point spans the overlap much
/// better. The last normal is the first [`axis`](SignedDistanceOptions::axis), if the options have none.
pub fn contact_after<A, B>(
    last: &Contact<A::Vector>,
    a: &A,
    b: &B,
    within: <A::Vector as Vector>::Scalar,
    options: SignedDistanceOptions<A::Vector>,
) -> Option<Contact<A::Vector>>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    contact_of(a, b, within, options, Some(last))
}

/// [`contact_after`], if there was a contact before.
pub(crate) fn contact_of<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized>(
    a: &A,
    b: &B,
    within: <A::Vector as Vector>::Scalar,
    options: SignedDistanceOptions<A::Vector>,
    last: Option<&Contact<A::Vector>>,
) -> Option<Contact<A::Vector>> {
    let axis = options.axis.or(last.map(|last| last.normal));
    let limit = options.limit.min(within);
    let answer = signed_distance(a, b, SignedDistanceOptions { axis, limit, ..options });
    // A NaN or infinite distance is beyond any limit.
    if !(answer.signed_distance <= within && answer.signed_distance.is_finite()) {
        return None;
    }
    Some(manifold(a, b, &answer, within, last.map_or(&[], Contact::points)))
}
