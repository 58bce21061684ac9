//! First and second derivatives at the stationary normal of [`super`]'s L.
//!
//! *First.* Since L is stationary in N, s changes as L does with N held. A turn ω of body k is N ↦ exp(−[ω])N in hₖ. In the
//! body's axes let W = Rₖᵀ[ω]Rₖ, and let e = diag(a)RₖᵀN/h be the point of the unit ball that touches. Then
//!
//! > ∂s/∂δ = ∓N for E₁, E₂, and ∂h = −ht, t = Σᵢⱼ eᵢWᵢⱼeⱼaᵢ/aⱼ = Σ over i < j of eᵢeⱼWᵢⱼ(aᵢ/aⱼ − aⱼ/aᵢ), ∂s = kht.
//!
//! *Second.* N follows the motion, N′ being its rate, by L_NN·N′ + L_Nθ − s′∇γ = 0 and ∇γ·N′ + γ_θ = 0. On the tangent plane
//! N^⊥ let A = −L_NN = k₀I/‖N‖ + k₁H₁ + k₂H₂, Hₖ = ∇²hₖ. Along N both sides vanish, by Euler's relation for homogeneous
//! functions. Eliminating N′ leaves for two motions θ and φ
//!
//! > s″ = L_θφ + q_θ·A⁻¹q_φ − s_θγ_φ − s_φγ_θ, q_θ = L_Nθ − s_θ∇γ on the tangent plane.
//!
//! With v = Rₖ·diag(a)e = ∇hₖ, n = RₖᵀN, m = Wn and bᵢ = Σⱼ Wᵢⱼ(eⱼ/aⱼ)(aⱼ² − aᵢ²) these are
//!
//! > L_Nδ = ∓δ, L_Nω = −k(Rₖb + vt), L_δδ = L_δω = 0, L_ωω = k(½(m_θ·b_φ + m_φ·b_θ) + ht_θt_φ), γ_ω = −gₖht.
//!
//! *Stiff bodies.* N turns with a needle, and against one: a turn with N held is then answered by an N′ that takes nearly all of L_ωω
//! back. So for the rotations of the body that is the stiffer of the two, N is taken as seen by that body. This is to turn all else by
//! −ω, so that t, m and b are those of the other body for −ω, and of r ↦ exp(−[ω])(r ∓ δ) there remain
//!
//! > L_Nω: −ω × r, L_ωω: −½((ω × N)·(φ × r) + (φ × N)·(ω × r)), L_δω: ∓δ·(ω × N).
//!
//! A ball has t = 0 and b = 0 to the last bit. Of A only the root is formed, A = MᵀM: xᵀHₖx = ‖e∧diag(a)Rₖᵀx‖²/h, so that the
//! rows of M are these products, and the triangle of M = QR has the aspect for its condition and not the square of that.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::numerics::{Vec, add, combine, dot, sub, unit};
use crate::pair::Pair;

/// Weights f and g of ‖N‖, h₁ and h₂: what is maximised, and what is 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quantity {
    objective: [f64; 3],
    constraint: [f64; 3],
}

impl Quantity {
    /// ρ = √(1 + m).
    pub(super) const GROWTH: Self = Self { objective: [0.0, 0.0, 1.0], constraint: [0.0, 1.0, 0.0] };
    /// d.
    pub(super) const DISTANCE: Self = Self { objective: [0.0, 1.0, 1.0], constraint: [1.0, 0.0, 0.0] };
    /// α.
    pub(super) const SCALE: Self = Self { objective: [0.0; 3], constraint: [0.0, 1.0, 1.0] };
}

/// Which of the two moves.
#[derive(Clone, Copy, Debug)]
pub(super) enum Mover {
    First,
    Second,
}

impl Mover {
    fn other(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
        }
    }

    /// Its place among ‖N‖, h₁, h₂.
    fn index(self) -> usize {
        match self {
            Self::First => 1,
            Self::Second => 2,
        }
    }
}

/// One body as N sees it.
#[derive(Clone, Copy, Debug)]
struct Side<const N: usize> {
    axes: [Vec<N>; N],
    a: Vec<N>,
    e: Vec<N>,
    h: f64,
    /// v = ∇h: from the centre to the point that touches.
    v: Vec<N>,
}

impl<const N: usize> Side<N> {
    fn new(axes: [Vec<N>; N], a: Vec<N>, e: Vec<N>, h: f64) -> Self {
        Self { axes, a, e, h, v: combine(axes, core::array::from_fn(|i| a[i] * e[i])) }
    }
}

/// The stationary normal, with all that the derivatives need.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact<const N: usize> {
    quantity: Quantity,
    /// r = x₂ − x₁.
    r: Vec<N>,
    normal: Vec<N>,
    sides: [Side<N>; 2],
    /// s.
    pub(super) value: f64,
    /// k = f + s·g.
    k: [f64; 3],
    /// Orthonormal, of the plane across N; in 2D the second is 0.
    tangents: [Vec<N>; 2],
    /// R of M = QR: r₁₁, r₁₂, r₂₂; in 2D the first only.
    root: [f64; 3],
}

/// What a motion changes: s, γ, and R⁻ᵀq.
#[derive(Clone, Copy, Debug)]
struct Rate<const N: usize> {
    value: f64,
    constraint: f64,
    whitened: [f64; 2],
    /// t, m and b of the body that L_ωω is written with.
    turn: Turn<N>,
    /// ω × N and ω × r where N is as seen by the body that moves, and ±2δ in place of ω × r.
    spun: [Vec<N>; 2],
}

/// t, m and b of a rotation.
#[derive(Clone, Copy, Debug)]
struct Turn<const N: usize> {
    t: f64,
    m: Vec<N>,
    b: Vec<N>,
}

impl<const N: usize> Contact<N> {
    /// At the normal along `direction`, from E₁ to E₂; `None` where that is not a direction.
    pub(super) fn new(pair: &Pair<N>, quantity: Quantity, direction: Vec<N>) -> Option<Self> {
        let e = heights(pair, direction).map(unit);
        Self::at_points(pair, quantity, direction, e)
    }

    /// The same where the points that touch, as unit vectors e of the two balls, are known better than from `direction`: turned
    /// into the axes of a needle it has lost the digits of its small coordinates.
    pub(super) fn at_points(
        pair: &Pair<N>,
        quantity: Quantity,
        direction: Vec<N>,
        [e1, e2]: [Vec<N>; 2],
    ) -> Option<Self> {
        let unit = unit(direction);
        let [h1, h2] = heights(pair, unit).map(|u| dot(u, u).sqrt());
        let gauge = weighted(quantity.constraint, [1.0, h1, h2]);
        let normal = unit.map(|x| x / gauge);
        let sides = [Side::new(pair.axes1, pair.a1, e1, h1 / gauge), Side::new(pair.axes2, pair.a2, e2, h2 / gauge)];
        let r = pair.r().map(|x| -x);
        let norm = 1.0 / gauge;
        let value = dot(normal, r) - weighted(quantity.objective, [norm, sides[0].h, sides[1].h]);
        let k = core::array::from_fn(|i| quantity.objective[i] + value * quantity.constraint[i]);
        let tangents = tangents(unit);
        let root = root(&tangents, k[0] / norm, [(&sides[0], k[1]), (&sides[1], k[2])]);
        value.is_finite().then_some(Self { quantity, r, normal, sides, value, k, tangents, root })
    }

    /// One step of Newton's method for N. An answer's value is stationary in N and may have been found with half its digits.
    /// Kept if it brings L nearer to being stationary: else what was left was rounding.
    pub(super) fn refined(self, pair: &Pair<N>) -> Self {
        let [x, y] = self.solved(self.whitened(self.residual()));
        let step: Vec<N> = core::array::from_fn(|i| x * self.tangents[0][i] + y * self.tangents[1][i]);
        match Self::new(pair, self.quantity, add(self.normal, step)) {
            Some(next) if next.slope() < 0.25 * self.slope() => next,
            _ => self,
        }
    }

    /// ∇L, which is r − k₁v₁ − k₂v₂ on the tangent plane.
    fn residual(&self) -> Vec<N> {
        let [first, second] = &self.sides;
        core::array::from_fn(|i| self.r[i] - self.k[1] * first.v[i] - self.k[2] * second.v[i])
    }

    fn slope(&self) -> f64 {
        let residual = self.residual();
        let [x, y] = self.tangents.map(|tangent| dot(tangent, residual));
        x.hypot(y)
    }

    /// R⁻ᵀ of the part of `x` in the tangent plane.
    fn whitened(&self, x: Vec<N>) -> [f64; 2] {
        let [r11, r12, r22] = self.root;
        let first = dot(self.tangents[0], x) / r11;
        if N == 2 { [first, 0.0] } else { [first, (dot(self.tangents[1], x) - r12 * first) / r22] }
    }

    /// R⁻¹x.
    fn solved(&self, x: [f64; 2]) -> [f64; 2] {
        let [r11, r12, r22] = self.root;
        let second = if N == 2 { 0.0 } else { x[1] / r22 };
        [(x[0] - r12 * second) / r11, second]
    }

    /// ∂s/∂δ in world axes, and ∂s/∂ω of the plane eᵢ∧eⱼ as kh·eᵢeⱼ(…): the factor −kh and e, for [`super::motion::torque`].
    pub(super) fn gradient(&self, mover: Mover) -> (Vec<N>, Vec<N>, f64) {
        let (side, k, sign) = self.of(mover);
        (self.normal.map(|x| -sign * x), side.e, -k * side.h)
    }

    /// The second derivatives s″ and the first s′: entry by entry, the translations first.
    pub(super) fn hessian(&self, mover: Mover) -> ([[f64; 6]; 6], [f64; 6]) {
        let count = N + N * (N - 1) / 2;
        let is_seen = self.is_stiffer(mover);
        let (side, k, _) = self.of(if is_seen { mover.other() } else { mover });
        let mut rates = [Rate::ZERO; 6];
        let (mut second, mut first) = ([[0.0; 6]; 6], [0.0; 6]);
        for i in 0..count {
            rates[i] = if i < N { self.translation(mover, i) } else { self.rotation(mover, i - N, is_seen) };
            first[i] = rates[i].value;
            for j in 0..=i {
                let (x, y) = (&rates[i], &rates[j]);
                let followed = x.whitened[0] * y.whitened[0] + x.whitened[1] * y.whitened[1];
                let mut entry = followed - (x.value * y.constraint + y.value * x.constraint);
                // L_θφ; two translations have none.
                if i >= N {
                    entry += k * (0.5 * (dot(x.turn.m, y.turn.b) + dot(y.turn.m, x.turn.b)))
                        + k * side.h * (x.turn.t * y.turn.t)
                        - 0.5 * (dot(x.spun[0], y.spun[1]) + dot(y.spun[0], x.spun[1]));
                }
                (second[i][j], second[j][i]) = (entry, entry);
            }
        }
        (second, first)
    }

    /// Whether L_ωω of the body that moves is the greater: about k·(a_max² − a_min²)‖N‖²/h.
    fn is_stiffer(&self, mover: Mover) -> bool {
        let stiffness = |mover: Mover| {
            let (side, k, _) = self.of(mover);
            let (least, most) = side.a.iter().fold((side.a[0], side.a[0]), |(l, m), a| (l.min(*a), m.max(*a)));
            k * (most - least) * (most + least) / side.h
        };
        stiffness(mover) > stiffness(mover.other())
    }

    fn translation(&self, mover: Mover, along: usize) -> Rate<N> {
        let (.., sign) = self.of(mover);
        let delta: Vec<N> = core::array::from_fn(|i| if i == along { sign } else { 0.0 });
        let value = -sign * self.normal[along];
        Rate {
            value,
            constraint: 0.0,
            whitened: self.followed(delta.map(|x| -x), value),
            turn: Turn::ZERO,
            spun: [[0.0; N], delta.map(|x| 2.0 * x)],
        }
    }

    /// The rotation about a world axis, with N as the body sees it or N held.
    fn rotation(&self, mover: Mover, about: usize, is_seen: bool) -> Rate<N> {
        let (side, k, _) = self.of(mover);
        let turn = Turn::new(side, about, 1.0);
        let value = k * side.h * turn.t;
        let nothing = [[0.0; N]; 2];
        let (turned, turn, spun) = if is_seen {
            let other = mover.other();
            let turn = Turn::new(self.of(other).0, about, -1.0);
            (other, turn, [self.normal, self.r].map(|x| spun(x, about)))
        } else {
            (mover, turn, nothing)
        };
        let (side, k, _) = self.of(turned);
        let weight = self.quantity.constraint[turned.index()];
        let b = combine(side.axes, turn.b);
        let cross = core::array::from_fn(|i| -k * (b[i] + side.v[i] * turn.t) - spun[1][i]);
        Rate { value, constraint: -weight * side.h * turn.t, whitened: self.followed(cross, value), turn, spun }
    }

    /// R⁻ᵀq for L_Nθ and s_θ; of ∇γ, the part along ‖N‖ has none in the tangent plane.
    fn followed(&self, cross: Vec<N>, value: f64) -> [f64; 2] {
        let [_, g1, g2] = self.quantity.constraint;
        let [first, second] = &self.sides;
        let gradient: Vec<N> = core::array::from_fn(|i| value * (g1 * first.v[i] + g2 * second.v[i]));
        self.whitened(sub(cross, gradient))
    }

    /// The body, its k, and the sign with which its translation shortens r.
    fn of(&self, mover: Mover) -> (&Side<N>, f64, f64) {
        match mover {
            Mover::First => (&self.sides[0], self.k[1], 1.0),
            Mover::Second => (&self.sides[1], self.k[2], -1.0),
        }
    }
}

impl<const N: usize> Rate<N> {
    const ZERO: Self = Self { value: 0.0, constraint: 0.0, whitened: [0.0; 2], turn: Turn::ZERO, spun: [[0.0; N]; 2] };
}

impl<const N: usize> Turn<N> {
    const ZERO: Self = Self { t: 0.0, m: [0.0; N], b: [0.0; N] };

    /// Of `sign` times the unit rotation about world axis number `about`, in 2D the only one.
    fn new(side: &Side<N>, about: usize, sign: f64) -> Self {
        let Side { axes, a, e, h, .. } = *side;
        let spun = axes.map(|axis| spun(axis, about));
        let (mut t, mut m, mut b) = (0.0, [0.0; N], [0.0; N]);
        for i in 0..N {
            for j in (0..N).filter(|&j| j != i) {
                // Wᵢⱼnⱼ/h with W = Rᵀ[ω]R, n/h = e/a
                let n = sign * dot(axes[i], spun[j]) * (e[j] / a[j]);
                let difference = (a[j] - a[i]) * (a[j] + a[i]);
                m[i] += n * h;
                b[i] += n * difference;
                // Each plane once.
                t -= if i < j { n * (e[i] / a[i]) * difference } else { 0.0 };
            }
        }
        Self { t, m, b }
    }
}

/// ω × x for the unit rotation about world axis number `about`, in 2D the only one.
fn spun<const N: usize>(x: Vec<N>, about: usize) -> Vec<N> {
    let (p, q) = if N == 2 { (0, 1) } else { ((about + 1) % 3, (about + 2) % 3) };
    let mut spun = [0.0; N];
    (spun[p], spun[q]) = (-x[q], x[p]);
    spun
}

/// diag(a)Rᵀn for both bodies: vectors of length h.
fn heights<const N: usize>(pair: &Pair<N>, n: Vec<N>) -> [Vec<N>; 2] {
    [
        core::array::from_fn(|i| pair.a1[i] * dot(pair.axes1[i], n)),
        core::array::from_fn(|i| pair.a2[i] * dot(pair.axes2[i], n)),
    ]
}

fn weighted(weights: [f64; 3], x: [f64; 3]) -> f64 {
    weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2]
}

/// An orthonormal basis of the plane across the unit vector `n`: in 2D n turned, in 3D the two columns of a reflection that takes a
/// world axis to ±n.
fn tangents<const N: usize>(n: Vec<N>) -> [Vec<N>; 2] {
    if N == 2 {
        return [core::array::from_fn(|i| if i == 0 { -n[1] } else { n[0] }), [0.0; N]];
    }
    let along = (1..N).fold(0, |m, i| if n[i].abs() > n[m].abs() { i } else { m });
    // I − uuᵀ/u_k with u = n ± e_k, u·u = 2|u_k|
    let mut u = n;
    u[along] += 1f64.copysign(n[along]);
    [1, 2].map(|next| {
        let column = (along + next) % N;
        core::array::from_fn(|i| f64::from(u8::from(i == column)) - u[i] * u[column] / u[along].abs())
    })
}

/// R of M = QR, MᵀM = A on the tangent plane.
fn root<const N: usize>(tangents: &[Vec<N>; 2], isotropic: f64, sides: [(&Side<N>, f64); 2]) -> [f64; 3] {
    // Up to two rows of the isotropic part, and a row per body and plane of its axes.
    let mut columns = [[0.0; 8]; 2];
    for (c, (column, tangent)) in columns.iter_mut().zip(tangents).take(N - 1).enumerate() {
        column[c] = isotropic.max(0.0).sqrt();
        let mut row = 2;
        for (side, k) in sides {
            let weight = (k.max(0.0) / side.h).sqrt();
            let y: Vec<N> = core::array::from_fn(|i| side.a[i] * dot(side.axes[i], *tangent));
            for i in 0..N {
                for j in i + 1..N {
                    column[row] = weight * (side.e[i] * y[j] - side.e[j] * y[i]);
                    row += 1;
                }
            }
        }
    }
    let [first, second] = columns;
    let r11 = dot(first, first).sqrt();
    let r12 = dot(first, second) / r11;
    let rest: Vec<8> = core::array::from_fn(|i| second[i] - r12 * (first[i] / r11));
    [r11, r12, dot(rest, rest).sqrt()]
}
