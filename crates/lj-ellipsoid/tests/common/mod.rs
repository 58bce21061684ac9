//! Fixed-seed point sets shared by the tests.

use lj_ellipsoid::{Ellipsoid, Enclosing};
use proptest::prelude::ProptestConfig;
use proptest::test_runner::{RngSeed, contextualize_config};

/// The configuration of property tests that draw the same cases in every run, as that of convex-support, unless
/// `PROPTEST_RNG_SEED` or `PROPTEST_CASES` say otherwise.
pub(crate) fn config(cases: u32) -> ProptestConfig {
    let rng_seed = RngSeed::Fixed(20_041_120);
    contextualize_config(ProptestConfig { cases, rng_seed, ..ProptestConfig::default() })
}

/// A small generator (splitmix64), so that the sets are the same everywhere.
pub(crate) struct Rng(pub(crate) u64);

impl Rng {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [−1, 1).
    pub(crate) fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Standard normal.
    pub(crate) fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (std::f64::consts::TAU * self.unit()).cos()
    }

    pub(crate) fn normals<const N: usize>(&mut self, m: usize) -> Vec<[f64; N]> {
        (0..m).map(|_| std::array::from_fn(|_| self.normal())).collect()
    }

    /// On the unit sphere.
    pub(crate) fn sphere<const N: usize>(&mut self, m: usize) -> Vec<[f64; N]> {
        self.normals::<N>(m)
            .into_iter()
            .map(|x| {
                let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
                x.map(|x| x / length)
            })
            .collect()
    }

    /// In the unit ball.
    pub(crate) fn ball<const N: usize>(&mut self, m: usize) -> Vec<[f64; N]> {
        self.sphere::<N>(m)
            .into_iter()
            .map(|x| {
                let radius = self.unit().powf(1.0 / N as f64);
                x.map(|x| x * radius)
            })
            .collect()
    }

    /// A rotation, rows orthonormal.
    pub(crate) fn rotation<const N: usize>(&mut self) -> [[f64; N]; N] {
        let mut rows: Vec<[f64; N]> = Vec::new();
        while rows.len() < N {
            let mut v: [f64; N] = std::array::from_fn(|_| self.normal());
            for row in &rows {
                let along: f64 = row.iter().zip(&v).map(|(a, b)| a * b).sum();
                v.iter_mut().zip(row).for_each(|(x, r)| *x -= along * r);
            }
            let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            rows.push(v.map(|x| x / length));
        }
        std::array::from_fn(|k| rows[k])
    }
}

/// M·x.
pub(crate) fn apply<const N: usize>(m: &[[f64; N]; N], x: [f64; N]) -> [f64; N] {
    std::array::from_fn(|i| (0..N).map(|k| m[i][k] * x[k]).sum())
}

/// The corners of the box between `low` and `high`.
pub(crate) fn corners<const N: usize>(low: [f64; N], high: [f64; N]) -> Vec<[f64; N]> {
    (0..1usize << N).map(|i| std::array::from_fn(|k| if i >> k & 1 == 1 { high[k] } else { low[k] })).collect()
}

/// (x − c)ᵀX(x − c) in the plainest order.
pub(crate) fn level<const N: usize>(e: &Ellipsoid<N>, x: [f64; N]) -> f64 {
    let (c, m) = (e.center(), e.matrix());
    let mut sum = 0.0;
    for i in 0..N {
        for j in 0..N {
            sum += (x[i] - c[i]) * m[i][j] * (x[j] - c[j]);
        }
    }
    sum
}

/// Every point inside, by the axes and by the matrix.
#[track_caller]
pub(crate) fn assert_contains<const N: usize>(answer: &Enclosing<N>, points: &[[f64; N]]) {
    for (i, &x) in points.iter().enumerate() {
        assert!(answer.ellipsoid.contains(x), "point {i} at radius {}", answer.ellipsoid.radius_at(x));
        let level = level(&answer.ellipsoid, x);
        assert!(level <= 1.0, "point {i} at level {level} of the matrix");
    }
}

#[track_caller]
pub(crate) fn assert_near(what: &str, got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance, "{what}: {got}, not {want} (off by {:e})", (got - want).abs());
}
