//! W5: pairs of ellipsoids whose free margin is asked for.

use crate::rng::Rng;
use crate::vec3::{rotate, scale};

/// How many pairs [`pairs2`] and [`pairs3`] make.
pub const PAIRS: usize = 2_000;

/// Two ellipsoids in the frame in which the first is the unit ball: the second is `{ translation + map·y : |y| ≤ 1 }`.
#[derive(Clone, Copy, Debug)]
pub struct EllipsoidPair<const N: usize> {
    /// The linear map `M`, by rows.
    pub map: [[f64; N]; N],
    /// The centre `t` of the second ellipsoid.
    pub translation: [f64; N],
}

/// The condition number of the shape matrices: the square of the longest semi-axis over the shortest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// 1e2: semi-axes from 1 to 0.1.
    Mild,
    /// 1e6: semi-axes from 1 to 0.001.
    Stiff,
}

impl Condition {
    fn index(self) -> u64 {
        match self {
            Self::Mild => 0,
            Self::Stiff => 1,
        }
    }

    fn shortest_semi_axis(self) -> f64 {
        match self {
            Self::Mild => 1.0 / 100.0_f64.sqrt(),
            Self::Stiff => 1.0 / 1e6_f64.sqrt(),
        }
    }
}

/// Ellipsoids in space: the middle semi-axis is uniform between the others, the centres are 3 apart.
#[must_use]
pub fn pairs3(condition: Condition) -> Vec<EllipsoidPair<3>> {
    let shortest = condition.shortest_semi_axis();
    let mut rng = Rng::new(60_030 + condition.index());
    let ellipsoid = |rng: &mut Rng| {
        let semi_axes = [1.0, shortest + (1.0 - shortest) * rng.unit(), shortest];
        let q = rng.quat();
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| rotate(q, axis));
        Axes { semi_axes, columns }
    };
    (0..PAIRS)
        .map(|_| {
            let (first, second) = (ellipsoid(&mut rng), ellipsoid(&mut rng));
            first.as_unit_ball(&second, scale(rng.sphere(), 3.0))
        })
        .collect()
}

/// Ellipses in the plane. Their centres are 3 apart in space and then projected, so that some are nearer and overlap.
#[must_use]
pub fn pairs2(condition: Condition) -> Vec<EllipsoidPair<2>> {
    let shortest = condition.shortest_semi_axis();
    let mut rng = Rng::new(60_020 + condition.index());
    let ellipse = |rng: &mut Rng| {
        let [c, s] = circle(rng);
        Axes { semi_axes: [1.0, shortest], columns: [[c, s], [-s, c]] }
    };
    (0..PAIRS)
        .map(|_| {
            let (first, second) = (ellipse(&mut rng), ellipse(&mut rng));
            let [x, y, _] = scale(rng.sphere(), 3.0);
            first.as_unit_ball(&second, [x, y])
        })
        .collect()
}

/// Uniform on the unit circle, by rejection from the square.
fn circle(rng: &mut Rng) -> [f64; 2] {
    loop {
        let (x, y) = (rng.signed(), rng.signed());
        let squared = x * x + y * y;
        if 1e-4 < squared && squared <= 1.0 {
            let length = squared.sqrt();
            return [x / length, y / length];
        }
    }
}

/// An ellipsoid about the origin.
struct Axes<const N: usize> {
    semi_axes: [f64; N],
    /// The unit vectors along the semi-axes.
    columns: [[f64; N]; N],
}

impl<const N: usize> Axes<N> {
    /// The pair of `self` and `other` moved to `center`: `M = D₁⁻¹R₁ᵀ·R₂D₂` and `t = D₁⁻¹R₁ᵀ·center`.
    fn as_unit_ball(&self, other: &Self, center: [f64; N]) -> EllipsoidPair<N> {
        let dot = |a: [f64; N], b: [f64; N]| (1..N).fold(a[0] * b[0], |sum, k| sum + a[k] * b[k]);
        let row = |i: usize| {
            std::array::from_fn(|j| dot(self.columns[i], other.columns[j]) / self.semi_axes[i] * other.semi_axes[j])
        };
        EllipsoidPair {
            map: std::array::from_fn(row),
            translation: std::array::from_fn(|i| dot(self.columns[i], center) / self.semi_axes[i]),
        }
    }
}

/// The pairs as a file: `M` row by row, then `t`, for each.
#[must_use]
pub fn records<const N: usize>(pairs: &[EllipsoidPair<N>]) -> Vec<f64> {
    pairs.iter().flat_map(|pair| pair.map.into_iter().flatten().chain(pair.translation)).collect()
}
