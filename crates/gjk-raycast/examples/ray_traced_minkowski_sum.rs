//! What does the sum of a cone and an ellipsoid look like? One ray cast per pixel, shaded by the normal.
//!
//! ```text
//! cargo run --release -p gjk-raycast --example ray_traced_minkowski_sum                # in letters
//! cargo run --release -p gjk-raycast --example ray_traced_minkowski_sum -- sum.ppm     # as a picture
//! ```

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Cone, Ellipsoid, MinkowskiSum, Posed, SupportMap};
use gjk_raycast::{Ray, RayCastError, RayCastOptions, ray_cast};

/// How bright each pixel is, from 0 to 1; `None` beside the shape. Row by row, `aspect` being a pixel's height by its
/// width.
fn render(
    shape: &impl SupportMap<Vector = DVec3>,
    (width, height): (usize, usize),
    aspect: f64,
) -> Result<Vec<Option<f64>>, RayCastError> {
    let light = DVec3::new(-0.5, 0.8, 0.6).normalize();
    let mut options = RayCastOptions::new();
    let mut pixels = Vec::with_capacity(width * height);
    for row in 0..height {
        for column in 0..width {
            let right = (column as f64 + 0.5 - width as f64 / 2.0) / width as f64;
            let up = -(row as f64 + 0.5 - height as f64 / 2.0) / width as f64 * aspect;
            let ray = Ray { source: DVec3::new(0.0, 0.0, 10.0), direction: DVec3::new(right, up, -2.2) };
            let hit = ray_cast(shape, ray, options)?.outcome.hit();
            if let Some(normal) = hit.and_then(|hit| hit.normal) {
                options = options.with_axis(normal); // the next pixel's is much like it
            }
            pixels.push(hit.map(|hit| 0.15 + 0.85 * hit.normal.map_or(0.0, |n| n.dot(light).max(0.0))));
        }
    }
    Ok(pixels)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cone = Cone::new(1.0, 1.0)?;
    let disc = Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 0.15, 0.6), DQuat::IDENTITY)?;
    let sum = Posed::new(MinkowskiSum::new(cone, disc), DQuat::from_rotation_x(0.5), DVec3::ZERO)?;

    if let Some(file) = std::env::args_os().nth(1) {
        let size = (960, 720);
        let mut picture = format!("P5\n{} {}\n255\n", size.0, size.1).into_bytes();
        picture.extend(render(&sum, size, 1.0)?.iter().map(|pixel| pixel.map_or(24, |light| (255.0 * light) as u8)));
        std::fs::write(file, picture)?;
        return Ok(());
    }

    const SHADES: &[u8] = b".:-=+*#%@";
    let size = (76, 30); // letters are about twice as high as wide
    let pixels = render(&sum, size, 2.0)?;
    for row in pixels.chunks(size.0) {
        let letter =
            |pixel: &Option<f64>| pixel.map_or(' ', |l| SHADES[(l * (SHADES.len() - 1) as f64) as usize] as char);
        println!("{}", row.iter().map(letter).collect::<String>().trim_end());
    }
    let covered = pixels.iter().flatten().count();
    assert!(pixels.len() / 5 < covered && covered < pixels.len() * 4 / 5, "{covered} pixels show the shape");
    assert!(pixels[0].is_none() && pixels[pixels.len() / 2 + size.0 / 2].is_some(), "it is in the middle");
    Ok(())
}
