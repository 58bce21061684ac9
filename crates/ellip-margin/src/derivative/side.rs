//! A body in terms of the normal N, and the changes by its rotations with N held: t, m and b of [`super::contact`].

use crate::numerics::{Vec, dot};

/// The changes by unit rotations of a body about the axes of the world with N held; in 2D the first is the only one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turns {
    /// t.
    pub(super) t: [f64; 3],
    /// b on the tangent plane.
    pub(super) b: [[f64; 3]; 2],
    /// ½(m_θ·b_φ + m_φ·b_θ) + ht_θt_φ.
    pub(super) second: [[f64; 3]; 3],
}

/// One body in terms of N.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<const N: usize> {
    pub(super) axes: [Vec<N>; N],
    pub(super) a: Vec<N>,
    pub(super) e: Vec<N>,
    pub(super) h: f64,
    /// The tangents of the plane across N, in the body's axes.
    pub(super) tangents: [Vec<N>; 2],
}

impl<const N: usize> Side<N> {
    pub(super) fn new(axes: [Vec<N>; N], a: Vec<N>, e: Vec<N>, h: f64, tangents: &[Vec<N>; 2]) -> Self {
        Self { axes, a, e, h, tangents: tangents.map(|tangent| axes.map(|axis| dot(axis, tangent))) }
    }

    /// v = ∇h on the tangent plane: across N, from the centre to the point that touches.
    pub(super) fn reach(&self) -> [f64; 2] {
        let point: Vec<N> = core::array::from_fn(|i| self.a[i] * self.e[i]);
        self.tangents.map(|tangent| dot(tangent, point))
    }

    /// The planes i, j of the body's axes, in space those across axis 0, 1 and 2, and the unit rotations about the axes
    /// of the world in them: Wᵢⱼ of W = Rᵀ[ω]R.
    #[inline]
    fn planes(&self) -> [(usize, usize, [f64; 3]); 3] {
        let mut planes = [(0, 1, [0.0; 3]); 3];
        for (across, (i, j, w)) in planes.iter_mut().enumerate().take(N * (N - 1) / 2) {
            (*i, *j) = plane::<N>(across);
            for (about, w) in w.iter_mut().enumerate().take(N * (N - 1) / 2) {
                *w = wedge(self.axes[*j], self.axes[*i], about);
            }
        }
        planes
    }

    /// Rotations by Wᵢⱼ = 1 in one plane i, j of the body's axes have, with D = aⱼ² − aᵢ² and n/h = e/a,
    ///
    /// > t = −D(eᵢ/aᵢ)(eⱼ/aⱼ), b = D(eⱼ/aⱼ, eᵢ/aᵢ), m = (nⱼ, −nᵢ),
    ///
    /// so that m·b = D(nⱼ² − nᵢ²)/h, and for the planes across the axes k and l = k + 1, which have one axis in common,
    /// ½(m_k·b_l + m_l·b_k) = ½(D_k − D_l)n_kn_l/h. Changes about the axes of the world are sums of these by Wᵢⱼ.
    #[inline]
    pub(super) fn turns(&self) -> Turns {
        let (planes, rotations) = (self.planes(), N * (N - 1) / 2);
        let Self { a, e, h, .. } = self;
        let n: Vec<N> = core::array::from_fn(|i| e[i] / a[i]);
        let mut turns = Turns { t: [0.0; 3], b: [[0.0; 3]; 2], second: [[0.0; 3]; 3] };
        let (mut t, mut differences, mut second) = ([0.0; 3], [0.0; 3], [[0.0; 3]; 3]);
        for (k, &(i, j, w)) in planes.iter().enumerate().take(rotations) {
            let difference = (a[j] - a[i]) * (a[j] + a[i]);
            differences[k] = difference;
            t[k] = -(n[i] * n[j] * difference);
            second[k][k] = h * (difference * ((n[j] - n[i]) * (n[j] + n[i])));
            let b = self.tangents.map(|tangent| difference * (tangent[i] * n[j] + tangent[j] * n[i]));
            for about in 0..rotations {
                turns.t[about] += w[about] * t[k];
                turns.b[0][about] += w[about] * b[0];
                turns.b[1][about] += w[about] * b[1];
            }
        }
        if N == 3 {
            for k in 0..3 {
                let l = (k + 1) % 3;
                second[k][l] = 0.5 * h * (n[k] * n[l] * (differences[k] - differences[l]));
                second[l][k] = second[k][l];
            }
        }
        // Into the axes of the world: Wᵀ(second)W, and ht_θt_φ.
        for about in 0..rotations {
            let mut column = [0.0; 3];
            for k in 0..rotations {
                for l in 0..rotations {
                    column[k] += second[k][l] * planes[l].2[about];
                }
            }
            for other in 0..=about {
                let mut sum = h * (turns.t[other] * turns.t[about]);
                for k in 0..rotations {
                    sum += planes[k].2[other] * column[k];
                }
                turns.second[other][about] = sum;
                turns.second[about][other] = sum;
            }
        }
        turns
    }

    /// t for the unit rotations about the world axes, in 2D the only one.
    #[inline]
    pub(super) fn twists(&self) -> [f64; 3] {
        let Self { a, e, .. } = self;
        let mut twists = [0.0; 3];
        for &(i, j, w) in self.planes().iter().take(N * (N - 1) / 2) {
            let twist = (e[i] / a[i]) * (e[j] / a[j]) * ((a[j] - a[i]) * (a[j] + a[i]));
            for (t, w) in twists.iter_mut().zip(w) {
                *t -= w * twist;
            }
        }
        twists
    }
}

/// The plane across an axis, in 2D the only one.
#[inline]
fn plane<const N: usize>(across: usize) -> (usize, usize) {
    if N == 2 { (0, 1) } else { ((across + 1) % 3, (across + 2) % 3) }
}

/// y·(ω × x) = ω·(x × y) for the unit rotation about world axis number `about`, in 2D the only one.
#[inline]
pub(super) fn wedge<const N: usize>(x: Vec<N>, y: Vec<N>, about: usize) -> f64 {
    let (p, q) = plane::<N>(about);
    x[p] * y[q] - x[q] * y[p]
}

/// ω × x for the unit rotation about world axis number `about`, in 2D the only one.
pub(super) fn spun<const N: usize>(x: Vec<N>, about: usize) -> Vec<N> {
    let (p, q) = plane::<N>(about);
    let mut spun = [0.0; N];
    (spun[p], spun[q]) = (-x[q], x[p]);
    spun
}
