//! A scene answers as brute force does over the single queries, to the last bit.

#![allow(clippy::print_stdout, reason = "a long run says how its questions came out")]

mod brute_force;
mod compare;
mod instances;
mod numbers;
mod situations;
mod worlds;

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};

use compare::{Count, ask};
use numbers::Numbers;
use worlds::{KINDS, world};

use crate::common::space::Space;

/// How many questions are asked in all, unless `SCENE_QUESTIONS` says another number.
const QUESTIONS: usize = 12_000;

fn random_scenes<V: Space>(seed: u64, share: usize) {
    let wanted = std::env::var("SCENE_QUESTIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(QUESTIONS) / share;
    let mut numbers = Numbers(seed);
    let mut count = Count::default();
    while count.questions < wanted {
        for kind in 0..KINDS {
            let mut world = world::<V>(&mut numbers, kind);
            for _ in 0..3 {
                ask(&world, &mut numbers, &mut count);
                world.change(&mut numbers);
            }
        }
    }
    println!("{}: {count:?}", std::any::type_name::<V>());
    assert!(count.is_fair(), "no fair sample: {count:?}");
}

#[test]
fn solid_double() {
    random_scenes::<DVec3>(1, 3);
}

#[test]
fn planar_double() {
    random_scenes::<DVec2>(2, 6);
}

#[test]
fn solid_single() {
    random_scenes::<Vec3>(3, 6);
}

#[test]
fn solid_single_aligned() {
    random_scenes::<Vec3A>(4, 6);
}

#[test]
fn planar_single() {
    random_scenes::<Vec2>(5, 6);
}
