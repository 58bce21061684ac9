//! Many lines at one shape, side by side.
//!
//! A shape's closed form for one line is run over an array of them. There is no second formula: all of it is inlined
//! into a loop that stores no more than numbers, so that the compiler runs both sides of each branch for several lines
//! at a time, and chooses. Each answer is that of the line alone, to the last bit, or the line is in doubt and asked
//! alone.

use super::certain::BeyondEnd;
use super::{CertainCrossing, LineQuery, NearLine, Spine};
use crate::numerics::widest::{Loop, widest};
use crate::{Scalar, Vector};

/// How many lines are asked at a time: a multiple of every vector register.
pub const LINES: usize = 32;

/// A number of each line.
type Lane<S> = [S; LINES];

/// Lines, and what a shape [certainly knows](crate::SupportMap::certain_crossings) of them, coordinate by coordinate.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct Lines<S> {
    /// A point of each line.
    pub source: [Lane<S>; 3],
    /// The direction of each line.
    pub direction: [Lane<S>; 3],
    /// The answer is to hold for every line that passes within this distance of the line near the shape.
    pub error: Lane<S>,
    /// 1 where the line enters the shape, −1 where it misses it, 0 where it is to be asked alone.
    pub known: Lane<S>,
    /// Where the line enters.
    pub entry: Lane<S>,
    /// Bounds on that.
    pub bounds: [Lane<S>; 2],
    /// The normal there.
    pub normal: [Lane<S>; 3],
    /// What [`NearLine`] has of each, and 1 or 0 whether there is one.
    is_near: Lane<S>,
    base: Lane<S>,
    near: [Lane<S>; 3],
    near_error: Lane<S>,
    /// What [`BeyondEnd`] has of each.
    beyond: [Lane<S>; 3],
}

impl<S: Scalar> Default for Lines<S> {
    fn default() -> Self {
        let zero = [S::ZERO; LINES];
        Self {
            source: [zero; 3],
            direction: [zero; 3],
            error: zero,
            known: zero,
            entry: zero,
            bounds: [zero; 2],
            normal: [zero; 3],
            is_near: zero,
            base: zero,
            near: [zero; 3],
            near_error: zero,
            beyond: [zero; 3],
        }
    }
}

/// A vector of one line.
#[inline(always)]
fn vector<V: Vector>(lanes: &[Lane<V::Scalar>; 3], line: usize) -> V {
    V::from_fn(|i| lanes[i][line])
}

#[inline(always)]
fn set<V: Vector>(lanes: &mut [Lane<V::Scalar>; 3], line: usize, v: V) {
    for i in 0..V::DIM {
        lanes[i][line] = v.get(i);
    }
}

/// A loop over the lines that is inlined always, unlike a closure.
trait EachLine<V: Vector>: Copy {
    /// What is true of all lines; where it is not, nothing is done. So the compiler knows it in the loop.
    #[inline(always)]
    fn holds(&self) -> bool {
        true
    }

    fn call(&self, lines: &mut Lines<V::Scalar>, line: usize);
}

#[inline(never)]
fn each<V: Vector>(lines: &mut Lines<V::Scalar>, body: impl EachLine<V>) {
    struct Each<'a, V: Vector, B>(&'a mut Lines<V::Scalar>, B);
    impl<V: Vector, B: EachLine<V>> Loop for Each<'_, V, B> {
        #[inline(always)]
        fn run(self) {
            let Self(lines, body) = self;
            if body.holds() {
                for line in 0..LINES {
                    body.call(lines, line);
                }
            }
        }
    }
    widest(Each(lines, body));
}

/// Sees the lines from a point near the shape, as [`NearLine::new`] does.
#[inline]
fn approach<V: Vector>(lines: &mut Lines<V::Scalar>, origin: V, size: V::Scalar) {
    #[derive(Clone, Copy)]
    struct Approach<V: Vector, const FAR: bool>(V, V::Scalar);
    impl<V: Vector, const FAR: bool> EachLine<V> for Approach<V, FAR> {
        #[inline(always)]
        fn call(&self, lines: &mut Lines<V::Scalar>, line: usize) {
            let (source, direction) = (vector::<V>(&lines.source, line), vector(&lines.direction, line));
            let asked = LineQuery::new(source, direction).within(lines.error[line]);
            let near = NearLine::new_without_branch::<FAR>(asked, self.0, self.1);
            let (near, known) = near;
            lines.base[line] = near.base;
            set(&mut lines.near, line, near.source);
            lines.near_error[line] = near.error;
            lines.is_near[line] = known;
        }
    }
    each(lines, Approach::<V, false>(origin, size));
    if any(&lines.is_near, |near| near == V::Scalar::ZERO) {
        each(lines, Approach::<V, true>(origin, size));
    }
}

/// Whether any is so; without a branch for each.
fn any<S: Scalar>(lane: &Lane<S>, is_so: impl Fn(S) -> bool) -> bool {
    lane.iter().fold(false, |any, &value| any | is_so(value))
}

/// What a closed form tells of a line near the shape.
trait Closed<V: Vector>: Copy {
    /// What holds of all lines.
    #[inline(always)]
    fn holds(&self) -> bool {
        true
    }

    /// The size of the shape.
    fn size(&self) -> V::Scalar;
    fn certain(&self, line: &NearLine<V>) -> Option<CertainCrossing<V>>;
}

#[derive(Clone, Copy)]
struct Ask<C>(C);

impl<V: Vector, C: Closed<V>> EachLine<V> for Ask<C> {
    #[inline(always)]
    fn holds(&self) -> bool {
        self.0.holds()
    }

    #[inline(always)]
    fn call(&self, lines: &mut Lines<V::Scalar>, line: usize) {
        let known = self.0.certain(&lines.near(line, self.0.size()));
        lines.tell(line, known.map_or(Told::NOTHING, Told::new));
    }
}

impl<S: Scalar> Lines<S> {
    #[inline(always)]
    fn near<V: Vector<Scalar = S>>(&self, line: usize, size: S) -> NearLine<V> {
        NearLine {
            base: self.base[line],
            source: vector(&self.near, line),
            direction: vector(&self.direction, line),
            size,
            error: self.near_error[line],
        }
    }

    /// What was written down of a line.
    #[inline(always)]
    fn told<V: Vector<Scalar = S>>(&self, line: usize) -> Told<V> {
        let bounds = [self.bounds[0][line], self.bounds[1][line]];
        Told { known: self.known[line], entry: self.entry[line], bounds, normal: vector(&self.normal, line) }
    }

    /// Writes down what is known of a line, if it is near.
    #[inline(always)]
    fn tell<V: Vector<Scalar = S>>(&mut self, line: usize, told: Told<V>) {
        self.known[line] = told.known * self.is_near[line];
        self.entry[line] = told.entry;
        self.bounds[0][line] = told.bounds[0];
        self.bounds[1][line] = told.bounds[1];
        set(&mut self.normal, line, told.normal);
    }
}

/// [`CertainCrossing`] or nothing, in numbers alone: of all answers at once, since stores that depend on which it is
/// are masked, and take long.
#[derive(Clone, Copy)]
struct Told<V: Vector> {
    known: V::Scalar,
    entry: V::Scalar,
    bounds: [V::Scalar; 2],
    normal: V,
}

impl<V: Vector> Told<V> {
    const NOTHING: Self =
        Self { known: V::Scalar::ZERO, entry: V::Scalar::ZERO, bounds: [V::Scalar::ZERO; 2], normal: V::ZERO };

    #[inline(always)]
    fn new(certain: CertainCrossing<V>) -> Self {
        match certain {
            CertainCrossing::Enters { entry, bounds, normal } => Self { known: V::Scalar::ONE, entry, bounds, normal },
            CertainCrossing::Misses(_) => Self { known: -V::Scalar::ONE, ..Self::NOTHING },
        }
    }
}

/// A ball about a point.
#[inline]
pub(crate) fn ball<V: Vector>(lines: &mut Lines<V::Scalar>, center: V, radius: V::Scalar) -> bool {
    #[derive(Clone, Copy)]
    struct Ball<S>(S);
    impl<V: Vector> Closed<V> for Ball<V::Scalar> {
        #[inline(always)]
        fn holds(&self) -> bool {
            self.0 > V::Scalar::ZERO
        }
        #[inline(always)]
        fn size(&self) -> V::Scalar {
            self.0
        }
        #[inline(always)]
        fn certain(&self, line: &NearLine<V>) -> Option<CertainCrossing<V>> {
            line.ball(self.0)
        }
    }
    if radius == V::Scalar::ZERO {
        return false;
    }
    approach(lines, center, radius);
    each::<V>(lines, Ask(Ball(radius)));
    true
}

/// A box about zero.
#[inline]
pub(crate) fn cuboid<V: Vector>(lines: &mut Lines<V::Scalar>, half_extents: V, size: V::Scalar) -> bool {
    #[derive(Clone, Copy)]
    struct Cuboid<V: Vector>(V, V::Scalar);
    impl<V: Vector> Closed<V> for Cuboid<V> {
        #[inline(always)]
        fn size(&self) -> V::Scalar {
            self.1
        }
        #[inline(always)]
        fn certain(&self, line: &NearLine<V>) -> Option<CertainCrossing<V>> {
            line.cuboid(self.0)
        }
    }
    approach(lines, V::ZERO, size);
    each::<V>(lines, Ask(Cuboid(half_extents, size)));
    true
}

/// A segment about zero along the second axis, swept by a ball: its side, and then the ends of those that need them.
#[inline]
pub(crate) fn capsule<V: Vector>(lines: &mut Lines<V::Scalar>, half_height: V::Scalar, radius: V::Scalar) -> bool {
    #[derive(Clone, Copy)]
    struct Side<S>(S, S);
    impl<V: Vector> EachLine<V> for Side<V::Scalar> {
        #[inline(always)]
        fn holds(&self) -> bool {
            self.1 > V::Scalar::ZERO
        }
        #[inline(always)]
        fn call(&self, lines: &mut Lines<V::Scalar>, line: usize) {
            let side = lines.near::<V>(line, self.0 + self.1).side(&Spine::upright(self.0), self.1);
            let (told, BeyondEnd { end, along, base }) = match side {
                Ok(known) => (Told::new(known), BeyondEnd::NEITHER),
                Err(beyond) => (Told::NOTHING, beyond.unwrap_or(BeyondEnd::NEITHER)),
            };
            lines.beyond[0][line] = end;
            lines.beyond[1][line] = along;
            lines.beyond[2][line] = base;
            lines.tell(line, told);
        }
    }
    #[derive(Clone, Copy)]
    struct End<S>(S, S);
    impl<V: Vector> EachLine<V> for End<V::Scalar> {
        #[inline(always)]
        fn holds(&self) -> bool {
            self.1 > V::Scalar::ZERO
        }
        #[inline(always)]
        fn call(&self, lines: &mut Lines<V::Scalar>, line: usize) {
            let [end, along, base] = [0, 1, 2].map(|i| lines.beyond[i][line]);
            let near = lines.near::<V>(line, self.0 + self.1);
            let known = near.end(&Spine::upright(self.0), self.1, BeyondEnd { end, along, base });
            let (told, before) = (known.map_or(Told::NOTHING, Told::new), lines.told(line));
            lines.tell(line, if end == V::Scalar::ZERO { before } else { told });
        }
    }
    if radius == V::Scalar::ZERO {
        return false;
    }
    approach(lines, V::ZERO, half_height + radius);
    each::<V>(lines, Side(half_height, radius));
    if any(&lines.beyond[0], |end| end != V::Scalar::ZERO) {
        each::<V>(lines, End(half_height, radius));
    }
    true
}
