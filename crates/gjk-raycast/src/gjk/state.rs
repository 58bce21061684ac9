//! What GJK knows after each step: a simplex with its point closest to zero, and the best plane.

use convex_support::numerics::range::is_comfortable;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::{Direction, Frame, Progress};
use crate::body::{AnyPair, PointPair};
use crate::simplex::{Closest, Face, MAX_POINTS, Simplex, nearest, nearest_face, project};
use crate::{Iterate, SubAlgorithm};

/// The simplex, the bounds on the distance of the cores, and the plane that proves the lower one; lengths in units of
/// the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gjk<V: Vector> {
    /// The corners of the face closest to zero (the paper's W).
    pub(crate) simplex: Simplex<V>,
    /// A vector along the shortest one found from zero to the difference (the paper's v), of any length.
    pub(crate) normal: V,
    /// The length of the shortest one.
    pub(crate) length: V::Scalar,
    /// The best lower bound on the distance of the cores, before rounding, and the axis that proves it, of any length.
    pub(crate) lower: V::Scalar,
    pub(crate) axis: V,
    pub(super) axis_length: V::Scalar,
    /// Whether the corners have weights, and the length is that of an orthogonal projection.
    pub(super) measured: bool,
    pub(crate) iterations: usize,
}

impl<V: Vector> Gjk<V> {
    /// The state before the first support point, which is to be along the given direction.
    #[inline(always)]
    pub(crate) fn new(first: V) -> Self {
        Self {
            simplex: Simplex::new(),
            normal: first,
            length: V::Scalar::infinity(),
            lower: -V::Scalar::infinity(),
            axis: first,
            axis_length: first.length(),
            measured: false,
            iterations: 0,
        }
    }

    /// Begins with a point of the difference, if that is finite, and with the vector to it for first direction. Whether
    /// the bodies meet there, to rounding.
    #[inline(always)]
    pub(crate) fn begin_at(&mut self, point: V, witness: PointPair<V>, frame: &Frame<V>) -> bool {
        let mut weights = [V::Scalar::ZERO; MAX_POINTS];
        weights[0] = V::Scalar::ONE;
        self.simplex.push(point, -point, witness);
        if self.accept(Closest { v: point, face: Face::of_corners(&[0]), weights }).is_none() {
            self.simplex.pop();
            return false;
        }
        self.length <= frame.touching()
    }

    /// Begins at the closest points of the cores of a pair of the given size, where those are known in closed form:
    /// whether the bodies meet there, to rounding. `None` where they are not known, and the state is as it was.
    #[inline(always)]
    pub(crate) fn begin_at_closest(
        &mut self,
        pair: &AnyPair<'_, V>,
        frame: &Frame<V>,
        size: V::Scalar,
    ) -> Option<bool> {
        let points = pair.closest_points(frame.offset * frame.scale, size)?;
        Some(self.begin_at(points.a - points.b + frame.offset, points, frame))
    }

    /// The state at a face of the difference, of which `v` is the point closest to zero and is made of its corners with
    /// these weights.
    #[inline]
    pub(crate) fn at_face(
        corners: impl Iterator<Item = (V, PointPair<V>)>,
        weights: [V::Scalar; MAX_POINTS],
        v: V,
    ) -> Self {
        let mut state = Self::new(v);
        for (point, witness) in corners {
            state.simplex.push(point, -v, witness);
        }
        state.simplex.weigh(weights);
        (state.length, state.measured) = (v.norm(), true);
        state
    }

    /// Raises the lower bound to the plane through the support point `w` along a direction, if it is higher: no point
    /// of `A − B` lies before `w` along it (the paper's bound `‖v‖² − v·w`, divided by `‖v‖`). How high the plane is,
    /// if that is finite. Of planes that are equally high the first
    /// is kept: the later ones are along shorter vectors, of which more is rounding.
    #[inline(always)]
    pub(super) fn advance(&mut self, Direction { n, length }: Direction<V>, w: V) -> Option<V::Scalar> {
        self.iterations += 1;
        let reach = n.dot(w) / length;
        if !reach.is_finite() {
            return None;
        }
        if reach > self.lower {
            (self.lower, self.axis, self.axis_length) = (reach, n, length);
        }
        Some(reach)
    }

    /// Whether the bounds are as near to one another as rounding or the tolerance.
    #[inline(always)]
    pub(super) fn is_closed(&self, frame: &Frame<V>, tolerance: V::Scalar) -> bool {
        let gap = self.length - self.lower;
        // By default there is no tolerance, and nothing to compute.
        gap <= frame.noise || tolerance > V::Scalar::ZERO && gap <= tolerance * (self.lower - frame.radius)
    }

    /// What an observer is shown after support point `w` was found.
    #[inline(always)]
    pub(super) fn iterate(&self, w: V, scale: V::Scalar) -> Iterate<'_, V> {
        let (v, length) = self.shortest();
        Iterate {
            iteration: self.iterations - 1,
            simplex: self.simplex.points(),
            v,
            w,
            scale,
            lower: self.lower * scale,
            upper: length * scale,
        }
    }

    /// The shortest vector found and its length; as long as there is none, the first direction and infinity.
    fn shortest(&self) -> (V, V::Scalar) {
        let size = self.normal.length();
        if !self.length.is_finite() || size <= V::Scalar::ZERO {
            return (self.normal, self.length);
        }
        // A sliver's normal leans by its rounding, and its corners are not equally far along it.
        let levels = self.simplex.points().iter().map(|p| self.normal.dot(*p) / size);
        let length = levels.fold(self.length, V::Scalar::max);
        (self.normal * (length / size), length)
    }

    #[inline(always)]
    pub(super) fn along_normal(&self) -> Direction<V> {
        Direction { n: self.normal, length: self.normal.length() }
    }

    /// Whether the shortest vector is no longer than `touching`; `v` is its direction, which may change as it is
    /// measured.
    #[inline(always)]
    pub(super) fn overlaps(&mut self, touching: V::Scalar, v: &mut Direction<V>) -> bool {
        // No point is nearer than the lower bound: the length of a fast step in a sliver is its rounding. Taken for
        // progress, it would have the same two steps go on forever.
        if self.length < self.lower && !self.measured {
            *v = self.measure().unwrap_or(*v);
        }
        // A simplex of full dimension contains zero, or is looked at more closely; of any other it remains to be
        // measured, even where the fast step's length is zero, as it may be by rounding.
        if self.length <= touching && self.simplex.points().len() <= V::DIM && !self.measured {
            *v = self.measure().unwrap_or(*v);
        }
        self.length <= touching
    }

    /// Goes on to the face of the simplex closest to zero, if that is clear and brings it nearer. The newest point is
    /// `y`.
    #[inline(always)]
    pub(super) fn step(&mut self, y: V, sub_algorithm: SubAlgorithm) -> Option<Direction<V>> {
        if sub_algorithm != SubAlgorithm::Regions {
            return self.step_by(sub_algorithm);
        }
        let (points, newest) = self.simplex.padded();
        let next = nearest(points, newest, y)?;
        let level = next.normal.dot(y);
        let direction = in_range(next.normal)?;
        let length = if direction.length > V::Scalar::ZERO { level / direction.length } else { direction.length };
        if length < self.length {
            self.simplex.keep(next.face);
            (self.normal, self.length, self.measured) = (direction.n, length, false);
            Some(direction)
        } else {
            None
        }
    }

    /// The same by another way to find the face.
    #[cold]
    #[inline(never)]
    fn step_by(&mut self, sub_algorithm: SubAlgorithm) -> Option<Direction<V>> {
        let next = sub_algorithm.closest(self.simplex.points(), V::DIM)?;
        if next.v.norm() < self.length { self.accept(next).map(|_| self.along_normal()) } else { None }
    }

    /// The same by a search of all faces. Where rounding is all that is left to gain, a few steps without a gain are
    /// allowed. `None`, and the newest point is not added, where there are too many of them.
    #[cold]
    #[inline(never)]
    pub(super) fn step_by_all_faces(&mut self, nearing: &mut Progress<V::Scalar>) -> Option<Direction<V>> {
        let next = match self.simplex.points() {
            [known @ .., newest] if known.contains(newest) => None,
            points => nearest_face(points, V::DIM),
        };
        let Some(next) = next.filter(|next| nearing.goes_on(next.v.norm())) else {
            self.simplex.pop();
            return None;
        };
        self.accept(next)
    }

    /// [Measures](Self::measure) the shortest vector where that was not done yet.
    #[inline(always)]
    pub(crate) fn ensure_measured(&mut self) {
        if !self.measured {
            let _ = self.measure();
        }
    }

    /// Measures the face closest to zero by orthogonal projection, whatever rounding the steps there left.
    #[inline(never)]
    fn measure(&mut self) -> Option<Direction<V>> {
        let points = self.simplex.points();
        if points.is_empty() {
            return None;
        }
        let foot = project(points, |corner| -corner);
        if !foot.coordinates[..points.len()].iter().all(|&b| b > V::Scalar::ZERO) {
            return nearest_face(points, V::DIM).and_then(|found| self.accept(found));
        }
        let v = if points.len() > V::DIM { V::ZERO } else { -foot.across };
        self.simplex.weigh(foot.coordinates);
        self.now_at(v)
    }

    #[inline(always)]
    fn accept(&mut self, Closest { v, face, weights }: Closest<V>) -> Option<Direction<V>> {
        self.simplex.retain(face, weights);
        self.now_at(v)
    }

    /// Takes the measured shortest vector for the best known.
    #[inline(always)]
    fn now_at(&mut self, v: V) -> Option<Direction<V>> {
        let direction = in_range(v)?;
        (self.normal, self.length, self.measured) = (direction.n, v.norm(), true);
        Some(direction)
    }
}

/// The direction of a vector, at a length whose square is in range; the zero vector as it is. `None` where it is not
/// finite.
#[inline]
pub(super) fn in_range<V: Vector>(v: V) -> Option<Direction<V>> {
    let squared = v.length_squared();
    if is_comfortable(squared) {
        Some(Direction { n: v, length: squared.sqrt() })
    } else if v == V::ZERO {
        Some(Direction { n: v, length: V::Scalar::ZERO })
    } else {
        v.unit().map(|n| Direction { n, length: V::Scalar::ONE })
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::DVec3;

    use super::*;

    /// A plane that is lower proves less; of planes that are equally high the first one is kept.
    #[test]
    fn only_a_higher_plane_raises_the_lower_bound() {
        let mut state = Gjk::new(DVec3::X);
        let along = |n: DVec3| Direction { n, length: n.length() };
        assert_eq!(state.advance(along(DVec3::X * 4.0), DVec3::new(2.0, 0.0, 0.0)), Some(2.0));
        assert_eq!(state.advance(along(DVec3::Y), DVec3::new(0.0, 1.0, 0.0)), Some(1.0));
        assert_eq!((state.lower, state.axis), (2.0, DVec3::X * 4.0));
        let _ = state.advance(along(DVec3::Z), DVec3::new(0.0, 0.0, 2.0));
        assert_eq!((state.lower, state.axis), (2.0, DVec3::X * 4.0));
        assert_eq!(state.advance(along(DVec3::X), DVec3::NAN), None);
        let _ = state.advance(along(DVec3::Z), DVec3::new(0.0, 0.0, 2.5));
        assert_eq!((state.lower, state.axis, state.iterations), (2.5, DVec3::Z, 5));
    }
}
