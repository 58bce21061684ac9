//! The stretch of a line within a set, in closed form.

use num_traits::Float as _;

use crate::shapes::{Frame, across};
use crate::vector::{is_comfortable, scaled};
use crate::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Matrix, Point, Posed, Rounded, Scalar, ScalarOf, Segment,
    SupportMap, Triangle, Vector, Vector3,
};

/// The stretch of a line that lies in a convex set: `{ λ : source + λ·direction ∈ C }` is the interval from `entry` to
/// `exit`, in units of the direction.
///
/// It is about the whole line: for a ray, an `entry` below 0 means that the source is inside, and an `exit` below 0 that
/// the set is behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Crossing<V: Vector> {
    /// Where the line enters the set.
    pub entry: V::Scalar,
    /// Where it leaves the set; at least `entry`.
    pub exit: V::Scalar,
    /// The unit outward normal where it enters; one of them at an edge or a corner.
    pub normal: V,
}

impl<V: Vector> Crossing<V> {
    /// The first `λ` in `[0, max_lambda]` that is in the interval: 0 for a source inside, `None` where the ray misses.
    ///
    /// ```
    /// use convex_support::{Ball, LineCrossing, glam::DVec2};
    ///
    /// let disc = Ball::<DVec2>::new(1.0)?;
    /// let crossing = disc.line_crossing(DVec2::new(-3.0, 0.0), DVec2::new(0.5, 0.0)).ok_or("a miss")?;
    /// assert_eq!((crossing.entry, crossing.exit, crossing.normal), (4.0, 8.0, DVec2::NEG_X));
    /// assert_eq!(crossing.first_hit(f64::INFINITY), Some(4.0));
    /// assert_eq!(crossing.first_hit(3.0), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline]
    #[must_use]
    pub fn first_hit(&self, max_lambda: V::Scalar) -> Option<V::Scalar> {
        (self.exit >= V::Scalar::ZERO && self.entry <= max_lambda).then(|| self.entry.max(V::Scalar::ZERO))
    }
}

/// A convex set whose crossing by a line has a closed form.
///
/// For ray tracers, and as the independent reference of ray casts that only use the support mapping. Poses and invertible
/// affine maps pass it through, and so does [`Rounded`] for the shapes that know it
/// ([`RoundedLineCrossing`]).
///
/// # Accuracy
/// Every method starts from the point of the line nearest the shape's centre, so that coordinates there are of the size
/// of the shape and nothing cancels but what the source's own coordinates have already lost: `λ·|direction|` carries an
/// error of a few units in the last place of the distance between source and centre. Where a line grazes a curved
/// surface, at an angle `α`, this is magnified by `1/sin α`; whether a line hits that passes the boundary within that
/// error is decided by rounding. Squares of lengths must stay in range (about 1e±150 in `f64`, 1e±18 in `f32`);
/// directions may have any length. A zero direction has no line and a `NaN` no crossing: `None`.
#[diagnostic::on_unimplemented(
    message = "the crossing of `{Self}` by a line has no closed form here",
    note = "implement `LineCrossing` for it, or use the GJK ray cast, which needs only `SupportMap`"
)]
pub trait LineCrossing: SupportMap {
    /// Where the line through `source` along `direction` is in the set; `None` where it misses.
    fn line_crossing(&self, source: Self::Vector, direction: Self::Vector) -> Option<Crossing<Self::Vector>>;
}

/// A convex set that has a closed form of its crossing also when it is swept by a ball.
#[diagnostic::on_unimplemented(
    message = "the crossing of a rounded `{Self}` by a line has no closed form here",
    note = "use the GJK ray cast, to which rounding costs nothing"
)]
pub trait RoundedLineCrossing: SupportMap {
    /// Where the line through `source` along `direction` is in the set swept by a ball of the given `radius ≥ 0`.
    fn rounded_line_crossing(
        &self,
        radius: ScalarOf<Self>,
        source: Self::Vector,
        direction: Self::Vector,
    ) -> Option<Crossing<Self::Vector>>;
}

impl<S: LineCrossing + ?Sized> LineCrossing for &S {
    #[inline]
    fn line_crossing(&self, source: S::Vector, direction: S::Vector) -> Option<Crossing<S::Vector>> {
        (**self).line_crossing(source, direction)
    }
}

impl<S: LineCrossing + ?Sized> LineCrossing for alloc::boxed::Box<S> {
    #[inline]
    fn line_crossing(&self, source: S::Vector, direction: S::Vector) -> Option<Crossing<S::Vector>> {
        (**self).line_crossing(source, direction)
    }
}

/// The part of a line within a ball about zero, as `middle ± half`, and the line's point nearest zero.
struct Chord<V: Vector> {
    middle: V::Scalar,
    half: V::Scalar,
    nearest: V,
}

/// Where the line is nearest zero; `recip` is `1/|direction|²`.
#[inline]
fn rebased<V: Vector>(source: V, direction: V, recip: V::Scalar) -> (V::Scalar, V) {
    let first = -source.dot(direction) * recip;
    let near = source + direction * first;
    // Far from zero that was rounded to the distance of the source; the second step is rounded to that of the line.
    let second = -near.dot(direction) * recip;
    (first + second, near + direction * second)
}

/// The chord that the ball `|x|² ≤ radius²` cuts out of `source + λ·direction`; `dd` is `|direction|²`.
#[inline]
fn chord<V: Vector>(source: V, direction: V, dd: V::Scalar, radius: V::Scalar) -> Option<Chord<V>> {
    let recip = dd.recip();
    let (middle, nearest) = rebased(source, direction, recip);
    // |nearest + μ·direction|² = radius², where nearest ⟂ direction.
    let inside = radius * radius - nearest.length_squared();
    (inside >= V::Scalar::ZERO).then(|| Chord { middle, half: (inside * recip).sqrt(), nearest })
}

/// Where the direction is too long or too short to be squared: the same line in units of a power of two.
#[cold]
fn in_other_units<S: LineCrossing + ?Sized>(
    shape: &S,
    source: S::Vector,
    direction: S::Vector,
) -> Option<Crossing<S::Vector>> {
    let (direction, unit) = scaled(direction).filter(|(d, _)| d.is_finite())?;
    let crossing = shape.line_crossing(source, direction)?;
    Some(Crossing { entry: crossing.entry / unit, exit: crossing.exit / unit, ..crossing })
}

impl<V: Vector> LineCrossing for Ball<V> {
    #[inline]
    fn line_crossing(&self, source: V, direction: V) -> Option<Crossing<V>> {
        let dd = direction.length_squared();
        if !is_comfortable(dd) {
            return in_other_units(self, source, direction);
        }
        ball(self.radius(), source, direction, dd)
    }
}

/// The crossing of a ball about zero.
#[inline]
fn ball<V: Vector>(radius: V::Scalar, source: V, direction: V, dd: V::Scalar) -> Option<Crossing<V>> {
    let chord = chord(source, direction, dd, radius)?;
    Some(chord.crossing(radius, direction, dd))
}

impl<V: Vector> Chord<V> {
    /// As the crossing of the ball of the given radius.
    #[inline]
    fn crossing(&self, radius: V::Scalar, direction: V, dd: V::Scalar) -> Crossing<V> {
        let normal = if radius > V::Scalar::ZERO {
            (self.nearest - direction * self.half) * radius.recip()
        } else {
            -direction / dd.sqrt()
        };
        Crossing { entry: self.middle - self.half, exit: self.middle + self.half, normal }
    }
}

impl<V: Vector> LineCrossing for Cuboid<V> {
    #[inline]
    fn line_crossing(&self, source: V, direction: V) -> Option<Crossing<V>> {
        let (mut entry, mut exit) = (-V::Scalar::infinity(), V::Scalar::infinity());
        let mut face = V::DIM;
        for i in 0..V::DIM {
            let (s, d, h) = (source.get(i), direction.get(i), self.half_extents().get(i));
            if d == V::Scalar::ZERO {
                if s.abs() > h {
                    return None;
                }
                continue;
            }
            let near = h.copysign(-d);
            let enters = (near - s) / d;
            if enters > entry {
                (entry, face) = (enters, i);
            }
            exit = exit.min((-near - s) / d);
        }
        // A NaN compares false; without a face the direction is zero.
        (face < V::DIM && entry <= exit).then(|| {
            let normal = V::axis(face) * V::Scalar::ONE.copysign(-direction.get(face));
            Crossing { entry, exit, normal }
        })
    }
}

impl<V: Vector> LineCrossing for Capsule<V> {
    #[inline]
    fn line_crossing(&self, source: V, direction: V) -> Option<Crossing<V>> {
        let dd = direction.length_squared();
        if !is_comfortable(dd) {
            return in_other_units(self, source, direction);
        }
        let recip = dd.recip();
        let (base, source) = rebased(source, direction, recip);
        let (y, h, r) = (V::axis(1), self.half_height(), self.radius());
        let split = |v: V| (v.get(1), V::from_fn(|i| if i == 1 { V::Scalar::ZERO } else { v.get(i) }));
        shifted(capsule(y, h, r, (source, split(source)), (direction, split(direction)), recip)?, base)
    }
}

/// A vector and its parts along and across an axis.
type Split<V> = (V, (<V as Vector>::Scalar, V));

/// The crossing of the segment between `±half_height·axis`, swept by a ball; `axis` is a unit vector, and `source` the
/// point of the line nearest the middle; `recip` is `1/|direction|²`.
///
/// A line enters the infinite cylinder about the axis through the side, which is then where it enters the capsule, or
/// beyond one of the ends, and then it has to pass through the ball at that end; likewise where it leaves.
#[inline]
fn capsule<V: Vector>(
    axis: V,
    half_height: V::Scalar,
    radius: V::Scalar,
    (source, (along, out)): Split<V>,
    (direction, (rise, across)): Split<V>,
    recip: V::Scalar,
) -> Option<Crossing<V>> {
    let slope = across.length_squared();
    // A direction that is along the axis to rounding meets the side nowhere near.
    let steep = slope * recip <= V::Scalar::EPSILON * V::Scalar::EPSILON;
    let side = if steep {
        (out.length_squared() <= radius * radius).then_some(None)
    } else if V::DIM == 2 {
        // In the plane a line meets the axis itself, also where rounding says that it passes it at some distance.
        Some(Some(Chord { middle: -out.dot(across) / slope, half: radius / slope.sqrt(), nearest: V::ZERO }))
    } else {
        chord(out, across, slope, radius).map(Some)
    }?;
    let (enters, leaves) = match &side {
        Some(c) => (along + rise * (c.middle - c.half), along + rise * (c.middle + c.half)),
        None => (-rise * V::Scalar::infinity(), rise * V::Scalar::infinity()),
    };
    let cap = |y: V::Scalar| {
        // From the end on the side of y; (source − end)·direction, with source ⟂ direction, is −height·rise.
        let height = half_height.copysign(y);
        let middle = height * rise * recip;
        let nearest = source - axis * height + direction * middle;
        let inside = radius * radius - nearest.length_squared();
        (inside >= V::Scalar::ZERO).then(|| Chord { middle, half: (inside * recip).sqrt(), nearest })
    };
    let (entry, normal) = match &side {
        Some(c) if enters.abs() <= half_height => {
            let Crossing { entry, normal, .. } = c.crossing(radius, across, slope);
            (entry, normal)
        }
        _ => {
            let Crossing { entry, normal, .. } = cap(enters)?.crossing(radius, direction, recip.recip());
            (entry, normal)
        }
    };
    let exit = match &side {
        Some(c) if leaves.abs() <= half_height => c.middle + c.half,
        _ => cap(leaves).map_or(entry, |c| c.middle + c.half),
    };
    Some(Crossing { entry, exit: exit.max(entry), normal })
}

/// The part of a line where `|y| ≤ half_height`: entry, exit. A level line is in the slab everywhere or nowhere.
#[inline]
fn slab<S: Scalar>(y: S, rise: S, half_height: S) -> Option<(S, S)> {
    if rise == S::ZERO {
        return (y.abs() <= half_height).then(|| (-S::infinity(), S::infinity()));
    }
    let near = half_height.copysign(-rise);
    Some(((near - y) / rise, (-near - y) / rise))
}

impl<V: Vector3> LineCrossing for Cylinder<V> {
    #[inline]
    fn line_crossing(&self, source: V, direction: V) -> Option<Crossing<V>> {
        let dd = direction.length_squared();
        if !is_comfortable(dd) {
            return in_other_units(self, source, direction);
        }
        let (base, source) = rebased(source, direction, dd.recip());
        let (out, radial) = (across(source), across(direction));
        let slope = radial.length_squared();
        let r = self.disc_radius();

        let rise = direction.get(1);
        let (top, bottom) = slab(source.get(1), rise, self.half_height())?;
        let mut crossing = Crossing { entry: top, exit: bottom, normal: V::axis(1) * V::Scalar::ONE.copysign(-rise) };
        if slope <= dd * (V::Scalar::EPSILON * V::Scalar::EPSILON) {
            if out.length_squared() > r * r {
                return None;
            }
        } else {
            let side = chord(out, radial, slope, r)?;
            let (enters, leaves) = (side.middle - side.half, side.middle + side.half);
            if enters > crossing.entry {
                crossing.entry = enters;
                crossing.normal = side.crossing(r, radial, slope).normal;
            }
            crossing.exit = crossing.exit.min(leaves);
        }
        shifted(crossing, base)
    }
}

/// The crossing with `λ` counted from where the line was before it was re-based; `None` where it is empty.
#[inline]
fn shifted<V: Vector>(crossing: Crossing<V>, base: V::Scalar) -> Option<Crossing<V>> {
    (crossing.entry <= crossing.exit).then(|| Crossing {
        entry: base + crossing.entry,
        exit: base + crossing.exit,
        normal: crossing.normal,
    })
}

impl<V: Vector3> LineCrossing for Cone<V> {
    /// Within its slab, the cone is `F(x) ≤ 0` below the apex, with `F(x) = cos²α·(x² + z²) − sin²α·(h − y)²` and `α` half
    /// the opening angle. Along the line, counted from the apex, `F = Aλ² + 2Bλ + C`; and by Lagrange's identity the
    /// discriminant is, with the moment `m = p × d`, `B² − AC = cos²α·(sin²α·(m_x² + m_z²) − cos²α·m_y²)`: no difference
    /// of the products of `B` and `AC` is formed.
    #[inline]
    fn line_crossing(&self, source: V, direction: V) -> Option<Crossing<V>> {
        let dd = direction.length_squared();
        if !is_comfortable(dd) {
            return in_other_units(self, source, direction);
        }
        let zero = V::Scalar::ZERO;
        let (h, r) = (self.half_height(), self.disc_radius());
        if h == zero || r == zero {
            // A disc or a segment.
            return Cylinder::new(h, r).ok()?.line_crossing(source, direction);
        }
        // A unit direction keeps the products of four lengths and directions below in range.
        let speed = dd.sqrt();
        let direction = direction / speed;
        let (base, source) = rebased(source, direction, V::Scalar::ONE);
        let (y, rise) = (source.get(1), direction.get(1));
        let (top, bottom) = slab(y, rise, h)?;

        let height = h + h;
        let slant = height.hypot(r);
        let (cosine, sine) = (height / slant, r / slant);
        let (out, radial) = (across(source) * cosine, across(direction) * cosine);
        let (drop, fall) = (sine * (h - y), -sine * rise);
        let a = radial.length_squared() - fall * fall;
        let b = out.dot(radial) - drop * fall;
        let c = out.length_squared() - drop * drop;
        let m = (source - V::axis(1) * h).cross(direction);
        let (swing, twist) = (sine * across(m).length(), cosine * m.get(1).abs());
        let discriminant = (swing - twist) * (swing + twist);
        if discriminant < zero || discriminant.is_nan() {
            return None;
        }
        let root = cosine * discriminant.sqrt();
        // The larger of the two in magnitude first, so that B and the root do not cancel; the other from the product.
        let q = -(b + root.copysign(b));
        let far = if a == zero { V::Scalar::infinity().copysign(-q) } else { q / a };
        let near = if q == zero { far } else { c / q };
        let (low, high) = (near.min(far), near.max(far));
        let (enters, leaves) = if a > zero {
            // Across the cone, through one of its two nappes.
            if drop + fall * (-b / a) < zero {
                return None;
            }
            (low, high)
        } else if fall > zero {
            // Down within the cone, for good.
            (high, V::Scalar::infinity())
        } else {
            (-V::Scalar::infinity(), low)
        };

        let mut crossing =
            Crossing { entry: top, exit: bottom.min(leaves), normal: V::axis(1) * V::Scalar::ONE.copysign(-rise) };
        let from_above = enters > top || rise < zero;
        if from_above {
            crossing.entry = enters.max(top);
        }
        // The slant and the base of a flat cone are nearly parallel, and rounding moves the place where they meet along
        // both; but the rim is at a distance r from the axis, which the crossing neither begins beyond nor ends before.
        let place = across(source + direction * crossing.entry);
        let rounding = V::Scalar::EPSILON * V::Scalar::from_f64(8.0);
        let within = place.length_squared() <= r * r * (V::Scalar::ONE + rounding);
        if !within || crossing.entry > crossing.exit + rounding * (slant + crossing.entry.abs()) {
            return None;
        }
        if from_above {
            // At the apex one normal is as good as the other, as long as it looks against the line.
            let facing = |out: V| out * cosine + V::axis(1) * sine;
            let normal = place.unit().map(facing).filter(|n| n.dot(direction) <= zero);
            crossing.normal = normal.unwrap_or_else(|| across(direction).unit().map_or(V::axis(1), |out| facing(-out)));
        }
        Some(Crossing {
            entry: (base + crossing.entry) / speed,
            exit: (base + crossing.exit.max(crossing.entry)) / speed,
            normal: crossing.normal,
        })
    }
}

impl<V: Vector> LineCrossing for Ellipsoid<V> {
    #[inline]
    fn line_crossing(&self, source: V, direction: V) -> Option<Crossing<V>> {
        // In the coordinates where it is the unit ball; a normal n there is R·(n/a) here.
        let inverse = V::from_fn(|i| self.semi_axes().get(i).recip());
        let local = self.axes().transpose_mul(source - self.center()) * inverse;
        let along = self.axes().transpose_mul(direction) * inverse;
        let dd = along.length_squared();
        if !is_comfortable(dd) {
            return in_other_units(self, source, direction);
        }
        let crossing = ball(V::Scalar::ONE, local, along, dd)?;
        let normal = self.axes() * (crossing.normal * inverse).unit()?;
        Some(Crossing { normal, ..crossing })
    }
}

impl<S: LineCrossing> LineCrossing for Posed<S> {
    #[inline]
    fn line_crossing(&self, source: S::Vector, direction: S::Vector) -> Option<Crossing<S::Vector>> {
        let rotation = self.rotation();
        let local = rotation.transpose_mul(source - self.translation());
        let crossing = self.shape().line_crossing(local, rotation.transpose_mul(direction))?;
        Some(Crossing { normal: rotation * crossing.normal, ..crossing })
    }
}

/// Where the matrix is singular the image is flat, a line meets it in at most a point or along itself, and the answer is
/// `None`.
impl<S: LineCrossing> LineCrossing for Affine<S> {
    #[inline]
    fn line_crossing(&self, source: S::Vector, direction: S::Vector) -> Option<Crossing<S::Vector>> {
        let inverse = self.matrix().inverse();
        if !inverse.is_finite() {
            return None;
        }
        let local = inverse * (source - self.translation());
        let crossing = self.shape().line_crossing(local, inverse * direction)?;
        Some(Crossing { normal: inverse.transpose_mul(crossing.normal).unit()?, ..crossing })
    }
}

impl<S: RoundedLineCrossing> LineCrossing for Rounded<S> {
    #[inline]
    fn line_crossing(&self, source: S::Vector, direction: S::Vector) -> Option<Crossing<S::Vector>> {
        self.shape().rounded_line_crossing(self.rounding(), source, direction)
    }
}

impl<S: RoundedLineCrossing + ?Sized> RoundedLineCrossing for &S {
    #[inline]
    fn rounded_line_crossing(
        &self,
        radius: ScalarOf<S>,
        source: S::Vector,
        direction: S::Vector,
    ) -> Option<Crossing<S::Vector>> {
        (**self).rounded_line_crossing(radius, source, direction)
    }
}

impl<S: RoundedLineCrossing> RoundedLineCrossing for Posed<S> {
    #[inline]
    fn rounded_line_crossing(
        &self,
        radius: ScalarOf<S>,
        source: S::Vector,
        direction: S::Vector,
    ) -> Option<Crossing<S::Vector>> {
        let rotation = self.rotation();
        let local = rotation.transpose_mul(source - self.translation());
        let direction = rotation.transpose_mul(direction);
        let crossing = self.shape().rounded_line_crossing(radius, local, direction)?;
        Some(Crossing { normal: rotation * crossing.normal, ..crossing })
    }
}

impl<S: RoundedLineCrossing> RoundedLineCrossing for Rounded<S> {
    #[inline]
    fn rounded_line_crossing(
        &self,
        radius: ScalarOf<S>,
        source: S::Vector,
        direction: S::Vector,
    ) -> Option<Crossing<S::Vector>> {
        self.shape().rounded_line_crossing(self.rounding() + radius, source, direction)
    }
}

impl<V: Vector> RoundedLineCrossing for Ball<V> {
    #[inline]
    fn rounded_line_crossing(&self, radius: V::Scalar, source: V, direction: V) -> Option<Crossing<V>> {
        Self::new(self.radius() + radius).ok()?.line_crossing(source, direction)
    }
}

impl<V: Vector> RoundedLineCrossing for Point<V> {
    #[inline]
    fn rounded_line_crossing(&self, radius: V::Scalar, source: V, direction: V) -> Option<Crossing<V>> {
        Ball::new(radius).ok()?.line_crossing(source - self.at(), direction)
    }
}

impl<V: Vector> RoundedLineCrossing for Capsule<V> {
    #[inline]
    fn rounded_line_crossing(&self, radius: V::Scalar, source: V, direction: V) -> Option<Crossing<V>> {
        Self::new(self.half_height(), self.radius() + radius).ok()?.line_crossing(source, direction)
    }
}

impl<V: Vector> RoundedLineCrossing for Segment<V> {
    #[inline]
    fn rounded_line_crossing(&self, radius: V::Scalar, source: V, direction: V) -> Option<Crossing<V>> {
        let dd = direction.length_squared();
        if !is_comfortable(dd) {
            return in_other_units(&Rounded::new(*self, radius).ok()?, source, direction);
        }
        edge(self.points(), radius, source, direction, dd)
    }
}

/// The crossing of the segment between two points, swept by a ball.
#[inline]
fn edge<V: Vector>([a, b]: [V; 2], radius: V::Scalar, source: V, direction: V, dd: V::Scalar) -> Option<Crossing<V>> {
    let half = V::Scalar::from_f64(0.5);
    let to_b = (b - a) * half;
    let axis = to_b.unit().unwrap_or_else(|| V::axis(0));
    let source = source - (a + to_b);
    let recip = dd.recip();
    let (base, source) = rebased(source, direction, recip);
    let split = |v: V| (v.dot(axis), v - axis * v.dot(axis));
    shifted(capsule(axis, to_b.norm(), radius, (source, split(source)), (direction, split(direction)), recip)?, base)
}

/// In 3D a line crosses it at a point, where `entry` and `exit` agree. A triangle without area, a segment, has no side to
/// cross it by: `None`.
impl<V: Vector> LineCrossing for Triangle<V> {
    #[inline]
    fn line_crossing(&self, source: V, direction: V) -> Option<Crossing<V>> {
        self.rounded_line_crossing(V::Scalar::ZERO, source, direction)
    }
}

/// The prism over the triangle, as thick as the ball, and the three edges swept by the ball: their union is convex, so
/// the line is inside from the first entry to the last exit. In 2D the triangle itself stands for the prism.
impl<V: Vector> RoundedLineCrossing for Triangle<V> {
    fn rounded_line_crossing(&self, radius: V::Scalar, source: V, direction: V) -> Option<Crossing<V>> {
        let dd = direction.length_squared();
        if !is_comfortable(dd) {
            return in_other_units(&Rounded::new(*self, radius).ok()?, source, direction);
        }
        let mut union = if V::DIM == 2 {
            self.crossing_in_the_plane(source, direction)
        } else {
            self.prism_crossing(radius, source, direction)
        };
        if radius > V::Scalar::ZERO {
            let [a, b, c] = self.points();
            for side in [[a, b], [b, c], [c, a]] {
                union = match (union, edge(side, radius, source, direction, dd)) {
                    (Some(p), Some(q)) => {
                        let first = if q.entry < p.entry { q } else { p };
                        Some(Crossing { exit: p.exit.max(q.exit), ..first })
                    }
                    (p, q) => p.or(q),
                };
            }
        }
        union
    }
}

impl<V: Vector> Triangle<V> {
    /// The crossing of a triangle in 2D: through the edges whose ends are on different sides of the line. A line meets
    /// a sliver too, however thin, that lies across it.
    fn crossing_in_the_plane(&self, source: V, direction: V) -> Option<Crossing<V>> {
        let zero = V::Scalar::ZERO;
        let left = |v: V| V::from_fn(|i| if i == 0 { -v.get(1) } else { v.get(0) });
        let [a, b, c] = self.points();
        let (base, source) = rebased(source - a, direction, direction.length_squared().recip());
        // Every corner by how far it is to the left of the line, and how far along it.
        let corners = [V::ZERO, b - a, c - a].map(|p| {
            let p = p - source;
            (left(direction).dot(p), direction.dot(p) / direction.length_squared(), p)
        });
        let mut crossing = Crossing { entry: V::Scalar::infinity(), exit: -V::Scalar::infinity(), normal: V::ZERO };
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            let ((side_i, along_i, p_i), (side_j, along_j, p_j)) = (corners[i], corners[j]);
            if side_i.max(side_j) < zero || side_i.min(side_j) > zero {
                continue;
            }
            let t = if side_i == side_j { zero } else { side_i / (side_i - side_j) };
            let at = along_i + (along_j - along_i) * t;
            if at <= crossing.entry {
                let n = left(p_j - p_i);
                let outward = if n.dot(corners[k].2 - p_i) > zero { -n } else { n };
                if at < crossing.entry || outward.dot(direction) < zero {
                    crossing.normal = outward;
                }
                crossing.entry = at;
            }
            crossing.exit = crossing.exit.max(at);
        }
        crossing.normal = if crossing.normal.dot(direction) < zero { crossing.normal } else { -direction }.unit()?;
        shifted(crossing, base)
    }

    /// The crossing of the points within `thickness` of the triangle in 3D, across its plane.
    fn prism_crossing(&self, thickness: V::Scalar, source: V, direction: V) -> Option<Crossing<V>> {
        let Frame { corners: [a, b, _], axes: [u, v], length, along, height } = self.frame()?;
        let (base, from_a) = rebased(source - a, direction, direction.length_squared().recip());
        let zero = V::Scalar::ZERO;
        let mut clip = Clip::default();
        // The normal is what is left of the axis that is least within the plane.
        let off_plane = |x: V| x - u * u.dot(x) - v * v.dot(x);
        let lengths = V::from_fn(|i| off_plane(V::axis(i)).length_squared());
        let steepest = (1..V::DIM).fold(0, |best, i| if lengths.get(i) > lengths.get(best) { i } else { best });
        let normal = off_plane(off_plane(V::axis(steepest))).unit()?;
        clip.cut(normal, from_a, thickness, direction);
        clip.cut(-normal, from_a, thickness, direction);
        // Outward of each edge, within the plane.
        clip.cut(-v, from_a, zero, direction);
        clip.cut((u * height + v * (length - along)).unit()?, from_a - (b - a), zero, direction);
        clip.cut((v * along - u * height).unit()?, from_a, zero, direction);
        // The sides of a sliver are parallel to rounding and do not say where it ends; its longest edge does, and is
        // normal to a supporting line at both of its ends.
        clip.cut(-u, from_a, zero, direction);
        clip.cut(u, from_a, length, direction);
        shifted(clip.crossing?, base)
    }
}

/// What half-spaces leave of a line.
struct Clip<V: Vector> {
    crossing: Option<Crossing<V>>,
}

impl<V: Vector> Default for Clip<V> {
    /// The whole line.
    fn default() -> Self {
        let infinity = V::Scalar::infinity();
        Self { crossing: Some(Crossing { entry: -infinity, exit: infinity, normal: V::ZERO }) }
    }
}

impl<V: Vector> Clip<V> {
    /// Keeps what satisfies `normal·x ≤ offset`.
    #[inline]
    fn cut(&mut self, normal: V, source: V, offset: V::Scalar, direction: V) {
        let Some(crossing) = &mut self.crossing else { return };
        let (room, speed) = (offset - normal.dot(source), normal.dot(direction));
        if speed < V::Scalar::ZERO {
            let enters = room / speed;
            if enters > crossing.entry {
                (crossing.entry, crossing.normal) = (enters, normal);
            }
        } else if speed > V::Scalar::ZERO {
            crossing.exit = crossing.exit.min(room / speed);
        } else if room < V::Scalar::ZERO || room.is_nan() {
            self.crossing = None;
        }
    }
}

/// The squared distance from a box is `φ(λ) = Σ max(|xᵢ| − hᵢ, 0)²` along the line: convex, and one quadratic between
/// any two neighbouring crossings of the planes `xᵢ = ±hᵢ`. The line enters the rounded box in the piece that ends at the
/// first crossing where `φ ≤ radius²`, and leaves it in the piece that begins at the last; or both happen in one piece.
impl<V: Vector> RoundedLineCrossing for Cuboid<V> {
    fn rounded_line_crossing(&self, radius: V::Scalar, source: V, direction: V) -> Option<Crossing<V>> {
        if radius == V::Scalar::ZERO {
            return self.line_crossing(source, direction);
        }
        let dd = direction.length_squared();
        if !is_comfortable(dd) {
            return in_other_units(&Rounded::new(*self, radius).ok()?, source, direction);
        }
        let (base, source) = rebased(source, direction, dd.recip());
        let h = self.half_extents();

        let infinity = V::Scalar::infinity();
        let mut planes = [infinity; 6];
        let mut count = 0;
        for i in 0..V::DIM {
            let (s, d) = (source.get(i), direction.get(i));
            if d != V::Scalar::ZERO {
                planes[count] = (h.get(i) - s) / d;
                planes[count + 1] = (-h.get(i) - s) / d;
                count += 2;
            }
        }
        let planes = &mut planes[..count];
        planes.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));

        // How far x is outside, coordinate by coordinate.
        let excess = |x: V| x - x.max(-h).min(h);
        let at = |lambda: V::Scalar| source + direction * lambda;
        let inside = |lambda: V::Scalar| excess(at(lambda)).length_squared() <= radius * radius;
        // The chord that the quadratic of the piece around `lambda` has, and where that piece is.
        let piece = |low: V::Scalar, high: V::Scalar| {
            let lambda = if low == -infinity {
                high - V::Scalar::ONE.max(high.abs())
            } else if high == infinity {
                low + V::Scalar::ONE.max(low.abs())
            } else {
                low + (high - low) * V::Scalar::from_f64(0.5)
            };
            let side = excess(at(lambda));
            let active = |v: V| V::from_fn(|i| if side.get(i) == V::Scalar::ZERO { V::Scalar::ZERO } else { v.get(i) });
            let d = active(direction);
            let dd = d.length_squared();
            if dd == V::Scalar::ZERO { None } else { chord(active(source - h.copysign(side)), d, dd, radius) }
        };
        let low_of = |k: usize| if k == 0 { -infinity } else { planes[k - 1] };
        let high_of = |k: usize| planes.get(k).copied().unwrap_or(infinity);

        let (entry, exit) = match planes.iter().position(|&t| inside(t)) {
            Some(first) => {
                let last = planes.iter().rposition(|&t| inside(t)).unwrap_or(first);
                let enters = piece(low_of(first), planes[first]).map_or(planes[first], |c| c.middle - c.half);
                let leaves = piece(planes[last], high_of(last + 1)).map_or(planes[last], |c| c.middle + c.half);
                (enters.max(low_of(first)).min(planes[first]), leaves.max(planes[last]).min(high_of(last + 1)))
            }
            None => (0..=count).find_map(|k| {
                let (low, high) = (low_of(k), high_of(k));
                let c = piece(low, high)?;
                (low <= c.middle && c.middle <= high).then(|| (c.middle - c.half, c.middle + c.half))
            })?,
        };
        let normal = excess(at(entry)).unit().or_else(|| (-direction).unit())?;
        shifted(Crossing { entry, exit, normal }, base)
    }
}
