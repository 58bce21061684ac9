//! Bodies of single precision near contact whose closest points are known in closed form.
//!
//! Numbers of single precision, and the differences of two, are exact in double precision. So the closed form is
//! computed there, and its own rounding is nothing beside the errors that the shapes state. For double precision no
//! wider numbers are at hand: there the plane is evaluated [without rounding](super), and so is what no closed form
//! tells.

use convex_support::glam::DVec3;
use convex_support::numerics::bound::{least, raised};
use convex_support::numerics::coordinates::{array, vector};
use convex_support::{Core, CoreKind, Hint, Scalar, compiled_once};

use super::Uncertainty;
use crate::body::PointPair;
use crate::pair::{Aligned, Pair, Shapes};
use crate::segments;
use crate::{SignedDistance, Status};

/// The rounding in double precision, in ε of the size: some 20 operations, each of half of that.
const ROUNDED_IN_DOUBLE: f64 = 32.0;

/// How many errors the cores must be apart for bodies that may overlap. Their plane is then the best but for a part of
/// the error as small as that, and nothing that a search finds would decide more.
const CLEAR: f64 = 64.0;

compiled_once! {
    /// The signed distance of two bodies, given the closest points of their cores in the world's unit. `None` if
    /// these are not as near as the plane between them, or within a few errors, and for double precision.
    pub(crate) fn in_double<V>(
        shapes: &dyn Shapes<Vector = V>,
        cores: [&Core<V>; 2],
        points: &PointPair<V>,
    ) -> Option<SignedDistance<V>> {
        if size_of::<V::Scalar>() >= size_of::<f64>() {
            return None;
        }
        let [core_a, core_b] = cores;
        let wide = |v: V| DVec3::from(array(v));
        let narrow = |v: DVec3| vector::<V>(v.to_array());
        let offset = wide(core_a.origin) - wide(core_b.origin);
        // A point is a segment without length.
        let segment = |core: &Core<V>| match core.kind {
            CoreKind::Point(at) => Some((wide(at), DVec3::ZERO)),
            CoreKind::Segment { middle, half } => Some((wide(middle), wide(half))),
            _ => None,
        };
        let (a, b, v, n, level);
        if let (Some((x, u)), Some((y, w))) = (segment(core_a), segment(core_b)) {
            let (s, t) = segments::closest_points(u, w, offset - (y - x));
            (a, b) = (x + s, y + t);
            v = a - b + offset;
            n = v / v.length();
            level = n.dot(x - y + offset) - n.dot(u).abs() - n.dot(w).abs();
        } else {
            (a, b) = (wide(points.a), wide(points.b));
            v = a - b + offset;
            let along = narrow(v);
            n = wide(along).normalize();
            let [Aligned(x), Aligned(y)] = shapes.support_points([-along, along], &mut [Hint::new(), Hint::new()]);
            level = n.dot(wide(x) - wide(y) + offset);
        }
        let (length, radius) = (v.length(), core_a.radius.as_f64() + core_b.radius.as_f64());
        let known = Uncertainty::new(&Pair::new(shapes, cores), Scalar::ONE);
        let along = raised(known.along(narrow(n)));
        let beyond = raised(known.beyond_length(V::Scalar::from_f64(length), along));
        let size = (core_a.extent + core_b.extent).as_f64() + radius + length + offset.length();
        let rounded = size * (ROUNDED_IN_DOUBLE * f64::EPSILON);
        let (below, above) = (along.as_f64() + rounded, beyond.as_f64() + rounded);
        let (lower, upper) = (level.min(length) - below - radius, length + above - radius);
        let clear = if lower > 0.0 { 2.0 } else { CLEAR };
        // NaN is left to the search.
        if !(length - level <= 2.0 * below && length > clear * above) {
            return None;
        }
        let single = |x: f64| V::Scalar::from_f64(x);
        let lost = |x: f64| single(x.abs()) * V::Scalar::EPSILON + least();
        let (signed_distance, normal) = (single(length - radius), narrow(n));
        Some(SignedDistance {
            signed_distance,
            lower: single(lower) - lost(lower),
            upper: single(upper) + lost(upper),
            normal,
            point_a: narrow(wide(core_a.origin) + a - n * core_a.radius.as_f64()),
            point_b: narrow(wide(core_b.origin) + b + n * core_b.radius.as_f64()),
            overlap: signed_distance <= Scalar::ZERO,
            status: Status::Converged,
            iterations: 1,
            unexpanded: 0,
        })
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DQuat, DVec3, Quat, Vec3A};
    use convex_support::{Ball, Capsule, Cuboid, InvalidShape, Posed, SupportMap};

    use crate::{DistanceOptions, SignedDistanceOptions, Status, distance, signed_distance};

    type Pair<'a, V> = (&'a dyn SupportMap<Vector = V>, &'a dyn SupportMap<Vector = V>);

    /// The bounds of two bodies in single precision, a few roundings apart or deep, hold those that double precision
    /// finds for the same numbers, whichever body comes first, and the distance has the same.
    fn agrees(i: i32, single: Pair<'_, Vec3A>, double: Pair<'_, DVec3>) -> Result<(), InvalidShape> {
        let angle = f64::from(i);
        let turn = Quat::from_xyzw(angle.sin() as f32, angle.cos() as f32, 0.5, (0.7 * angle).sin() as f32).normalize();
        let away = DVec3::new((1.3 * angle).sin(), (1.7 * angle).cos(), (0.9 * angle).sin() + 2.0) * 4.0;
        let wide = |turn: Quat| DQuat::from_xyzw(turn.x.into(), turn.y.into(), turn.z.into(), turn.w.into());
        let a = Posed::new(double.0, wide(turn), DVec3::ZERO)?;
        let at = |place: DVec3| -> Result<_, InvalidShape> {
            Ok(signed_distance(&a, &Posed::translated(double.1, place)?, SignedDistanceOptions::new()))
        };
        let far = at(away)?;
        let gap = f64::from(i % 25 - 12) * f64::from(f32::EPSILON);
        let place = (away + far.normal * (far.signed_distance - gap)).as_vec3a();
        let truth = at(place.as_dvec3())?;
        let (a, b) = (Posed::new(single.0, turn, Vec3A::ZERO)?, Posed::translated(single.1, place)?);
        let near = signed_distance(&a, &b, SignedDistanceOptions::new());
        assert!(f64::from(near.lower) <= truth.lower && truth.upper <= f64::from(near.upper), "{near:?} {truth:?}");
        assert_eq!((near.status, near.iterations), (Status::Converged, 1), "{near:?}");
        assert_eq!(signed_distance(&b, &a, SignedDistanceOptions::new()), near.reversed());
        let apart = distance(&a, &b, DistanceOptions::new());
        assert_eq!((apart.overlap, apart.status), (near.lower <= 0.0, Status::Converged), "{apart:?} {near:?}");
        assert_eq!((apart.lower, apart.upper), (near.lower.max(0.0), near.upper.max(0.0)), "{apart:?} {near:?}");
        assert!(((apart.point_a - apart.point_b).length() - apart.distance).abs() < 4e-6, "{apart:?} {near:?}");
        Ok(())
    }

    #[test]
    fn bounds_in_single_precision_hold_what_double_precision_finds() -> Result<(), InvalidShape> {
        let radius = f64::from(0.3_f32);
        let (block, ball) = (Cuboid::<Vec3A>::new(Vec3A::new(1.0, 0.5, 0.75))?, Ball::<Vec3A>::new(0.3)?);
        let (wide_block, wide_ball) = (Cuboid::<DVec3>::new(DVec3::new(1.0, 0.5, 0.75))?, Ball::<DVec3>::new(radius)?);
        let [rod, other] = [Capsule::<Vec3A>::new(1.0, 0.5)?, Capsule::new(0.5, 0.3)?];
        let [wide_rod, wide_other] = [Capsule::<DVec3>::new(1.0, 0.5)?, Capsule::new(0.5, radius)?];
        for i in 0..400 {
            agrees(i, (&block, &ball), (&wide_block, &wide_ball))?;
            agrees(i, (&rod, &other), (&wide_rod, &wide_other))?;
        }
        Ok(())
    }
}
