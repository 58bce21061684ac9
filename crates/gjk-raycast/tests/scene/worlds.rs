//! Scenes of all kinds of bodies, and what happens to them.

use convex_support::{
    Ball, Capsule, Cuboid, Ellipsoid, Point, Polytope, Posed, Rotation, Rounded, Scalar, Segment, SupportMap, Triangle,
};
use gjk_raycast::{HalfSpace, Pose, Scene};

use super::numbers::Numbers;
use crate::common::space::Space;

pub(crate) type Shape<V> = Box<dyn SupportMap<Vector = V> + Send + Sync>;

/// A shape of any kind about the origin.
fn shape<V: Space>(numbers: &mut Numbers, size: f64) -> Shape<V> {
    let number = V::Scalar::from_f64;
    let length = number(size * (0.2 + 0.8 * numbers.unit()));
    let radius = number(size * 0.4 * numbers.unit());
    let lengths = V::from_fn(|_| number(size * (0.1 + 0.9 * numbers.unit())));
    let mut point = || numbers.vector::<V>(size);
    let made: Option<Shape<V>> = (|| {
        Some(match (length.as_f64().to_bits() % 11) as usize {
            0 => Box::new(Ball::new(length).ok()?) as Shape<V>,
            1 => Box::new(Cuboid::new(lengths).ok()?),
            2 => Box::new(Capsule::new(length, radius).ok()?),
            3 => Box::new(Ellipsoid::new(V::ZERO, lengths, V::Rotation::default()).ok()?),
            4 => Box::new(Polytope::new((0..20).map(|_| point())).ok()?),
            5 => Box::new(Segment::new([point(), point()]).ok()?),
            6 => Box::new(Triangle::new([point(), point(), point()]).ok()?),
            7 => Box::new(Point::new(point()).ok()?),
            8 => Box::new(Rounded::new(Cuboid::new(lengths).ok()?, radius).ok()?),
            kind => V::upright(kind - 9, length, radius)?,
        })
    })();
    made.unwrap_or_else(|| Box::new(Ball::new(length).expect("a ball")))
}

/// The size of a shape in a world, and its pose.
pub(crate) fn place<V: Space>(numbers: &mut Numbers, kind: usize, index: usize) -> (f64, Pose<V>) {
    // The smallest numbers whose products still have digits, by a factor.
    let tiny = if V::Scalar::EPSILON.as_f64() > 1e-10 { 1e-30 } else { 1e-250 };
    let (size, reach, far) = match kind {
        0 => (0.3, 3.0, 0.0),
        1 => (0.5, 0.0, 0.0),
        2 if index == 0 => (1e4, 1e4, 0.0),
        2 => (1e-3, 1.0, 0.0),
        3 => (0.5, 4.0, 1e5),
        4 => (0.3 * tiny, 3.0 * tiny, 0.0),
        5 => (1.0, 1.0, 0.0),
        _ => (0.05, 2.0, 0.0),
    };
    let rotation = V::Rotation::from_xyzw([0, 1, 2, 3].map(|i| {
        let turned = numbers.below(3) > 0;
        V::Scalar::from_f64(if turned { numbers.signed() } else { f64::from(i == 3) })
    }));
    let translation = numbers.vector::<V>(reach) + V::splat(V::Scalar::from_f64(far));
    (size, Pose { rotation, translation })
}

/// A shape in a place of a world.
pub(crate) fn body<V: Space>(numbers: &mut Numbers, kind: usize, index: usize) -> Shape<V> {
    let (size, Pose { rotation, translation }) = place(numbers, kind, index);
    let shape = shape(numbers, size);
    match Posed::new(&*shape, rotation, translation) {
        Ok(_) => {}
        Err(_) => return shape,
    }
    Box::new(Posed::new(shape, rotation, translation).expect("checked"))
}

/// How many kinds of worlds there are.
pub(crate) const KINDS: usize = 7;

pub(crate) struct World<V: Space> {
    pub(crate) scene: Scene<Shape<V>>,
    pub(crate) kind: usize,
}

pub(crate) fn world<V: Space>(numbers: &mut Numbers, kind: usize) -> World<V> {
    let count = [0, 1, 2, 5, 20, 60][numbers.below(6)];
    let mut scene = Scene::new((0..count).map(|i| body(numbers, kind, i))).expect("all are finite");
    if numbers.below(4) == 0 {
        let normal: V = numbers.vector(1.0);
        if let Ok(half_space) = HalfSpace::new(normal, V::Scalar::from_f64(-1.0)) {
            scene.insert_half_space(half_space);
        }
    }
    World { scene, kind }
}

impl<V: Space> World<V> {
    pub(crate) fn change(&mut self, numbers: &mut Numbers) {
        let kind = self.kind;
        match numbers.below(4) {
            0 => self.scene.update(|index, _| body(numbers, kind, index)).expect("all are finite"),
            1 => {
                for _ in 0..numbers.below(20) {
                    self.scene.insert(body(numbers, kind, 1)).expect("finite");
                }
            }
            2 => {
                let end = self.scene.iter().map(|(index, _)| index + 1).last().unwrap_or(1);
                for _ in 0..numbers.below(20) {
                    let index = numbers.below(end);
                    let there = self.scene.get(index).is_some();
                    assert_eq!(self.scene.remove(index).is_some(), there, "a body is removed once");
                }
            }
            _ => {
                let indices: Vec<_> = self.scene.iter().filter(|(_, b)| b.convex().is_some()).map(|(i, _)| i).collect();
                for index in indices.into_iter().step_by(3) {
                    self.scene.replace(index, body(numbers, kind, index)).expect("finite");
                }
            }
        }
        let count = self.scene.iter().filter(|(_, body)| body.convex().is_some()).count();
        assert_eq!(self.scene.tree().len(), count, "the tree holds what is bounded");
    }
}
