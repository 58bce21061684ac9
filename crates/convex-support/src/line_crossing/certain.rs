//! Certain bounds on where a line enters a shape, from its closed form.
//!
//! A closed form computes the crossing of a slightly wrong line. Near the shape, that line is nowhere farther from the
//! true one than an error `e`: a few roundings of the size and of the distance of the line's source, which is no more
//! than [`NEAR`] sizes, and the rounding of the shape itself. So a line certainly misses if it passes at more than `e`.
//! And it certainly enters between two of its parameters if the point at the first is more than `e` outside of the
//! shape and the point at the second more than `e` inside: since the shape is convex, no point before the first is in
//! it.

use num_traits::Float as _;

use super::{Chord, Crossed, Crossing, Spine, across_two_axes, axis_of, past_rim, rebased};
use crate::numerics::bound::roundings;
use crate::numerics::range::{is_comfortable, is_moderate};
use crate::numerics::twofold::{foot_from, lost_in_sum, two_sum};
use crate::shapes::axial::{ConeMeasures, across};
use crate::{Matrix, Scalar, Vector, Vector3};

/// A line, for the [certain crossing](crate::SupportMap::certain_crossing) of a shape.
// A number is between the vectors. Side by side like those of a ray, they are copied in pieces of two numbers, one of
// which has the end of the first and the beginning of the second. A shape behind a pointer reads each vector from its
// own beginning, and would wait until both pieces are in the cache: twice the time of a ray at a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineQuery<V: Vector> {
    /// A point of the line.
    pub source: V,
    /// The radius of a further ball that the shape is swept by.
    pub radius: V::Scalar,
    /// The line's direction, of any length.
    pub direction: V,
    /// The answer must hold for every line that passes within this distance of the line near the shape.
    pub error: V::Scalar,
    /// Whether to compute in twice the precision: for the few lines for which the closed form in plain numbers is
    /// certain of nothing.
    pub is_close: bool,
}

impl<V: Vector> LineQuery<V> {
    /// A line without error, for a shape without a further ball, in plain numbers.
    #[inline(always)]
    #[must_use]
    pub fn new(source: V, direction: V) -> Self {
        Self { source, direction, radius: V::Scalar::ZERO, error: V::Scalar::ZERO, is_close: false }
    }

    /// The line relative to a point that is the sum of two.
    #[inline(always)]
    #[must_use]
    pub fn seen_from(self, [origin, at]: [V; 2]) -> Self {
        // Mostly the second is zero, and the sum is exact.
        let point = origin + at;
        let lost = lost_in_sum(origin, at).norm() + lost_in_sum(self.source, -point).norm();
        Self { source: self.source - point, ..self.within(lost) }
    }

    /// The line with a further `error`.
    #[inline(always)]
    #[must_use]
    pub fn within(self, error: V::Scalar) -> Self {
        Self { error: self.error + error, ..self }
    }

    /// The line for the shape swept by a further ball.
    #[inline(always)]
    #[must_use]
    pub fn sweeping(self, radius: V::Scalar) -> Self {
        // A zero radius, mostly known at compile time, needs no arithmetic and adds no rounding.
        if self.radius == V::Scalar::ZERO {
            return Self { radius, ..self };
        }
        let [radius, lost] = two_sum(radius, self.radius);
        Self { radius, ..self.within(lost.abs()) }
    }
}

/// Where a line enters a convex set, as far as that is certain.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub enum CertainCrossing<V: Vector> {
    /// The line misses the set. The vector is across the line and of any length; a plane across it has the set behind
    /// it and the line before it.
    Misses(V),
    /// The line meets the set.
    Enters {
        /// Where it enters.
        entry: V::Scalar,
        /// It certainly enters between these, to the rounding of the parameters themselves.
        bounds: [V::Scalar; 2],
        /// The unit outward normal there; one of them at an edge or a corner.
        normal: V,
    },
}

/// The greatest distance of a line's source, in sizes, that the bounds here are for.
const NEAR: f64 = 8.0;

/// The error of a closed form, as a displacement of the line near the shape, is at most the sum of these, in units of ε
/// times the distance of the line's source and times the size.
///
/// With `u = ε/2`, a distance `D` and a size `S`, the difference from the origin loses `uD`. From there:
/// - to a ball, the foot of the line loses `uD + uS` in the step and its sum; its square, the radius and the difference
///   `2.5uS`. Along the line the sum of the two steps loses `uD`, that of the middle and the half `uD + uS`, and the
///   half `2.5uS`: in all `4uD + 7uS`;
/// - to a slab, the difference from the side, its sum with the error and the quotient lose `4u(D + S)`: in all
///   `5uD + 4uS`;
/// - to a cylinder, the foot loses `2uD + 2uS`, its disc and its slab from there `8uS`, and the sum with the foot's
///   parameter `uD`;
/// - to a capsule's side, `3uD + 10uS` as to a cylinder's; to the ball at an end, whose centre is a size away,
///   `5uD + 12uS`;
/// - to a swept core or a cone, a point of the line, at a parameter that is a sum, loses `2uD + 3uS`, and its distance
///   at most `6uS`.
const OF_DISTANCE: f64 = 2.5;
const OF_SIZE: f64 = 6.0;

/// The further error of a line that is taken from its foot and then turned, in units of ε times the size.
///
/// The foot loses `3uD + 2uS`. If it matters, it is no more than 2 sizes from the origin, and one for a hit, which is
/// within a size from there: the products with a rotation lose `3√3u` of both lengths, and those with the semi-axes of
/// an ellipsoid `2u`, in all `15uS`; and to its ball `13uS`.
const OF_TURN: f64 = 11.0;

/// The further error of a line that is split along the axis of a segment, in units of ε times the size.
///
/// Relative to the origin the ends have errors of `2u` of the size `S`, the middle and the line from there `2uS`, and
/// half the length `2uS`. The axis is wrong by `4u`, as if the segment were turned by so much. The part of a vector
/// along the axis loses `7u` of its length, and the part across `3u`, beside an error along the axis, which counts
/// squared. At a hit, the foot and the way from there are no longer than the size. In all `26u`.
const OF_SPLIT: f64 = 16.0;

/// The largest length of a bracket along a line, in errors; a longer one is computed [more closely](super::closely).
const WIDE: f64 = 64.0;

/// The square of the sine of the angle with a cylinder's side below which a line counts as nearly along it, and is
/// computed more closely.
const ALONG: f64 = 1.0 / (1024.0 * 1024.0);

/// A line near a shape, relative to the shape's origin, from a point at most [`NEAR`] sizes away.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearLine<V: Vector> {
    /// The parameter of that point.
    pub(super) base: V::Scalar,
    pub(crate) source: V,
    pub(crate) direction: V,
    /// The size of the shape.
    pub(super) size: V::Scalar,
    /// A bound on the error of the line's crossing, as a displacement of the line.
    pub(crate) error: V::Scalar,
    /// Whether the point is the source itself, and the square of the direction is moderate.
    pub(super) is_direct: bool,
}

/// A line that enters the infinite cylinder about a capsule beyond one of its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct BeyondEnd<S> {
    /// The end, ±1.
    pub(super) end: S,
    /// The coordinate along the axis of the line's point nearest the middle, and its parameter.
    pub(super) along: S,
    pub(super) base: S,
}

impl<S: Scalar> BeyondEnd<S> {
    /// A line that is beyond neither end.
    pub(super) const NEITHER: Self = Self { end: S::ZERO, along: S::ZERO, base: S::ZERO };
}

impl<V: Vector> CertainCrossing<V> {
    /// The answer with its normal, or the vector along which the line is apart, mapped.
    #[inline(always)]
    pub fn with_normal(self, normal: impl FnOnce(V) -> V) -> Self {
        match self {
            Self::Misses(axis) => Self::Misses(normal(axis)),
            Self::Enters { entry, bounds, normal: n } => Self::Enters { entry, bounds, normal: normal(n) },
        }
    }
}

impl<V: Vector> NearLine<V> {
    /// The line near a shape of a `size` about an `origin`. `None` if it passes far from there, or if numbers are too
    /// small or large to be squared.
    #[inline(always)]
    pub(crate) fn new(line: LineQuery<V>, origin: V, size: V::Scalar) -> Option<Self> {
        // A moderate square is that of a moderate length.
        let (near, is_near) = Self::seen::<false>(line, origin, size, line.direction.length_squared());
        if is_near {
            return Some(Self { is_direct: true, ..near });
        }
        let length = sum_of_coordinates(line.direction);
        let (near, is_near) = Self::seen::<false>(line, origin, size, length);
        if is_near {
            return Some(near);
        }
        let (near, is_near) = Self::seen::<true>(line, origin, size, length);
        is_near.then_some(near)
    }

    /// The line without a branch, and whether it is [near](Self::new). Unless `FAR` is set, a line is near only if its
    /// source is. Of `length`, which stands for that of the direction, only the magnitude counts.
    #[inline(always)]
    pub(super) fn seen<const FAR: bool>(
        line: LineQuery<V>,
        origin: V,
        size: V::Scalar,
        length: V::Scalar,
    ) -> (Self, bool) {
        let LineQuery { source, direction, error, .. } = line;
        let number = V::Scalar::from_f64;
        // NaN and zero are not moderate; the largest coordinate may pass over a NaN, but no sum does.
        let is_moderate = is_moderate(size) & is_moderate(length);
        let (seen, near) = (source - origin, size * number(NEAR));
        let is_near = is_moderate & (seen.length_squared() <= near * near);
        let (base, source, is_near) = if FAR {
            let (base, foot) = foot_from(origin, source, direction);
            let source = V::from_fn(|i| if is_near { seen.get(i) } else { foot.get(i) });
            (
                if is_near { V::Scalar::ZERO } else { base },
                source,
                is_near | is_moderate & (foot.length_squared() <= near * near),
            )
        } else {
            // With minus zero a sum is no operation.
            (-V::Scalar::ZERO, seen, is_near)
        };
        let rounding = V::Scalar::EPSILON * (size * number(OF_SIZE) + sum_of_coordinates(source) * number(OF_DISTANCE));
        // Before what the difference from the origin lost is added to it, the foot may be that long, and its rounding
        // is `u` of that.
        let far = V::Scalar::EPSILON * V::Scalar::EPSILON * sum_of_coordinates(seen);
        let rounding = if FAR { rounding + far } else { rounding };
        (Self { base, source, direction, size, error: error + rounding, is_direct: false }, is_near)
    }

    /// The same line from its point nearest the origin, to be turned.
    #[inline(always)]
    pub(crate) fn at_foot(&self) -> Self {
        let Self { source, direction, size, .. } = *self;
        let (base, source) = rebased(source, direction, direction.length_squared().recip());
        let error = self.error + size * (V::Scalar::EPSILON * V::Scalar::from_f64(OF_TURN));
        Self { base: self.base + base, source, error, ..*self }
    }

    /// An answer for the mapped shape and this line, mapped back.
    #[inline(always)]
    pub(crate) fn after(&self, known: CertainCrossing<V>, normal: impl FnOnce(V) -> V) -> CertainCrossing<V> {
        match known.with_normal(normal) {
            CertainCrossing::Enters { entry, bounds: [earliest, latest], normal } => {
                self.enters([earliest, entry, latest], normal)
            }
            missed @ CertainCrossing::Misses(_) => missed,
        }
    }

    /// The line enters the shape between two of its parameters, counted from the base.
    #[inline(always)]
    pub(super) fn enters(&self, [earliest, entry, latest]: [V::Scalar; 3], normal: V) -> CertainCrossing<V> {
        let (entry, earliest, latest) = (self.base + entry, self.base + earliest, self.base + latest);
        let rounding = entry.abs() * (V::Scalar::EPSILON + V::Scalar::EPSILON);
        CertainCrossing::Enters { entry, bounds: [earliest - rounding, latest + rounding], normal }
    }

    /// Whether a direct line without an error of its own clearly misses a ball about zero, told without a quotient or a
    /// root.
    ///
    /// `|x|²·d²` of the line's nearest point `x` is `s²·d² − (s·d)²`, right to 8ε of `s²·d²`. With a source no more
    /// than 8 radii away, the error of `is_past` is at most 41ε of the radius, and asks for 126ε of its square. The
    /// size and the square of the direction are moderate, so that the square of the one times the other keeps all
    /// digits.
    #[inline(always)]
    fn clearly_passes(&self, radius: V::Scalar) -> bool {
        let Self { source, direction, .. } = *self;
        let (dd, sd) = (direction.length_squared(), source.dot(direction));
        let (ss, rr, number) = (source.length_squared(), radius * radius, V::Scalar::from_f64);
        let margin = (ss * number(32.0) + rr * number(256.0)) * V::Scalar::EPSILON;
        ss * dd - sd * sd > (rr + margin) * dd
    }

    /// A ball about zero, for a line as it was asked about: most rays that miss a ball clearly miss it.
    #[inline(always)]
    pub(crate) fn swept_point(&self, asked: LineQuery<V>) -> Option<CertainCrossing<V>> {
        let chord = self.chord(asked.radius);
        if self.is_direct & (asked.error == V::Scalar::ZERO) && self.clearly_passes(asked.radius) {
            return Some(CertainCrossing::Misses(chord.nearest));
        }
        self.ball(asked.radius)
    }

    #[inline(always)]
    fn chord(&self, radius: V::Scalar) -> Chord<V> {
        super::ball::chord(radius, self.source, self.direction, self.direction.length_squared().recip())
    }

    /// A ball about zero.
    #[inline(always)]
    pub(crate) fn ball(&self, radius: V::Scalar) -> Option<CertainCrossing<V>> {
        let (chord, recip) = (self.chord(radius), self.direction.length_squared().recip());
        if let Some(slack) = chord.slack(radius, self.error, recip, least_chord::<V::Scalar>()) {
            let entry = chord.ends().0;
            return Some(
                self.enters([entry - slack, entry, entry + slack], chord.normal(radius, self.direction, recip)),
            );
        }
        let is_past = chord.is_past(radius, self.error, -V::Scalar::ZERO);
        is_past.then_some(CertainCrossing::Misses(chord.nearest))
    }

    /// A box about zero: the line is in all of its slabs, each smaller and larger by the error.
    ///
    /// The line is mirrored, exactly, so that it runs along each axis: it enters a slab where it is `h + x` away from
    /// behind, and leaves it `h − x` ahead. For a line that is parallel to a slab this divides by zero, and the line is
    /// in the slab from `−∞` to `∞` or nowhere. If it lies in the plane of a side that was moved by the error, `0/0`
    /// compares false and changes nothing: the line counts as being in that slab, or as not known to miss it.
    #[inline(always)]
    pub(crate) fn cuboid(&self, half_extents: V) -> Option<CertainCrossing<V>> {
        let Self { source, direction, .. } = *self;
        let (per_unit, sign) = ((V::ONE / direction).abs(), V::ONE.copysign(direction));
        let (mirrored, error) = (source * sign, V::splat(self.error));
        let (since_near, to_far) = (half_extents + mirrored, half_extents - mirrored);
        let (enters_early, enters_late) = ((since_near + error) * per_unit, (since_near - error) * per_unit);
        let (leaves_early, leaves_late) = ((to_far - error) * per_unit, (to_far + error) * per_unit);
        let (earliest, latest) = (-least(enters_early), -least(enters_late));
        if latest <= least(leaves_early) {
            let enters = since_near * per_unit;
            let entry = least(enters);
            return Some(self.enters([earliest, -entry, latest], -(axis_of(enters, entry) * sign)));
        }
        let leaves = least(leaves_late);
        if !(earliest > leaves) {
            return None;
        }
        // The line leaves one slab before it enters the other: projected along both of them, it passes a rectangle.
        let axes = [axis_of(enters_early, -earliest), axis_of(leaves_late, leaves)];
        Some(CertainCrossing::Misses(across_two_axes(axes, source, direction)))
    }
}

impl<V: Vector> NearLine<V> {
    /// An ellipsoid about zero, by its axes and the reciprocals of its semi-axes.
    ///
    /// With `A = diag(1/a)·Rᵀ`, the ellipsoid is `F(x) = |w|² − 1 ≤ 0` for `w = Ax`, and a displacement by `e` changes
    /// `F` by no more than `2eg + e²k²`, with `g = |Aᵀw|` and the largest reciprocal `k` of a semi-axis. Along the line
    /// `F` is as of a ball, and at `σ = 1.25·e·g/(m|Ad|²)` from the end of a chord `2m` it is less than `−2.34eg` or
    /// more than `2.5eg` (`Chord::slack`), while `g` has changed by `σk|Ad|` at most. That is less than `g/20` if
    /// `m²|Ad|² > 625·e²k²`, and `e²k²` less than `eg/5` if `e·k²` is less than a fifth of the least reciprocal; both,
    /// and that the slack is less than `m/8`, follow from `m²|Ad|² > 128·e·k`.
    ///
    /// A line passes at more than `e` if `|w|(|w| − 1) > eg` for its nearest point; the left side is at least
    /// `(|w|² − 1)/2`, and `g` is at most `k|w| ≤ k(1 + |w|²)/2`.
    #[inline(always)]
    pub(crate) fn ellipsoid(&self, axes: &V::Matrix, inverse_semi_axes: V) -> Option<CertainCrossing<V>> {
        let number = V::Scalar::from_f64;
        let line = self.at_foot();
        let onto_ball = |v: V| axes.transpose_mul(v) * inverse_semi_axes;
        let (source, direction, error) = (onto_ball(line.source), onto_ball(line.direction), line.error);
        let (least, most) = (inverse_semi_axes.min_element(), inverse_semi_axes.max_element());
        if !(error * (most * most) <= least * number(0.2)) {
            return None;
        }
        let recip = direction.length_squared().recip();
        let middle = -source.dot(direction) * recip;
        let chord = Chord::about(middle, source + direction * middle, recip, V::Scalar::ONE);
        if -chord.inside >= error * most * (number(3.0) - chord.inside * number(1.5)) {
            return Some(CertainCrossing::Misses(*axes * (chord.nearest * inverse_semi_axes)));
        }
        if !(chord.inside >= error * most * number(128.0)) {
            return None;
        }
        let gradient = (chord.nearest - direction * chord.half) * inverse_semi_axes;
        let length = gradient.length();
        let slack = length * recip / chord.half * (error * number(1.25));
        let entry = chord.ends().0;
        Some(line.enters([entry - slack, entry, entry + slack], *axes * (gradient * length.recip())))
    }

    /// A segment swept by a ball.
    #[inline(always)]
    pub(crate) fn segment(&self, spine: &Spine<V>, radius: V::Scalar) -> Option<CertainCrossing<V>> {
        let line = self.seen_along(spine);
        // Not `or_else`, whose closure the compiler may call.
        let known = line.capsule(spine, radius);
        if known.is_some() { known } else { line.segment_by_points(*spine, radius) }
    }

    /// The same for the few lines near a rim, by points before and behind the surface.
    #[cold]
    #[inline(never)]
    fn segment_by_points(self, spine: Spine<V>, radius: V::Scalar) -> Option<CertainCrossing<V>> {
        let half_height = spine.half_height;
        let closest = |x: V| spine.axis * spine.split(x).0.max(-half_height).min(half_height);
        let support_value = |d: V| spine.split(d).0.abs() * half_height;
        let crossed = Spine { middle: V::ZERO, ..spine }.crossing(radius, self.source, self.direction);
        let longest = if spine.is_upright { self.longest_slack() } else { V::Scalar::infinity() };
        self.swept(radius, closest, support_value, crossed, longest)
    }

    /// A box swept by a ball.
    #[inline(always)]
    pub(crate) fn rounded_cuboid(&self, h: V, radius: V::Scalar) -> Option<CertainCrossing<V>> {
        let crossed = super::rounded_cuboid(h, radius, self.source, self.direction);
        self.swept(radius, |x| x.max(-h).min(h), |d| d.abs().dot(h), crossed, self.longest_slack())
    }

    /// The largest distance of the bounds along the line.
    #[inline(always)]
    pub(super) fn longest_slack(&self) -> V::Scalar {
        self.error * V::Scalar::from_f64(WIDE) / self.direction.abs().max_element()
    }

    /// The line relative to the middle of a segment.
    #[inline(always)]
    fn seen_along(&self, spine: &Spine<V>) -> Self {
        if spine.is_upright {
            return *self;
        }
        let error = self.error + self.size * (V::Scalar::EPSILON * V::Scalar::from_f64(OF_SPLIT));
        Self { source: self.source - spine.middle, error, ..*self }
    }

    /// A segment about zero, swept by a ball. `None` also if the line passes near a rim.
    #[inline(always)]
    fn capsule(&self, spine: &Spine<V>, radius: V::Scalar) -> Option<CertainCrossing<V>> {
        match self.side(spine, radius) {
            Ok(known) => Some(known),
            Err(beyond) => self.end(spine, radius, beyond?),
        }
    }

    /// The side of the capsule, or the end beyond which the line enters the infinite cylinder.
    ///
    /// The capsule is within that cylinder, and contains the ball at each end. So if the line enters the side between
    /// the ends, the slack of the side's chord is certain before the entry. It is also certain behind the entry if the
    /// point there is between the ends by more than the error.
    #[inline(always)]
    pub(super) fn side(
        &self,
        spine: &Spine<V>,
        radius: V::Scalar,
    ) -> Result<CertainCrossing<V>, Option<BeyondEnd<V::Scalar>>> {
        let (Self { direction, error, .. }, half_height) = (*self, spine.half_height);
        let recip = direction.length_squared().recip();
        let (base, source) = rebased(self.source, direction, recip);
        let ((along, out), (rise, radial)) = (spine.split(source), spine.split(direction));
        let slope = radial.length_squared();
        let (least_slope, least_chord) = if spine.is_upright {
            (V::Scalar::from_f64(ALONG), least_chord::<V::Scalar>())
        } else {
            (V::Scalar::EPSILON * V::Scalar::EPSILON, V::Scalar::from_f64(LEAST_CHORD))
        };
        if !(slope * recip > least_slope) {
            return Err(None);
        }
        let per_slope = slope.recip();
        let middle = -out.dot(radial) * per_slope;
        let side = Chord::about(middle, out + radial * middle, per_slope, radius);
        if side.is_past(radius, error, self.size) {
            return Ok(CertainCrossing::Misses(side.nearest));
        }
        let slack = side.slack(radius, error, per_slope, least_chord).ok_or(None)?;
        let entry = side.ends().0;
        let height = along + rise * (entry + slack);
        if height.abs() <= half_height - error {
            let at = base + entry;
            return Ok(self.enters([at - slack, at, at + slack], side.normal(radius, radial, per_slope)));
        }
        let end = V::Scalar::ONE.copysign(height);
        Err((height.abs() >= half_height + error).then_some(BeyondEnd { end, along, base }))
    }

    /// The ball at the end beyond which the line enters the infinite cylinder: it enters the capsule through that ball
    /// alone.
    ///
    /// Beyond the end, which is then the closest point of the segment, the slack of the ball's chord is certain, if the
    /// point before the entry is there by more than the error. And if the line passes the ball, the plane across the
    /// nearest point has the other end behind it, too, if that point is beyond the end.
    #[inline(always)]
    pub(super) fn end(
        &self,
        spine: &Spine<V>,
        radius: V::Scalar,
        BeyondEnd { end, along, base }: BeyondEnd<V::Scalar>,
    ) -> Option<CertainCrossing<V>> {
        let (Self { direction, error, .. }, half_height) = (*self, spine.half_height);
        let recip = direction.length_squared().recip();
        let ball = super::ball::chord(radius, self.source - spine.axis * (half_height * end), direction, recip);
        let is_beyond = spine.split(ball.nearest).0 * end >= V::Scalar::ZERO;
        if is_beyond & ball.is_past(radius, error, self.size + self.size) {
            return Some(CertainCrossing::Misses(ball.nearest));
        }
        let least_chord = if spine.is_upright { least_chord() } else { V::Scalar::from_f64(LEAST_CHORD) };
        let slack = ball.slack(radius, error, recip, least_chord)?;
        let entry = ball.ends().0;
        let height = (along + spine.split(direction).0 * (entry - base - slack)) * end;
        // Not `then`, whose closure the compiler may call.
        if height >= half_height + error {
            Some(self.enters([entry - slack, entry, entry + slack], ball.normal(radius, direction, recip)))
        } else {
            None
        }
    }

    /// A set about zero, swept by a ball, whose crossing has a closed form, with known closest points and support
    /// values.
    ///
    /// The points at `1.5e` before and behind the surface, along the normal at the entry, are measured against the set,
    /// if that is no more than `longest` along the line.
    #[inline(always)]
    pub(super) fn swept(
        &self,
        radius: V::Scalar,
        closest: impl Fn(V) -> V,
        support_value: impl Fn(V) -> V::Scalar,
        crossed: Crossed<V>,
        longest: V::Scalar,
    ) -> Option<CertainCrossing<V>> {
        let Self { source, direction, error, .. } = *self;
        let Crossing { entry, normal, .. } = match crossed {
            Ok(crossing) => crossing,
            Err(axis) => return self.passes(axis, support_value(axis), radius),
        };
        let from_core = |at: V::Scalar| {
            let x = source + direction * at;
            x - closest(x)
        };
        let approach = -from_core(entry).dot(direction);
        let slack = radius / approach * (error * V::Scalar::from_f64(1.5));
        let (inner, outer) = (radius - error, radius + error);
        let is_certain = (inner > V::Scalar::ZERO)
            & (slack >= V::Scalar::ZERO)
            & (slack <= longest)
            & (from_core(entry + slack).length_squared() <= inner * inner)
            & (from_core(entry - slack).length_squared() >= outer * outer);
        is_certain.then(|| self.enters([entry - slack, entry, entry + slack], normal))
    }

    /// A miss, if along `axis` the line passes beyond the given support value of the set, and the radius of the ball,
    /// by more than the error.
    ///
    /// Only the part of the line near the set counts, at most `NEAR + 1` sizes from the source. There it comes nearer
    /// by at most that length times `|n·d|/|d|`. This product loses `3u`, which is `27u` of the size, and `n·x` another
    /// `24u`: more than one error, and less than two.
    #[inline(always)]
    pub(crate) fn passes(&self, axis: V, support_value: V::Scalar, radius: V::Scalar) -> Option<CertainCrossing<V>> {
        let reach = self.size * V::Scalar::from_f64(NEAR + 1.0) / self.direction.abs().max_element();
        let ahead = axis.dot(self.source) - support_value - axis.dot(self.direction).abs() * reach;
        let (squared, apart) = (axis.length_squared(), radius + self.error + self.error);
        // Not by squares: those of a short axis and a small size are both zero.
        let passes = is_comfortable(squared) & (ahead > V::Scalar::ZERO) & (ahead >= apart * squared.sqrt());
        passes.then_some(CertainCrossing::Misses(axis))
    }
}

impl<V: Vector3> NearLine<V> {
    /// A cone about the second axis.
    ///
    /// It is behind the plane of its base and within its slant, `G(x) = cosα·ρ − sinα·(h − y) ≤ 0` at a distance `ρ`
    /// from the axis. `G` is how far a point is before the plane along the slant there, and it is crossed at the speed
    /// `(cos²α·(ρ·d) + sin²α·(h − y)·d_y)/(sinα·(h − y))`. As for a [swept set](Self::swept), two points of the line
    /// are measured.
    #[inline(always)]
    pub(crate) fn cone(&self, shape: &ConeMeasures<V::Scalar>) -> Option<CertainCrossing<V>> {
        let Self { source, direction, error, .. } = *self;
        let (h, (cosine, sine)) = (shape.half_height, shape.slant);
        let Crossing { entry, normal, .. } = match super::cone(shape, source, direction) {
            Ok(crossing) => crossing,
            Err(axis) => {
                return self.passes(axis, cone_reach(shape, axis), V::Scalar::ZERO);
            }
        };
        let at = source + direction * entry;
        let below = (h - at.get(1)) * sine;
        let (out, radial, rise) = (across(at) * cosine, across(direction) * cosine, direction.get(1));
        let per_speed =
            if at.get(1) <= error - h { rise.recip() } else { -below / (out.dot(radial) + below * (sine * rise)) };
        let slack = per_speed * (error * V::Scalar::from_f64(1.5));
        let (inner, outer) = (source + direction * (entry + slack), source + direction * (entry - slack));
        let slant = |x: V, by: V::Scalar| (across(x) * cosine, sine * (h - x.get(1)) + by);
        let is_in = {
            let (out, room) = slant(inner, -error);
            (room >= V::Scalar::ZERO) & (out.length_squared() <= room * room) & (inner.get(1) >= error - h)
        };
        let is_out = {
            let (out, room) = slant(outer, error);
            (room < V::Scalar::ZERO) | (out.length_squared() >= room * room) | (outer.get(1) <= -error - h)
        };
        // At the rim, the side may be one that the line leaves.
        let is_entered = normal.dot(direction) < V::Scalar::ZERO;
        ((slack >= V::Scalar::ZERO) & (slack <= self.longest_slack()) & is_in & is_out & is_entered)
            .then(|| self.enters([entry - slack, entry, entry + slack], normal))
    }

    /// A cylinder about the second axis: the line is in the slab and, projected along the axis, in the disc.
    #[inline(always)]
    pub(crate) fn cylinder(&self, half_height: V::Scalar, radius: V::Scalar) -> Option<CertainCrossing<V>> {
        let Self { source, direction, error, .. } = *self;
        let dd = direction.length_squared();
        let (base, source) = rebased(source, direction, dd.recip());
        let (out, radial) = (across(source), across(direction));
        let slope = radial.length_squared();
        if !(slope > dd * V::Scalar::from_f64(ALONG)) {
            return None;
        }
        let recip = slope.recip();
        let middle = -out.dot(radial) * recip;
        let side = Chord::about(middle, out + radial * middle, recip, radius);
        if side.is_past(radius, error, self.size) {
            return Some(CertainCrossing::Misses(side.nearest));
        }
        let slack = side.slack(radius, error, recip, least_chord::<V::Scalar>())?;
        let (enters, leaves) = side.ends();
        let (y, rise) = (source.get(1), direction.get(1));
        let per_rise = rise.recip();
        let near = half_height.copysign(-rise);
        let shift = error.copysign(rise);
        let (to_near, to_far) = (near - y, -near - y);
        let (top, bottom) = (to_near * per_rise, to_far * per_rise);
        let earliest = later(enters - slack, (to_near - shift) * per_rise);
        let latest = later(enters + slack, (to_near + shift) * per_rise);
        if latest <= sooner(leaves - slack, (to_far - shift) * per_rise) {
            let lid = V::axis(1) * V::Scalar::ONE.copysign(-rise);
            let normal = if enters > top { side.normal(radius, radial, recip) } else { lid };
            return Some(self.enters([earliest, later(enters, top), latest].map(|at| base + at), normal));
        }
        // The line leaves the side before it is at the height of the lids, or enters it after that.
        let axis = || past_rim(source, direction, if leaves < top { top } else { bottom });
        let leaves_late = sooner(leaves + slack, (to_far + shift) * per_rise);
        if earliest > leaves_late { Some(CertainCrossing::Misses(axis())) } else { None }
    }
}

impl<V: Vector> Chord<V> {
    /// A bound on the error of the ends of the chord that a ball cuts out of the line, if the line is displaced by up
    /// to `error`; `None` if the line may miss the ball, or if the squared half of the chord is less than `least·er`.
    /// `recip` is `1/|direction|²`.
    ///
    /// With the half `m`, `F = |x|² − r²` is `|d|²·σ·(σ ∓ 2m)` at `σ` within or before an end. With
    /// `σ = 1.25·e·r/(m|d|²)`, which is less than `m/8` if `m²|d|² > 10er`, `F` is less than `−2.3er` at the one and
    /// more than `2.5er` at the other: one point is deeper than `e`, and the other farther out.
    #[inline(always)]
    fn slack(&self, radius: V::Scalar, error: V::Scalar, recip: V::Scalar, least: V::Scalar) -> Option<V::Scalar> {
        let to_end = radius * recip / self.half;
        (self.inside >= radius * error * least).then(|| to_end * (error * V::Scalar::from_f64(1.25)))
    }

    /// Whether the line passes the ball, or the disc of a set as long as `length` across it, by more than an error, and
    /// so far that the plane across its nearest point `x` has the set behind it. Because `x` is wrong by up to `e`,
    /// that plane leans by `e/|x|`, and `|x|·(|x| − r) ≥ e·(r + e + length)` is enough. With `|x|² − r²` at most twice
    /// the left side, three times as much leaves room for rounding.
    #[inline(always)]
    fn is_past(&self, radius: V::Scalar, error: V::Scalar, length: V::Scalar) -> bool {
        -self.inside >= (radius + error + length) * error * V::Scalar::from_f64(3.0)
    }
}

/// The least squared half of a chord that has a [slack](Chord::slack), in units of the error times the radius.
const LEAST_CHORD: f64 = 10.0;

/// The same if a grazing line can be computed more closely: the slack is then less than a part in some thousands of the
/// radius.
#[inline(always)]
fn least_chord<S: Scalar>() -> S {
    S::from_f64(if size_of::<S>() == size_of::<f64>() { 1e7 } else { 1e2 })
}

/// The support value of a cone along an axis: at its apex, or at its base.
#[inline(always)]
pub(super) fn cone_reach<V: Vector3>(shape: &ConeMeasures<V::Scalar>, axis: V) -> V::Scalar {
    let (apex, middle) = (shape.half_height * axis.get(1), shape.radius * across(axis).length());
    apex.max(middle - apex)
}

/// The sum of the magnitudes of the coordinates, an upper bound of the length.
#[inline(always)]
pub(super) fn sum_of_coordinates<V: Vector>(v: V) -> V::Scalar {
    v.abs().dot(V::ONE)
}

/// The later of two parameters; the first, if the second is `NaN`.
#[inline(always)]
fn later<S: Scalar>(a: S, b: S) -> S {
    if b > a { b } else { a }
}

/// The earlier of two parameters; the first, if the second is `NaN`.
#[inline(always)]
fn sooner<S: Scalar>(a: S, b: S) -> S {
    if b < a { b } else { a }
}

/// The smallest coordinate; `NaN` is passed over.
#[inline(always)]
fn least<V: Vector>(v: V) -> V::Scalar {
    (0..V::DIM).fold(V::Scalar::infinity(), |least, i| sooner(least, v.get(i)))
}

/// A bound on the difference of a nearly orthogonal matrix `R` from the inverse of its transpose, applied to a unit
/// vector: `R⁻ᵀ − R = R⁻ᵀ(1 − RᵀR)`. The products lose `3u`.
pub(crate) fn skew<M: Matrix>(matrix: &M) -> <M::Vector as Vector>::Scalar {
    let gram = M::from_cols_fn(|j| matrix.transpose_mul(matrix.col(j)));
    let off = M::Vector::from_fn(|j| (gram.col(j) - M::Vector::axis(j)).length());
    (off.length() + roundings(12.0, Scalar::ONE)) * Scalar::from_f64(1.125)
}

#[cfg(test)]
mod tests {
    use crate::glam::{DVec3, Vec3A};

    use super::*;

    /// In single precision, a line that clearly misses does so in double precision, and the chord tells the same axis.
    /// Lines that pass by a thousandth of the radius clearly miss, and none that passes by less than nothing does.
    #[test]
    fn a_clear_miss_is_a_miss() {
        let (mut clear, mut near) = (0, 0);
        for i in 0..20_000 {
            let angle = f64::from(i);
            let direction = DVec3::new(angle.sin(), (1.7 * angle).cos(), (0.3 * angle).sin()).as_vec3a() * 0.8;
            let (d, radius) = (direction.as_dvec3(), 0.75_f32);
            let past = 0.75 * (1.0 + f64::from(i % 41 - 20) * 2.0_f64.powi(i % 13 - 24));
            let source = (d.any_orthonormal_vector() * past - d * (angle * 0.61).cos() * 4.0).as_vec3a();
            let line = LineQuery::<Vec3A>::new(source, direction).sweeping(radius);
            let s = source.as_dvec3();
            let off = (s - d * (s.dot(d) / d.dot(d))).length() - f64::from(radius);
            let near_line = NearLine::new(line, Vec3A::ZERO, radius).expect("numbers are moderate");
            if !(near_line.is_direct && near_line.clearly_passes(radius)) {
                assert!(off < 1e-3 || s.length() > 8.0 * f64::from(radius), "{off} {source} {direction}");
                continue;
            }
            clear += 1;
            near += u32::from(off < 1e-4);
            assert!(off > 0.0, "{off} {source} {direction}");
            let by_chord = near_line.ball(radius);
            assert!(matches!(by_chord, Some(CertainCrossing::Misses(_))), "{off} {source} {direction}");
            assert_eq!(near_line.swept_point(line), by_chord, "{off} {source} {direction}");
        }
        assert!(clear > 2000 && near > 100, "{clear} {near}");
    }
}
