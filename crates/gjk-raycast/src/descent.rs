//! The descent to the closest points that [`distance`](crate::distance) and [`intersects`](crate::intersects) share (the
//! paper's Algorithm 2).

use convex_support::{Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::body::{Body, Pair, power_of_two_near, reciprocal_of_power};
use crate::closest::{Closest, nearest_face};
use crate::decrease::Decrease;
use crate::flat::project;
use crate::newton::Newton;
use crate::regions::nearest;
use crate::simplex::{Face, MAX_POINTS, Simplex};
use crate::{Iterate, Status, SubAlgorithm};

/// Where the difference of two bodies is, and the unit it is measured in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<V: Vector> {
    pub(crate) scale: V::Scalar,
    pub(crate) per_unit: V::Scalar,
    /// The difference of the origins: zero lies at minus this, seen from the origin of `A − B`.
    pub(crate) offset: V,
    /// The radii of both bodies.
    pub(crate) radius: V::Scalar,
    /// What rounding may have added to any bound.
    pub(crate) noise: V::Scalar,
}

impl<V: Vector> Frame<V> {
    /// The frame of a pair whose origins and sizes are these, which is set to the frame's unit.
    #[inline]
    pub(crate) fn new<A, B>(pair: &mut Pair<'_, A, B>, offset: V, size: V::Scalar) -> Self
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
    {
        let scale = power_of_two_near(size);
        let per_unit = reciprocal_of_power(scale);
        pair.set_scale(scale);
        let (radius, noise) = (pair.radius() * per_unit, rounding(size) * per_unit);
        Self { scale, per_unit, offset: offset * per_unit, radius, noise }
    }

    /// Cores no farther apart than this touch.
    #[inline(always)]
    fn touching(&self) -> V::Scalar {
        self.radius.max(self.noise)
    }
}

/// What rounding may add to a bound on the distance of two bodies of the given size.
#[inline]
pub(crate) fn rounding<S: Scalar>(size: S) -> S {
    S::from_f64(8.0) * S::EPSILON * size
}

/// What a descent is to find out; lengths in units of the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted<V: Vector> {
    /// The first direction from zero to the difference, of any length but zero.
    pub(crate) first: V,
    /// Stop where the cores are certainly farther apart than this.
    pub(crate) limit: V::Scalar,
    /// Stop where the bracket is as narrow as this, relative to its lower end.
    pub(crate) tolerance: V::Scalar,
    /// Whether the closest points are wanted, and not only which of two bounds comes first.
    pub(crate) closely: bool,
    pub(crate) max_iterations: usize,
    pub(crate) sub_algorithm: SubAlgorithm,
}

/// How a descent ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    Separated,
    Overlap,
    IterationLimit,
    Stalled,
}

impl End {
    pub(crate) fn status(self) -> Status {
        match self {
            Self::Separated | Self::Overlap => Status::Converged,
            Self::IterationLimit => Status::IterationLimit,
            Self::Stalled => Status::Stalled,
        }
    }
}

/// What a descent knows at its end; lengths in units of the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Descent<V: Vector, W> {
    /// The corners of the face closest to zero.
    pub(crate) simplex: Simplex<V, W>,
    /// The shortest vector of the difference that was found, of any length, and its length.
    pub(crate) normal: V,
    pub(crate) length: V::Scalar,
    /// The best lower bound on the distance of the cores, before rounding, and the axis that proves it, of any length.
    pub(crate) lower: V::Scalar,
    pub(crate) axis: V,
    axis_length: V::Scalar,
    /// Whether the corners have weights, and the length is that of an orthogonal projection.
    pub(crate) measured: bool,
    pub(crate) end: End,
    pub(crate) iterations: usize,
}

/// The shortest vector of a vertex or an edge is not trusted while the lower bound is below this part of its length.
const VAGUE: f64 = 0.5;

/// The weight of the lower bound's axis in a direction between it and the shortest vector. Of 1.5, 2 and 3 it takes the fewest
/// support points on average of polytopes of 8 to 1024 vertices.
const LEAN: f64 = 2.0;

/// Algorithm 2 on the cores, until their distance is known to rounding, or to exceed the limit, or not to exceed the radii.
///
/// Steps are taken lightly, by [`nearest`] or as asked, and judged by what they achieve: one that brings the simplex no nearer
/// is taken again with care, by a search of all faces. The bounds that end the descent do not depend on how it came there:
/// the lower one is that of a plane through a support point, and the upper one is measured again before it counts.
///
/// `first` is the support point along the first direction, if it is known; `descent` is a new one, or one that
/// [began](Descent::begin_at) with a point, and its normal for first direction.
#[inline]
pub(crate) fn descend<B: Body>(
    descent: &mut Descent<B::Vector, B::Witness>,
    body: &mut B,
    frame: Frame<B::Vector>,
    wanted: Wanted<B::Vector>,
    mut first: Option<(B::Vector, B::Witness)>,
    mut observer: impl FnMut(Iterate<'_, B::Vector>),
) {
    let Frame { scale, offset, radius, noise, .. } = frame;
    let infinity = <B::Vector as Vector>::Scalar::infinity();
    let touching = frame.touching();
    let regions = wanted.sub_algorithm == SubAlgorithm::Regions;
    let mut nearing = Decrease::new();
    let mut n = wanted.first;
    let mut size = n.length();
    let curved = wanted.closely && body.is_curved();
    let mut newton = Newton::new(noise);
    let mut leant = false;
    while descent.iterations < wanted.max_iterations {
        let (point, witness) = first.take().unwrap_or_else(|| body.support(-n));
        let w = point + offset;
        descent.iterations += 1;
        // No point of A − B lies before w along n (the paper's bound ‖v‖² − v·w, divided by ‖v‖).
        let reach = n.dot(w) / size;
        if !reach.is_finite() {
            descent.end = End::Stalled;
            break;
        }
        if reach > descent.lower {
            (descent.lower, descent.axis, descent.axis_length) = (reach, n, size);
        }
        let (v, length) = descent.shortest();
        observer(Iterate {
            iteration: descent.iterations - 1,
            simplex: descent.simplex.points(),
            v,
            w,
            scale,
            lower: descent.lower * scale,
            upper: length * scale,
        });
        let mut light = true;
        if descent.lower > wanted.limit + noise {
            // The first support points are a bound from above, if nothing better is known.
            if wanted.closely && descent.simplex.points().is_empty() {
                descent.simplex.push(w, -n, witness);
            }
            descent.end = End::Separated;
            break;
        }
        let wide = |descent: &Descent<_, _>| {
            let gap = descent.length - descent.lower;
            !(gap <= noise || gap <= wanted.tolerance * descent.lower)
        };
        if !wide(descent) {
            if !descent.measured {
                let _ = descent.measure();
            }
            if !wide(descent) {
                descent.end = if descent.length - radius <= noise { End::Overlap } else { End::Separated };
                break;
            }
            // The steps were not as good as they seemed.
            light = false;
        }
        descent.simplex.push(w, -n, witness);
        let next = if light && regions {
            descent.step_lightly(w)
        } else if light && descent.step_nearer(wanted.sub_algorithm) {
            Some((descent.normal, descent.normal.length()))
        } else {
            None
        };
        if next.is_none() && light && (leant || newton.has_turned()) {
            // A plane that was turned away from the shortest vector may be the better bound without its support point
            // bringing the simplex nearer.
            descent.simplex.pop();
            let to = if leant { None } else { newton.next(body, descent, w, n / size, reach) };
            (n, size) = to.map_or((descent.normal, descent.normal.length()), |to| (to, Scalar::ONE));
            leant = false;
            continue;
        }
        let next = next.or_else(|| descent.step_carefully(&mut nearing));
        let Some(next) = next else {
            // The light steps' normal of a sliver leans by its rounding, and what supports the body along it may be a corner
            // already. Measured, it shows another.
            if !descent.measured {
                let _ = descent.measure();
            }
            if n != descent.normal && nearing.goes_on(descent.length) {
                (n, size) = (descent.normal, descent.normal.length());
                continue;
            }
            descent.end = End::Stalled;
            break;
        };
        let (along, along_size) = (n, size);
        (n, size) = next;
        // No point is nearer than the lower bound: a sliver's light length is its rounding. Taken for progress, it would have the same
        // two steps go on forever.
        if descent.length < descent.lower && !descent.measured {
            (n, size) = descent.measure().unwrap_or((n, size));
        }
        if descent.length <= touching {
            // A simplex of full dimension contains zero for certain; of any other it remains to be measured.
            if descent.length > Scalar::ZERO && !descent.measured {
                (n, size) = descent.measure().unwrap_or((n, size));
            }
            if descent.length <= touching {
                descent.end = End::Overlap;
                break;
            }
        }
        if curved {
            if let Some(to) = newton.next(body, descent, w, along / along_size, reach) {
                (n, size) = (to, Scalar::ONE);
            }
        } else {
            let to = if descent.is_vague() { descent.leaning(n, size) } else { B::Vector::ZERO };
            let length = to.length();
            // Both directions may cancel.
            leant = length > Scalar::ZERO;
            if leant {
                (n, size) = (to, length);
            }
        }
    }
    if descent.end == End::Stalled && descent.length < infinity {
        if !descent.measured {
            let _ = descent.measure();
        }
        if descent.length - radius <= noise {
            descent.end = End::Overlap;
        }
    }
}

impl<V: Vector, W: Copy + Default> Descent<V, W> {
    /// The descent that begins along the given direction.
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
            end: End::IterationLimit,
            iterations: 0,
        }
    }

    /// The descent that begins with a point of the difference, if that is finite, and with the vector to it for first direction;
    /// it ends there where the bodies meet to rounding.
    #[inline(always)]
    pub(crate) fn begin_at(&mut self, point: V, witness: W, frame: &Frame<V>) {
        let mut weights = [V::Scalar::ZERO; MAX_POINTS];
        weights[0] = V::Scalar::ONE;
        self.simplex.push(point, -point, witness);
        if self.accept(Closest { v: point, face: Face::of_corners(&[0]), weights }).is_none() {
            self.simplex.pop();
        } else if self.length <= frame.touching() {
            self.end = End::Overlap;
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

    /// Whether the simplex leaves open where to look next, and its shortest vector says little about that. A triangle leaves
    /// nothing open, and polygons in the plane need few steps anyway.
    #[inline(always)]
    fn is_vague(&self) -> bool {
        let is_open = V::DIM == 3 && self.simplex.points().len() < V::DIM;
        is_open && self.lower < self.length * V::Scalar::from_f64(VAGUE)
    }

    /// A direction between that of the shortest vector, `n` of length `size`, and the axis of the lower bound.
    ///
    /// Among unit vectors, the distance of `C = A − B` from zero is the maximum of `f(n) = min n·x` over all `x` of `C`. The
    /// points known of `C` bound `f` from above, and the shortest vector of their simplex is where that bound is largest. While
    /// they are few it is far from where `f` is, and leaps from side to side, as cutting planes do. So, as in level bundle
    /// methods (Lemaréchal, Nemirovskii, Nesterov, 1995), only part of the way to it is gone from the best direction known.
    /// Where an edge is closest, both its ends should stay equally far: the way is across the edge.
    #[inline(always)]
    fn leaning(&self, n: V, size: V::Scalar) -> V {
        let mut axis = self.axis;
        if let &[p, q] = self.simplex.points() {
            let e = q - p;
            axis -= e * (axis.dot(e) / e.length_squared());
        }
        // The sum of the unit vectors, times both lengths.
        n * self.axis_length + axis * (V::Scalar::from_f64(LEAN) * size)
    }

    /// Goes on to the face of the simplex closest to zero, if that is clear and brings it nearer; its normal, and the length
    /// of that. The newest point is `y`.
    #[inline(always)]
    fn step_lightly(&mut self, y: V) -> Option<(V, V::Scalar)> {
        let (points, newest) = self.simplex.padded();
        let next = nearest(points, newest, y)?;
        let level = next.normal.dot(y);
        let (normal, size) = comfortable(next.normal)?;
        let length = if size > V::Scalar::ZERO { level / size } else { size };
        if length < self.length {
            self.simplex.keep(next.face);
            (self.normal, self.length, self.measured) = (normal, length, false);
            Some((normal, size))
        } else {
            None
        }
    }

    /// The same by another way to find the face; whether it did.
    #[cold]
    #[inline(never)]
    fn step_nearer(&mut self, sub_algorithm: SubAlgorithm) -> bool {
        let next = sub_algorithm.closest(self.simplex.points(), V::DIM);
        next.filter(|next| next.v.norm() < self.length).and_then(|next| self.accept(next)).is_some()
    }

    /// The same by a search of all faces. Where rounding is all that is left to gain, a few steps without a gain are borne
    /// with. `None`, and the newest point is not added, where there are too many of them.
    #[cold]
    #[inline(never)]
    fn step_carefully(&mut self, nearing: &mut Decrease<V::Scalar>) -> Option<(V, V::Scalar)> {
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

    /// Measures the face closest to zero by orthogonal projection, whatever rounding the steps there left.
    #[inline(never)]
    pub(crate) fn measure(&mut self) -> Option<(V, V::Scalar)> {
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
    fn accept(&mut self, Closest { v, face, weights }: Closest<V>) -> Option<(V, V::Scalar)> {
        self.simplex.retain(face, weights);
        self.now_at(v)
    }

    /// Takes the measured shortest vector for the best known.
    #[inline(always)]
    fn now_at(&mut self, v: V) -> Option<(V, V::Scalar)> {
        let (normal, size) = comfortable(v)?;
        (self.normal, self.length, self.measured) = (normal, v.norm(), true);
        Some((normal, size))
    }
}

/// A vector of the same direction whose square is in range, and its length; the zero vector as it is. `None` where it is
/// not finite.
#[inline]
fn comfortable<V: Vector>(v: V) -> Option<(V, V::Scalar)> {
    let squared = v.length_squared();
    if squared >= V::Scalar::min_positive_value() / V::Scalar::EPSILON {
        squared.is_finite().then(|| (v, squared.sqrt()))
    } else {
        v.unit().map_or((v == V::ZERO).then_some((v, V::Scalar::ZERO)), |unit| Some((unit, V::Scalar::ONE)))
    }
}
