//! The next direction of GJK: along its shortest vector, or along one that is turned from it, towards the best plane
//! known or, for curved bodies, by [Newton's method](super::newton).

use convex_support::{Scalar, Vector};

use super::newton::Newton;
use super::state::in_range;
use super::{Direction, Gjk};
use crate::body::TracedSupport;

/// Chooses the next direction.
pub(super) struct NextDirection<V: Vector> {
    /// Steps by curvature, where they are worthwhile.
    newton: Option<Newton<V>>,
    /// Whether the last direction was chosen between the shortest vector and the best plane.
    levelled: bool,
}

impl<V: Vector> NextDirection<V> {
    /// `curved` if steps by curvature are worthwhile.
    pub(super) fn new(curved: bool, noise: V::Scalar) -> Self {
        Self { newton: curved.then(|| Newton::new(noise)), levelled: false }
    }

    /// Whether the last direction is not that of the shortest vector.
    pub(super) fn has_turned(&self) -> bool {
        self.levelled || self.newton.as_ref().is_some_and(Newton::has_turned)
    }

    /// The direction after a turned one, whose support point `w`, with `reach` along it, brings the simplex no nearer.
    #[inline(always)]
    pub(super) fn turn_again<B: TracedSupport<Vector = V>>(
        &mut self,
        body: &B,
        state: &Gjk<V>,
        looked: Direction<V>,
        w: V,
        reach: V::Scalar,
    ) -> Direction<V> {
        let newton = self.newton.as_mut().filter(|_| !self.levelled);
        let turned = newton.and_then(|newton| newton.next(body, state, w, looked.n / looked.length, reach));
        self.levelled = false;
        turned.map_or_else(|| state.along_normal(), |n| Direction { n, length: Scalar::ONE })
    }

    /// The direction after a step to the shortest vector, by the support point `w` with `reach` along the last
    /// direction.
    #[inline(always)]
    pub(super) fn after<B: TracedSupport<Vector = V>>(
        &mut self,
        body: &B,
        state: &Gjk<V>,
        looked: Direction<V>,
        w: V,
        reach: V::Scalar,
    ) -> Direction<V> {
        let v = state.along_normal();
        if let Some(newton) = &mut self.newton {
            let turned = newton.next(body, state, w, looked.n / looked.length, reach);
            return turned.map_or(v, |n| Direction { n, length: Scalar::ONE });
        }
        let levelled = if leaves_open(state) { in_range(level(state, v)) } else { None };
        // The two directions may cancel. If bodies overlap deeply, the axis is opposite to the shortest vector, and a
        // direction between them is the axis again: the same support point would come back forever.
        let levelled = levelled
            .filter(|direction| direction.n.dot(v.n) > -(direction.length * v.length) * V::Scalar::from_f64(OPPOSITE));
        self.levelled = levelled.is_some();
        levelled.unwrap_or(v)
    }
}

/// The shortest vector of a vertex or an edge is not trusted while the lower bound is below this part of its length.
const TRUSTED: f64 = 0.5;

/// The weight of the lower bound's axis in a direction between it and the shortest vector. Among 1.5, 2 and 3 it takes
/// the fewest support points on average, for polytopes of 8 to 1024 vertices.
const AXIS_WEIGHT: f64 = 2.0;

/// The cosine of the angle to the opposite of the shortest vector, above which a direction between that and the axis is
/// the axis again.
const OPPOSITE: f64 = 0.6;

/// Whether the simplex does not determine the next direction, and its shortest vector is a poor guess. A triangle
/// determines it, and polygons in the plane need few steps anyway.
#[inline(always)]
fn leaves_open<V: Vector>(state: &Gjk<V>) -> bool {
    let is_open = V::DIM == 3 && state.simplex.points().len() < V::DIM;
    is_open && state.lower < state.length * V::Scalar::from_f64(TRUSTED)
}

/// A direction between the shortest vector `v` and the axis of the lower bound.
///
/// Among unit vectors, the distance of `C = A − B` from zero is the maximum of `f(n) = min n·x` over all `x` of `C`.
/// The known points of `C` bound `f` from above, and this bound is largest along the shortest vector of their simplex.
/// With few points it is far from the maximum of `f`, and moves from side to side, as with cutting planes. So, as in
/// level bundle methods (Lemaréchal, Nemirovskii, Nesterov, 1995), the step from the best direction known goes only
/// part of the way. If an edge is closest, both its ends should stay equally far: the step is across the edge.
#[inline(always)]
fn level<V: Vector>(state: &Gjk<V>, v: Direction<V>) -> V {
    let mut axis = state.axis;
    if let &[p, q] = state.simplex.points() {
        let e = q - p;
        axis -= e * (axis.dot(e) / e.length_squared());
    }
    // The sum of the unit vectors, times both lengths. Otherwise it may become shorter and shorter from one such
    // direction to the next.
    v.n * state.axis_length + axis * (V::Scalar::from_f64(AXIS_WEIGHT) * v.length)
}
