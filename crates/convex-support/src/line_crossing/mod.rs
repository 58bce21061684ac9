//! The stretch of a line within a set, in closed form.
//!
//! These functions are short. Most rays need no normal and many no exit, so they are always inlined, and unused results
//! are not computed. Half of the rays miss, and a branch that cannot be predicted takes longer than the arithmetic it
//! skips. So a miss is a `NaN` or an entry behind the exit, and is recognized at the end.

#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "comparisons are written so that NaN is a miss")]

mod ball;
mod capsule;
mod certain;
mod closely;
mod cone;
mod cuboid;
mod cylinder;
mod ellipsoid;
#[cfg(feature = "hull")]
mod faceted;
pub(crate) mod lanes;
mod rounded_cuboid;
mod triangle;
mod turned;

use num_traits::Float as _;

pub(crate) use ball::ball;
pub(crate) use capsule::Spine;
pub use certain::{CertainCrossing, LineQuery};
pub(crate) use certain::{NearLine, skew};
pub(crate) use closely::closely;
pub use closely::{Close, CloseLine};
pub(crate) use cone::cone;
pub(crate) use cuboid::cuboid;
pub(crate) use cylinder::cylinder;
pub(crate) use ellipsoid::ellipsoid;
#[cfg(feature = "hull")]
pub(crate) use faceted::faceted;
pub(crate) use rounded_cuboid::rounded_cuboid;
pub(crate) use triangle::triangle;
pub(crate) use turned::Turned;

use crate::numerics::range::is_comfortable;
use crate::shapes::across;
use crate::{Core, Lines, Scalar, ScalarOf, SupportMap, Vector, Vector3};

/// The part of a line that lies in a convex set: `{ λ : source + λ·direction ∈ C }` is the interval from `entry` to
/// `exit`, in units of the direction.
///
/// It is about the whole line: for a ray, an `entry` below 0 means that the source is inside, and an `exit` below 0
/// that the set is behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Crossing<V: Vector> {
    /// Where the line enters the set.
    pub entry: V::Scalar,
    /// Where it leaves the set; at least `entry`.
    pub exit: V::Scalar,
    /// The unit outward normal where it enters; one of them at an edge or a corner.
    pub normal: V,
}

impl<V: Vector> Crossing<V> {
    /// The first `λ` in `[0, max_lambda]` that is in the interval: 0 for a source inside, `None` if the ray misses.
    ///
    /// ```
    /// use convex_support::{Ball, glam::DVec2, line_crossing};
    ///
    /// let disc = Ball::<DVec2>::new(1.0)?;
    /// let crossing = line_crossing(&disc, DVec2::new(-3.0, 0.0), DVec2::new(0.5, 0.0))
    ///     .crossing()
    ///     .ok_or("a miss")?;
    /// assert_eq!((crossing.entry, crossing.exit, crossing.normal), (4.0, 8.0, DVec2::NEG_X));
    /// assert_eq!(crossing.first_hit(f64::INFINITY), Some(4.0));
    /// assert_eq!(crossing.first_hit(3.0), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline]
    #[must_use]
    pub fn first_hit(&self, max_lambda: V::Scalar) -> Option<V::Scalar> {
        // Not `&&` and `max`: half of the rays miss, and a branch that cannot be predicted takes longer than all of
        // this.
        let first = if self.entry > V::Scalar::ZERO { self.entry } else { V::Scalar::ZERO };
        ((self.exit >= V::Scalar::ZERO) & (self.entry <= max_lambda)).then_some(first)
    }

    /// The crossing with `λ` counted from the original source, in units of the original direction; a miss, along the
    /// given axis, if the stretch is empty or `NaN`.
    #[inline(always)]
    fn shifted(self, base: V::Scalar, unit: V::Scalar, axis: impl FnOnce() -> V) -> Crossed<V> {
        if self.entry <= self.exit {
            Ok(Self { entry: (base + self.entry) * unit, exit: (base + self.exit) * unit, ..self })
        } else {
            Err(axis())
        }
    }
}

/// The crossing of a convex set by a line, as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub enum LineCrossing<V: Vector> {
    /// The shape has no closed form, or none in this case.
    Unknown,
    /// The line misses the set. The vector is across the line and of any length. If it is not zero, a plane across it
    /// has the set behind it and the line before it; algorithms check that.
    Misses(V),
    /// The stretch of the line that is in the set.
    Crosses(Crossing<V>),
}

impl<V: Vector> LineCrossing<V> {
    /// The stretch of the line that is in the set; `None` if it misses or is unknown.
    #[inline]
    #[must_use]
    pub fn crossing(self) -> Option<Crossing<V>> {
        match self {
            Self::Crosses(crossing) => Some(crossing),
            Self::Unknown | Self::Misses(_) => None,
        }
    }

    /// The answer with its normal, or the vector across which the line misses, mapped.
    #[inline(always)]
    pub(crate) fn with_normal(self, normal: impl FnOnce(V) -> V) -> Self {
        match self {
            Self::Crosses(crossing) => Self::Crosses(Crossing { normal: normal(crossing.normal), ..crossing }),
            Self::Misses(axis) => Self::Misses(normal(axis)),
            Self::Unknown => Self::Unknown,
        }
    }
}

/// The result of a closed form: the crossing, or the vector of [`LineCrossing::Misses`].
type Crossed<V> = Result<Crossing<V>, V>;

impl<V: Vector> From<Crossed<V>> for LineCrossing<V> {
    #[inline(always)]
    fn from(crossed: Crossed<V>) -> Self {
        crossed.map_or_else(Self::Misses, Self::Crosses)
    }
}

/// A convex set with a closed form for where a line is in it, for [`line_crossing`].
#[diagnostic::on_unimplemented(
    message = "where a line crosses `{Self}` has no closed form",
    note = "`gjk_raycast::ray_cast` answers of every shape where a ray enters it, and `ray_exit` where it leaves"
)]
pub trait CrossedByLine: SupportMap {
    /// Where the line through `source` along `direction` is in the core swept by a ball of the given `radius`, in
    /// closed form; `source` is relative to the [origin](Core::origin) of the core. [`LineCrossing::Unknown`] if this
    /// core and this radius have no closed form.
    fn core_line_crossing(
        &self,
        source: Self::Vector,
        direction: Self::Vector,
        radius: ScalarOf<Self>,
    ) -> LineCrossing<Self::Vector>;

    /// The answers of [`certain_crossing`](SupportMap::certain_crossing) in plain numbers for many lines, to the last
    /// bit. Lines without a certain answer, or whose answer costs a branch, are left out. `false`, as the provided
    /// method returns, if nothing is ever known.
    #[doc(hidden)]
    #[inline]
    fn certain_crossings(&self, lines: &mut Lines<ScalarOf<Self>>) -> bool {
        let _ = lines;
        false
    }
}

/// Where the line through `source` along `direction` is in a shape.
///
/// This is for ray tracers, and it is an independent reference for ray casts that only use the support mapping.
/// Points, segments, triangles, balls, boxes, capsules, cylinders, cones and ellipsoids have closed forms, and so
/// have the first six of these swept by a ball. It also works through poses, invertible affine maps, roundings and
/// sums with a point, and behind any pointer. If such a combination has no closed form, the answer is
/// [`LineCrossing::Unknown`].
///
/// ```
/// use convex_support::{Cone, Cuboid, LineCrossing, Posed, Rounded, glam::DVec3, line_crossing};
///
/// let die = Posed::translated(
///     Rounded::new(Cuboid::new(DVec3::ONE)?, 0.25)?,
///     DVec3::new(5.0, 0.0, 0.0),
/// )?;
/// let crossing = line_crossing(&die, DVec3::ZERO, DVec3::X).crossing().ok_or("a miss")?;
/// assert_eq!((crossing.entry, crossing.exit), (3.75, 6.25));
/// assert!(matches!(line_crossing(&die, DVec3::ZERO, DVec3::Y), LineCrossing::Misses(_)));
///
/// let rounded_cone = Rounded::new(Cone::<DVec3>::new(1.0, 1.0)?, 0.1)?;
/// assert_eq!(line_crossing(&rounded_cone, DVec3::ZERO, DVec3::Y), LineCrossing::Unknown);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Accuracy
/// Every method starts from the point of the line nearest the shape's centre, so that coordinates there are of the
/// size of the shape and nothing cancels except the digits that the source's own coordinates have already lost:
/// `λ·|direction|` carries an error of a few units in the last place of the distance between source and centre. Where
/// a line grazes a curved surface, at an angle `α`, this is magnified by `1/sin α`. If a line passes the boundary
/// within this error, rounding decides whether it hits. Squares of lengths must stay in range (about 1e±150 in
/// `f64`, 1e±18 in `f32`); directions may have any length. A zero direction has no line and a `NaN` no crossing: a
/// miss.
#[inline(always)]
pub fn line_crossing<S: CrossedByLine + ?Sized>(
    shape: &S,
    source: S::Vector,
    direction: S::Vector,
) -> LineCrossing<S::Vector> {
    let Core { origin, radius, .. } = shape.core();
    shape.core_line_crossing(source - origin, direction, radius)
}

/// The part of a line within a ball about zero, as `middle ± half`; `half` is `NaN` if the line misses the ball.
struct Chord<V: Vector> {
    middle: V::Scalar,
    half: V::Scalar,
    /// The point of the line nearest zero.
    nearest: V,
    /// The square of the radius less that of the distance of that point.
    inside: V::Scalar,
}

/// The parameter at which the line is nearest zero; `recip` is `1/|direction|²`.
#[inline(always)]
fn rebased<V: Vector>(source: V, direction: V, recip: V::Scalar) -> (V::Scalar, V) {
    let first = -source.dot(direction) * recip;
    let near = source + direction * first;
    // Far from zero, the first step was rounded to the distance of the source; the second is rounded to the line's.
    let second = -near.dot(direction) * recip;
    (first + second, near + direction * second)
}

impl<V: Vector> Chord<V> {
    /// The chord that the ball `|x|² ≤ radius²` cuts out of `nearest + (λ − middle)·direction`, where `nearest ⟂
    /// direction` and `recip` is `1/|direction|²`: `|nearest|² + μ²·|direction|² = radius²`.
    #[inline(always)]
    fn about(middle: V::Scalar, nearest: V, recip: V::Scalar, radius: V::Scalar) -> Self {
        let inside = radius * radius - nearest.length_squared();
        Self { middle, half: (inside * recip).sqrt(), nearest, inside }
    }

    /// Whether the line meets the ball.
    #[inline(always)]
    fn is_some(&self) -> bool {
        self.half >= V::Scalar::ZERO
    }

    /// Where the line enters and leaves the ball.
    #[inline(always)]
    fn ends(&self) -> (V::Scalar, V::Scalar) {
        (self.middle - self.half, self.middle + self.half)
    }

    /// The unit outward normal of the ball where the line enters it; `recip` is `1/|direction|²`.
    #[inline(always)]
    fn normal(&self, radius: V::Scalar, direction: V, recip: V::Scalar) -> V {
        if radius > V::Scalar::ZERO {
            (self.nearest - direction * self.half) * radius.recip()
        } else {
            -direction * recip.sqrt()
        }
    }
}

/// The axis of the first coordinate that has the given value; the last axis if none has.
#[inline(always)]
fn axis_of<V: Vector>(v: V, value: V::Scalar) -> V {
    let mut found = false;
    V::from_fn(|i| {
        let here = !found & ((v.get(i) == value) | (i + 1 == V::DIM));
        found |= here;
        if here { V::Scalar::ONE } else { V::Scalar::ZERO }
    })
}

/// The vector across a line and across all axes but two, from the middle of a box towards the line.
#[inline(always)]
fn across_two_axes<V: Vector>([a, b]: [V; 2], source: V, direction: V) -> V {
    let across = a * b.dot(direction) - b * a.dot(direction);
    // A line along both slabs across these axes is outside of each.
    let across = if across == V::ZERO { a } else { across };
    across * V::Scalar::ONE.copysign(across.dot(source))
}

/// The normal of the plane along a line that is parallel to the rim of a disc about the second axis. The line crosses
/// the plane of the disc at `at`, outside of the disc. With `ρ` the vector from the disc's middle to `at`, the normal
/// is across `d` and the tangent `y × ρ`: a multiple of `ρ·d_y − y·(ρ·d)`. A level line passes above or below.
#[inline(always)]
fn past_rim<V: Vector3>(source: V, direction: V, at: V::Scalar) -> V {
    let rise = direction.get(1);
    if rise == V::Scalar::ZERO {
        return V::axis(1) * V::Scalar::ONE.copysign(source.get(1));
    }
    let out = across(source + direction * at);
    (out * rise - V::axis(1) * out.dot(direction)) * V::Scalar::ONE.copysign(rise)
}

/// The part of a line where `|y| ≤ half_height`: entry, exit. A level line is in the slab everywhere or nowhere: an
/// infinite stretch, or one that ends before it begins.
#[inline(always)]
fn slab<S: Scalar>(y: S, rise: S, half_height: S) -> (S, S) {
    let near = half_height.copysign(-rise);
    let (enters, leaves) = ((near - y) / rise, (-near - y) / rise);
    if rise == S::ZERO {
        let within = y.abs() <= half_height;
        return if within { (-S::infinity(), S::infinity()) } else { (S::infinity(), -S::infinity()) };
    }
    (enters, leaves)
}

/// The direction, scaled by a power of two if its square would over- or underflow; the square of its length; and the
/// power, which is the length of a unit of `λ` along it in units of the given direction.
///
/// A zero, infinite or `NaN` direction has a `λ` that is `NaN`.
#[inline(always)]
fn comfortable<V: Vector>(direction: V) -> (V, V::Scalar, V::Scalar) {
    let dd = direction.length_squared();
    if is_comfortable(dd) {
        (direction, dd, V::Scalar::ONE)
    } else {
        let unit = comfortable_unit(dd);
        (direction * unit, (direction * unit).length_squared(), unit)
    }
}

/// Powers that bring the shortest and the longest vectors into range, and no others out of it: with `2⁻⁶¹⁵` and `2⁶¹⁵`
/// in `f64`, lengths of `2⁻¹⁰⁷⁴..2⁻⁴⁸⁵` become `2⁻⁴⁵⁹..2¹³⁰` and `2⁵¹²..2¹⁰²⁴` become `2⁻¹⁰³..2⁴⁰⁹`.
#[cold]
#[inline(never)]
fn comfortable_unit<S: Scalar>(squared: S) -> S {
    let small = S::min_positive_value().sqrt() * S::EPSILON * S::EPSILON;
    if squared < S::ONE { small.recip() } else { small }
}
