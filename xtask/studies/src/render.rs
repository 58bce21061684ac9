//! `cargo xtask render`: a picture of support-mapped shapes, one GJK ray cast per pixel, shadows by boolean casts.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use convex_support::glam::{Quat, Vec3, Vec3A};
use convex_support::{Ball, Core, Scalar as _};
use convex_support::{
    Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Hull, InvalidShape, MinkowskiSum, Polytope, Posed, Rounded, SupportMap,
};
use gjk_raycast::{Outcome, Ray, RayCastOptions, ray_cast};
use rayon::prelude::*;

type Shape = Box<dyn SupportMap<Vector = Vec3A> + Send + Sync>;

/// A shape in its colour.
struct Thing {
    shape: Shape,
    colour: Vec3,
    /// How much of a mirror it is.
    gloss: f32,
    /// A ball around it: rays that miss this are not cast.
    center: Vec3A,
    radius: f32,
}

/// Rays per pixel along each axis. Each has its own spot in the pixel, its own part of the sun, and its own part of the
/// sky, the same in every pixel: the average is smooth, without noise.
const SAMPLES: u32 = 4;

/// The middle of the sun, and its radius as seen from the ground.
const SUN: Vec3A = Vec3A::new(-0.55, 0.8, 0.5);
const SUN_RADIUS: f32 = 0.06;

/// The colours of light.
struct Light {
    sun: Vec3,
    sky: Vec3,
    /// What is seen where nothing is, at the ground and overhead.
    backdrop: [Vec3; 2],
}

/// For light pages, and for dark ones.
const DAY: Light = Light {
    sun: Vec3::new(1.0, 0.94, 0.84),
    sky: Vec3::new(0.62, 0.7, 0.82),
    backdrop: [Vec3::new(0.80, 0.84, 0.88), Vec3::new(0.42, 0.53, 0.68)],
};
const NIGHT: Light = Light {
    sun: Vec3::new(0.62, 0.66, 0.78),
    sky: Vec3::new(0.07, 0.09, 0.14),
    backdrop: [Vec3::new(0.022, 0.028, 0.042), Vec3::new(0.004, 0.006, 0.011)],
};

/// The part of the sun and of the sky that sample `i` asks for light.
fn lights(i: u32) -> (Vec3A, Vec3A) {
    let count = SAMPLES * SAMPLES;
    // Samples next to each other in a pixel ask for parts that are far apart.
    let k = i * 7 % count;
    let along = (k as f32 + 0.5) / count as f32;
    let (sine, cosine) = (f32::from_f64(2.399_963) * k as f32).sin_cos();
    let sun = SUN.normalize();
    let (side, up) = (sun.cross(Vec3A::Y).normalize(), sun.cross(Vec3A::Y).normalize().cross(sun));
    let sun = (sun + (side * cosine + up * sine) * (SUN_RADIUS * along.sqrt())).normalize();
    let across = (1.0 - along * along).sqrt();
    (sun, Vec3A::new(across * cosine, along, across * sine))
}

/// Renders the picture into a PNG file.
pub(crate) fn run(file: &Path, width: u32, night: bool) -> ExitCode {
    match render(file, width, if night { &NIGHT } else { &DAY }, &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => xtask::output::failed(&format!("cannot write {}", file.display()), &why),
    }
}

fn render(file: &Path, width: u32, light: &Light, output: &mut impl Write) -> io::Result<()> {
    let things = things().map_err(io::Error::other)?;
    let height = width * 9 / 16;
    let casts = AtomicU64::new(0);
    let undecided = AtomicU64::new(0);
    let camera = Camera::new(width, height);
    let start = Instant::now();
    let rows: Vec<Vec<u8>> = (0..height)
        .into_par_iter()
        .map(|y| {
            let mut tally = Tally::default();
            let row = (0..width).flat_map(|x| camera.pixel(x, y, &things, light, &mut tally)).collect();
            casts.fetch_add(tally.casts, Ordering::Relaxed);
            undecided.fetch_add(tally.undecided, Ordering::Relaxed);
            row
        })
        .collect();
    let seconds = start.elapsed().as_secs_f64();
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(file)?), width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&rows.concat())?;
    let casts = casts.into_inner();
    writeln!(
        output,
        "{}: {width} × {height}, {casts} ray casts in {seconds:.2} s, {:.2} million per second on {} threads; {} undecided",
        file.display(),
        casts as f64 / seconds * 1e-6,
        rayon::current_num_threads(),
        undecided.into_inner()
    )
}

#[derive(Default)]
struct Tally {
    casts: u64,
    undecided: u64,
}

impl Tally {
    /// The hit of a ray, if there is one: λ and the normal.
    fn cast(&mut self, thing: &Thing, ray: Ray<Vec3A>, max_lambda: f32) -> Option<(f32, Vec3A)> {
        // Where the ray passes the centre of the ball around the thing.
        let to_center = thing.center - ray.source;
        let along = to_center.dot(ray.direction) / ray.direction.length_squared();
        if (to_center - ray.direction * along.max(0.0)).length_squared() > thing.radius * thing.radius {
            return None;
        }
        self.casts += 1;
        let options = RayCastOptions::new().with_max_lambda(max_lambda);
        match ray_cast(&thing.shape, ray, options).ok()?.outcome {
            Outcome::Hit(hit) => hit.normal.map(|normal| (hit.lambda, normal)),
            Outcome::Miss(_) => None,
            Outcome::Undecided => {
                self.undecided += 1;
                None
            }
        }
    }
}

struct Camera {
    eye: Vec3A,
    right: Vec3A,
    up: Vec3A,
    forward: Vec3A,
    width: u32,
    height: u32,
}

impl Camera {
    fn new(width: u32, height: u32) -> Self {
        let (eye, target) = (Vec3A::new(0.0, 3.6, 12.0), Vec3A::new(0.0, 0.72, 0.0));
        let forward = (target - eye).normalize();
        let right = forward.cross(Vec3A::Y).normalize();
        let field = 0.385;
        Self { eye, right: right * field, up: right.cross(forward) * field, forward, width, height }
    }

    /// The colour of a pixel, averaged over its samples and encoded for a screen.
    fn pixel(&self, x: u32, y: u32, things: &[Thing], light: &Light, tally: &mut Tally) -> [u8; 3] {
        let mut sum = Vec3::ZERO;
        for sample in 0..SAMPLES * SAMPLES {
            let part = |i: u32| (i as f32 + 0.5) / SAMPLES as f32;
            let u = 2.0 * (x as f32 + part(sample % SAMPLES)) / self.width as f32 - 1.0;
            let v = 1.0 - 2.0 * (y as f32 + part(sample / SAMPLES)) / self.height as f32;
            let aspect = self.height as f32 / self.width as f32;
            let direction = self.forward + self.right * u + self.up * (v * aspect);
            sum += shade(Ray { source: self.eye, direction }, sample, 1, things, light, tally);
        }
        let linear = sum / (SAMPLES * SAMPLES) as f32;
        linear.powf(1.0 / 2.2).clamp(Vec3::ZERO, Vec3::ONE).to_array().map(|c| (c * 255.0).round() as u8)
    }
}

/// What is seen where nothing is: brighter towards the ground.
fn backdrop(direction: Vec3A, light: &Light) -> Vec3 {
    let height = direction.normalize().y;
    let [low, high] = light.backdrop;
    low.lerp(high, (0.5 + 1.6 * height).clamp(0.0, 1.0))
}

/// The light that comes back along a ray, mirrored at most `bounces` times.
fn shade(ray: Ray<Vec3A>, sample: u32, bounces: u32, things: &[Thing], of: &Light, tally: &mut Tally) -> Vec3 {
    let mut nearest: Option<(f32, Vec3A, &Thing)> = None;
    for thing in things {
        // Nothing behind what was hit already needs to be looked at.
        let limit = nearest.map_or(f32::INFINITY, |(lambda, _, _)| lambda);
        if let Some((lambda, normal)) = tally.cast(thing, ray, limit) {
            nearest = Some((lambda, normal, thing));
        }
    }
    let Some((lambda, normal, thing)) = nearest else { return backdrop(ray.direction, of) };
    let towards = -ray.direction.normalize();
    // Off the surface, so that it does not shade itself.
    let spot = ray.at(lambda) + normal * 1e-3;
    let mut reaches = |direction: Vec3A, how_far: f32| {
        let ray = Ray { source: spot, direction };
        normal.dot(direction) > 0.0 && !things.iter().any(|other| tally.cast(other, ray, how_far).is_some())
    };
    let (sun, sky) = lights(sample);
    let sunlit = reaches(sun, f32::INFINITY);
    // What is far away darkens the sky no more.
    let skylit = reaches(sky, 4.0);
    let mut light = of.sky * (0.16 - 0.08 * normal.y);
    if sunlit {
        light += of.sun * (0.85 * normal.dot(sun));
    }
    if skylit {
        light += of.sky * (1.1 * normal.dot(sky));
    }
    let mut seen = thing.colour * light;
    // Schlick's approximation of what glass-like gloss mirrors.
    let facing = normal.dot(towards).clamp(0.0, 1.0);
    let mirrored = thing.gloss * (0.04 + 0.96 * (1.0 - facing).powi(5));
    if bounces > 0 {
        let direction = normal * (2.0 * normal.dot(towards)) - towards;
        let other = shade(Ray { source: spot, direction }, sample, bounces - 1, things, of, tally);
        seen = seen.lerp(other, mirrored);
    }
    if sunlit {
        let half = (sun + towards).normalize();
        seen += of.sun * (thing.gloss * 0.5 * normal.dot(half).max(0.0).powi(90));
    }
    // The floor has no end: it fades into the backdrop.
    let far = ((spot.length() - 6.0) / 9.0).clamp(0.0, 1.0);
    seen.lerp(backdrop(ray.direction, of), far * far * (3.0 - 2.0 * far))
}

fn thing<S>(shape: S, colour: [f32; 3], [x, y, z]: [f32; 3], rotation: Quat) -> Result<Thing, InvalidShape>
where
    S: SupportMap<Vector = Vec3A> + Send + Sync + 'static,
{
    let shape = Posed::new(shape, rotation, Vec3A::new(x, y, z))?;
    let Core { origin: center, radius, extent, .. } = shape.core();
    let radius = extent + radius;
    Ok(Thing {
        center,
        radius: radius * (1.0 + 4.0 * f32::EPSILON),
        shape: Box::new(shape),
        // The colours are written as a screen shows them.
        colour: Vec3::from(colour).powf(2.2),
        gloss: 1.0,
    })
}

/// The floor and, from the left: sums, hulls, ellipsoids and rounded bodies.
fn things() -> Result<Vec<Thing>, InvalidShape> {
    let level = Quat::IDENTITY;
    let turned = |x: f32, y: f32, z: f32| Quat::from_euler(convex_support::glam::EulerRot::YXZ, y, x, z);
    let disc = Cylinder::<Vec3A>::new(0.0, 0.55)?;
    let gem: Vec<Vec3A> = (0..40).map(|i| spiral(i, 40) * Vec3A::new(0.75, 0.95, 0.75)).collect();
    Ok(vec![
        Thing {
            gloss: 0.6,
            ..thing(Cuboid::new(Vec3A::new(60.0, 0.1, 60.0))?, [0.86, 0.86, 0.86], [0.0, -0.1, 0.0], level)?
        },
        // A box swept by a disc.
        thing(
            MinkowskiSum::new(Cuboid::new(Vec3A::new(0.35, 0.6, 0.35))?, disc),
            [0.12, 0.42, 0.75],
            [-3.4, 0.6, 0.2],
            turned(0.0, 0.5, 0.0),
        )?,
        // A cone swept by a ball.
        thing(Rounded::new(Cone::<Vec3A>::new(0.7, 0.6)?, 0.18)?, [0.95, 0.66, 0.16], [-1.7, 0.88, 0.8], level)?,
        // The hull of a ball and a box.
        thing(
            Hull::new(
                Posed::translated(Ball::new(0.42)?, Vec3A::new(0.0, 1.5, 0.0))?,
                Cuboid::new(Vec3A::new(0.6, 0.02, 0.6))?,
            ),
            [0.10, 0.62, 0.48],
            [-0.3, 0.02, -1.2],
            turned(0.0, 0.6, 0.0),
        )?,
        thing(
            Ellipsoid::new(Vec3A::ZERO, Vec3A::new(0.95, 0.5, 0.35), level)?,
            [0.82, 0.45, 0.68],
            [0.1, 0.75, 1.7],
            turned(0.3, 0.7, 0.5),
        )?,
        thing(Polytope::new(gem)?, [0.88, 0.36, 0.13], [1.5, 0.95, 0.1], turned(0.2, 0.0, 0.1))?,
        // A capsule plus an ellipsoid.
        thing(
            MinkowskiSum::new(
                Capsule::<Vec3A>::new(0.45, 0.1)?,
                Ellipsoid::new(Vec3A::ZERO, Vec3A::new(0.7, 0.18, 0.4), level)?,
            ),
            [0.38, 0.70, 0.92],
            [3.2, 0.75, 0.3],
            turned(0.0, 0.4, 0.25),
        )?,
        thing(
            Rounded::new(Cuboid::new(Vec3A::new(0.35, 0.2, 0.3))?, 0.12)?,
            [0.82, 0.73, 0.20],
            [2.2, 0.32, 1.9],
            turned(0.0, 0.9, 0.0),
        )?,
    ])
}

/// Point `i` of `count` spread over the unit sphere.
fn spiral(i: u32, count: u32) -> Vec3A {
    let z = 1.0 - (2 * i + 1) as f32 / count as f32;
    let (sine, cosine) = (f32::from_f64(2.399_963) * i as f32).sin_cos();
    let r = (1.0 - z * z).sqrt();
    Vec3A::new(r * cosine, z, r * sine)
}
