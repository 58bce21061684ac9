//! Every single query, one after the other.

use convex_support::{SupportMap, Vector};
use gjk_raycast::{
    Body, BodyContact, BodyDistance, Contact, Distance, DistanceOptions, LinearCast, LinearCastOptions, Motion,
    MotionCast, MotionCastOptions, PairContact, PairDistance, Ray, RayCast, RayCastOptions, RigidMotion, Scene,
    SignedDistanceOptions, contact, distance, linear_cast, motion_cast, ray_cast,
};

use super::worlds::{Shape, World};
use crate::common::space::Space;

pub(crate) fn rays<V: Space>(world: &World<V>, ray: Ray<V>, options: RayCastOptions<V>) -> Vec<(usize, RayCast<V>)> {
    let cast = |body: &Body<Shape<V>>| match body {
        Body::Convex(body) => ray_cast(body, ray, options),
        Body::HalfSpace(half_space) => half_space.ray_cast(ray, options),
    };
    world.scene.iter().map(|(index, body)| (index, cast(body).expect("a good ray"))).collect()
}

pub(crate) fn casts<V: Space>(
    world: &World<V>,
    shape: &Shape<V>,
    motion: Motion<V>,
    options: LinearCastOptions<V>,
) -> Vec<(usize, LinearCast<V>)> {
    let cast = |body: &Body<Shape<V>>| match body {
        Body::Convex(body) => linear_cast(shape, body, motion, options),
        Body::HalfSpace(half_space) => half_space.linear_cast(shape, motion, options),
    };
    world.scene.iter().map(|(index, body)| (index, cast(body).expect("a good motion"))).collect()
}

pub(crate) fn motions<V: Space>(
    world: &World<V>,
    shape: &Shape<V>,
    motion: RigidMotion<V>,
    of_bodies: RigidMotion<V>,
    options: MotionCastOptions<V>,
) -> Vec<(usize, MotionCast<V>)> {
    let cast = |body: &Body<Shape<V>>| match body {
        Body::Convex(body) => motion_cast(shape, motion, body, of_bodies, options),
        Body::HalfSpace(_) => body.motion_cast_of_both(shape, motion, of_bodies, options),
    };
    world.scene.iter().map(|(index, body)| (index, cast(body).expect("a good motion"))).collect()
}

pub(crate) fn distances<V: Space>(world: &World<V>, shape: &Shape<V>) -> Vec<BodyDistance<V>> {
    let from = |body: &Body<Shape<V>>| match body {
        Body::Convex(body) => distance(shape, body, DistanceOptions::default()),
        Body::HalfSpace(half_space) => half_space.distance_from(shape),
    };
    world.scene.iter().map(|(body, other)| BodyDistance { body, member: None, distance: from(other) }).collect()
}

/// All pairs of bodies, half-spaces apart.
pub(crate) fn pairs<V: Space>(world: &World<V>, within: V::Scalar) -> Vec<PairDistance<V>> {
    let mut found = Vec::new();
    for (a, first) in world.scene.iter() {
        for (b, second) in world.scene.iter().filter(|&(b, _)| b > a) {
            let (Some(first), Some(second)) = (first.convex(), second.convex()) else { continue };
            let distance: Distance<V> = distance(first, second, DistanceOptions::default());
            if distance.distance <= within {
                found.push(PairDistance { a, b, member_a: None, member_b: None, distance });
            }
        }
    }
    found
}

/// The distances of all pairs of a body of one scene and one of another, but for two half-spaces.
pub(crate) fn distances_between<V: Space>(first: &Scene<Shape<V>>, second: &Scene<Shape<V>>) -> Vec<PairDistance<V>> {
    let mut found = Vec::new();
    for (a, one) in first.iter() {
        for (b, other) in second.iter() {
            let distance = match (one, other) {
                (Body::Convex(one), Body::Convex(other)) => distance(one, other, DistanceOptions::default()),
                (Body::Convex(one), Body::HalfSpace(other)) => other.distance_from(one),
                (Body::HalfSpace(one), Body::Convex(other)) => one.distance_from(other).reversed(),
                (Body::HalfSpace(_), Body::HalfSpace(_)) => continue,
            };
            found.push(PairDistance { a, b, member_a: None, member_b: None, distance });
        }
    }
    found
}

/// The contacts of all pairs of bodies, but for two half-spaces.
pub(crate) fn contacts<V: Space>(world: &World<V>, within: V::Scalar) -> Vec<PairContact<V>> {
    let mut found = Vec::new();
    for (a, first) in world.scene.iter() {
        for (b, second) in world.scene.iter().filter(|&(b, _)| b > a) {
            let contact = match (first, second) {
                (Body::Convex(first), Body::Convex(second)) => {
                    contact(first, second, within, SignedDistanceOptions::default())
                }
                (Body::Convex(first), Body::HalfSpace(second)) => second.contact(first, within),
                (Body::HalfSpace(first), Body::Convex(second)) => first.contact(second, within).map(Contact::reversed),
                (Body::HalfSpace(_), Body::HalfSpace(_)) => None,
            };
            found.extend(contact.map(|contact| PairContact { a, b, member_a: None, member_b: None, contact }));
        }
    }
    found
}

pub(crate) fn contacts_of<V: Space>(world: &World<V>, shape: &Shape<V>, within: V::Scalar) -> Vec<BodyContact<V>> {
    let with = |body: &Body<Shape<V>>| body.contact(shape, within, SignedDistanceOptions::default());
    world
        .scene
        .iter()
        .filter_map(|(body, other)| Some(BodyContact { body, member: None, contact: with(other)? }))
        .collect()
}

/// The pairs without half-spaces.
pub(crate) fn bounded<V: Vector, S: SupportMap<Vector = V>>(
    pairs: &[PairDistance<V>],
    scene: &Scene<S>,
) -> Vec<PairDistance<V>> {
    let is_bounded = |index| scene.get(index).is_some_and(|body| body.convex().is_some());
    pairs.iter().copied().filter(|pair| is_bounded(pair.a) && is_bounded(pair.b)).collect()
}
