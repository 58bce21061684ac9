//! A level of a game: a mesh for the ground, hulls for what stands on it, entities in layers, a character, bullets that
//! are not mistaken for the targets that they replace, and a mouse that picks.
//!
//! `cargo run -p gjk-raycast --example game_level -- docs/figures/game-level.svg` also draws it.

#![allow(clippy::print_stdout, reason = "an example talks")]

mod level;

use std::collections::HashMap;
use std::error::Error;

use convex_support::glam::Vec3;
use convex_support::{Ball, Capsule, Polytope, Posed, SupportMap};
use gjk_raycast::{
    BodyHandle, DistanceOptions, LinearCastOptions, Motion, MotionCastOptions, Ray, RayCastOptions, RigidMotion, Scene,
};

use crate::level::Picture;

/// Shapes of any kind, in single precision as games have it; `Sync`, since layers are asked by a closure that may be.
type Shape = Box<dyn SupportMap<Vector = Vec3> + Sync>;

/// Layers, one bit each.
const SOLID: u32 = 1;
const ENEMY: u32 = 2;
const BULLET: u32 = 4;

/// What a body is to the game.
struct Entity {
    name: &'static str,
    layers: u32,
    velocity: Vec3,
}

/// The bodies that come and go, and what the game knows of them.
#[derive(Default)]
struct World {
    bodies: Scene<Shape>,
    entities: HashMap<BodyHandle, Entity>,
}

impl World {
    fn add(&mut self, shape: Shape, entity: Entity) -> Result<BodyHandle, Box<dyn Error>> {
        let index = self.bodies.insert(shape)?;
        let handle = self.bodies.handle(index).ok_or("it was just inserted")?;
        self.entities.insert(handle, entity);
        Ok(handle)
    }

    fn entity(&self, body: usize) -> Option<&Entity> {
        self.entities.get(&self.bodies.handle(body)?)
    }

    fn is_in(&self, body: usize, mask: u32) -> bool {
        self.entity(body).is_some_and(|entity| entity.layers & mask != 0)
    }

    fn remove(&mut self, handle: BodyHandle) {
        if let Some(body) = self.bodies.index_of(handle) {
            self.bodies.remove(body);
            self.entities.remove(&handle);
        }
    }
}

/// The ground: a grid of two triangles a square, with indices as they come from a file.
fn ground() -> Result<Scene<convex_support::Triangle<Vec3>>, Box<dyn Error>> {
    let at = |x: u32, z: u32| Vec3::new(x as f32 - 8.0, 0.0, z as f32 - 8.0);
    let vertices: Vec<_> = (0..17).flat_map(|z| (0..17).map(move |x| at(x, z))).collect();
    let corner = |x: u32, z: u32| z * 17 + x;
    let square = |x, z| {
        let [a, b, c, d] = [corner(x, z), corner(x + 1, z), corner(x, z + 1), corner(x + 1, z + 1)];
        [[a, c, b], [b, c, d]]
    };
    let triangles: Vec<[u32; 3]> = (0..16).flat_map(|z| (0..16).flat_map(move |x| square(x, z))).collect();
    Ok(Scene::mesh(&vertices, &triangles)?)
}

fn hull(points: [[f32; 3]; 5]) -> Result<Shape, Box<dyn Error>> {
    Ok(Box::new(Polytope::new(points.map(Vec3::from))?))
}

fn main() -> Result<(), Box<dyn Error>> {
    let ground = ground()?;
    let mut picture = Picture::default();
    for (_, triangle) in ground.iter().filter_map(|(index, body)| Some((index, body.convex()?))) {
        picture.body("ground", triangle);
    }
    let mut world = World::default();
    let still = |name, layers| Entity { name, layers, velocity: Vec3::ZERO };
    // A crystal of two convex pieces, as a decomposition gives them.
    let base = [[2.0, 0.0, -1.0], [4.0, 0.0, -1.0], [4.0, 0.0, 1.0], [2.0, 0.0, 1.0], [3.0, 1.0, 0.0]];
    let tip = [[2.5, 0.5, -0.5], [3.5, 0.5, -0.5], [3.5, 0.5, 0.5], [2.5, 0.5, 0.5], [3.0, 3.0, 0.0]];
    world.add(hull(base)?, still("crystal", SOLID))?;
    world.add(hull(tip)?, still("crystal", SOLID))?;
    let enemy_at = |x| Posed::translated(Capsule::new(0.5, 0.4)?, Vec3::new(x, 1.0, 4.0));
    let enemy = world.add(Box::new(enemy_at(5.0)?), still("enemy", ENEMY))?;

    // The character walks until something solid is in the way; enemies are no obstacles. The ground is a scene apart.
    let start = Vec3::new(-2.0, 1.0, 0.0);
    let hero = Posed::translated(Capsule::new(0.6, 0.3)?, start)?;
    let walk = Motion { velocity_a: Vec3::X * 2.0, ..Motion::default() };
    let solid = |body| world.is_in(body, SOLID);
    let stop = world.bodies.among(&solid).linear_cast(&hero, walk, LinearCastOptions::new())?.first;
    let stop = stop.ok_or("the crystal is in the way")?;
    println!("the hero walks {:.2} s up to the {}", stop.hit.time, world.entity(stop.body).map_or("?", |it| it.name));
    let below = ground.all().any_within(&hero, 0.5, DistanceOptions::new());
    assert!(below.any && stop.body < 2, "over the ground, up to the crystal");
    let way = walk.velocity_a * stop.hit.time;
    picture.body("was", &hero);
    picture.body("hero", &Posed::translated(hero, way)?);
    picture.way("walk", start, start + way);
    picture.label("the hero walks up to the crystal", start + Vec3::Y * 2.2);

    // Bullets fly at the enemy, all in one step. Those of one gun do not hit each other.
    for x in [0.0, 1.0] {
        let bullet = Posed::translated(Ball::new(0.05)?, Vec3::new(x, 1.0, 4.0))?;
        world.add(Box::new(bullet), Entity { name: "bullet", layers: BULLET, velocity: Vec3::X * 100.0 })?;
    }
    let flies = |body: usize| RigidMotion::translation(world.entity(body).map_or(Vec3::ZERO, |it| it.velocity));
    let no_hit = |a: usize, b: usize| world.is_in(a, BULLET) == world.is_in(b, BULLET);
    let step = MotionCastOptions::new().with_max_time(1.0 / 20.0);
    let mut hits = Vec::new();
    let _ = world.bodies.all().without_pairs(&no_hit).first_contacts(&flies, step, &mut hits)?;
    for hit in &hits {
        let [a, b] = [hit.a, hit.b].map(|body| world.entity(body).map_or("?", |it| it.name));
        println!("{b} {} hits {a} {} after {:.4} s", hit.b, hit.a, hit.impact.time);
        let flown = flies(hit.b).velocity * hit.impact.time;
        picture.way("shot", hit.impact.point - flown, hit.impact.point);
    }
    assert_eq!(hits.iter().map(|hit| (hit.a, hit.b)).collect::<Vec<_>>(), [(2, 4), (2, 3)], "the nearer one first");

    // The enemy is gone. What takes its index is not taken for it.
    picture.body("gone", &enemy_at(5.0)?);
    picture.label("bullets hit the enemy", Vec3::new(5.0, 0.0, 4.0));
    world.remove(enemy);
    let next = world.add(Box::new(enemy_at(-5.0)?), still("enemy", ENEMY))?;
    assert!(world.bodies.index_of(enemy).is_none() && world.bodies.index_of(next) == Some(2), "another one");

    // The mouse picks what is seen first: a body, or the ground from above, with the place in its triangle.
    let eye = Vec3::new(0.0, 10.0, 0.0);
    for direction in [Vec3::new(0.3, -1.0, 0.05), Vec3::new(-0.22, -1.0, 0.13)] {
        let ray = Ray { source: eye, direction };
        let body = world.bodies.ray_cast(ray, RayCastOptions::new())?.first;
        let floor = ground.ray_cast_fronts(ray, RayCastOptions::new())?.first.ok_or("the ground is below")?;
        match body.filter(|body| body.hit.lambda < floor.hit.lambda) {
            Some(body) => {
                println!("picked the {}", world.entity(body.body).map_or("?", |it| it.name));
                picture.way("ray", eye, body.hit.point);
                picture.label("picked: a body", body.hit.point);
            }
            None => {
                let triangle = ground.get(floor.body).and_then(|body| body.convex()).ok_or("it was hit")?;
                let weights = triangle.barycentric(floor.hit.point);
                picture.body("picked", triangle);
                picture.way("ray", eye, floor.hit.point);
                picture.label("picked: a triangle", floor.hit.point);
                println!("picked triangle {} of the ground, at {weights:.3?}", floor.body);
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-6, "weights of the corners");
            }
        }
    }

    for (index, body) in world.bodies.iter() {
        if let (Some(entity), Some(shape)) = (world.entity(index), body.convex()) {
            picture.body(entity.name, shape);
        }
    }
    if let Some(file) = std::env::args().nth(1) {
        std::fs::write(file, picture.svg())?;
    }
    Ok(())
}
