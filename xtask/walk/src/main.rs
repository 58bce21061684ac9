//! `walk NAME` asks one question of each kind about bodies of this name; `walk` lists the names.
//!
//! `cargo xtask follow` runs it under callgrind and counts the files of gjk-raycast that the question goes through.
//! Each kind has a function whose name begins with `counted`: only what it calls is counted.
#![allow(clippy::print_stdout, reason = "printing is what it is for")]

use std::error::Error;
use std::fmt::Debug;

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ball, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Posed, Rounded, SupportMap};
use gjk_raycast::{
    DistanceOptions, IntersectOptions, Joint, JointKind, LinearCastOptions, Link, Linkage, Motion, MotionCastOptions,
    PathWorkspace, Ray, RayCastOptions, RigidMotion, Scene, SignedDistanceOptions, contact, distance, intersects,
    linear_cast, motion_cast, ray_cast, signed_distance,
};

/// The names of the questions.
const NAMES: [&str; 21] = [
    "ray_hull",
    "ray_box",
    "ray_roundhull",
    "ray_plane_polygon",
    "scene_hull",
    "distance_hull",
    "distance_box",
    "distance_ballbox",
    "signed_hull_deep",
    "signed_box_deep",
    "signed_cyl_deep",
    "intersects_hull",
    "intersects_box",
    "linear_hull",
    "linear_cyl",
    "linear_el",
    "motion_hull",
    "motion_box",
    "contact_box",
    "contact_hull",
    "path",
];

type Answer = Result<(), Box<dyn Error>>;

/// A shape in double precision.
trait Shape: SupportMap<Vector = DVec3> {}
impl<S: SupportMap<Vector = DVec3>> Shape for S {}

fn main() -> Answer {
    let Some(name) = std::env::args().nth(1) else {
        for name in NAMES {
            println!("{name}");
        }
        return Ok(());
    };
    let hulls = [hull(64, 1)?, hull(64, 7)?];
    let block = Cuboid::new(DVec3::new(0.8, 0.5, 0.6))?;
    let (cylinder, cone) = (Cylinder::<DVec3>::new(0.5, 0.4)?, Cone::<DVec3>::new(0.5, 0.4)?);
    let ellipsoid = Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 0.7, 0.5), DQuat::IDENTITY)?;
    let [a, b] = hulls;
    let (far, deep) = (DVec3::new(-4.0, 0.3, 0.2), DVec3::new(-0.7, 0.3, 0.2));
    match name.as_str() {
        "ray_hull" => counted_ray(&aside(a)?, RAY),
        "ray_box" => counted_ray(&aside(block)?, RAY),
        "ray_roundhull" => counted_ray(&aside(Rounded::new(a, 0.1)?)?, RAY),
        "ray_plane_polygon" => {
            let polygon = Polytope::new(a.points().iter().map(|point| point.truncate().normalize()))?;
            counted_ray(&polygon, Ray { source: RAY.source.truncate(), direction: RAY.direction.truncate() })
        }
        "scene_hull" => {
            let bodies: Result<Vec<_>, Box<dyn Error>> =
                (0..50).map(|i| posed(hull(32, i)?, DVec3::X * (3.0 * f64::from(i)), 0.3)).collect();
            counted_scene(&Scene::new(bodies?)?)
        }
        "distance_hull" => counted_distance(&posed(a, far, 0.5)?, &b),
        "distance_box" => counted_distance(&posed(block, far, 0.5)?, &block),
        "distance_ballbox" => counted_distance(&posed(Ball::new(0.4)?, far, 0.5)?, &block),
        "signed_hull_deep" => counted_signed(&posed(a, deep, 0.5)?, &b),
        "signed_box_deep" => counted_signed(&posed(block, deep, 0.5)?, &block),
        "signed_cyl_deep" => counted_signed(&posed(cylinder, DVec3::new(-0.4, 0.2, 0.1), 0.5)?, &cone),
        "intersects_hull" => counted_intersects(&posed(a, deep, 0.5)?, &b),
        "intersects_box" => counted_intersects(&posed(block, deep, 0.5)?, &block),
        "linear_hull" => counted_linear(&posed(a, far, 0.5)?, &b),
        "linear_cyl" => counted_linear(&posed(cylinder, far, 0.5)?, &cone),
        "linear_el" => counted_linear(&posed(ellipsoid, far, 0.5)?, &ellipsoid),
        "motion_hull" => counted_motion(&posed(a, far, 0.5)?, &b),
        "motion_box" => counted_motion(&posed(block, far, 0.5)?, &block),
        "contact_box" => counted_contact(&posed(block, deep, 0.5)?, &block),
        "contact_hull" => counted_contact(&posed(a, deep, 0.5)?, &b),
        "path" => {
            let joint = |parent, axis| Joint { parent, pose: Default::default(), kind: JointKind::Revolute(axis) };
            let arm = Link { joint: Some(1), bodies: vec![posed(hull(32, 3)?, DVec3::X * 2.0, 0.1)?] };
            let robot = Linkage::new(vec![joint(None, DVec3::Z), joint(Some(0), DVec3::Y)], vec![arm])?;
            let [near, aside] = [DVec3::new(0.0, 2.9, 0.0), DVec3::new(-1.2, 2.9, 1.0)];
            counted_path(&robot, &Scene::new([posed(hull(32, 5)?, near, 0.3)?, posed(hull(32, 6)?, aside, 0.3)?])?)
        }
        _ => Err(format!("there is no question of the name {name}; without a name they are listed").into()),
    }
}

/// The hull of so many points on the unit ball, by a generator of its own: the path of a question depends on them.
fn hull(count: usize, seed: u32) -> Result<Polytope<DVec3>, Box<dyn Error>> {
    let mut state = seed;
    let mut coordinate = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24) * 2.0 - 1.0
    };
    let points = (0..count).map(|_| DVec3::new(coordinate(), coordinate(), coordinate()).normalize());
    Ok(Polytope::new(points.collect::<Vec<_>>())?)
}

fn posed<S: Shape>(shape: S, translation: DVec3, angle: f64) -> Result<Posed<S>, Box<dyn Error>> {
    let rotation = DQuat::from_axis_angle(DVec3::new(0.3, 0.5, 0.81).normalize(), angle);
    Ok(Posed::new(shape, rotation, translation)?)
}

/// A target of a ray.
fn aside<S: Shape>(shape: S) -> Result<Posed<S>, Box<dyn Error>> {
    posed(shape, DVec3::X * 0.1, 0.5)
}

const RAY: Ray<DVec3> = Ray { source: DVec3::new(-5.0, 0.13, 0.21), direction: DVec3::new(1.0, 0.02, -0.03) };
const VELOCITY: DVec3 = DVec3::new(1.0, 0.05, -0.02);

fn print(answer: impl Debug) -> Answer {
    println!("{answer:?}");
    Ok(())
}

#[inline(never)]
fn counted_ray<S: SupportMap>(shape: &S, ray: Ray<S::Vector>) -> Answer {
    print(ray_cast(shape, ray, RayCastOptions::default())?)
}

#[inline(never)]
fn counted_scene(scene: &Scene<impl Shape>) -> Answer {
    print(scene.ray_cast(RAY, RayCastOptions::default())?)
}

#[inline(never)]
fn counted_distance(a: &impl Shape, b: &impl Shape) -> Answer {
    print(distance(a, b, DistanceOptions::default()))
}

#[inline(never)]
fn counted_signed(a: &impl Shape, b: &impl Shape) -> Answer {
    print(signed_distance(a, b, SignedDistanceOptions::default()))
}

#[inline(never)]
fn counted_intersects(a: &impl Shape, b: &impl Shape) -> Answer {
    print(intersects(a, b, IntersectOptions::default()))
}

#[inline(never)]
fn counted_linear(a: &impl Shape, b: &impl Shape) -> Answer {
    let motion = Motion { velocity_a: VELOCITY, velocity_b: DVec3::ZERO };
    print(linear_cast(a, b, motion, LinearCastOptions::default())?)
}

#[inline(never)]
fn counted_motion(a: &impl Shape, b: &impl Shape) -> Answer {
    let center = DVec3::new(-4.0, 0.3, 0.2);
    let motion = RigidMotion { velocity: VELOCITY, angular_velocity: DVec3::new(0.2, 0.9, 0.4), center };
    let options = MotionCastOptions::default().with_max_time(10.0);
    print(motion_cast(a, motion, b, RigidMotion::default(), options)?)
}

#[inline(never)]
fn counted_contact(a: &impl Shape, b: &impl Shape) -> Answer {
    print(contact(a, b, 0.01, SignedDistanceOptions::default()).map(|contact| contact.points().len()))
}

#[inline(never)]
fn counted_path(robot: &Linkage<impl Shape>, scene: &Scene<impl Shape>) -> Answer {
    let path = [[0.0, 0.0], [1.6, 0.3]];
    print(robot.path(&path, scene, MotionCastOptions::default(), &mut PathWorkspace::new())?)
}
