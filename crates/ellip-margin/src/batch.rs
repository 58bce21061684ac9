//! Many margins side by side: the same arithmetic as one margin, in lanes of vector registers.
//!
//! Pairs are taken eight at a time and turned into a structure of arrays. The loop over the lanes then has one body
//! without branches, [`solve_straight`], which the compiler turns into vector instructions: those of the target, or
//! with the feature `simd` the widest of the processor, found at run time. Pairs near contact, near the boundary of
//! E₂, of high aspect, or slow to converge are solved again one by one.

use alloc::vec::Vec;
use core::ops::Range;

use convex_support::numerics::widest::{Loop, widest};
use convex_support::{Ellipsoid, Scalar, Vector};

use crate::margin::free_margin;
use crate::numerics::{self, add};
use crate::pair::Pair;
use crate::polynomial::{STRAIGHT_STEPS, solve_straight};
use crate::{Answer, EllipsoidPair, InvalidQuery, Margin, MarginOptions, Method, Status};

const LANES: usize = 8;

/// The free margins of many pairs, of `e1[k]` about `e2[k]` for each k: the answers of
/// [`free_margin`](crate::free_margin), in a fraction of the time.
///
/// The margins are the same to 1e-14 of 1 + m and the rounding of m, ν to 1e-12 of itself, the signs exactly; all are
/// the same on every processor. `iterations` is 5, that of the batch, for a pair that was not solved again by itself.
///
/// If one list has a single ellipsoid, it is paired with every ellipsoid of the other list.
///
/// ```
/// use ellip_margin::convex_support::{Ellipsoid, glam::DVec2};
/// use ellip_margin::{MarginOptions, free_margin, free_margins};
///
/// let link = Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 0.5), 0.0)?;
/// let obstacles =
///     [1.0, 2.0, 3.0].map(|y| Ellipsoid::new(DVec2::new(1.0, y), DVec2::new(0.3, 0.2), 0.7));
/// let obstacles = obstacles.into_iter().collect::<Result<Vec<_>, _>>()?;
/// let margins = free_margins(&[link], &obstacles, MarginOptions::default())?;
/// let third = free_margin(&link, &obstacles[2], MarginOptions::default());
/// assert!((margins[2].margin - third.margin).abs() < 1e-14 * (1.0 + third.margin));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`InvalidQuery::LengthsDiffer`] if the lists are of different lengths, neither of them 1.
pub fn free_margins<V: Vector>(
    e1: &[Ellipsoid<V>],
    e2: &[Ellipsoid<V>],
    options: MarginOptions,
) -> Result<Vec<Margin<V>>, InvalidQuery> {
    let mut margins = Vec::new();
    free_margins_into(e1, e2, options, &mut margins)?;
    Ok(margins)
}

/// [`free_margins`], appended to a list that may be reused.
///
/// # Errors
/// [`InvalidQuery::LengthsDiffer`] if the lists are of different lengths, neither of them 1; nothing is appended then.
pub fn free_margins_into<V: Vector>(
    e1: &[Ellipsoid<V>],
    e2: &[Ellipsoid<V>],
    options: MarginOptions,
    margins: &mut Vec<Margin<V>>,
) -> Result<(), InvalidQuery> {
    let (count, of) = (count(e1, e2)?, pairs(e1, e2));
    margins.reserve(count);
    in_parts(count, margins, |part, margins| each(part, of, options, |_, margin| margins.push(margin)));
    Ok(())
}

/// Calls `ask` with the margin of each pair and returns the results, such as gradients and Hessians. The margins are
/// solved side by side as by [`free_margins`].
///
/// ```
/// use ellip_margin::convex_support::{Ellipsoid, glam::DVec2};
/// use ellip_margin::{MarginOptions, map_margins};
///
/// let link = Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 0.5), 0.0)?;
/// let obstacles =
///     [1.0, 2.0, 3.0].map(|y| Ellipsoid::new(DVec2::new(1.0, y), DVec2::new(0.3, 0.2), 0.7));
/// let obstacles = obstacles.into_iter().collect::<Result<Vec<_>, _>>()?;
/// let gradients = map_margins(&[link], &obstacles, MarginOptions::default(), |m| m.gradient())?;
/// assert!(gradients.iter().all(|gradient| gradient.translation.y < 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`InvalidQuery::LengthsDiffer`] if the lists are of different lengths, neither of them 1.
pub fn map_margins<'a, V: Vector, T: Send>(
    e1: &'a [Ellipsoid<V>],
    e2: &'a [Ellipsoid<V>],
    options: MarginOptions,
    ask: impl Fn(Answer<'a, V, Margin<V>>) -> T + Sync,
) -> Result<Vec<T>, InvalidQuery> {
    let (count, of) = (count(e1, e2)?, pairs(e1, e2));
    let mut answers = Vec::with_capacity(count);
    in_parts(count, &mut answers, |part, answers| {
        each(part, of, options, |k, margin| {
            let (e1, e2) = of(k);
            answers.push(ask(EllipsoidPair::new(e1, e2, options).answer(margin)));
        });
    });
    Ok(answers)
}

/// [`map_margins`] into a slice: `answers[k]` becomes the result of `ask` for pair k. Nothing is allocated.
///
/// Use it for columns of a data frame, if a single number of each answer goes into an existing buffer.
///
/// ```
/// use ellip_margin::convex_support::{Ellipsoid, glam::DVec2};
/// use ellip_margin::{MarginOptions, map_margins_into};
///
/// let link = Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 0.5), 0.0)?;
/// let obstacles =
///     [1.0, 2.0, 3.0].map(|y| Ellipsoid::new(DVec2::new(1.0, y), DVec2::new(0.3, 0.2), 0.7));
/// let obstacles = obstacles.into_iter().collect::<Result<Vec<_>, _>>()?;
/// let mut margins = [0.0; 3];
/// map_margins_into(&[link], &obstacles, MarginOptions::default(), &mut margins, |m| m.margin)?;
/// assert!(margins[0] < margins[1] && margins[1] < margins[2]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`InvalidQuery::LengthsDiffer`] if the lists are of different lengths, neither of them 1, and
/// [`InvalidQuery::AnswersLength`] if there are not as many answers as pairs; no answer is written then.
pub fn map_margins_into<'a, V: Vector, T: Send>(
    e1: &'a [Ellipsoid<V>],
    e2: &'a [Ellipsoid<V>],
    options: MarginOptions,
    answers: &mut [T],
    ask: impl Fn(Answer<'a, V, Margin<V>>) -> T + Sync,
) -> Result<(), InvalidQuery> {
    let (pairs, of) = (count(e1, e2)?, pairs(e1, e2));
    if answers.len() != pairs {
        return Err(InvalidQuery::AnswersLength { pairs, answers: answers.len() });
    }
    by_parts(answers, |first, answers| {
        each(first..first + answers.len(), of, options, |k, margin| {
            let (e1, e2) = of(k);
            answers[k - first] = ask(EllipsoidPair::new(e1, e2, options).answer(margin));
        });
    });
    Ok(())
}

/// Calls `ask` with each pair and returns the results, such as distances, common scales, and their derivatives. With
/// the feature `rayon` it uses all cores.
///
/// ```
/// use ellip_margin::convex_support::{Ellipsoid, glam::DVec2};
/// use ellip_margin::{MarginOptions, map_pairs};
///
/// let link = Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 0.5), 0.0)?;
/// let obstacles =
///     [0.1, 2.0, 3.0].map(|y| Ellipsoid::new(DVec2::new(1.0, y), DVec2::new(0.3, 0.2), 0.7));
/// let obstacles = obstacles.into_iter().collect::<Result<Vec<_>, _>>()?;
/// let ways = map_pairs(&[link], &obstacles, MarginOptions::default(), |pair| {
///     pair.scaling().gradient()
/// })?;
/// assert!(ways[0].translation.y < 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`InvalidQuery::LengthsDiffer`] if the lists are of different lengths, neither of them 1.
pub fn map_pairs<'a, V: Vector, T: Send>(
    e1: &'a [Ellipsoid<V>],
    e2: &'a [Ellipsoid<V>],
    options: MarginOptions,
    ask: impl Fn(EllipsoidPair<'a, V>) -> T + Sync,
) -> Result<Vec<T>, InvalidQuery> {
    let (count, of) = (count(e1, e2)?, pairs(e1, e2));
    let mut answers = Vec::with_capacity(count);
    in_parts(count, &mut answers, |part, answers| {
        answers.extend(part.map(|k| {
            let (e1, e2) = of(k);
            ask(EllipsoidPair::new(e1, e2, options))
        }));
    });
    Ok(answers)
}

/// How many pairs two lists make.
fn count<V: Vector>(e1: &[Ellipsoid<V>], e2: &[Ellipsoid<V>]) -> Result<usize, InvalidQuery> {
    match (e1.len(), e2.len()) {
        (first, second) if first == second => Ok(first),
        (1, second) => Ok(second),
        (first, 1) => Ok(first),
        (first, second) => Err(InvalidQuery::LengthsDiffer { first, second }),
    }
}

/// Pair number `k` of two lists: a single ellipsoid stands for as many of it as the other list has.
fn pairs<'a, V: Vector>(
    e1: &'a [Ellipsoid<V>],
    e2: &'a [Ellipsoid<V>],
) -> impl Fn(usize) -> (&'a Ellipsoid<V>, &'a Ellipsoid<V>) + Copy + Sync {
    move |k| (&e1[if e1.len() == 1 { 0 } else { k }], &e2[if e2.len() == 1 { 0 } else { k }])
}

/// How many pairs a core takes at a time: whole lanes, so that each pair is solved as it is in one go.
#[cfg(feature = "rayon")]
const PART: usize = 128 * LANES;

/// Fills the list by parts, on all cores.
#[cfg(feature = "rayon")]
fn in_parts<M: Send>(count: usize, list: &mut Vec<M>, fill: impl Fn(Range<usize>, &mut Vec<M>) + Sync) {
    use rayon::prelude::*;
    if count <= PART {
        return fill(0..count, list);
    }
    let part = |k: usize| {
        let mut part = Vec::with_capacity(PART);
        fill(k * PART..count.min((k + 1) * PART), &mut part);
        part
    };
    let parts: Vec<Vec<M>> = (0..count.div_ceil(PART)).into_par_iter().map(part).collect();
    list.extend(parts.into_iter().flatten());
}

/// Fills the list.
#[cfg(not(feature = "rayon"))]
fn in_parts<M>(count: usize, list: &mut Vec<M>, fill: impl Fn(Range<usize>, &mut Vec<M>)) {
    fill(0..count, list);
}

/// Fills the column by parts, on all cores; each part is told where it begins.
#[cfg(feature = "rayon")]
fn by_parts<T: Send>(column: &mut [T], fill: impl Fn(usize, &mut [T]) + Sync) {
    use rayon::prelude::*;
    column.par_chunks_mut(PART).enumerate().for_each(|(k, part)| fill(k * PART, part));
}

/// Fills the column.
#[cfg(not(feature = "rayon"))]
fn by_parts<T>(column: &mut [T], fill: impl Fn(usize, &mut [T])) {
    fill(0, column);
}

/// Tells the margins of the pairs of a range, one by one in their order.
fn each<'a, V: Vector>(
    range: Range<usize>,
    of: impl Fn(usize) -> (&'a Ellipsoid<V>, &'a Ellipsoid<V>),
    options: MarginOptions,
    mut tell: impl FnMut(usize, Margin<V>),
) {
    let Range { start, end } = range;
    let mut next = start;
    if has_lanes(options) {
        next = in_dimension!(by_eights::<V>(start..end, &of, options, &mut tell));
    }
    for k in next..end {
        let (e1, e2) = of(k);
        tell(k, free_margin(e1, e2, options));
    }
}

/// Whether the options leave the method and its steps to what the lanes do.
fn has_lanes(options: MarginOptions) -> bool {
    options.method == Method::Automatic && options.max_iterations >= STRAIGHT_STEPS
}

/// The margins of as many of a range as make whole lanes; where it ended.
fn by_eights<'a, V: Vector, const N: usize>(
    Range { start, end }: Range<usize>,
    of: impl Fn(usize) -> (&'a Ellipsoid<V>, &'a Ellipsoid<V>),
    options: MarginOptions,
    mut tell: impl FnMut(usize, Margin<V>),
) -> usize {
    let (mut pairs, mut answers) = (Pairs::<N>::ZERO, Answers::<N>::ZERO);
    let mut next = start;
    while next + LANES <= end {
        for lane in 0..LANES {
            let (e1, e2) = of(next + lane);
            pairs.set(lane, &Pair::new(e1, e2));
        }
        solve_lanes(&pairs, options.tolerance(), &mut answers);
        for lane in 0..LANES {
            let margin = if answers.is_answer[lane] == 0.0 {
                let (e1, e2) = of(next + lane);
                free_margin(e1, e2, options)
            } else {
                answers.get(lane)
            };
            tell(next + lane, margin);
        }
        next += LANES;
    }
    next
}

/// A number of each lane.
type Lane = [f64; LANES];

const NONE: Lane = [0.0; LANES];

/// [`Pair`] of eight pairs.
struct Pairs<const N: usize> {
    x1: [Lane; N],
    x2: [Lane; N],
    axes1: [[Lane; N]; N],
    axes2: [[Lane; N]; N],
    a1: [Lane; N],
    a2: [Lane; N],
}

impl<const N: usize> Pairs<N> {
    const ZERO: Self = Self {
        x1: [NONE; N],
        x2: [NONE; N],
        axes1: [[NONE; N]; N],
        axes2: [[NONE; N]; N],
        a1: [NONE; N],
        a2: [NONE; N],
    };

    #[inline(always)]
    fn set(&mut self, lane: usize, pair: &Pair<N>) {
        for i in 0..N {
            self.x1[i][lane] = pair.x1[i];
            self.x2[i][lane] = pair.x2[i];
            self.a1[i][lane] = pair.a1[i];
            self.a2[i][lane] = pair.a2[i];
            for j in 0..N {
                self.axes1[i][j][lane] = pair.axes1[i][j];
                self.axes2[i][j][lane] = pair.axes2[i][j];
            }
        }
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> Pair<N> {
        let vector = |v: &[Lane; N]| -> numerics::Vec<N> { core::array::from_fn(|i| v[i][lane]) };
        Pair {
            x1: vector(&self.x1),
            x2: vector(&self.x2),
            axes1: core::array::from_fn(|i| vector(&self.axes1[i])),
            axes2: core::array::from_fn(|i| vector(&self.axes2[i])),
            a1: vector(&self.a1),
            a2: vector(&self.a2),
        }
    }
}

/// [`Straight`](crate::polynomial::Straight) of eight pairs.
struct Answers<const N: usize> {
    is_answer: Lane,
    nu: Lane,
    y: [Lane; N],
    point: [Lane; N],
    margin: Lane,
}

impl<const N: usize> Answers<N> {
    const ZERO: Self = Self { is_answer: NONE, nu: NONE, y: [NONE; N], point: [NONE; N], margin: NONE };

    /// The margin of a lane, which holds where `is_answer`.
    #[inline(always)]
    fn get<V: Vector>(&self, lane: usize) -> Margin<V> {
        let vector = |v: &[Lane; N]| V::from_fn(|i| V::Scalar::from_f64(v[i][lane]));
        Margin {
            margin: V::Scalar::from_f64(self.margin[lane]),
            nu: V::Scalar::from_f64(self.nu[lane]),
            point: vector(&self.point),
            status: Status::Converged,
            iterations: STRAIGHT_STEPS,
            ball_point: vector(&self.y),
        }
    }
}

/// [`loop_over_lanes`] in the widest vector instructions this processor has, or without the feature `simd` in those of
/// the target.
#[inline(never)]
fn solve_lanes<const N: usize>(pairs: &Pairs<N>, tolerance: f64, answers: &mut Answers<N>) {
    struct Lanes<'a, const N: usize>(&'a Pairs<N>, f64, &'a mut Answers<N>);
    impl<const N: usize> Loop for Lanes<'_, N> {
        #[inline(always)]
        fn run(self) {
            loop_over_lanes(self.0, self.1, self.2);
        }
    }
    widest(Lanes(pairs, tolerance, answers));
}

/// The loop that becomes vector instructions: in a function of its own, so that nothing aliases and nothing else is in
/// it.
#[inline(always)]
fn loop_over_lanes<const N: usize>(pairs: &Pairs<N>, tolerance: f64, answers: &mut Answers<N>) {
    for lane in 0..LANES {
        let pair = pairs.get(lane);
        let straight = solve_straight(&pair, tolerance);
        let point = add(pair.x2, pair.out_of_ball(straight.y));
        answers.is_answer[lane] = straight.is_answer;
        answers.nu[lane] = straight.nu;
        answers.margin[lane] = straight.margin;
        for i in 0..N {
            answers.y[i][lane] = straight.y[i];
            answers.point[i][lane] = point[i];
        }
    }
}
