//! Where a line certainly enters a shape, in twice the precision.
//!
//! If a line is nearly along a surface, or grazes it, or if the shape is a needle, errors as small as roundings of the
//! shape's size move the crossing far. But the given numbers of shape and line are exact: with all of them in twice the
//! precision, only the error that comes with the shape is left. So a pose and an affine map take the line to their
//! shape in twice the precision too. A shape is a union of pieces, each the intersection of slabs and quadrics, and the
//! line is in each for a stretch with bounds on both ends. To hold for every line that passes within the error, the
//! shape is once made larger and once smaller by it.
//!
//! The arithmetic is that of `f64` whatever the precision of the shape, and is compiled once.

use glam::{DMat3, DVec3};

use super::certain::cone_reach;
use super::{CertainCrossing, Crossed, Crossing, LineQuery, NearLine, Spine, axis_of};
use crate::numerics::bound::roundings;
use crate::numerics::bounded::Bounded;
use crate::numerics::elementary::hypot;
use crate::numerics::range::power_of_two_below;
use crate::shapes::axial::{ConeMeasures, across};
use crate::{Core, Matrix, Scalar, Vector};

/// A line in the frame of a shape, in units of a power of two near the size of that shape.
#[derive(Clone, Copy, Debug)]
pub struct CloseLine {
    source: [Bounded; 3],
    direction: [Bounded; 3],
    /// The radius of a ball that the shape is swept by.
    radius: Bounded,
    /// The answer must hold for every line that passes within this distance near the shape.
    error: f64,
    /// The unit of length.
    unit: f64,
}

/// What a shape says of a line in twice the precision, if that is certain; its vectors are in the shape's frame.
pub type Close = Option<CertainCrossing<DVec3>>;

/// The certain crossing of a shape of this core in twice the precision, by its answer about the line in its own frame.
/// A line that passes far from the shape, and numbers too small or large to be squared, are left to a search.
pub(super) fn crossing<V: Vector>(
    core: &Core<V>,
    line: LineQuery<V>,
    answer: impl FnOnce(&CloseLine) -> Close,
) -> Option<CertainCrossing<V>> {
    let number = V::Scalar::from_f64;
    let size = core.size() + line.radius;
    NearLine::new(line, core.origin, size)?;
    let unit = power_of_two_below(size).as_f64();
    let speed = power_of_two_below(line.direction.abs().max_element()).as_f64();
    let close = CloseLine {
        source: (wide(line.source) / unit).to_array().map(Bounded::from),
        direction: (wide(line.direction) / speed).to_array().map(Bounded::from),
        radius: (line.radius.as_f64() / unit).into(),
        error: line.error.as_f64() / unit,
        unit,
    };
    let narrow = |v: DVec3| V::from_fn(|i| number(v[i]));
    Some(match answer(&close)? {
        CertainCrossing::Misses(axis) => CertainCrossing::Misses(narrow(axis)),
        CertainCrossing::Enters { bounds, normal, .. } => {
            let [earliest, latest] = bounds.map(|at| at * (unit / speed));
            let entry = number(earliest + (latest - earliest) * 0.5);
            // Rounded to the numbers of the shape.
            let apart = |at: f64| roundings(4.0, number(at.abs()));
            let bounds = [number(earliest) - apart(earliest), number(latest) + apart(latest)];
            CertainCrossing::Enters { entry, bounds, normal: narrow(normal) }
        }
    })
}

/// A vector in `f64` with three coordinates.
fn wide<V: Vector>(v: V) -> DVec3 {
    DVec3::from_array(core::array::from_fn(|i| if i < V::DIM { v.get(i).as_f64() } else { 0.0 }))
}

impl CloseLine {
    /// A length in the unit of this line.
    fn in_units<S: Scalar>(&self, length: S) -> f64 {
        length.as_f64() / self.unit
    }

    /// The line relative to a point.
    pub(crate) fn seen_from<V: Vector>(self, point: V) -> Self {
        let at = wide(point) / self.unit;
        Self { source: core::array::from_fn(|i| self.source[i] - at[i].into()), ..self }
    }

    /// The line for the shape swept by a further ball.
    pub(crate) fn sweeping<S: Scalar>(self, radius: S) -> Self {
        Self { radius: self.radius + self.in_units(radius).into(), ..self }
    }

    /// The line with a further error.
    pub(crate) fn within<S: Scalar>(self, error: S) -> Self {
        Self { error: self.error + self.in_units(error), ..self }
    }

    /// The line for the reflected shape.
    pub(crate) fn reflected(self) -> Self {
        Self { source: self.source.map(|x| -x), direction: self.direction.map(|x| -x), ..self }
    }

    /// The answer of a shape of a `size` that is mapped by a matrix and then moved: the shape is asked about the line
    /// before the map, and its normal `n` is mapped to `M⁻ᵀ·n`. A ball that sweeps the image is one before the map only
    /// if all lengths are scaled by one factor, which is right to 16 roundings unless it is 1.
    ///
    /// The inverse is that of Cramer's rule, whose error the coordinates carry.
    pub(crate) fn mapped<V: Vector>(
        &self,
        (matrix, translation): (&V::Matrix, V),
        size: V::Scalar,
        scale: Option<V::Scalar>,
        answer: impl FnOnce(&Self) -> Close,
    ) -> Close {
        let columns: [DVec3; 3] = core::array::from_fn(|j| if j < V::DIM { wide(matrix.col(j)) } else { DVec3::Z });
        let largest = columns[..V::DIM].iter().fold(0.0, |most: f64, column| most.max(column.abs().max_element()));
        let power = power_of_two_below(largest);
        let entry =
            |i: usize, j: usize| Bounded::from(columns[j % 3][i % 3] / if j % 3 < V::DIM { power } else { 1.0 });
        let cofactor = |i, j| entry(i + 1, j + 1) * entry(i + 2, j + 2) - entry(i + 1, j + 2) * entry(i + 2, j + 1);
        let determinant = (0..3).fold(Bounded::from(0.0), |sum, j| sum + entry(0, j) * cofactor(0, j));
        if !(determinant.is_positive() || determinant.is_negative()) {
            return None;
        }
        let shrunk = scale.map(|scale| scale.as_f64().recip());
        let radius = self.radius * shrunk.unwrap_or(1.0).into();
        let unit = power_of_two_below(size.as_f64() + radius.middle() * self.unit);
        let per_unit = self.unit / unit;
        let inverse: [[Bounded; 3]; 3] = core::array::from_fn(|i| {
            core::array::from_fn(|j| cofactor(j, i) / determinant * Bounded::from(per_unit / power))
        });
        let onto = |v: [Bounded; 3]| inverse.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
        // The transpose: its columns are the rows of the inverse. It maps normals, and bounds how far an error grows.
        let transpose = DMat3::from_cols_array_2d(&inverse.map(|row| row.map(Bounded::middle)));
        let rows = [transpose.x_axis, transpose.y_axis, transpose.z_axis].map(DVec3::length);
        let longest = hypot(hypot(rows[0], rows[1]), rows[2]);
        let longest = shrunk.map_or(longest, |shrunk| shrunk * per_unit * NEARLY_ORTHOGONAL);
        let radius = radius * per_unit.into();
        let rounded = if shrunk.is_none_or(|shrunk| shrunk == 1.0) { 0.0 } else { 32.0 * V::Scalar::EPSILON.as_f64() };
        if shrunk.is_none() {
            self.is_not_swept()?;
        }
        let line = Self {
            source: onto(self.seen_from(translation).source),
            direction: onto(self.direction),
            radius,
            error: (self.error * longest + radius.middle() * rounded) * ROUNDED,
            unit,
        };
        Some(answer(&line)?.with_normal(|n| (transpose * n).normalize_or_zero()))
    }

    /// The answer of a shape of a `size` whose distance of the origin is `far`, turned by a matrix whose entries have
    /// errors of so many ε, and then moved. The identity is exact, and so is any other matrix that was given.
    pub(crate) fn turned<V: Vector>(
        &self,
        (matrix, translation): (&V::Matrix, V),
        matrix_error: V::Scalar,
        [size, far]: [V::Scalar; 2],
        answer: impl FnOnce(&Self) -> Close,
    ) -> Close {
        let is_exact = *matrix == V::Matrix::IDENTITY;
        let error = if is_exact { V::Scalar::ZERO } else { V::Scalar::from_f64(V::DIM as f64) * matrix_error };
        let line = self.within(error * V::Scalar::EPSILON * (size + far + V::Scalar::from_f64(self.error * self.unit)));
        line.mapped((matrix, translation), size, Some(V::Scalar::ONE), answer)
    }

    /// The line in plain numbers, as a point and a direction.
    fn plain(&self) -> [DVec3; 2] {
        [self.source, self.direction].map(|v| DVec3::from_array(v.map(Bounded::middle)))
    }

    /// The line from its point at a parameter: from near the shape, differences of squares keep their digits.
    fn from(&self, at: f64) -> Self {
        let moved = |i: usize| self.source[i] + self.direction[i] * at.into();
        Self { source: core::array::from_fn(moved), ..*self }
    }

    /// The certain answer from the first entry into a shape made larger by a length, or smaller if that is negative.
    /// `outward` is the unit normal at a point of the surface, and the core `reaches` so far along an axis. The closed
    /// form in plain numbers tells from where to count, and along which axis a line misses.
    fn known(
        &self,
        entry: impl Fn(&Self, f64) -> First,
        outward: impl Fn(DVec3) -> DVec3,
        crossed: impl Fn(DVec3, DVec3) -> Crossed<DVec3>,
        reaches: impl Fn(DVec3) -> f64,
    ) -> Close {
        let [source, direction] = self.plain();
        let found = crossed(source, direction);
        let foot = || -source.dot(direction) / direction.length_squared();
        let base = found.map_or_else(|_| foot(), |crossing| crossing.entry);
        let line = self.from(base);
        let [source, _] = line.plain();
        let larger = entry(&line, self.error);
        let smaller = if self.error > 0.0 { entry(&line, -self.error) } else { larger };
        if larger.earliest == f64::INFINITY {
            // By rounding alone the line may cross the shape, but then it misses a smaller one: that is, one farther
            // out misses the shape. An axis along which they are not apart to rounding tells nothing.
            let axis = found.err().or_else(|| crossed(source * (1.0 + 32.0 * f64::EPSILON), direction).err())?;
            let ahead = axis.dot(source) - reaches(axis) - self.radius.middle() * axis.length();
            let is_apart = ahead >= -64.0 * f64::EPSILON * axis.length() && axis.length_squared() > 0.0;
            return is_apart.then_some(CertainCrossing::Misses(axis));
        }
        let bounds = [base + larger.earliest, base + smaller.latest];
        // NaN and infinity prove nothing.
        let is_known = bounds[0] > f64::NEG_INFINITY && bounds[1] < f64::INFINITY;
        let entry = larger.earliest + (smaller.latest - larger.earliest) * 0.5;
        let normal = outward(source + direction * entry);
        is_known.then_some(CertainCrossing::Enters { entry: base + entry, bounds, normal })
    }

    /// A segment about zero along the second axis, swept by a ball, or a ball.
    pub(crate) fn capsule<S: Scalar>(&self, half_height: S) -> Close {
        let half_height = self.in_units(half_height);
        let radius = self.radius.middle();
        let end = DVec3::Y * half_height;
        let [_, direction] = self.plain();
        let outward =
            |at: DVec3| (at - at.max(-end).min(end)).try_normalize().unwrap_or(-direction.normalize_or_zero());
        let crossed = |source, direction| Spine::upright(half_height).crossing(radius, source, direction);
        let entry = |line: &Self, by: f64| {
            let radius = line.radius + by.into();
            let mut first = First::NONE;
            first.take(line.slab(1, half_height.into()).and(line.disc([true, false, true], [0.0; 3], radius)));
            for end in [half_height, -half_height] {
                first.take(line.disc([true; 3], [0.0, end, 0.0], radius));
            }
            first
        };
        self.known(entry, outward, crossed, |axis| half_height * axis.y.abs())
    }

    /// A cylinder about the second axis, not swept by a ball.
    pub(crate) fn cylinder<S: Scalar>(&self, half_height: S, radius: S) -> Close {
        let [half_height, radius] = [half_height, radius].map(|length| self.in_units(length));
        let [_, direction] = self.plain();
        let outward = |at: DVec3| {
            let lid = DVec3::Y.copysign(-direction);
            let side = across(at).try_normalize().unwrap_or(lid);
            self.entered([(across(at).length() - radius, side), (at.dot(lid) - half_height, lid)])
        };
        let crossed = |source, direction| super::cylinder(half_height, radius, source, direction);
        let entry = |line: &Self, by: f64| {
            let disc = line.disc([true, false, true], [0.0; 3], Bounded::sum(radius, by));
            let mut first = First::NONE;
            first.take(line.slab(1, Bounded::sum(half_height, by)).and(disc));
            first
        };
        self.is_not_swept()?;
        self.known(entry, outward, crossed, |axis| half_height * axis.y.abs() + radius * across(axis).length())
    }

    /// The normal of the surface that the line enters, of two that meet at an edge: the one that its point is farther
    /// beyond, but where that is an error, one that the line does not leave.
    fn entered(&self, surfaces: [(f64, DVec3); 2]) -> DVec3 {
        let [_, direction] = self.plain();
        let error = self.error * 2.0 + 32.0 * f64::EPSILON;
        let [first, second] = surfaces.map(|(beyond, n)| if n.dot(direction) > 0.0 { beyond - error } else { beyond });
        surfaces[usize::from(second > first)].1
    }

    /// `None` if the shape is swept by a ball.
    fn is_not_swept(&self) -> Option<()> {
        (self.radius.bounds() == [0.0; 2]).then_some(())
    }

    /// A cone about the second axis, not swept by a ball.
    pub(crate) fn cone<S: Scalar>(&self, half_height: S, radius: S) -> Close {
        let shape = ConeMeasures::new(self.in_units(half_height), self.in_units(radius));
        let ConeMeasures { half_height, radius, slant: (cosine, sine), .. } = shape;
        // A disc and a segment have no opening angle.
        (half_height.min(radius) > 0.0).then_some(())?;
        let [_, direction] = self.plain();
        let outward = |at: DVec3| {
            let beyond_slant = across(at).length() * cosine - (half_height - at.y) * sine;
            let out = across(at).try_normalize().unwrap_or_else(|| across(-direction).normalize_or_zero());
            self.entered([(beyond_slant, out * cosine + DVec3::Y * sine), (-half_height - at.y, DVec3::NEG_Y)])
        };
        let crossed = |source, direction| super::cone(&shape, source, direction);
        self.is_not_swept()?;
        let entry = |line: &Self, by| line.in_cone(half_height, radius, by);
        self.known(entry, outward, crossed, |axis| cone_reach(&shape, axis))
    }

    /// The cone is behind its base and below its apex, where `4h²·(x² + z²) ≤ r²·(h − y)²`. Each of its planes is moved
    /// by `by`: the base by `by`, and the apex by `by/sinα`, with `α` half the opening angle.
    fn in_cone(&self, half_height: f64, radius: f64, by: f64) -> First {
        let height = half_height + half_height;
        let lift = if by == 0.0 { 0.0 } else { by * hypot(height / radius, 1.0) };
        // The product and the length are wrong by a few roundings.
        let lift = lift + lift * (8.0 * f64::EPSILON);
        let (apex, base) = (Bounded::sum(half_height, lift), Bounded::sum(-half_height, -by));
        let (along, fall) = (apex - self.source[1], -self.direction[1]);
        let (tall, wide) = (Bounded::from(height).squared(), Bounded::from(radius).squared());
        let [a, b, c] = self.quadratic([true, false, true], [0.0; 3]);
        let a = a * tall - fall.squared() * wide;
        let b = b * tall - along * fall * wide;
        let c = c * tall - along.squared() * wide;
        let slant = match quadric(a, b, c) {
            Quadric::Within(stretch) => stretch,
            // A line steeper than the slant is below the apex after both roots if it falls, and before both if it
            // rises.
            Quadric::Outside { high, .. } if fall.is_positive() => Stretch { enters: high, leaves: [f64::INFINITY; 2] },
            Quadric::Outside { low, .. } => Stretch { enters: [f64::NEG_INFINITY; 2], leaves: low },
        };
        let mut first = First::NONE;
        first.take(slant.and(self.between(1, base, apex)));
        first
    }

    /// A box about zero, swept by a ball or not.
    pub(crate) fn cuboid<V: Vector>(&self, half_extents: V) -> Close {
        let half = wide(half_extents) / self.unit;
        let axes = |i: usize| i < V::DIM;
        let is_swept = self.is_not_swept().is_none();
        // In the plane a prism of any height has the same edges.
        let prism = DVec3::from_array(core::array::from_fn(|i| if axes(i) { half[i] } else { 1.0 }));
        let [_, direction] = self.plain();
        let outward = |at: DVec3| {
            // The line enters the sides that it goes against, also where its point is beyond others by an error.
            let side = DVec3::ONE.copysign(DVec3::select(direction.cmpeq(DVec3::ZERO), at, -direction));
            let beyond = at * side - prism;
            let face = axis_of(beyond, beyond.max_element()) * side;
            let excess = if is_swept { at - at.max(-prism).min(prism) } else { face };
            excess.try_normalize().unwrap_or(face)
        };
        let crossed = |source, direction| {
            if is_swept {
                super::rounded_cuboid(prism, self.radius.middle(), source, direction)
            } else {
                super::cuboid(prism, source, direction)
            }
        };
        let entry = |line: &Self, by| line.in_rounded_box(half.to_array(), V::DIM, is_swept, by);
        self.known(entry, outward, crossed, |axis| axis.abs().dot(prism))
    }

    /// A box swept by a ball: the boxes that are longer by the radius along one axis, the edges swept by a ball, and
    /// the balls about the corners. A box without a radius is itself made larger, or smaller.
    fn in_rounded_box(&self, half_extents: [f64; 3], dimension: usize, is_swept: bool, by: f64) -> First {
        let mut first = First::NONE;
        let radius = self.radius + by.into();
        if is_swept && radius.is_negative() {
            // What is left of the box when it is made smaller is not looked for.
            return first;
        }
        for long in 0..dimension {
            let half = |i: usize| {
                if i == long || !is_swept { radius + half_extents[i].into() } else { half_extents[i].into() }
            };
            first.take((0..dimension).fold(Stretch::EVERYWHERE, |all, i| all.and(self.slab(i, half(i)))));
            if !is_swept {
                return first;
            }
        }
        // For each axis the lower end, the upper end, or the part between.
        for place in 0..27_usize {
            let sides = [place % 3, place / 3 % 3, place / 9].map(|side| [-1.0, 0.0, 1.0][side]);
            let is_meant = core::array::from_fn(|i| sides[i] != 0.0);
            let count = is_meant.iter().filter(|&&is_meant| is_meant).count();
            if count < 2 || (dimension..3).any(|i| is_meant[i]) {
                continue;
            }
            let centre = core::array::from_fn(|i| sides[i] * half_extents[i]);
            let between = (0..dimension).filter(|&i| !is_meant[i]).map(|i| self.slab(i, half_extents[i].into()));
            first.take(between.fold(self.disc(is_meant, centre, radius), Stretch::and));
        }
        first
    }

    /// An ellipsoid about zero whose semi-axes are along the coordinate axes, not swept by a ball.
    ///
    /// With `wᵢ = xᵢ/aᵢ` it is the unit ball, and a displacement by `e` moves `w` within the ellipsoid `K` of semi-axes
    /// `kᵢ = e/aᵢ`. For all `t > 0` the ball swept by `K` is within the ellipsoid of the squared semi-axes
    /// `(1 + t) + kᵢ²·(1 + 1/t)`, because `(1 + |Kn|)² ≤ (1 + t) + (1 + 1/t)·|Kn|²` for a unit vector `n`, with
    /// equality if `t = |Kn|`. In the same way the ellipsoid of the squared semi-axes `(1 − kᵢ²·(1 + 1/t))/(1 + t)`,
    /// swept by `K`, is within the ball. So `t` is `|Kn|` for the normal `n` where the line enters: the tip of a
    /// needle then moves by `e`, and not by `e` times the aspect. Where `k` is too large for this, `t = 4k²` leaves a
    /// smaller ellipsoid that is not empty.
    pub(crate) fn ellipsoid<V: Vector>(&self, semi_axes: V) -> Close {
        let axis = |i: usize| Bounded::from(if i < V::DIM { self.in_units(semi_axes.get(i)) } else { 1.0 });
        let inverse = DVec3::from_array(core::array::from_fn(|i| axis(i).middle().recip()));
        let crossed = |source: DVec3, direction: DVec3| {
            super::ball(1.0, source * inverse, direction * inverse).map_err(|axis| axis * inverse)
        };
        let [source, direction] = self.plain();
        // The normal of the ball that it is.
        let normal = match crossed(source, direction) {
            Ok(Crossing { normal, .. }) => normal,
            Err(axis) => (axis / inverse).normalize_or_zero(),
        };
        let moved = inverse * self.error;
        let largest = moved.max_element();
        let part = (moved * normal).length();
        let one = Bounded::from(1.0);
        let entry = |line: &Self, by: f64| {
            let part = Bounded::from(if by < 0.0 { part.max(4.0 * largest * largest) } else { part });
            let squared: [Bounded; 3] = core::array::from_fn(|i| {
                if by == 0.0 {
                    return one;
                }
                let moved = (Bounded::from(by) / axis(i)).squared() * (one + one / part);
                if by > 0.0 { one + part + moved } else { (one - moved) / (one + part) }
            });
            let [v, w] = [line.direction, line.source].map(|v| [0, 1, 2].map(|i| v[i] / axis(i)));
            let product = |v: [Bounded; 3], w: [Bounded; 3]| {
                (0..3).fold(Bounded::from(0.0), |sum, i| sum + v[i] * w[i] / squared[i])
            };
            let is_real = squared.iter().all(|squared| squared.is_positive());
            let quadric = is_real.then(|| quadric(product(v, v), product(v, w), product(w, w) - one));
            let mut first = First::NONE;
            first.take(quadric.map_or(Stretch::UNKNOWN, Quadric::within));
            first
        };
        self.is_not_swept()?;
        let outward = |at: DVec3| (at * inverse * inverse).normalize_or_zero();
        self.known(entry, outward, crossed, |axis| (axis / inverse).length())
    }

    /// The stretch where `|x·eᵢ| ≤ half`.
    fn slab(&self, axis: usize, half: Bounded) -> Stretch {
        self.between(axis, -half, half)
    }

    /// The stretch where the coordinate is between two numbers.
    fn between(&self, axis: usize, low: Bounded, high: Bounded) -> Stretch {
        let (at, speed) = (self.source[axis], self.direction[axis]);
        if !(speed.is_positive() || speed.is_negative()) {
            // Level to within an error.
            let at = at.give_or_take(self.drift(axis));
            return Stretch::of_level(at - low, high - at);
        }
        let (below, above) = (at - low, high - at);
        let (enters, leaves) = if speed.is_positive() { (-below, above) } else { (above, -below) };
        Stretch { enters: (enters / speed).bounds(), leaves: (leaves / speed).bounds() }
    }

    /// A bound on how much a coordinate changes along the line near the shape, which is no larger than two units.
    fn drift(&self, axis: usize) -> f64 {
        let [source, direction] = self.plain();
        let [least, most] = self.direction[axis].bounds();
        let reach = (source.abs().element_sum() + 4.0 + self.error) / direction.abs().max_element();
        if [least, most] == [0.0; 2] { 0.0 } else { least.abs().max(most.abs()) * reach * ROUNDED }
    }

    /// With the meant coordinates `x` relative to a centre, `|x|² = aλ² + 2bλ + c` along the line.
    fn quadratic(&self, is_meant: [bool; 3], centre: [f64; 3]) -> [Bounded; 3] {
        (0..3).filter(|&i| is_meant[i]).fold([Bounded::from(0.0); 3], |[a, b, c], i| {
            let (at, d) = (self.source[i] - centre[i].into(), self.direction[i]);
            [a + d.squared(), b + at * d, c + at.squared()]
        })
    }

    /// The stretch where the meant coordinates are within a distance of a centre.
    fn disc(&self, is_meant: [bool; 3], centre: [f64; 3], radius: Bounded) -> Stretch {
        if radius.is_negative() {
            return Stretch::NOWHERE;
        }
        let [a, b, c] = self.quadratic(is_meant, centre);
        if !a.is_positive() {
            // The line is along the axis to within an error, and near the shape it is off by no more.
            let inside = (0..3).filter(|&i| is_meant[i]).fold(radius.squared(), |rest, i| {
                let at = self.source[i] - centre[i].into();
                rest - at.give_or_take(self.drift(i)).squared()
            });
            return Stretch::of_level(inside, inside);
        }
        quadric(a, b, c - radius.squared()).within()
    }
}

/// How much longer a vector may be before it is turned, by a matrix that is a rotation to half its digits.
const NEARLY_ORTHOGONAL: f64 = 1.0 + 1.0 / 256.0;

/// Makes up for the rounding of a bound that is computed in plain numbers.
const ROUNDED: f64 = 1.0 + 64.0 * f64::EPSILON;

/// The stretch of a line in a set, with bounds on both ends.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    enters: [f64; 2],
    leaves: [f64; 2],
}

impl Stretch {
    const EVERYWHERE: Self = Self { enters: [f64::NEG_INFINITY; 2], leaves: [f64::INFINITY; 2] };
    const NOWHERE: Self = Self { enters: [f64::INFINITY; 2], leaves: [f64::NEG_INFINITY; 2] };
    const UNKNOWN: Self =
        Self { enters: [f64::NEG_INFINITY, f64::INFINITY], leaves: [f64::NEG_INFINITY, f64::INFINITY] };

    /// The stretch of a line along which two numbers do not change, where neither is negative.
    fn of_level(one: Bounded, other: Bounded) -> Self {
        if one.is_negative() || other.is_negative() {
            Self::NOWHERE
        } else if one.is_positive() && other.is_positive() {
            Self::EVERYWHERE
        } else {
            Self::UNKNOWN
        }
    }

    /// The stretch in both.
    fn and(self, other: Self) -> Self {
        let (p, q) = (self, other);
        Self {
            enters: [p.enters[0].max(q.enters[0]), p.enters[1].max(q.enters[1])],
            leaves: [p.leaves[0].min(q.leaves[0]), p.leaves[1].min(q.leaves[1])],
        }
    }
}

/// Bounds on the first entry into one of several pieces; infinite if unknown or if there is none.
#[derive(Clone, Copy)]
struct First {
    earliest: f64,
    latest: f64,
}

impl First {
    const NONE: Self = Self { earliest: f64::INFINITY, latest: f64::INFINITY };

    fn take(&mut self, Stretch { enters, leaves }: Stretch) {
        if enters[0] <= leaves[1] {
            self.earliest = self.earliest.min(enters[0]);
        }
        if enters[1] <= leaves[0] {
            self.latest = self.latest.min(enters[1]);
        }
    }
}

/// The part where `aλ² + 2bλ + c ≤ 0`: between its roots, or, if `a` is negative, outside of them.
enum Quadric {
    Within(Stretch),
    Outside { low: [f64; 2], high: [f64; 2] },
}

impl Quadric {
    /// The stretch between the roots; unknown if it may be outside of them.
    fn within(self) -> Stretch {
        if let Self::Within(stretch) = self { stretch } else { Stretch::UNKNOWN }
    }
}

/// The larger root in magnitude is a sum without cancellation, and the other one is their product, `c/a`, over it.
fn quadric(a: Bounded, b: Bounded, c: Bounded) -> Quadric {
    if !(a.is_positive() || a.is_negative()) {
        return Quadric::Within(Stretch::UNKNOWN);
    }
    let discriminant = b.squared() - a * c;
    if !discriminant.is_positive() {
        let is_outside = discriminant.is_negative() && a.is_positive();
        return Quadric::Within(if is_outside { Stretch::NOWHERE } else { Stretch::UNKNOWN });
    }
    let root = discriminant.sqrt();
    let q = if b.is_positive() { -(b + root) } else { root - b };
    let [one, other] = [(q / a).bounds(), (c / q).bounds()];
    // With `a > 0` the first is the greater one exactly if `q` is positive.
    let (low, high) = if a.is_positive() != b.is_positive() { (other, one) } else { (one, other) };
    if a.is_positive() {
        Quadric::Within(Stretch { enters: low, leaves: high })
    } else {
        Quadric::Outside { low, high }
    }
}
