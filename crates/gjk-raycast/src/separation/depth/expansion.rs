//! The expanding polytope: the shortest way out of the difference of two cores. The facet nearest to zero bounds the
//! way from below, the support point beyond it from above and is added, until both meet.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::WayOut;
use super::boundary::Boundary;
use super::newton;
use super::witness::{self, Ends};
use crate::SignedDistanceOptions;
use crate::body::PointPair;
use crate::gjk::Gjk;
use crate::observer::Observer;
use crate::separation::MetPoint;
use crate::separation::cores::{Cores, Vertex};
use crate::simplex::{MAX_POINTS, project_rarely};
use crate::{Iterate, Status};

/// The width of a bracket relative to the way out, below which the tolerance is enough; and the number of further
/// support points to become so narrow. A tolerance relative to the size may be many times as wide as the way is long,
/// for bodies that barely touch.
const NARROW_PART: f64 = 1e-6;
const MORE_TO_NARROW: usize = 24;

/// How many of these may find nothing lower.
const IDLE_POINTS: usize = 4;

/// The part of the support points that may be added to them for the points at the ends of the way.
const FOR_ENDS: usize = 16;

/// Since when the bracket is as narrow as the tolerance, when a lower way out was found last, and which; times in
/// support points.
struct Closed<S> {
    from: usize,
    lowered: usize,
    h: S,
}

impl<S: Scalar> Closed<S> {
    fn new(time: usize, h: S) -> Self {
        Self { from: time, lowered: time, h }
    }

    /// Whether all support points are spent, at a time when the way out is `h`; a way lower by no more than a `little`
    /// does not count.
    fn is_spent(&mut self, time: usize, h: S, little: S) -> bool {
        if self.h - h > little {
            (self.lowered, self.h) = (time, h);
        }
        time >= self.from + MORE_TO_NARROW || time >= self.lowered + IDLE_POINTS
    }
}

/// The result of an expansion; lengths in the unit of the cores.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expanded<V: Vector> {
    pub(super) way: WayOut<V>,
    /// Points of both cores at its ends.
    pub(super) ends: Ends<V>,
    /// The ball of this radius about zero is certainly within the difference. If it is negative, zero is certainly no
    /// farther from the difference than its amount.
    pub(super) inner: V::Scalar,
    pub(super) status: Status,
    pub(super) unexpanded: usize,
}

/// The search for the direction `u` in which the support value of the difference `K` of two cores is least.
///
/// Every unit vector bounds the depth from above, by its support value `h(u)`; a polytope of support points with zero
/// within bounds it from below, by the facet nearest to zero. So only that facet has to be examined: the support
/// point along its normal either shows that it is on the boundary of `K`, and then it decides, or makes the polytope
/// larger (van den Bergen, *Proximity queries and penetration depth computation on 3D game objects*, 2001). Zero need
/// not be within the polytope at first. Facets that it is beyond are the nearest by their sign, and grow until it is
/// within, or one of them separates it from `K`. Until then its distance beyond their planes proves nothing, since
/// two planes may meet at an angle as sharp as one likes; zero is no farther from `K` than the point that GJK has
/// found, or than a point of the polytope.
///
/// If `K` is smooth, its facets never are on the boundary, and the polytope only shows that there is no shorter way;
/// Newton's method finds the way itself, in each basin that a facet leads to.
pub(super) fn expand<V: Vector>(
    cores: &mut Cores<'_, V>,
    state: &mut Gjk<V>,
    options: &SignedDistanceOptions<V>,
    observer: &mut Observer<'_, V>,
) -> Option<Expanded<V>> {
    let relative = if cores.is_curved() { options.tolerance } else { Scalar::ZERO };
    Boundary::lend(relative.max(Scalar::EPSILON).as_f64(), |boundary| {
        expand_within(boundary, relative * cores.size, cores, state, options, observer)
    })
}

/// [`expand`] until the bracket is as narrow as the tolerance, by a polytope that there is none of yet.
#[inline(always)]
fn expand_within<V: Vector>(
    boundary: &mut Boundary<V>,
    tolerance: V::Scalar,
    cores: &mut Cores<'_, V>,
    state: &mut Gjk<V>,
    options: &SignedDistanceOptions<V>,
    observer: &mut Observer<'_, V>,
) -> Option<Expanded<V>> {
    let is_curved = cores.is_curved();
    let way = match first_polytope(cores, state, boundary)? {
        FirstPolytope::Flat(way) => return Some(flat(way, MetPoint::new(cores, state))),
        FirstPolytope::Full(way) => way,
    };
    let mut expansion =
        Expansion { way, is_curved, tolerance, enough: tolerance, may_lean: is_curved, closed: None, met: None };
    expansion.take(cores, way);
    let depth_limit = (options.depth_limit - cores.radius()) / cores.scale();
    let mut is_deep = false;
    let status = loop {
        let (nearest, inner) = boundary.nearest();
        let inner = if inner > Scalar::ZERO {
            inner
        } else {
            -expansion.met.get_or_insert_with(|| MetPoint::new(cores, state)).reached
        };
        if expansion.is_closed(inner) {
            match expansion.close(cores, inner) {
                Closing::Spent => break Status::Converged,
                // Perhaps no step was taken towards the bottom yet.
                Closing::First => {
                    let corners = boundary.corners(nearest);
                    expansion.descend(cores, boundary, &corners[..V::DIM], options)?;
                    continue;
                }
                Closing::Again => {}
            }
        }
        // The depth is certainly this large, whatever the sum with the radii rounds to.
        if inner - cores.greatest_error() - cores.noise() > depth_limit {
            is_deep = true;
            break Status::Converged;
        }
        if cores.iterations >= options.max_iterations {
            break Status::IterationLimit;
        }
        if !expansion.grow(cores, boundary, nearest, inner, options, observer)? {
            break Status::Stalled;
        }
    };
    let Expansion { way, closed, met, .. } = expansion;
    let status = if closed.is_some() { Status::Converged } else { status };
    // A question only about a limit of the depth needs no better points.
    let for_ends = if is_deep { 0 } else { options.max_iterations + options.max_iterations / FOR_ENDS };
    Some(settled(cores, state, boundary, way, met, status, for_ends))
}

/// The state of an expansion beside its polytope.
struct Expansion<V: Vector> {
    /// The shortest way out that was found.
    way: WayOut<V>,
    is_curved: bool,
    tolerance: V::Scalar,
    /// The width that the bracket may keep: the tolerance, or the rounding along the way.
    enough: V::Scalar,
    /// Whether directions may lean; not next after one whose support point was not beyond the facet.
    may_lean: bool,
    /// Since when the bracket is as narrow as the options say.
    closed: Option<Closed<V::Scalar>>,
    /// The point that GJK has found, if zero is not within the polytope.
    met: Option<MetPoint<V>>,
}

/// The remaining work when the bracket is as narrow as the options say.
enum Closing {
    /// It is so for the first time, and may become narrower.
    First,
    Again,
    Spent,
}

impl<V: Vector> Expansion<V> {
    fn take(&mut self, cores: &Cores<'_, V>, way: WayOut<V>) {
        self.way = way;
        self.enough = self.tolerance.max(cores.rounding_along(way.u()));
    }

    /// Whether the bracket down to `inner` is as narrow as the options say. NaN is so too.
    fn is_closed(&self, inner: V::Scalar) -> bool {
        !(self.way.h - inner > self.enough)
    }

    fn close(&mut self, cores: &Cores<'_, V>, inner: V::Scalar) -> Closing {
        let (way, time) = (&self.way, cores.iterations);
        let little = cores.rounding_along(way.u()).max(way.h.abs() * Scalar::from_f64(NARROW_PART));
        let is_first = self.closed.is_none();
        let closed = self.closed.get_or_insert_with(|| Closed::new(time, way.h));
        if closed.is_spent(time, way.h, little) || !(self.is_curved && way.h - inner > little) {
            Closing::Spent
        } else if is_first {
            Closing::First
        } else {
            Closing::Again
        }
    }

    /// Goes to the bottom of the basin that the way is in, beside a facet that has or had these corners.
    fn descend(
        &mut self,
        cores: &mut Cores<'_, V>,
        boundary: &mut Boundary<V>,
        corners: &[u16],
        options: &SignedDistanceOptions<V>,
    ) -> Option<()> {
        let way = newton::descend(cores, boundary, self.way, corners, options, self.closed.is_some())?;
        self.take(cores, way);
        Some(())
    }

    /// Takes the support point along the normal of the nearest facet, which is `inner` from zero. Whether there is more
    /// to do.
    fn grow(
        &mut self,
        cores: &mut Cores<'_, V>,
        boundary: &mut Boundary<V>,
        nearest: usize,
        inner: V::Scalar,
        options: &SignedDistanceOptions<V>,
        observer: &mut Observer<'_, V>,
    ) -> Option<bool> {
        let normal = boundary.facet_at(nearest).normal;
        let leaned = || self.way.leaned(normal, &boundary.corner_points(nearest)[..V::DIM]);
        let direction = if self.may_lean { leaned() } else { normal };
        let Some(vertex) = cores.support(direction) else { return Some(false) };
        let seen = WayOut::new(vertex);
        if seen.h < self.way.h {
            self.take(cores, seen);
        }
        let mut facet = [V::ZERO; 3];
        observer.show(|| {
            facet = boundary.corner_points(nearest);
            let (iteration, scale) = (cores.iterations - 1, cores.scale());
            let (lower, upper) = (-self.way.h * scale, -inner * scale);
            let (simplex, v, w) = (&facet[..V::DIM], normal * inner, vertex.point);
            Iterate { iteration, simplex, v, w, scale, lower, upper }
        });
        if self.closed.is_none() && self.is_closed(inner) {
            return Some(true);
        }
        let corners = boundary.corners(nearest);
        if !boundary.insert(nearest, &vertex) {
            // The support point along its own normal is beyond any facet that is not of the boundary.
            if self.may_lean && direction != normal {
                self.may_lean = false;
                return Some(true);
            }
            // The facet is on the boundary of K, and by the rounding of its plane farther in than the support value.
            return Some(boundary.measure(nearest));
        }
        self.may_lean = self.is_curved;
        if self.is_curved && seen.h == self.way.h {
            self.descend(cores, boundary, &corners[..V::DIM], options)?;
        }
        Some(true)
    }
}

/// The result of an expansion at its end.
#[inline(always)]
fn settled<V: Vector>(
    cores: &mut Cores<'_, V>,
    state: &mut Gjk<V>,
    boundary: &Boundary<V>,
    mut way: WayOut<V>,
    met: Option<MetPoint<V>>,
    status: Status,
    for_ends: usize,
) -> Expanded<V> {
    let (nearest, _) = boundary.nearest();
    let certain = boundary.certain_inner(|n| cores.error_along(n), cores.greatest_error());
    let is_inside = certain > Scalar::ZERO;
    let (ends, inner) = match witness::ends(cores, boundary, nearest, &mut way, for_ends) {
        Some(ends) if is_inside => (ends, certain),
        ends => {
            // The foot of the nearest facet, or what GJK has met, is the point nearest to zero of those that are known.
            let mut foot = witness::nearest_to(cores, boundary, nearest, Vector::ZERO, 0);
            let foot = MetPoint::new(cores, &mut foot);
            let known = if is_inside { foot } else { met.unwrap_or_else(|| MetPoint::new(cores, state)) };
            let MetPoint { point, points, reached } = if foot.reached < known.reached { foot } else { known };
            let one = V::Scalar::ONE;
            let (sign, inner) = if is_inside { (one, certain) } else { (-one, -reached) };
            let u = point.unit().map_or(way.u(), |n| n * sign);
            (ends.unwrap_or(Ends { u, depth: point.norm() * sign, points }), inner)
        }
    };
    let rounding = cores.rounding_along(way.u());
    let status = match status {
        Status::Stalled if way.h - inner <= rounding * Scalar::from_f64(2.0) => Status::Converged,
        status => status,
    };
    Expanded { way, ends, inner, status, unexpanded: boundary.len() }
}

/// A difference without an inside: the way out is across it, and no length.
fn flat<V: Vector>(way: WayOut<V>, MetPoint { points, reached, .. }: MetPoint<V>) -> Expanded<V> {
    let ends = Ends { u: way.u(), depth: way.h, points };
    Expanded { way, ends, inner: -reached, status: Status::Converged, unexpanded: 0 }
}

/// The start of an expansion, with the best way out found so far.
#[derive(Clone, Copy, Debug)]
enum FirstPolytope<V: Vector> {
    /// The boundary of a simplex.
    Full(WayOut<V>),
    /// The difference is no thicker than rounding along this direction.
    Flat(WayOut<V>),
}

/// A simplex of support points, beginning with those of GJK; `None` if a support point is not finite.
///
/// For cores in deep overlap GJK has led to a simplex that is thicker than rounding. As long as the points span no
/// volume, those farthest both ways across them are computed, and the farther one is added.
#[inline]
fn first_polytope<V: Vector>(
    cores: &mut Cores<'_, V>,
    state: &Gjk<V>,
    boundary: &mut Boundary<V>,
) -> Option<FirstPolytope<V>> {
    let known = state.simplex.points().len();
    let is_curved = cores.is_curved();
    let mut span = AffineSpan::new();
    let mut vertices = span.points;
    for (i, vertex) in vertices[..known].iter_mut().enumerate() {
        let along = state.simplex.along()[i];
        // Nothing asks for the length of others.
        let along = if is_curved { along.unit().unwrap_or(along) } else { along };
        *vertex = Vertex { point: state.simplex.points()[i], along, pair: state.simplex.witnesses()[i] };
    }
    // GJK's best plane is a way out; its support point may be dropped.
    let mut best = state
        .axis
        .unit()
        .filter(|_| known > 0 && state.lower.is_finite())
        .map(|n| WayOut { h: -state.lower, vertex: Vertex { along: -n, ..vertices[0] } });
    if known > V::DIM
        && let Some(best) = best
    {
        let thickness = cores.greatest_error() * Scalar::from_f64(2.0);
        if boundary.begin(&vertices[..known], thickness) {
            return Some(FirstPolytope::Full(best));
        }
    }
    for vertex in &vertices[..known] {
        let _ = span.add(cores, vertex);
    }
    while span.len < V::DIM + 1 {
        let u = span.across();
        let ways = [WayOut::new(cores.support(u)?), WayOut::new(cores.support(-u)?)];
        let least = if ways[1].h < ways[0].h { ways[1] } else { ways[0] };
        if best.is_none_or(|best| least.h < best.h) {
            best = Some(least);
        }
        if span.len == 0 {
            let _ = span.add(cores, &ways[0].vertex);
        }
        let height = |way: &WayOut<V>| way.h - way.u().dot(span.points[0].point);
        let farther = if height(&ways[1]) > height(&ways[0]) { ways[1] } else { ways[0] };
        if !span.add(cores, &farther.vertex) {
            return Some(FirstPolytope::Flat(least));
        }
    }
    if !boundary.begin(&span.points[..span.len], Scalar::ZERO) {
        return None;
    }
    let best = match best {
        Some(best) => best,
        None => {
            let (nearest, _) = boundary.nearest();
            let u = boundary.facet_at(nearest).normal;
            WayOut::new(cores.support(u)?)
        }
    };
    Some(FirstPolytope::Full(best))
}

/// Affinely independent points.
struct AffineSpan<V: Vector> {
    points: [Vertex<V>; MAX_POINTS],
    len: usize,
}

impl<V: Vector> AffineSpan<V> {
    fn new() -> Self {
        let none = Vertex { point: V::ZERO, along: V::ZERO, pair: PointPair::ZERO };
        Self { points: [none; MAX_POINTS], len: 0 }
    }

    /// Adds a point, unless it is no farther from the span of the others than rounding; whether it was added.
    #[inline(never)]
    fn add(&mut self, cores: &Cores<'_, V>, &vertex: &Vertex<V>) -> bool {
        if self.len > 0 {
            let edge = self.orthogonal(vertex.point - self.points[0].point);
            if !edge.unit().is_some_and(|u| u.dot(edge) > cores.rounding_along(u)) {
                return false;
            }
        }
        self.points[self.len] = vertex;
        self.len += 1;
        true
    }

    /// The part of a vector across the span.
    fn orthogonal(&self, v: V) -> V {
        let points = self.points.map(|vertex| vertex.point);
        if self.len > 1 { project_rarely(&points[..self.len], &|_| v).across } else { v }
    }

    fn across(&self) -> V {
        let axes = (0..V::DIM).map(|i| self.orthogonal(V::axis(i)));
        let longest = axes.reduce(|best, v| if v.length_squared() > best.length_squared() { v } else { best });
        longest.and_then(V::unit).unwrap_or_else(|| V::axis(0))
    }
}

/// The number of points is no more than the room for them.
const _: () = assert!(MAX_POINTS == 4, "a simplex in space has four points");
