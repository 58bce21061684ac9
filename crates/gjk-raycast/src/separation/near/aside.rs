//! Whether bodies have a point in common where the [second measurement](super) leaves it open.
//!
//! Zero is then within rounding of the boundary of the difference, and a search that begins there cannot tell the face
//! beside zero from the next ones. From a few errors aside of zero it can. So the difference is looked at from there,
//! along the normal of the best plane and across it, both ways: from a place outside, GJK finds the face nearest to
//! that place, and the plane of this face may keep zero out. If no such plane does, the points found are the corners of
//! an [octahedron](super::octahedron) within the difference. Where zero has room in it, the bodies certainly meet. The
//! points and planes are evaluated without rounding, like all near contact.

use convex_support::numerics::bound::raised;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::faces::{about_edge, across_faces};
use super::octahedron::Octahedron;
use super::{Known, NearContact, SupportPlane, run};
use crate::gjk::{End, Frame, Gjk};
use crate::pair::AnyPair;
use crate::symmetric::axes_across;

/// How far aside the places are, in errors of the query. An octahedron of which all corners are inside leaves zero 9
/// errors of room; one that is larger is cut more by the edges of the bodies.
const OCTAHEDRON: f64 = 16.0;

/// The noise of GJK from there, in that of the query, but no more than the least error of points: it is to find the
/// faces of bodies thinner than the noise, and the side of a needle whose length makes the noise what it is.
const NOISE_ASIDE: f64 = 1.0 / 256.0;

/// The most support points of one look. None of them has to end: any point of the difference will do as a corner, and
/// any plane.
const MOST: usize = 16;

impl<V: Vector> Known<V> {
    /// The same measurement, decided from places aside of zero if that can be; given the search that it ended with.
    #[cold]
    #[inline(never)]
    pub(super) fn decided(
        &self,
        pair: &mut AnyPair<'_, V>,
        near: NearContact<V>,
        state: &Gjk<V>,
        max_iterations: usize,
    ) -> NearContact<V> {
        let (mut near, frame) = (near, &self.frame);
        // The planes of the faces of a simplex of full dimension have been tested.
        if state.simplex.points().len() <= V::DIM
            && let Some(plane) = self.higher_plane(pair, &near, state)
        {
            return near.with_plane(&plane);
        }
        // A search that stalled is at a distance from zero.
        let aside = frame.error * V::Scalar::from_f64(OCTAHEDRON) + (near.length - frame.radius).abs();
        let [u, w] = axes_across(near.normal);
        let octahedron = Octahedron::around_zero([-near.normal, -u, -w], aside, frame.radius, |place| {
            let left = max_iterations.saturating_sub(near.iterations);
            let seen = self.seen_from(pair, place, state, left.min(MOST));
            near.iterations += seen.iterations;
            let point = self.nearest_point(&seen);
            let is_outside = (place - point).norm() > frame.noise;
            match if is_outside { self.higher_plane(pair, &near, &seen) } else { None } {
                Some(plane) => Err(plane),
                None => Ok((!seen.simplex.points().is_empty()).then_some(point)),
            }
        });
        let octahedron = match octahedron {
            Ok(octahedron) => octahedron,
            Err(plane) => return near.with_plane(&plane),
        };
        if let Some(octahedron) = octahedron
            && !near.is_separated()
        {
            // A corner is right to 16 roundings of its largest part, besides the errors of its points.
            let all = octahedron.extent(frame.radius);
            let rounded = V::splat((all + frame.radius) * (V::Scalar::EPSILON * V::Scalar::from_f64(8.0)));
            let known = self.points.with(rounded);
            let room = octahedron.room(|u| raised(known.along(u)), |_| Scalar::ONE);
            if room > Scalar::ZERO {
                (near.end, near.overlaps_certainly, near.upper) = (End::Overlap, true, near.upper.min(-room));
            }
        }
        near
    }

    /// GJK as seen from a place near zero, which begins with the corners that a search from zero has ended with.
    fn seen_from(&self, pair: &mut AnyPair<'_, V>, place: V, state: &Gjk<V>, max_iterations: usize) -> Gjk<V> {
        let (mut seen, known) = (Gjk::new(place), &state.simplex);
        for ((&point, &along), &witness) in known.points().iter().zip(known.along()).zip(known.witnesses()) {
            seen.simplex.push(point - place, along, witness);
        }
        seen.ensure_measured();
        if seen.length > self.frame.noise {
            let noise = (self.frame.noise * Scalar::from_f64(NOISE_ASIDE)).min(self.points.least());
            let offset = self.frame.offset - place;
            let (frame, first) = (Frame { offset, noise, radius: Scalar::ZERO, ..self.frame }, seen.normal);
            run(&mut seen, pair, frame, first, max_iterations);
            seen.ensure_measured();
        }
        seen
    }

    /// A plane across what a search has ended with that is certainly beyond the radii, and beyond the plane known.
    fn higher_plane(
        &self,
        pair: &mut AnyPair<'_, V>,
        near: &NearContact<V>,
        state: &Gjk<V>,
    ) -> Option<SupportPlane<V>> {
        let (points, x) = (state.simplex.points(), self.nearest_point(state));
        let edge = if let [p, q] = *points { q - p } else { V::ZERO };
        let beside = if edge == V::ZERO { x } else { x - edge * (edge.dot(x) / edge.length_squared()) };
        let about = (V::DIM == 3 && edge != V::ZERO).then(|| about_edge(edge, x));
        let faces = across_faces(state.simplex.witnesses(), state.axis);
        let planes = [beside, state.axis].into_iter().chain(faces).chain(about.into_iter().flatten());
        let mut best: Option<SupportPlane<V>> = None;
        let mut least = near.lower.max(V::Scalar::ZERO) + self.frame.radius;
        let planes = planes.flat_map(|n| [Some(n), self.without_noise(n)]).flatten();
        for n in planes {
            if let Some(plane) = self.plane(pair, n).filter(|plane| plane.is_beyond(least)) {
                (least, best) = (plane.certain(), Some(plane));
            }
        }
        best
    }

    /// The vector without those of its coordinates that hold no more of the bodies' extents than the error of the
    /// query, if there are any: rounding may have made them up, and they tilt a plane by all of that error. The normal
    /// of a long box's side comes back exactly.
    fn without_noise(&self, n: V) -> Option<V> {
        let (extent, error) = (self.points.extent, self.frame.error * n.norm());
        let clean = V::from_fn(|i| if n.get(i).abs() * extent.get(i) > error { n.get(i) } else { Scalar::ZERO });
        (clean != n).then_some(clean)
    }
}

impl<V: Vector> NearContact<V> {
    /// The same with a plane that proves more.
    fn with_plane(self, &SupportPlane { n: normal, level, error }: &SupportPlane<V>) -> Self {
        let gap = level - self.frame.radius;
        Self { normal, gap, lower: gap - error, upper: self.upper.max(gap - error), ..self }
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DQuat, DVec3, Vec2};
    use convex_support::{Cone, Cuboid, Cylinder, Ellipsoid, InvalidShape, Posed, Triangle};

    use crate::pair::Shape;
    use crate::{DistanceOptions, SignedDistanceOptions, distance, signed_distance};

    /// A search from zero ends at a simplex with zero on one of its faces, or at a side of a needle that is thinner
    /// than the noise. Seen from aside, the first is within the difference, and the second beside zero.
    #[test]
    fn signs_that_a_search_leaves_open_are_seen_from_aside() -> Result<(), InvalidShape> {
        let cube = Cuboid::new(DVec3::ONE)?;
        let within = distance(&cube, &Cuboid::new(DVec3::splat(0.5))?, DistanceOptions::default());
        assert_eq!((within.upper, within.overlap), (0.0, true), "{within:?}");

        let needle = Triangle::new([Vec2::Y, Vec2::new(4.514369e-10, 0.25), Vec2::new(-1.8704648e-8, 0.46499807)])?;
        let needle = Posed::translated(needle, Vec2::new(-0.00040346384, -0.46299887))?;
        let point = Posed::translated(Cuboid::new(Vec2::ZERO)?, Vec2::new(-0.00040347216, 0.53700113))?;
        for beside in [distance(&point, &needle, Default::default()), distance(&needle, &point, Default::default())] {
            assert!(beside.lower > 0.0 && !beside.overlap, "{beside:?}");
        }
        Ok(())
    }

    /// Needles a few roundings beside what is small: the length of the needle rounds the query, and tells nothing of
    /// the gap. A depth search finds the planes too, and a distance may not say that the bodies meet.
    #[test]
    fn sides_of_needles_are_told_apart_as_a_depth_does() -> Result<(), InvalidShape> {
        let apart = |a: Shape<'_, DVec3>, b: Shape<'_, DVec3>, gap: f64| {
            let (plain, signed) =
                (distance(a, b, DistanceOptions::default()), signed_distance(a, b, SignedDistanceOptions::new()));
            assert!(plain.lower > 0.5 * gap && !plain.overlap && plain.lower < 2.0 * gap, "{plain:?}");
            assert!(signed.lower > 0.5 * gap && !signed.overlap, "{signed:?}");
        };
        let speck = Posed::translated(
            Cuboid::new(DVec3::splat(1e-43))?,
            DVec3::new(-0.11735953804403598, 0.9999897166614066, 0.1173595380440422),
        )?;
        apart(&Cone::<DVec3>::new(20147.429270990804, 0.33195937709484274)?, &speck, 2.5e-15);
        let short = Posed::translated(
            Cone::new(0.2762450253964171, 0.9521026630806718)?,
            DVec3::new(-128.2714892061013, 540.2886984036094, 364.1215706727575),
        )?;
        let rod = Posed::translated(
            Cylinder::new(2142146.808538575, 0.7869414837698594)?,
            DVec3::new(-127.69366982985628, 0.0, 362.4813269978302),
        )?;
        apart(&short, &rod, 2.3e-12);
        let grain = Ellipsoid::new(DVec3::new(1e-4, 3e-4, -5e-4), DVec3::new(1.1e-4, 7.3e-5, 5.6e-4), DQuat::IDENTITY)?;
        let wide = DVec3::new(0.75, 0.8, 4675632.701164697);
        let wall = Posed::translated(Cuboid::new(wide)?, DVec3::X * (1e-4 - 1.1e-4 - 0.75 - 2e-14))?;
        apart(&grain, &wall, 2e-14);
        Ok(())
    }
}
