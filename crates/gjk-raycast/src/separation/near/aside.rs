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

/// The noise of GJK from there, in that of the query: it is to find the faces of bodies thinner than the noise.
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
            let (offset, noise) = (self.frame.offset - place, self.frame.noise * Scalar::from_f64(NOISE_ASIDE));
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
        for n in planes {
            if let Some(plane) = self.plane(pair, n).filter(|plane| plane.is_beyond(least)) {
                (least, best) = (plane.certain(), Some(plane));
            }
        }
        best
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
    use convex_support::glam::{DVec3, Vec2};
    use convex_support::{Cuboid, Posed, Triangle};

    use crate::{DistanceOptions, distance};

    /// A search from zero ends at a simplex with zero on one of its faces, or at a side of a needle that is thinner
    /// than the noise. Seen from aside, the first is within the difference, and the second beside zero.
    #[test]
    fn signs_that_a_search_leaves_open_are_seen_from_aside() -> Result<(), convex_support::InvalidShape> {
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
}
