// What the bridges to parry's crates share: `parry` is the crate, `V` glam's vector type of the same dimension and
// precision. The two may use different versions of glam, so that vectors pass by their coordinates.

use parry::math::Vector as ParryVector;
use parry::shape as theirs;

use crate::{Ball, Cuboid, Feature, InvalidShape, Rounded, Segment, SupportMap, Triangle};

/// A parry shape, in its own frame, as a shape of this crate: anything that has parry's support mapping.
///
/// It is used through parry's interface, and so has neither a radius nor a hint, and of a face it shows those
/// vertices that are support points of directions nearby. If the kind of shape is known, the conversions
/// (`Ball::try_from(parry_ball)` …) make better shapes of it.
#[derive(Clone, Copy, Debug)]
pub struct FromParry<S>(
    /// The shape.
    pub S,
);

impl<S: theirs::SupportMap> SupportMap for FromParry<S> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        ours(self.0.local_support_point(parrys(direction)))
    }

    /// The vertices around, which are support points along directions that are turned a little.
    fn core_support_feature(&self, direction: V, slab: crate::ScalarOf<Self>, feature: &mut Feature<V>) {
        feature.probe(direction, slab, |direction| self.support(direction));
    }
}

/// A shape of this crate as a parry shape, for parry's queries on support maps.
#[derive(Clone, Copy, Debug)]
pub struct IntoParry<S>(
    /// The shape.
    pub S,
);

impl<S: SupportMap<Vector = V>> theirs::SupportMap for IntoParry<S> {
    #[inline]
    fn local_support_point(&self, dir: ParryVector) -> ParryVector {
        parrys(self.0.support(ours(dir)))
    }
}

impl TryFrom<theirs::Ball> for Ball<V> {
    type Error = InvalidShape;

    fn try_from(ball: theirs::Ball) -> Result<Self, InvalidShape> {
        Self::new(ball.radius)
    }
}

impl TryFrom<theirs::Cuboid> for Cuboid<V> {
    type Error = InvalidShape;

    fn try_from(cuboid: theirs::Cuboid) -> Result<Self, InvalidShape> {
        Self::new(ours(cuboid.half_extents))
    }
}

impl TryFrom<theirs::Segment> for Segment<V> {
    type Error = InvalidShape;

    fn try_from(segment: theirs::Segment) -> Result<Self, InvalidShape> {
        Self::new([ours(segment.a), ours(segment.b)])
    }
}

impl TryFrom<theirs::Triangle> for Triangle<V> {
    type Error = InvalidShape;

    fn try_from(triangle: theirs::Triangle) -> Result<Self, InvalidShape> {
        Self::new([ours(triangle.a), ours(triangle.b), ours(triangle.c)])
    }
}

/// parry's capsules lie along any segment.
impl TryFrom<theirs::Capsule> for Rounded<Segment<V>> {
    type Error = InvalidShape;

    fn try_from(capsule: theirs::Capsule) -> Result<Self, InvalidShape> {
        Self::new(Segment::try_from(capsule.segment)?, capsule.radius)
    }
}

impl From<&Ball<V>> for theirs::Ball {
    fn from(ball: &Ball<V>) -> Self {
        Self::new(ball.radius())
    }
}

impl From<&Cuboid<V>> for theirs::Cuboid {
    fn from(cuboid: &Cuboid<V>) -> Self {
        Self::new(parrys(cuboid.half_extents()))
    }
}

impl From<&Segment<V>> for theirs::Segment {
    fn from(segment: &Segment<V>) -> Self {
        let [a, b] = segment.points().map(parrys);
        Self::new(a, b)
    }
}

impl From<&Triangle<V>> for theirs::Triangle {
    fn from(triangle: &Triangle<V>) -> Self {
        let [a, b, c] = triangle.points().map(parrys);
        Self::new(a, b, c)
    }
}

impl From<&Rounded<Segment<V>>> for theirs::Capsule {
    fn from(capsule: &Rounded<Segment<V>>) -> Self {
        let [a, b] = capsule.shape().points().map(parrys);
        Self::new(a, b, capsule.radius())
    }
}
