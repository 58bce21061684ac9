//! A character in a game walks over a floor, against a wall, and slides along it.
//!
//! In each frame a capsule moves to its first contact, loses the part of its velocity that leads into the obstacle, and
//! goes on with the rest. Afterwards the contacts tell what it stands on and leans against. What is in another layer,
//! here a curtain of light, it walks through.
//!
//! `cargo run -p gjk-raycast --example character_in_a_level`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{Quat, Vec3};
use convex_support::{Ball, Capsule, Cuboid, InvalidShape, Posed, SupportMap};
use gjk_raycast::{BodyContact, LinearCastOptions, Motion, RayCastError, Scene, SignedDistanceOptions, StartInContact};

/// Shapes of any kind, in single precision as games have it.
type Shape = Box<dyn SupportMap<Vector = Vec3>>;

const FRAME: f32 = 1.0 / 60.0;
/// The character stops this far from everything, so that rounding never puts it into a wall.
const SKIN: f32 = 0.01;

/// What a game keeps of each body, in the order of the scene's indices: its entity, and its layers as bits.
struct Entity {
    name: &'static str,
    layers: u8,
}
const SOLID: u8 = 1;
const SEEN: u8 = 2;

fn level() -> Result<Vec<(Entity, Shape)>, InvalidShape> {
    let body = |name, layers, shape: Shape| (Entity { name, layers }, shape);
    let wall = Cuboid::new(Vec3::new(0.5, 2.0, 10.0))?;
    let curtain = Posed::translated(Cuboid::new(Vec3::new(0.1, 2.0, 10.0))?, Vec3::new(2.0, 2.0, 0.0))?;
    let floor = Posed::translated(Cuboid::new(Vec3::new(20.0, 0.5, 20.0))?, Vec3::new(0.0, -0.5, 0.0))?;
    Ok(vec![
        body("floor", SOLID | SEEN, Box::new(floor)),
        body("wall", SOLID | SEEN, Box::new(Posed::new(wall, Quat::from_rotation_y(0.3), Vec3::new(5.0, 2.0, 0.0))?)),
        body("boulder", SOLID | SEEN, Box::new(Posed::translated(Ball::new(1.0)?, Vec3::new(-3.0, 0.0, 3.0))?)),
        body("curtain", SEEN, Box::new(curtain)),
    ])
}

struct Level {
    entities: Vec<Entity>,
    scene: Scene<Shape>,
}

struct Character {
    shape: Capsule<Vec3>,
    /// The middle of the capsule.
    at: Vec3,
    velocity: Vec3,
}

impl Character {
    fn body(&self) -> Result<Posed<Capsule<Vec3>>, InvalidShape> {
        Posed::translated(self.shape, self.at)
    }

    /// Moves for one frame. A corner takes as many slides as it has walls, so that a few are enough.
    fn step(&mut self, level: &Level) -> Result<(), Box<dyn std::error::Error>> {
        let mut left = FRAME;
        for _ in 0..4 {
            let normal = match self.first_contact(level, left)? {
                None => {
                    self.at += self.velocity * left;
                    return Ok(());
                }
                Some((time, normal)) => {
                    self.at += self.velocity * time;
                    left -= time;
                    normal
                }
            };
            self.velocity -= normal * self.velocity.dot(normal).min(0.0);
        }
        Ok(())
    }

    /// When the character first comes within the skin of something, and the normal there, out of the obstacle.
    fn first_contact(&self, level: &Level, within: f32) -> Result<Option<(f32, Vec3)>, RayCastError> {
        // Contacts that the motion leaves or slides along do not count.
        let options = LinearCastOptions::new()
            .with_max_time(within)
            .with_target_distance(SKIN)
            .with_start_in_contact(StartInContact::IfDeeper);
        let body = self.body().expect("the character is at a finite place");
        let motion = Motion { velocity_a: self.velocity, ..Motion::default() };
        let entities = &level.entities;
        let solid = |body: usize| entities[body].layers & SOLID != 0;
        let first = level.scene.among(&solid).linear_cast(&body, motion, options)?.first;
        Ok(first
            .map(|first| (first.hit.time, first.hit.normal.expect("hits have one where only deeper motions count"))))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (entities, shapes): (Vec<_>, Vec<_>) = level()?.into_iter().unzip();
    let level = Level { entities, scene: Scene::new(shapes)? };
    let mut character =
        Character { shape: Capsule::new(0.5, 0.3)?, at: Vec3::new(0.0, 0.8 + SKIN, 0.0), velocity: Vec3::ZERO };
    for frame in 0..240 {
        character.velocity = Vec3::new(4.0, character.velocity.y - 9.81 * FRAME, 0.5);
        character.step(&level)?;
        if frame % 60 == 59 {
            println!("after {} s: at {:.3}, velocity {:.3}", (frame + 1) / 60, character.at, character.velocity);
        }
    }

    // What it touches.
    let mut contacts = Vec::new();
    let entities = &level.entities;
    let solid = |body: usize| entities[body].layers & SOLID != 0;
    level.scene.among(&solid).contacts_of(
        &character.body()?,
        2.0 * SKIN,
        SignedDistanceOptions::default(),
        &mut contacts,
    );
    for BodyContact { body, contact, .. } in &contacts {
        let name = level.entities[*body].name;
        println!("touches the {name} in {} points, normal {:.3}", contact.points().len(), contact.normal);
        assert!((contact.distance.signed_distance - SKIN).abs() < 1e-3, "{}", contact.distance.signed_distance);
    }
    assert_eq!(
        contacts.iter().map(|found| level.entities[found.body].name).collect::<Vec<_>>(),
        ["floor", "wall"],
        "it stands on the floor, by the wall"
    );
    // Along the wall, whose outward normal is (−cos 0.3, 0, sin 0.3), nothing slows it down.
    let along = Vec3::new(0.3_f32.sin(), 0.0, 0.3_f32.cos());
    let walked = Vec3::new(4.0, 0.0, 0.5).dot(along);
    assert!((character.velocity.dot(along) - walked).abs() < 1e-3, "{} along the wall", character.velocity);
    Ok(())
}
