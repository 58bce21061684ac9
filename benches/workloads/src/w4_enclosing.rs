//! W4: points to be enclosed by an ellipsoid; other clouds, boxes and half-spaces for the same benches.

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

/// The same points as arrays.
#[must_use]
pub fn cloud<const N: usize>(kind: Cloud, count: usize) -> Vec<[f64; N]> {
    points(kind, N, count).as_chunks::<N>().0.to_vec()
}

/// `count` points uniform on the unit sphere.
#[must_use]
pub fn on_sphere<const N: usize>(count: usize) -> Vec<[f64; N]> {
    let mut rng = Rng::new(60_000 + 10 * N as u64);
    (0..count)
        .map(|_| {
            let (x, square) = within(&mut rng);
            x.map(|x| x / square.sqrt())
        })
        .collect()
}

/// `count` points uniform in the unit ball.
#[must_use]
pub fn in_ball<const N: usize>(count: usize) -> Vec<[f64; N]> {
    let mut rng = Rng::new(60_001 + 10 * N as u64);
    (0..count).map(|_| within(&mut rng).0).collect()
}

/// A point of the unit ball but its very middle, by rejection, with its square.
fn within<const N: usize>(rng: &mut Rng) -> ([f64; N], f64) {
    loop {
        let x: [f64; N] = std::array::from_fn(|_| rng.signed());
        let square: f64 = x.iter().map(|x| x * x).sum();
        if 1e-4 < square && square <= 1.0 {
            return (x, square);
        }
    }
}

/// The corners of the box with a corner at the origin and these sides.
#[must_use]
pub fn corners<const N: usize>(sides: [f64; N]) -> Vec<[f64; N]> {
    (0..1_usize << N).map(|i| std::array::from_fn(|k| if i >> k & 1 == 1 { sides[k] } else { 0.0 })).collect()
}

/// `count` half-spaces `normal·x ≤ offset` at 1 to 1.5 from the origin, so that all of them may matter: normal and
/// offset.
#[must_use]
pub fn halfspaces<const N: usize>(count: usize) -> Vec<([f64; N], f64)> {
    let mut rng = Rng::new(70_000 + 10 * N as u64);
    (0..count)
        .map(|_| {
            let normal: [f64; N] = std::array::from_fn(|_| rng.normal());
            let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
            (normal.map(|x| x / length), 1.25 + 0.25 * rng.signed())
        })
        .collect()
}
