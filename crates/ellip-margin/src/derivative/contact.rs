//! First and second derivatives at the stationary normal of [`super`]'s L.
//!
//! *First.* Since L is stationary in N, s changes as L does with N held. A turn ω of body k is N ↦ exp(−[ω])N in hₖ. In
//! the body's axes let W = Rₖᵀ[ω]Rₖ, and let e = diag(a)RₖᵀN/h be the point of the unit ball that touches. Then
//!
//! > ∂s/∂δ = ∓N for E₁, E₂, and ∂h = −ht, t = Σᵢⱼ eᵢWᵢⱼeⱼaᵢ/aⱼ = Σ over i < j of eᵢeⱼWᵢⱼ(aᵢ/aⱼ − aⱼ/aᵢ), ∂s = kht.
//!
//! *Second.* N follows the motion, N′ being its rate, by L_NN·N′ + L_Nθ − s′∇γ = 0 and ∇γ·N′ + γ_θ = 0. On the tangent
//! plane N^⊥ let A = −L_NN = k₀I/‖N‖ + k₁H₁ + k₂H₂, Hₖ = ∇²hₖ. Along N both sides vanish, by Euler's relation for
//! homogeneous functions. Eliminating N′ leaves for two motions θ and φ
//!
//! > s″ = L_θφ + q_θ·A⁻¹q_φ − s_θγ_φ − s_φγ_θ, q_θ = L_Nθ − s_θ∇γ on the tangent plane.
//!
//! With v = Rₖ·diag(a)e = ∇hₖ, n = RₖᵀN, m = Wn and bᵢ = Σⱼ Wᵢⱼ(eⱼ/aⱼ)(aⱼ² − aᵢ²) these are
//!
//! > L_Nδ = ∓δ, L_Nω = −k(Rₖb + vt), L_δδ = L_δω = 0, L_ωω = k(½(m_θ·b_φ + m_φ·b_θ) + ht_θt_φ), γ_ω = −gₖht.
//!
//! *Stiff bodies.* N turns with a needle, and against one: a turn with N held then causes an N′ that takes nearly all
//! of L_ωω back. So for the rotations of the stiffer body, if it is stiffer than the bodies are apart, N is taken as
//! seen by that body. This turns all else by −ω, so that t, m and b are those of the other body for −ω, and of r ↦
//! exp(−[ω])(r ∓ δ) there remain
//!
//! > L_Nω: −ω × r, L_ωω: −½((ω × N)·(φ × r) + (φ × N)·(ω × r)), L_δω: ∓δ·(ω × N).
//!
//! A ball has t = 0 and b = 0 to the last bit. Only the root of A is formed, A = MᵀM: xᵀHₖx = ‖e∧diag(a)Rₖᵀx‖²/h, so
//! that the rows of M are these products. The condition of the triangle of M = QR is then the aspect and not its
//! square.

use convex_support::numerics::elementary::{hypot, sqrt};

use super::side::{Side, spun, wedge};
use crate::numerics::{Vec, add, dot, unit};
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

/// The body that moves.
#[derive(Clone, Copy, Debug)]
pub(super) enum Mover {
    First,
    Second,
}

impl Mover {
    /// It, of the first and the second.
    pub(super) fn of<T>(self, first: T, second: T) -> T {
        match self {
            Self::First => first,
            Self::Second => second,
        }
    }

    fn other(self) -> Self {
        self.of(Self::Second, Self::First)
    }

    /// Its index among ‖N‖, h₁, h₂.
    fn index(self) -> usize {
        self.of(1, 2)
    }
}

/// The stationary normal, with all quantities that the derivatives need.
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

/// The units in which a contact was computed: of its value, and of length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    pub(super) value: f64,
    pub(super) length: f64,
}

/// The unit of a Hessian and its function: slope·s + ½·curvature·s², s the change of the value of a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub(super) slope: f64,
    pub(super) curvature: f64,
    pub(super) units: Units,
}

impl Form {
    /// The value itself.
    pub(super) fn of_value(units: Units) -> Self {
        Self { slope: 1.0, curvature: 0.0, units }
    }
}

/// The changes by each coordinate of a pose, translations first; as many as a pose has, 3 in 2D.
#[derive(Clone, Copy, Debug)]
struct Rates {
    /// s.
    value: [f64; 6],
    /// γ.
    constraint: [f64; 6],
    /// R⁻ᵀq.
    whitened: [[f64; 6]; 2],
}

impl<const N: usize> Contact<N> {
    /// At the normal along `direction`, from E₁ to E₂; `None` if that is not a direction.
    pub(super) fn new(pair: &Pair<N>, quantity: Quantity, direction: Vec<N>) -> Option<Self> {
        let e = heights(pair, direction).map(unit);
        Self::at_points(pair, quantity, direction, e, None)
    }

    /// The same if the points that touch, as unit vectors e of the two balls, are more accurate than from `direction`:
    /// turned into the axes of a needle it has lost the digits of its small coordinates. The same may hold for the
    /// value: near the floor of the margin N·r cancels almost entirely.
    pub(super) fn at_points(
        pair: &Pair<N>,
        quantity: Quantity,
        direction: Vec<N>,
        [e1, e2]: [Vec<N>; 2],
        value: Option<f64>,
    ) -> Option<Self> {
        let unit = unit(direction);
        let [h1, h2] = heights(pair, unit).map(|u| sqrt(dot(u, u)));
        let gauge = weighted(quantity.constraint, [1.0, h1, h2]);
        let normal = unit.map(|x| x / gauge);
        let tangents = tangents(unit);
        let sides = [
            Side::new(pair.axes1, pair.a1, e1, h1 / gauge, &tangents),
            Side::new(pair.axes2, pair.a2, e2, h2 / gauge, &tangents),
        ];
        let r = pair.r().map(|x| -x);
        let norm = 1.0 / gauge;
        let value =
            value.unwrap_or_else(|| dot(normal, r) - weighted(quantity.objective, [norm, sides[0].h, sides[1].h]));
        let k = core::array::from_fn(|i| quantity.objective[i] + value * quantity.constraint[i]);
        let root = root(k[0] / norm, [(&sides[0], k[1]), (&sides[1], k[2])]);
        value.is_finite().then_some(Self { quantity, r, normal, sides, value, k, tangents, root })
    }

    /// One step of Newton's method for N. An answer's value is stationary in N and may have been found with half its
    /// digits. The step is kept if it brings L nearer to being stationary: otherwise only rounding was left.
    pub(super) fn refined(self, pair: &Pair<N>) -> Self {
        let [x, y] = self.solved(self.whitened(self.residual()));
        let step: Vec<N> = core::array::from_fn(|i| x * self.tangents[0][i] + y * self.tangents[1][i]);
        match Self::new(pair, self.quantity, add(self.normal, step)) {
            Some(next) if next.slope() < 0.25 * self.slope() => next,
            _ => self,
        }
    }

    /// ∇L on the tangent plane: r − k₁v₁ − k₂v₂.
    fn residual(&self) -> [f64; 2] {
        let (r, [first, second]) = (self.across(self.r), self.sides.each_ref().map(Side::reach));
        core::array::from_fn(|c| r[c] - self.k[1] * first[c] - self.k[2] * second[c])
    }

    fn slope(&self) -> f64 {
        let [x, y] = self.residual();
        hypot(x, y)
    }

    /// The part of `x` in the tangent plane.
    fn across(&self, x: Vec<N>) -> [f64; 2] {
        self.tangents.map(|tangent| dot(tangent, x))
    }

    /// R⁻ᵀx for a vector of the tangent plane.
    #[inline]
    fn whitened(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [r11, r12, r22] = self.root;
        let first = x / r11;
        if N == 2 { [first, 0.0] } else { [first, (y - r12 * first) / r22] }
    }

    /// R⁻¹x.
    fn solved(&self, x: [f64; 2]) -> [f64; 2] {
        let [r11, r12, r22] = self.root;
        let second = if N == 2 { 0.0 } else { x[1] / r22 };
        [(x[0] - r12 * second) / r11, second]
    }

    /// ∂s/∂δ in world axes, and ∂s/∂ω for the plane eᵢ∧eⱼ as kh·eᵢeⱼ(…): the factor −kh and e, from which the torque is
    /// made.
    pub(super) fn gradient(&self, mover: Mover) -> (Vec<N>, Vec<N>, f64) {
        let (side, k, sign) = self.of(mover);
        (self.normal.map(|x| -sign * x), side.e, -k * side.h)
    }

    /// The second derivatives, translations first; in 2D 3 by 3 of them.
    #[inline]
    pub(super) fn hessian(&self, mover: Mover, form: Form) -> [[f64; 6]; 6] {
        let (rotations, is_seen) = (N * (N - 1) / 2, self.is_stiffer(mover));
        let (side, k, sign) = self.of(mover);
        // The body whose rotation gives L_ωω, and the sense in which it turns: the other one, backwards, if N is as
        // seen by the body that moves.
        let written = if is_seen { mover.other() } else { mover };
        let (other, other_k, _) = self.of(written);
        let turns = other.turns();
        let (sense, values) = if is_seen { (-1.0, side.twists()) } else { (1.0, turns.t) };
        // ∇γ and v on the tangent plane.
        let [_, g1, g2] = self.quantity.constraint;
        let [first, second] = self.sides.each_ref().map(Side::reach);
        let gauge: [f64; 2] = core::array::from_fn(|c| g1 * first[c] + g2 * second[c]);
        let reach = written.of(first, second);

        let mut rates = Rates { value: [0.0; 6], constraint: [0.0; 6], whitened: [[0.0; 6]; 2] };
        for i in 0..N {
            let value = -sign * self.normal[i];
            let q = core::array::from_fn(|c| -sign * self.tangents[c][i] - value * gauge[c]);
            rates.set(i, value, 0.0, self.whitened(q));
        }
        let weight = self.quantity.constraint[written.index()];
        for about in 0..rotations {
            let (t, value) = (sense * turns.t[about], k * side.h * values[about]);
            let q = core::array::from_fn(|c| {
                let cross = -other_k * (sense * turns.b[c][about] + reach[c] * t);
                let moment = if is_seen { wedge(self.r, self.tangents[c], about) } else { 0.0 };
                cross - moment - value * gauge[c]
            });
            rates.set(N + about, value, -weight * other.h * t, self.whitened(q));
        }

        let (mut hessian, size) = (rates.hessian(N, form), form.slope * form.units.value);
        for p in 0..rotations {
            for q in 0..rotations {
                hessian[N + p][N + q] += size * (other_k * turns.second[p][q]);
            }
        }
        if is_seen {
            self.add_seen(&mut hessian, size, sign / form.units.length);
        }
        hessian
    }

    /// Adds `size` times the further terms of L_ωω and L_δω if N is as seen by the body that moves: with (ω × N)·(φ ×
    /// r) = (ω·φ)(N·r) − (ω·r)(φ·N), in the plane N·r, and `sign` in the unit of length.
    fn add_seen(&self, hessian: &mut [[f64; 6]; 6], size: f64, sign: f64) {
        let (n, r, along) = (&self.normal, &self.r, dot(self.normal, self.r));
        for p in 0..N * (N - 1) / 2 {
            let spin = spun(self.normal, p);
            for j in 0..N {
                let mixed = size * sign * spin[j];
                hessian[N + p][j] -= mixed;
                hessian[j][N + p] -= mixed;
            }
            for q in 0..N * (N - 1) / 2 {
                let aside = if N == 2 { 0.0 } else { 0.5 * (n[p] * r[q] + n[q] * r[p]) };
                hessian[N + p][N + q] -= size * (if p == q { along } else { 0.0 } - aside);
            }
        }
    }

    /// Whether N is taken as seen by the body that moves, because the terms are then smaller: L_ωω of the body that
    /// moves is about k·(a_max² − a_min²)‖N‖²/h. In its place are that of the other one and ‖N‖‖r‖, which is large if
    /// the bodies are far apart.
    fn is_stiffer(&self, mover: Mover) -> bool {
        let stiffness = |mover: Mover| {
            let (side, k, _) = self.of(mover);
            let (least, most) = side.a.iter().fold((side.a[0], side.a[0]), |(l, m), a| (l.min(*a), m.max(*a)));
            k * (most - least) * (most + least) / side.h
        };
        let squared = dot(self.normal, self.normal);
        let lever = sqrt(dot(self.r, self.r) / squared);
        stiffness(mover) > stiffness(mover.other()).max(lever)
    }

    /// The body, its k, and the sign with which its translation shortens r.
    fn of(&self, mover: Mover) -> (&Side<N>, f64, f64) {
        mover.of((&self.sides[0], self.k[1], 1.0), (&self.sides[1], self.k[2], -1.0))
    }
}

impl Rates {
    fn set(&mut self, i: usize, value: f64, constraint: f64, [x, y]: [f64; 2]) {
        (self.value[i], self.constraint[i]) = (value, constraint);
        (self.whitened[0][i], self.whitened[1][i]) = (x, y);
    }

    /// All terms but L_θφ: slope·(q_θ·A⁻¹q_φ − s_θγ_φ − s_φγ_θ) + curvature·s_θs_φ, which is w_θ·w_φ − (s_θg_φ +
    /// s_φg_θ) with w = √slope·R⁻ᵀq and g = slope·γ − ½·curvature·s. Units are put into the factors, which are fewer
    /// than the entries.
    #[inline]
    fn hessian(mut self, dimension: usize, Form { slope, curvature, units }: Form) -> [[f64; 6]; 6] {
        // The unit of length is a power of two.
        let inverse = 1.0 / units.length;
        // The unit of the value may be one too, but its root has other digits: only that of the slope is taken.
        let root = sqrt(slope);
        let (slope, curvature) = (slope * units.value, 0.5 * (curvature * units.value));
        let mut offset = [0.0; 6];
        for i in 0..6 {
            let per = if i < dimension { inverse } else { 1.0 };
            offset[i] = (slope * self.constraint[i] - curvature * self.value[i]) * per;
            self.value[i] *= per;
            for whitened in &mut self.whitened {
                whitened[i] *= root * per;
            }
        }
        let (s, [x, y]) = (&self.value, &self.whitened);
        let mut hessian = [[0.0; 6]; 6];
        for i in 0..6 {
            for j in 0..6 {
                let seen = (x[i] * x[j] + y[i] * y[j]) * units.value;
                hessian[i][j] = seen - (s[i] * offset[j] + s[j] * offset[i]);
            }
        }
        hessian
    }
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

/// An orthonormal basis of the plane across the unit vector `n`: in 2D n turned, in 3D the two columns of a reflection
/// that takes a world axis to ±n.
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
        let factor = u[column] / u[along].abs();
        core::array::from_fn(|i| f64::from(u8::from(i == column)) - u[i] * factor)
    })
}

/// R of M = QR, MᵀM = A on the tangent plane.
fn root<const N: usize>(isotropic: f64, sides: [(&Side<N>, f64); 2]) -> [f64; 3] {
    // Up to two rows of the isotropic part, and a row per body and plane of its axes.
    let mut columns = [[0.0; 8]; 2];
    let isotropic = sqrt(isotropic.max(0.0));
    (columns[0][0], columns[1][1]) = (isotropic, isotropic);
    let mut row = 2;
    for (side, k) in sides {
        let weight = sqrt(k.max(0.0) / side.h);
        let y = side.tangents.map(|tangent| -> Vec<N> { core::array::from_fn(|i| side.a[i] * tangent[i]) });
        for i in 0..N {
            for j in i + 1..N {
                for c in 0..2 {
                    columns[c][row] = weight * (side.e[i] * y[c][j] - side.e[j] * y[c][i]);
                }
                row += 1;
            }
        }
    }
    let [first, second] = columns;
    let r11 = sqrt(dot(first, first));
    let r12 = dot(first, second) / r11;
    let along = r12 / r11;
    let rest: Vec<8> = core::array::from_fn(|i| second[i] - along * first[i]);
    [r11, r12, sqrt(dot(rest, rest))]
}
