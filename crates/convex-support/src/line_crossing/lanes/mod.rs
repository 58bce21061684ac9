//! Many lines at one shape, side by side.
//!
//! A shape's closed form for one line is run over an array of them. There is no second formula: all of it is inlined
//! into a loop that stores only numbers, so that compilers compute both sides of each branch for several lines at a
//! time, and select. Each answer is that of the line alone, to the last bit; or the line is in doubt, and has to be
//! asked alone.

#![allow(clippy::needless_range_loop, reason = "arrays are read side by side, as vector instructions do")]

#[cfg(feature = "hull")]
pub(crate) mod hull;

use super::certain::{BeyondEnd, sum_of_coordinates};
use super::{CertainCrossing, LineQuery, NearLine, Spine, Turned};
use crate::numerics::widest::{Loop, widest};
use crate::{Matrix, Scalar, Vector, compiled_once};

/// The number of lines in an array: a multiple of the width of a vector register on every target.
pub const LINES: usize = 32;

/// A number of each line.
type Lane<S> = [S; LINES];

/// Lines, coordinate by coordinate, and the [certain answers](crate::CrossedByLine::certain_crossings) of a shape. The
/// shape may overwrite the lines.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct Lines<S> {
    /// A point of each line.
    pub source: [Lane<S>; 3],
    /// The direction of each line.
    pub direction: [Lane<S>; 3],
    /// The answer must hold for every line that passes within this distance of the line near the shape.
    pub error: Lane<S>,
    /// The answer: 1 if the line enters the shape, −1 if it misses it, 0 if it has to be asked alone.
    pub known: Lane<S>,
    /// The parameter where the line enters.
    pub entry: Lane<S>,
    /// Bounds on the entry.
    pub bounds: [Lane<S>; 2],
    /// The normal at the entry.
    pub normal: [Lane<S>; 3],
    /// The fields of each [`NearLine`], and 1 or 0 whether there is one.
    is_near: Lane<S>,
    base: Lane<S>,
    near: [Lane<S>; 3],
    near_error: Lane<S>,
    /// The fields of each [`BeyondEnd`].
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

impl<S: Scalar> Lines<S> {
    /// Whether any line has to be asked alone.
    #[must_use]
    pub fn any_in_doubt(&self) -> bool {
        any(&self.known, |known| known == S::ZERO)
    }

    #[inline(always)]
    fn near<V: Vector<Scalar = S>>(&self, line: usize, size: S) -> NearLine<V> {
        NearLine {
            base: self.base[line],
            source: vector(&self.near, line),
            direction: vector(&self.direction, line),
            size,
            error: self.near_error[line],
            is_direct: false,
        }
    }

    /// The stored answer of a line.
    #[inline(always)]
    fn told<V: Vector<Scalar = S>>(&self, line: usize) -> Told<V> {
        let bounds = [self.bounds[0][line], self.bounds[1][line]];
        Told { known: self.known[line], entry: self.entry[line], bounds, normal: vector(&self.normal, line) }
    }

    /// Stores the answer of a line, if it is near.
    #[inline(always)]
    fn tell<V: Vector<Scalar = S>>(&mut self, line: usize, told: Told<V>) {
        self.known[line] = told.known * self.is_near[line];
        self.entry[line] = told.entry;
        self.bounds[0][line] = told.bounds[0];
        self.bounds[1][line] = told.bounds[1];
        set(&mut self.normal, line, told.normal);
    }
}

/// [`CertainCrossing`] or nothing, in numbers: all are always stored, because stores of only some lanes are slow.
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

/// A step for each line, always inlined, unlike a closure.
trait EachLine<V: Vector>: Copy {
    /// A condition of all lines; unless it holds, nothing is done. So the compiler may assume it in the loop.
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

/// Whether any element satisfies it, without a branch for each.
fn any<S: Scalar>(lane: &Lane<S>, is_so: impl Fn(S) -> bool) -> bool {
    lane.iter().fold(false, |any, &value| any | is_so(value))
}

/// The lines, with a further `error`, relative to a shape of a `size` about an `origin`, as by [`NearLine::new`].
fn approach<V: Vector>(lines: &mut Lines<V::Scalar>, origin: V, size: V::Scalar, error: V::Scalar) {
    #[derive(Clone, Copy)]
    struct Approach<V: Vector, const FAR: bool>(V, V::Scalar, V::Scalar);
    impl<V: Vector, const FAR: bool> EachLine<V> for Approach<V, FAR> {
        #[inline(always)]
        fn call(&self, lines: &mut Lines<V::Scalar>, line: usize) {
            let (source, direction) = (vector::<V>(&lines.source, line), vector(&lines.direction, line));
            let asked = LineQuery { error: lines.error[line], ..LineQuery::new(source, direction) }.within(self.2);
            let (near, is_near) = NearLine::seen::<FAR>(asked, self.0, self.1, sum_of_coordinates(direction));
            lines.base[line] = near.base;
            set(&mut lines.near, line, near.source);
            lines.near_error[line] = near.error;
            lines.is_near[line] = if is_near { V::Scalar::ONE } else { V::Scalar::ZERO };
        }
    }
    each(lines, Approach::<V, false>(origin, size, error));
    if any(&lines.is_near, |near| near == V::Scalar::ZERO) {
        each(lines, Approach::<V, true>(origin, size, error));
    }
}

/// The vector with plain numbers.
#[inline(always)]
fn numbers<V: Vector>(v: V) -> V::Numbers {
    Vector::from_fn(|i| v.get(i))
}

compiled_once! {
    /// A ball about a point, known to within an `error`.
    pub(crate) fn ball<V>(
        lines: &mut Lines<<V as Vector>::Scalar>,
        center: V,
        radius: <V as Vector>::Scalar,
        error: <V as Vector>::Scalar,
    ) -> () {
        #[derive(Clone, Copy)]
        struct NearBall<S>(S);
        impl<V: Vector> EachLine<V> for NearBall<V::Scalar> {
            #[inline(always)]
            fn holds(&self) -> bool {
                self.0 > V::Scalar::ZERO
            }

            #[inline(always)]
            fn call(&self, lines: &mut Lines<V::Scalar>, line: usize) {
                let known = lines.near::<V>(line, self.0).ball(self.0);
                lines.tell(line, known.map_or(Told::NOTHING, Told::new));
            }
        }
        lines.known = [V::Scalar::ZERO; LINES];
        approach(lines, numbers(center), radius, error);
        each::<V::Numbers>(lines, NearBall(radius));
    }
}

compiled_once! {
    /// A box about zero.
    pub(crate) fn cuboid<V>(
        lines: &mut Lines<<V as Vector>::Scalar>,
        half_extents: V,
        size: <V as Vector>::Scalar,
    ) -> () {
        #[derive(Clone, Copy)]
        struct NearCuboid<V: Vector>(V, V::Scalar);
        impl<V: Vector> EachLine<V> for NearCuboid<V> {
            #[inline(always)]
            fn call(&self, lines: &mut Lines<V::Scalar>, line: usize) {
                let known = lines.near::<V>(line, self.1).cuboid(self.0);
                lines.tell(line, known.map_or(Told::NOTHING, Told::new));
            }
        }
        approach(lines, V::Numbers::ZERO, size, Scalar::ZERO);
        each(lines, NearCuboid(numbers(half_extents), size));
    }
}

compiled_once! {
    /// A segment about zero along the second axis, swept by a ball: its side, and then the ends for the lines that meet
    /// them.
    pub(crate) fn capsule<V>(
        lines: &mut Lines<<V as Vector>::Scalar>,
        half_height: <V as Vector>::Scalar,
        radius: <V as Vector>::Scalar,
    ) -> () {
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
        (lines.known, lines.beyond[0]) = ([V::Scalar::ZERO; LINES], [V::Scalar::ZERO; LINES]);
        approach(lines, V::Numbers::ZERO, half_height + radius, Scalar::ZERO);
        each::<V::Numbers>(lines, Side(half_height, radius));
        if any(&lines.beyond[0], |end| end != V::Scalar::ZERO) {
            each::<V::Numbers>(lines, End(half_height, radius));
        }
    }
}

/// The base parameters of lines in the frame of a shape, and whether there are such lines, 1 or 0.
type Counted<S> = [Lane<S>; 2];

compiled_once! {
    /// The lines in the frame of a turned shape.
    pub(crate) fn before_turn<V>(
        lines: &mut Lines<<V as Vector>::Scalar>,
        turned: Turned<V>,
    ) -> Counted<<V as Vector>::Scalar> {
        #[derive(Clone, Copy)]
        struct Before<V: Vector>(Turned<V>);
        impl<V: Vector> EachLine<V> for Before<V> {
            #[inline(always)]
            fn call(&self, lines: &mut Lines<V::Scalar>, line: usize) {
                let near = lines.near::<V>(line, self.0.size).at_foot();
                let before = self.0.before(&near, LineQuery::new(V::ZERO, V::ZERO));
                lines.base[line] = near.base;
                lines.error[line] = before.error;
                set(&mut lines.source, line, before.source);
                set(&mut lines.direction, line, before.direction);
            }
        }
        let Turned { rotation, center, size, error, from } = turned;
        let turned = Turned {
            rotation: <V::Numbers as Vector>::Matrix::from_cols_fn(|j| numbers(rotation.col(j))),
            center: numbers(center),
            size,
            error,
            from: from.map(|(lost, origin, error)| (numbers(lost), numbers(origin), error)),
        };
        approach::<V::Numbers>(lines, turned.center, size, error);
        each(lines, Before(turned));
        [lines.base, lines.is_near]
    }
}

compiled_once! {
    /// The answers of a shape in its own frame, for the given lines.
    pub(crate) fn after_turn<V>(
        lines: &mut Lines<<V as Vector>::Scalar>,
        rotation: <V as Vector>::Matrix,
        counted: &Counted<<V as Vector>::Scalar>,
    ) -> () {
        #[derive(Clone, Copy)]
        struct After<M>(M);
        impl<V: Vector> EachLine<V> for After<V::Matrix> {
            #[inline(always)]
            fn call(&self, lines: &mut Lines<V::Scalar>, line: usize) {
                let Told { known, entry, bounds, normal } = lines.told::<V>(line);
                let near = lines.near::<V>(line, Scalar::ZERO);
                let after = Told::new(near.enters([bounds[0], entry, bounds[1]], self.0 * normal));
                lines.tell(line, Told { known, ..after });
            }
        }
        [lines.base, lines.is_near] = *counted;
        let rotation = <V::Numbers as Vector>::Matrix::from_cols_fn(|j| numbers(rotation.col(j)));
        each::<V::Numbers>(lines, After(rotation));
    }
}
