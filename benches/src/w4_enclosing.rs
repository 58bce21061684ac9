//! W4: points to be enclosed by an ellipsoid.

use crate::rng::Rng;

/// How the points are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cloud {
    /// Nearly normal: few points are far out.
    Normal,
    /// Uniform in the cube [−1, 1)ⁿ: many points are near a corner.
    Cube,
}

/// Dimension and number of points of each instance; each exists as either [`Cloud`].
pub const SIZES: [(usize, usize); 9] =
    [(2, 8), (2, 100), (2, 10_000), (2, 1_000_000), (3, 8), (3, 100), (3, 10_000), (3, 1_000_000), (10, 10_000)];

/// `count` points of `dimension` coordinates, point after point.
#[must_use]
pub fn points(cloud: Cloud, dimension: usize, count: usize) -> Vec<f64> {
    let kind = match cloud {
        Cloud::Normal => 0,
        Cloud::Cube => 1,
    };
    let magnitude = (count as f64).log10().round() as u64;
    let mut rng = Rng::new(50_000 + 1_000 * dimension as u64 + 10 * magnitude + kind);
    let draw = match cloud {
        Cloud::Normal => Rng::normal,
        Cloud::Cube => Rng::signed,
    };
    (0..dimension * count).map(|_| draw(&mut rng)).collect()
}
