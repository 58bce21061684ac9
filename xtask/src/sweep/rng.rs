//! The random numbers of the sweep: splitmix64 (Steele, Lea and Flood, 2014), the same for the same seed.

use super::real::Vec3;

#[derive(Clone, Debug)]
pub(crate) struct Rng(u64);

impl Rng {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [−1, 1).
    pub(crate) fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2.0_f64.powi(-52) - 1.0
    }

    /// A whole number below `count`, nearly uniform.
    pub(crate) fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }

    /// Uniform on the unit sphere.
    pub(crate) fn sphere(&mut self) -> Vec3<f64> {
        loop {
            let v = [self.signed(), self.signed(), self.signed()];
            let squared: f64 = v.iter().map(|c| c * c).sum();
            if (1e-4..=1.0).contains(&squared) {
                return v.map(|c| c / squared.sqrt());
            }
        }
    }

    /// A uniform rotation, as a quaternion.
    pub(crate) fn rotation(&mut self) -> [f64; 4] {
        loop {
            let q = [self.signed(), self.signed(), self.signed(), self.signed()];
            let squared: f64 = q.iter().map(|c| c * c).sum();
            if (1e-4..=1.0).contains(&squared) {
                return q.map(|c| c / squared.sqrt());
            }
        }
    }
}
