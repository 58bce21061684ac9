//! A picture of the bodies of a question in space, ray traced: one ray for each pixel and body, by `ray_entries_into`.

use convex_support::glam::{DQuat, DVec3};
use convex_support::{
    Ball, Capsule, Cone, CrossedByLine, Cuboid, Cylinder, Ellipsoid, Faceted, Posed, Rounded, Segment, SupportMap,
    Triangle,
};
use gjk_raycast::{Ray, RayCastOptions, RayEntry, ray_casts, ray_entries_into};
use serde_json::Value;
use xtask::mesh::Meshes;
use xtask::wire::fields::{Dimension, Object, Written};
use xtask::wire::shape::{EllipsoidSpec, Shape, Solid, Upright, rotation_of, vector as spatial};

use crate::observed::vector;

/// A body as rays meet it: by closed forms in lanes, where its kind has them, or by a search.
enum Body {
    Closed(Box<dyn CrossedByLine<Vector = DVec3>>),
    Searched(Solid<DVec3>),
}

/// A body in its colour, with a ball around it.
struct Thing {
    body: Body,
    colour: DVec3,
    center: DVec3,
    radius: f64,
}

impl Thing {
    /// Where rays enter the body.
    fn enter(&self, rays: &[Ray<DVec3>], entries: &mut [RayEntry<DVec3>]) {
        match &self.body {
            // The error of a ray is written as NaN, which is no hit.
            Body::Closed(body) => drop(ray_entries_into(&**body, rays, RayCastOptions::new(), entries)),
            Body::Searched(body) => {
                for (entry, cast) in entries.iter_mut().zip(ray_casts(body, rays, RayCastOptions::new())) {
                    *entry = cast.map_or(RayEntry { lambda: f64::NAN, ..RayEntry::default() }, RayEntry::from);
                }
            }
        }
    }
}

/// The body with closed forms, where all that it is made of has them.
fn closed(shape: &Shape) -> Option<Box<dyn CrossedByLine<Vector = DVec3>>> {
    Some(match shape {
        Shape::Ball { radius } => Box::new(Ball::new(*radius).ok()?),
        Shape::Cuboid { half_extents } => Box::new(Cuboid::new(spatial(half_extents)).ok()?),
        Shape::Capsule { half_height, radius } => Box::new(Capsule::new(*half_height, *radius).ok()?),
        Shape::Upright { kind: Upright::Cylinder, half_height, radius } => {
            Box::new(Cylinder::new(*half_height, *radius).ok()?)
        }
        Shape::Upright { kind: Upright::Cone, half_height, radius } => Box::new(Cone::new(*half_height, *radius).ok()?),
        Shape::Triangle(points) => Box::new(Triangle::new(points.each_ref().map(spatial)).ok()?),
        Shape::Ellipsoid(spec) => Box::new(EllipsoidSpec::build::<DVec3>(spec, "").ok()?),
        Shape::Polytope(points) => Box::new(Faceted::hull_of(points.iter().map(spatial)).ok()?),
        Shape::Posed { translation, rotation, of } => {
            let rotation = rotation_of::<DVec3>(rotation.as_ref());
            Box::new(Posed::new(closed(of)?, rotation, spatial(translation)).ok()?)
        }
        _ => return None,
    })
}

/// Whose colours are whose, as the drawing in the plane has them.
const COLOURS: [(&str, [f64; 3]); 3] =
    [("a", [0.10, 0.45, 0.85]), ("b", [0.93, 0.50, 0.14]), ("target", [0.93, 0.50, 0.14])];
const MARK: [f64; 3] = [0.85, 0.12, 0.35];
const POINT: [f64; 3] = [0.35, 0.40, 0.48];
/// The ellipsoid around points would hide them.
const ELLIPSOID: [f64; 3] = [0.20, 0.62, 0.45];

fn thing(body: Body, colour: [f64; 3]) -> Thing {
    let core = match &body {
        Body::Closed(body) => body.core(),
        Body::Searched(body) => body.core(),
    };
    let radius = (core.extent + core.radius) * (1.0 + 1e-9);
    Thing { body, colour: DVec3::from(colour).powf(2.2), center: core.origin, radius }
}

/// What is seen, and the part of space that is: its middle and radius.
fn things(query: &Object, meshes: &Meshes) -> (Vec<Thing>, (DVec3, f64)) {
    let read = |body: &Value, colour| {
        let shape = Shape::read(Written::new(body.as_object()?, &Dimension::default())).ok()?;
        let body = closed(&shape).map(Body::Closed).or_else(|| shape.build("", meshes).ok().map(Body::Searched))?;
        Some(thing(body, colour))
    };
    let mut things: Vec<Thing> = COLOURS.iter().filter_map(|(key, colour)| read(query.get(*key)?, *colour)).collect();
    // Where moving bodies begin and end is seen at any time.
    let begun = things.len();
    things.extend(query.get("_also").and_then(Value::as_array).into_iter().flatten().filter_map(|b| read(b, POINT)));
    let mut bodies = span(&things);
    things.truncate(begun);
    for (key, colour) in COLOURS {
        if let Some((slab, seen)) = query.get(key).and_then(|floor| floor_below(floor, bodies)) {
            things.push(thing(Body::Closed(Box::new(slab)), colour));
            bodies = seen;
        }
    }
    let dot = |at: &Value, radius: f64, colour| {
        let ball = Posed::translated(Ball::new(radius).ok()?, vector::<DVec3>(Some(at))).ok()?;
        Some(thing(Body::Closed(Box::new(ball)), colour))
    };
    let each = |key: &str| query.get(key).and_then(Value::as_array).into_iter().flatten();
    // Points that are enclosed are seen beside the ellipsoid's size, of which they say something.
    let reach = each("points").map(|p| vector::<DVec3>(Some(p)).length()).fold(0.0, f64::max);
    things.extend(each("points").filter_map(|at| dot(at, 0.02 * reach, POINT)));
    things.extend(each("_marks").filter_map(|at| dot(at, 0.012 * bodies.1, MARK)));
    things.extend(each("_ways").filter_map(|way| {
        let ends = [0, 1].map(|end| vector::<DVec3>(way.get(end)));
        let rod = Rounded::new(Segment::new(ends).ok()?, 0.006 * bodies.1).ok()?;
        Some(thing(Body::Closed(Box::new(rod)), MARK))
    }));
    if let Some(Value::Object(found)) = query.get("_ellipsoid") {
        let axes = vector::<DVec3>(found.get("semi_axes"));
        let turn = found.get("rotation").and_then(Value::as_array);
        let turn: Vec<f64> = turn.into_iter().flatten().filter_map(Value::as_f64).collect();
        let rotation = if turn.len() == 4 { DQuat::from_slice(&turn) } else { DQuat::IDENTITY };
        if let Ok(body) = Ellipsoid::new(vector(found.get("center")), axes, rotation) {
            things.push(thing(Body::Closed(Box::new(body)), ELLIPSOID));
        }
    }
    let seen = if query.contains_key("points") { span(&things) } else { bodies };
    (things, seen)
}

/// A half-space, as a slab that reaches beyond the picture of bodies, and what is seen of both.
fn floor_below(floor: &Value, (middle, radius): (DVec3, f64)) -> Option<(Posed<Cuboid<DVec3>>, (DVec3, f64))> {
    let normal = vector::<DVec3>(floor.get("normal"));
    let (up, offset) = (normal.try_normalize()?, floor.get("offset")?.as_f64()? / normal.length());
    let height = up.dot(middle) - offset;
    let (foot, half) = (middle - up * height, DVec3::new(20.0, 0.02, 20.0) * radius);
    let turn = DQuat::from_rotation_arc(DVec3::Y, up);
    let slab = Posed::new(Cuboid::new(half).ok()?, turn, foot - up * half.y).ok()?;
    let reach = (height.abs() + radius) / 2.0;
    let seen = if reach > radius { (foot + up * (reach * height.signum()), reach) } else { (middle, radius) };
    Some((slab, seen))
}

/// The middle of what is seen, and its radius. A body many times as large as the smallest one does not count: a floor
/// is seen where the other stands.
fn span(things: &[Thing]) -> (DVec3, f64) {
    let least = things.iter().map(|t| t.radius).filter(|r| *r > 0.0).fold(f64::INFINITY, f64::min);
    let seen = || things.iter().filter(|t| t.radius <= 12.0 * least || things.len() == 1);
    let (low, high) = seen().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), t| {
        (low.min(t.center - DVec3::splat(t.radius)), high.max(t.center + DVec3::splat(t.radius)))
    });
    let middle = (low + high) / 2.0;
    let radius = seen().map(|t| (t.center - middle).length() + t.radius).fold(0.0, f64::max);
    if middle.is_finite() && radius > 0.0 { (middle, radius) } else { (DVec3::ZERO, 1.0) }
}

/// Rays of a picture that are cast together.
const ROW: usize = 1024;
/// Where light comes from, in the frame of the camera: from the left, above and behind it.
const LIGHT: DVec3 = DVec3::new(-0.45, 0.65, 0.6);

/// The pixels of the bodies, four bytes each, seen along `_view` = `[yaw, pitch, zoom]`, `_size` = `[width, height]`;
/// transparent where there is nothing. Empty if a size is out of range.
pub(crate) fn picture(query: &Object, meshes: &Meshes) -> Vec<u8> {
    let number = |key: &str, i: usize| query.get(key).and_then(|list| list.get(i)).and_then(Value::as_f64);
    let side = |i| number("_size", i).filter(|side| (1.0..=2048.0).contains(side)).unwrap_or(0.0) as usize;
    let (width, height) = (side(0), side(1));
    let [yaw, pitch, zoom] = [(0, 0.6), (1, 0.4), (2, 1.0)].map(|(i, usual)| number("_view", i).unwrap_or(usual));
    let (things, (middle, radius)) = things(query, meshes);
    let turn = DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(-pitch);
    let (right, up, back) = (turn * DVec3::X, turn * DVec3::Y, turn * DVec3::Z);
    let light = (turn * LIGHT).normalize();
    // A long lens: lengths keep their proportion, and far bodies are hardly smaller.
    let (far, field) = (6.0 * radius, radius / (6.0 * radius * zoom.clamp(0.05, 50.0)) * 1.08);
    let eye = middle + back * far;
    let unit = 2.0 * field / width.min(height).max(1) as f64;
    let ray = |i: usize| {
        let (x, y) = ((i % width) as f64 + 0.5 - width as f64 / 2.0, (i / width) as f64 + 0.5 - height as f64 / 2.0);
        Ray { source: eye, direction: right * (x * unit) - up * (y * unit) - back }
    };
    let mut pixels = Vec::with_capacity(width * height * 4);
    for first in (0..width * height).step_by(ROW) {
        let rays: Vec<_> = (first..(first + ROW).min(width * height)).map(ray).collect();
        let mut seen = vec![Seen::NOTHING; rays.len()];
        for thing in &things {
            meet(thing, &rays, &mut seen);
        }
        let lit = shadows(&things, &rays, &seen, light, radius);
        for ((ray, seen), lit) in rays.iter().zip(seen).zip(lit) {
            pixels.extend(if seen.lambda < f64::INFINITY {
                shade(ray.direction, seen.normal, seen.mixed(), light, lit)
            } else {
                [0; 4]
            });
        }
    }
    pixels
}

/// What a ray sees.
#[derive(Clone, Copy)]
struct Seen {
    lambda: f64,
    normal: DVec3,
    colour: DVec3,
    /// The colour of something else behind it, or within.
    hidden: Option<DVec3>,
}

impl Seen {
    const NOTHING: Self = Self { lambda: f64::INFINITY, normal: DVec3::ZERO, colour: DVec3::ZERO, hidden: None };

    /// What is hidden shines through, so that a body within another is seen.
    fn mixed(self) -> DVec3 {
        self.hidden.map_or(self.colour, |hidden| self.colour.lerp(hidden, 0.3))
    }
}

/// Casts the rays that pass through the ball around a thing, and keeps what is nearest.
fn meet(thing: &Thing, rays: &[Ray<DVec3>], seen: &mut [Seen]) {
    let near = |ray: &Ray<DVec3>| {
        let to = thing.center - ray.source;
        let along = to.dot(ray.direction) / ray.direction.length_squared();
        (to - ray.direction * along.max(0.0)).length_squared() <= thing.radius * thing.radius
    };
    let chosen: Vec<usize> = (0..rays.len()).filter(|&i| near(&rays[i])).collect();
    let asked: Vec<_> = chosen.iter().map(|&i| rays[i]).collect();
    let mut entries = vec![RayEntry::default(); asked.len()];
    thing.enter(&asked, &mut entries);
    for (&i, entry) in chosen.iter().zip(&entries) {
        let before = seen[i];
        // NaN is not nearer.
        if entry.lambda < before.lambda {
            let hidden = if before.lambda < f64::INFINITY { Some(before.colour) } else { None };
            seen[i] = Seen { lambda: entry.lambda, normal: entry.normal, colour: thing.colour, hidden };
        } else if entry.lambda < f64::INFINITY {
            seen[i].hidden = Some(thing.colour);
        }
    }
}

/// Whether the light reaches what each ray sees.
fn shadows(things: &[Thing], rays: &[Ray<DVec3>], seen: &[Seen], light: DVec3, radius: f64) -> Vec<bool> {
    let mut lit = vec![true; rays.len()];
    let facing: Vec<usize> =
        (0..rays.len()).filter(|&i| seen[i].lambda < f64::INFINITY && seen[i].normal.dot(light) > 0.0).collect();
    // Off the surface, so that it does not shade itself.
    let from = |i: usize| rays[i].at(seen[i].lambda) + seen[i].normal * (1e-4 * radius);
    let rays: Vec<_> = facing.iter().map(|&i| Ray { source: from(i), direction: light }).collect();
    let mut hits = vec![Seen::NOTHING; rays.len()];
    for thing in things {
        meet(thing, &rays, &mut hits);
    }
    for (&i, hit) in facing.iter().zip(&hits) {
        lit[i] = hit.lambda == f64::INFINITY;
    }
    lit
}

/// The colour of a spot, as a screen takes it.
fn shade(direction: DVec3, normal: DVec3, colour: DVec3, light: DVec3, lit: bool) -> [u8; 4] {
    let towards = -direction.normalize();
    let sun = if lit { normal.dot(light).max(0.0) } else { 0.0 };
    let facing = normal.dot(towards).clamp(0.0, 1.0);
    let half = (light + towards).normalize();
    let gloss = if lit { 0.35 * normal.dot(half).max(0.0).powi(60) } else { 0.0 };
    // The sky from above, the light of a lamp beside the eye, and the rim that a sky behind gives.
    let ambient = 0.24 + 0.12 * normal.y + 0.14 * facing;
    let rim = 0.25 * (1.0 - facing).powi(4);
    let linear = colour * (ambient + 0.7 * sun) + DVec3::splat(gloss + rim * 0.5);
    let [r, g, b] = linear.powf(1.0 / 2.2).clamp(DVec3::ZERO, DVec3::ONE).to_array().map(|c| (c * 255.0).round() as u8);
    [r, g, b, 255]
}
