//! The robot as a film strip, by this library's own ray casts: links and obstacles are their hulls, the ellipsoids
//! around the links are glass.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

use convex_support::glam::{DMat3, DQuat, DVec2, DVec3};
use convex_support::{
    Capsule, Ellipsoid, InvalidShape, Posed, Rounded, Segment, SupportMap, line_crossing, support_value,
};
use gjk_raycast::{Ray, RayCastOptions, Scene};
use rayon::prelude::*;

use super::body::Placed;
use super::picture::{OBSTACLE, State, view};

/// The robot at a time.
#[derive(Debug)]
pub(super) struct Moment {
    pub(super) links: Vec<(Placed, State)>,
}

/// The width and height of a picture in pixels, the rays for each along both, and the white between pictures.
const SIZE: [usize; 2] = [400, 420];
const SAMPLES: usize = 2;
const GAP: usize = 6;

/// Towards the light.
const SUN: DVec3 = DVec3::new(0.8, -0.5, 1.4);

/// The squares of the floor, and the length of the arrows along the axes, in metres; and where on the floor the arrows
/// are, beside the robot rather than within it.
const SQUARE: f64 = 0.1;
const AXIS: f64 = 0.2;
const ASIDE: DVec2 = DVec2::new(0.03, -0.53);

/// The way of the hand is drawn in pieces of so many rows.
const PIECE: usize = 4;

const WHITE: DVec3 = DVec3::ONE;

type Shape = Box<dyn SupportMap<Vector = DVec3> + Send + Sync>;

/// Draws the moments side by side, and in each the way that the last link takes.
pub(super) fn write(moments: &[Moment], obstacles: &[Placed], way: &[DVec3], file: &Path) -> io::Result<()> {
    let stages = moments.iter().map(|moment| Stage::new(moment, obstacles, way)).collect::<Result<Vec<_>, _>>();
    let stages = stages.map_err(io::Error::other)?;
    let camera = Camera::around(moments, obstacles, way);
    let width = moments.len() * (SIZE[0] + GAP) - GAP;
    let row = |y: usize| -> Vec<u8> {
        let pixel = |x: usize| match stages.get(x / (SIZE[0] + GAP)) {
            Some(stage) if x % (SIZE[0] + GAP) < SIZE[0] => camera.pixel(x % (SIZE[0] + GAP), y, stage),
            _ => WHITE,
        };
        (0..width).flat_map(|x| pixel(x).to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)).collect()
    };
    let rows: Vec<Vec<u8>> = (0..SIZE[1]).into_par_iter().map(row).collect();
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(file)?), width as u32, SIZE[1] as u32);
    encoder.set_color(png::ColorType::Rgb);
    Ok(encoder.write_header()?.write_image_data(&rows.concat())?)
}

/// What is seen in one picture.
struct Stage {
    scene: Scene<Shape>,
    /// The colour of each body.
    colours: Vec<DVec3>,
    glass: Vec<(Ellipsoid<DVec3>, DVec3)>,
    floor: f64,
}

impl Stage {
    fn new(moment: &Moment, obstacles: &[Placed], way: &[DVec3]) -> Result<Self, String> {
        let floor = -obstacles.iter().map(|o| support_value(&o.hull, DVec3::NEG_Z)).fold(0.0, f64::max);
        let (mut shapes, mut colours): (Vec<Shape>, Vec<DVec3>) = (Vec::new(), Vec::new());
        let mut add = |shape: Shape, colour: DVec3| {
            shapes.push(shape);
            colours.push(colour);
        };
        for (link, state) in &moment.links {
            add(Box::new(link.hull.clone()), colour(state.colour()).lerp(WHITE, 0.35));
        }
        for obstacle in obstacles {
            add(Box::new(obstacle.hull.clone()), colour(OBSTACLE).lerp(WHITE, 0.25));
        }
        let failed = |why: InvalidShape| why.to_string();
        for ends in way.iter().step_by(PIECE).collect::<Vec<_>>().windows(2) {
            let piece = Segment::new([*ends[0], *ends[1]]).and_then(|piece| Rounded::new(piece, 0.004));
            add(Box::new(piece.map_err(failed)?), DVec3::splat(0.2));
        }
        for (axis, colour) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().zip(DMat3::IDENTITY.to_cols_array_2d()) {
            let arrow = Capsule::new(AXIS / 2.0, 0.007).map_err(failed)?;
            let arrow =
                Posed::new(arrow, DQuat::from_rotation_arc(DVec3::Y, axis), ASIDE.extend(floor) + axis * (AXIS / 2.0));
            add(Box::new(arrow.map_err(failed)?), DVec3::from(colour) * 0.8);
        }
        let glass = moment.links.iter().map(|(link, state)| (link.outer, colour(state.colour()))).collect();
        Ok(Self { scene: Scene::new(shapes).map_err(|why| why.to_string())?, colours, glass, floor })
    }

    /// The colour that comes back along a ray.
    fn seen(&self, ray: Ray<DVec3>) -> DVec3 {
        let first = self.scene.all().ray_cast(ray, RayCastOptions::default()).ok().and_then(|cast| cast.first);
        let on_body = first.and_then(|first| Some((first.hit.lambda, first.hit.normal?, self.colours[first.body])));
        let (far, mut seen) = match on_body.or_else(|| self.on_floor(ray)) {
            Some((lambda, normal, colour)) => {
                let shadow = Ray { source: ray.at(lambda) + normal * 1e-5, direction: SUN };
                let dark = self.scene.all().any_hit(shadow, RayCastOptions::default()).is_ok_and(|answer| answer.hit);
                let sunlight = if dark { 0.0 } else { normal.dot(SUN.normalize()).max(0.0) };
                (lambda, colour * (0.5 + 0.5 * sunlight))
            }
            None => (f64::INFINITY, WHITE),
        };
        // From the back to the front, and more of it where the glass is seen from the side.
        let crossing = |(body, colour): &(Ellipsoid<DVec3>, DVec3)| {
            let crossing = line_crossing(body, ray.source, ray.direction).crossing()?;
            (crossing.entry < far).then(|| (crossing.entry, crossing.normal.dot(ray.direction).abs(), *colour))
        };
        let mut panes: Vec<(f64, f64, DVec3)> = self.glass.iter().filter_map(crossing).collect();
        panes.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, facing, colour) in panes {
            seen = seen.lerp(colour, 0.1 + 0.35 * (1.0 - facing).powi(3));
        }
        seen
    }

    /// Where a ray meets the floor, a disc around the robot with squares on it.
    fn on_floor(&self, ray: Ray<DVec3>) -> Option<(f64, DVec3, DVec3)> {
        let lambda = (self.floor - ray.source.z) / ray.direction.z;
        let spot = ray.at(lambda);
        let is_line = |x: f64| (x / SQUARE - (x / SQUARE).round()).abs() < 0.02;
        let grey = if is_line(spot.x) || is_line(spot.y) { 0.78 } else { 0.95 };
        (lambda > 0.0 && spot.truncate().length() < 1.2).then_some((lambda, DVec3::Z, DVec3::splat(grey)))
    }
}

/// Looks along one direction, without perspective, so that lengths can be compared.
struct Camera {
    axes: DMat3,
    /// The middle of the picture, along its axes, and the length of a pixel.
    center: DVec3,
    pixel: f64,
}

impl Camera {
    /// Sees all that moves and all that is in its way.
    fn around(moments: &[Moment], obstacles: &[Placed], way: &[DVec3]) -> Self {
        let axes = view().transpose();
        let links = moments.iter().flat_map(|moment| moment.links.iter().map(|(link, _)| link));
        let reach = |axis: DVec3| {
            let bodies = obstacles.iter().chain(links.clone()).map(|body| support_value(&body.outer, axis));
            bodies.chain(way.iter().map(|at| axis.dot(*at))).fold(f64::NEG_INFINITY, f64::max)
        };
        let (high, low) = ([0, 1].map(|k| reach(axes.col(k))), [0, 1].map(|k| -reach(-axes.col(k))));
        let pixel = (0..2).map(|k| 1.04 * (high[k] - low[k]) / SIZE[k] as f64).fold(0.0, f64::max);
        let middle = [0, 1].map(|k| f64::midpoint(high[k], low[k]));
        Self { axes, center: DVec3::new(middle[0], middle[1], -10.0), pixel }
    }

    fn pixel(&self, x: usize, y: usize, stage: &Stage) -> DVec3 {
        let part = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
        let samples = (0..SAMPLES * SAMPLES).map(|k| {
            let right = x as f64 + part(k % SAMPLES) - SIZE[0] as f64 / 2.0;
            let down = y as f64 + part(k / SAMPLES) - SIZE[1] as f64 / 2.0;
            let source = self.axes * (self.center + DVec3::new(right, -down, 0.0) * self.pixel);
            stage.seen(Ray { source, direction: self.axes.z_axis })
        });
        samples.sum::<DVec3>() / (SAMPLES * SAMPLES) as f64
    }
}

/// A colour as `#rrggbb`.
fn colour(text: &str) -> DVec3 {
    let part = |k: usize| text.get(k..k + 2).and_then(|hex| u8::from_str_radix(hex, 16).ok()).unwrap_or_default();
    DVec3::new(part(1).into(), part(3).into(), part(5).into()) / 255.0
}
