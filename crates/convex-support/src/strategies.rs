//! Strategies for [proptest](https://docs.rs/proptest) that generate shapes, poses and directions which are adversarial
//! on purpose: lengths a few ulps apart or six orders of magnitude apart, zero extents, duplicate, collinear and
//! coplanar points, parallel faces, directions along an axis or one ulp off it.
//!
//! Every strategy for a shape takes its `size`, so that a test chooses the scale, by [`size`] or otherwise, and knows
//! it for its tolerance.

use std::boxed::Box;
use std::fmt::Debug;
use std::vec::Vec;

use num_traits::Float as _;
use proptest::prelude::*;
use proptest::sample::select;

use crate::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Difference, Ellipsoid, Hull, InvalidShape, Matrix, MinkowskiSum,
    Point, Polytope, Posed, Rotation, Rounded, Scalar, Segment, SupportMap, Triangle, Vector, Vector3,
};

/// A shape that can be printed, as proptest requires of what it generates.
pub trait Shape: SupportMap + Debug {}

impl<S: SupportMap + Debug> Shape for S {}

/// A shape of any kind.
pub type AnyShape<V> = Box<dyn Shape<Vector = V>>;

/// What a strategy's own numbers are always good enough for.
fn valid<S>(shape: Result<S, InvalidShape>) -> S {
    shape.unwrap_or_else(|error| unreachable!("a strategy generated an invalid shape: {error}"))
}

fn any_shape<S: Shape + 'static>(shape: Result<S, InvalidShape>) -> AnyShape<S::Vector> {
    Box::new(valid(shape))
}

/// The size of a scene: 1, or anything from 1e-9 to 1e9.
pub fn size<S: Scalar>() -> BoxedStrategy<S> {
    prop_oneof![Just(0.0), select(std::vec![-9.0, 9.0]), -9.0..9.0]
        .prop_map(|e: f64| S::from_f64(10f64.powf(e)))
        .boxed()
}

/// A number in `[-1, 1]`: often one of −1, 0, 1, a round fraction, one of these a few ulps off, or something tiny.
pub fn coordinate<S: Scalar>() -> BoxedStrategy<S> {
    let round = || select(std::vec![0.0, 1.0, -1.0, 0.5, -0.5, 0.25, 0.75]);
    prop_oneof![
        2 => round().prop_map(S::from_f64),
        2 => (round(), -3i32..=3).prop_map(|(x, ulps)| {
            let off = S::ONE + S::from_f64(f64::from(ulps)) * S::EPSILON;
            (S::from_f64(x) * off).max(-S::ONE).min(S::ONE)
        }),
        4 => (-1.0..1.0).prop_map(S::from_f64),
        1 => (-1.0..1.0, select(std::vec![1e-3, 1e-6, 1e-9])).prop_map(|(x, s): (f64, f64)| S::from_f64(x * s)),
    ]
    .boxed()
}

/// A length in `[0, size]`: often `size` itself, 0, or down to a millionth of it.
pub fn length<S: Scalar>(size: S) -> BoxedStrategy<S> {
    prop_oneof![6 => positive_length(size), 1 => Just(S::ZERO)].boxed()
}

/// A length in `(0, size]`, not below a millionth of it.
pub fn positive_length<S: Scalar>(size: S) -> BoxedStrategy<S> {
    prop_oneof![
        2 => Just(S::ONE),
        4 => (0.1..1.0).prop_map(S::from_f64),
        1 => (-6.0..0.0).prop_map(|e: f64| S::from_f64(10f64.powf(e))),
        1 => (1..4).prop_map(|ulps| S::ONE - S::from_f64(f64::from(ulps)) * S::EPSILON),
    ]
    .prop_map(move |x| x * size)
    .boxed()
}

/// A vector whose coordinates are made by `strategy`.
fn vector_of<V: Vector>(strategy: BoxedStrategy<V::Scalar>) -> BoxedStrategy<V> {
    proptest::array::uniform3(strategy).prop_map(|c| V::from_fn(|i| c[i])).boxed()
}

/// A vector with coordinates in `[-size, size]`.
pub fn vector<V: Vector>(size: V::Scalar) -> BoxedStrategy<V> {
    vector_of(coordinate()).prop_map(move |v: V| v * size).boxed()
}

/// A vector that is not zero, of any length from 1e-9 to 1e9: along an axis, a diagonal, one ulp off, or anywhere.
pub fn direction<V: Vector>() -> BoxedStrategy<V> {
    (vector::<V>(V::Scalar::ONE), 0..V::DIM, size::<V::Scalar>())
        .prop_map(|(v, i, s)| if v == V::ZERO { V::axis(i) * s } else { v * s })
        .boxed()
}

/// A rotation: none, a quarter turn about an axis, either of them one ulp off, or anything.
pub fn rotation<V: Vector>() -> BoxedStrategy<V::Rotation> {
    let quarter = core::f64::consts::FRAC_1_SQRT_2;
    let q = prop_oneof![
        Just([0.0, 0.0, 0.0, 1.0]),
        select(std::vec![[quarter, 0.0, 0.0, quarter], [0.0, quarter, 0.0, quarter], [0.0, 0.0, quarter, quarter]]),
        (-3i32..=3).prop_map(|ulps| [0.0, f64::from(ulps) * f64::EPSILON, f64::from(ulps) * f64::EPSILON, 1.0]),
        proptest::array::uniform4(-1.0..1.0f64),
    ];
    q.prop_map(|q| if q == [0.0; 4] { [0.0, 0.0, 0.0, 1.0] } else { q })
        .prop_map(|q| V::Rotation::from_xyzw(q.map(V::Scalar::from_f64)))
        .boxed()
}

/// A rotation and a translation by up to `reach`.
pub fn pose<V: Vector>(reach: V::Scalar) -> BoxedStrategy<(V::Rotation, V)> {
    (rotation::<V>(), vector::<V>(reach)).boxed()
}

/// A point.
pub fn point<V: Vector>(size: V::Scalar) -> BoxedStrategy<Point<V>> {
    vector(size).prop_map(|p| valid(Point::new(p))).boxed()
}

/// A segment, at times of no length.
pub fn segment<V: Vector>(size: V::Scalar) -> BoxedStrategy<Segment<V>> {
    proptest::array::uniform2(vector(size)).prop_map(|p| valid(Segment::new(p))).boxed()
}

/// A triangle, at times flat, a sliver or a point.
pub fn triangle<V: Vector>(size: V::Scalar) -> BoxedStrategy<Triangle<V>> {
    let corners = proptest::array::uniform3(vector::<V>(size));
    prop_oneof![
        3 => corners.clone(),
        // The third corner on the first edge, or a few ulps off it.
        1 => (corners, 0.0..1.0).prop_map(|([a, b, c], t)| {
            [a, b, a + (b - a) * V::Scalar::from_f64(t) + c * V::Scalar::EPSILON]
        }),
    ]
    .prop_map(|p| valid(Triangle::new(p)))
    .boxed()
}

/// A ball, at times of radius 0.
pub fn ball<V: Vector>(size: V::Scalar) -> BoxedStrategy<Ball<V>> {
    length(size).prop_map(|r| valid(Ball::new(r))).boxed()
}

/// A box, at times flat.
pub fn cuboid<V: Vector>(size: V::Scalar) -> BoxedStrategy<Cuboid<V>> {
    vector_of(length(size)).prop_map(|h| valid(Cuboid::new(h))).boxed()
}

/// A capsule, at times a ball or a segment.
pub fn capsule<V: Vector>(size: V::Scalar) -> BoxedStrategy<Capsule<V>> {
    (length(size), length(size)).prop_map(|(h, r)| valid(Capsule::new(h, r))).boxed()
}

/// A cylinder, at times a disc or a segment.
pub fn cylinder<V: Vector3>(size: V::Scalar) -> BoxedStrategy<Cylinder<V>> {
    (length(size), length(size)).prop_map(|(h, r)| valid(Cylinder::new(h, r))).boxed()
}

/// A cone, at times a disc or a segment.
pub fn cone<V: Vector3>(size: V::Scalar) -> BoxedStrategy<Cone<V>> {
    (length(size), length(size)).prop_map(|(h, r)| valid(Cone::new(h, r))).boxed()
}

/// An ellipsoid of an aspect ratio of up to 1e6, about a centre within `size`.
pub fn ellipsoid<V: Vector>(size: V::Scalar) -> BoxedStrategy<Ellipsoid<V>> {
    (pose::<V>(size), vector_of(positive_length(size)))
        .prop_map(|((rotation, center), axes)| valid(Ellipsoid::new(center, axes, rotation)))
        .boxed()
}

/// The hull of up to `count` points: with duplicates, all in a plane, all on a line, on a grid, or in general position.
pub fn polytope<V: Vector>(size: V::Scalar, count: usize) -> BoxedStrategy<Polytope<V>> {
    points(size, count).prop_map(|p| valid(Polytope::new(p))).boxed()
}

/// Points as [`polytope`] takes them.
pub fn points<V: Vector>(size: V::Scalar, count: usize) -> BoxedStrategy<Vec<V>> {
    let some = || proptest::collection::vec(vector::<V>(size), 1..=count);
    prop_oneof![
        4 => some(),
        1 => some().prop_map(|mut p| { p.extend_from_within(..); p }),
        1 => (some(), 0..V::DIM).prop_map(|(p, flat)| {
            p.iter().map(|&v| V::from_fn(|i| if i == flat { V::Scalar::ZERO } else { v.get(i) })).collect()
        }),
        1 => (some(), vector::<V>(V::Scalar::ONE)).prop_map(|(p, line)| p.iter().map(|v| line * v.get(0)).collect()),
        1 => some().prop_map(move |p| {
            let step = size * V::Scalar::from_f64(0.5);
            p.iter().map(|&v| V::from_fn(|i| (v.get(i) / step).round() * step)).collect()
        }),
    ]
    .boxed()
}

/// Any primitive shape that exists in every dimension.
pub fn primitive<V: Vector>(size: V::Scalar) -> BoxedStrategy<AnyShape<V>> {
    prop_oneof![
        point(size).prop_map(|s| any_shape(Ok(s))),
        segment(size).prop_map(|s| any_shape(Ok(s))),
        triangle(size).prop_map(|s| any_shape(Ok(s))),
        ball(size).prop_map(|s| any_shape(Ok(s))),
        cuboid(size).prop_map(|s| any_shape(Ok(s))),
        capsule(size).prop_map(|s| any_shape(Ok(s))),
        ellipsoid(size).prop_map(|s| any_shape(Ok(s))),
        polytope(size, 12).prop_map(|s| any_shape(Ok(s))),
    ]
    .boxed()
}

/// Any primitive shape of 3D space.
pub fn primitive_3d<V: Vector3>(size: V::Scalar) -> BoxedStrategy<AnyShape<V>> {
    prop_oneof![
        4 => primitive(size),
        1 => cylinder(size).prop_map(|s| any_shape(Ok(s))),
        1 => cone(size).prop_map(|s| any_shape(Ok(s))),
    ]
    .boxed()
}

/// Combinations of the shapes that `leaf` generates, two levels deep.
pub fn combined<V: Vector>(leaf: BoxedStrategy<AnyShape<V>>, size: V::Scalar) -> BoxedStrategy<AnyShape<V>> {
    let once = combined_once(leaf.clone(), leaf.clone(), size);
    prop_oneof![2 => leaf.clone(), 3 => once.clone(), 2 => combined_once(once, leaf, size)].boxed()
}

fn combined_once<V: Vector>(
    a: BoxedStrategy<AnyShape<V>>,
    b: BoxedStrategy<AnyShape<V>>,
    size: V::Scalar,
) -> BoxedStrategy<AnyShape<V>> {
    let pair = || (a.clone(), b.clone());
    prop_oneof![
        2 => (a.clone(), pose::<V>(size)).prop_map(|(s, (r, t))| any_shape(Posed::new(s, r, t))),
        1 => (a.clone(), matrix::<V>(), vector(size)).prop_map(|(s, m, t)| any_shape(Affine::new(s, m, t))),
        1 => pair().prop_map(|(a, b)| any_shape(Ok(MinkowskiSum::new(a, b)))),
        1 => pair().prop_map(|(a, b)| any_shape(Ok(Difference::new(a, b)))),
        1 => pair().prop_map(|(a, b)| any_shape(Ok(Hull::new(a, b)))),
        1 => (a.clone(), length(size)).prop_map(|(s, r)| any_shape(Rounded::new(s, r))),
    ]
    .boxed()
}

/// A matrix with entries in `[-1, 1]`, at times singular, a mirror or a scaling.
pub fn matrix<V: Vector>() -> BoxedStrategy<V::Matrix> {
    let columns = proptest::array::uniform3(vector::<V>(V::Scalar::ONE));
    prop_oneof![
        2 => columns.prop_map(|c| V::Matrix::from_cols_fn(|j| c[j])),
        1 => vector::<V>(V::Scalar::ONE).prop_map(V::Matrix::from_diagonal),
        1 => (rotation::<V>(), positive_length(V::Scalar::ONE)).prop_map(|(r, s)| {
            let rotation = r.matrix();
            V::Matrix::from_cols_fn(|j| rotation.col(j) * s)
        }),
    ]
    .boxed()
}
