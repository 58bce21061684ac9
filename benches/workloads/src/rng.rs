//! The random numbers of every workload, and of the report's and the sweep's questions: splitmix64, and what is drawn
//! from it.
//!
//! Values are made with `+ − × ÷ √` only, in the order written here and without fused multiply-adds, so that any
//! IEEE-754 program that follows this text draws the same bits.

use crate::vec3::{Quat, Vec3};

/// splitmix64, started at the seed (Steele, Lea & Flood, *Fast splittable pseudorandom number generators*, 2014).
#[derive(Clone, Debug)]
pub struct Rng(u64);

impl Rng {
    /// The generator whose state is `seed`.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1): the upper 53 bits times 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// Uniform in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// A whole number below `count`, nearly uniform.
    pub fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }

    /// Uniform in the cube [−1, 1)³.
    pub fn cube(&mut self) -> Vec3 {
        [self.signed(), self.signed(), self.signed()]
    }

    /// Uniform on the unit sphere, by rejection from the cube.
    pub fn sphere(&mut self) -> Vec3 {
        loop {
            let [x, y, z] = self.cube();
            let squared = x * x + y * y + z * z;
            if 1e-4 < squared && squared <= 1.0 {
                let length = squared.sqrt();
                return [x / length, y / length, z / length];
            }
        }
    }

    /// A uniform unit quaternion `(x, y, z, w)`, by rejection from the cube.
    pub fn quat(&mut self) -> Quat {
        loop {
            let (x, y, z, w) = (self.signed(), self.signed(), self.signed(), self.signed());
            let squared = x * x + y * y + z * z + w * w;
            if 1e-4 < squared && squared <= 1.0 {
                let length = squared.sqrt();
                return [x / length, y / length, z / length, w / length];
            }
        }
    }

    /// The sum of twelve uniform numbers minus six (Irwin–Hall): nearly normal, and no logarithm involved.
    pub fn normal(&mut self) -> f64 {
        let mut sum = 0.0;
        for _ in 0..12 {
            sum += self.unit();
        }
        sum - 6.0
    }
}

/// Rounded to `f32` and back, so that programs of both precisions see the same number.
#[must_use]
#[allow(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is the purpose")]
pub fn round_to_f32(x: f64) -> f64 {
    f64::from(x as f32)
}
