//! How the margin, the distance and the common scale change as a body moves: one derivation for the three.
//!
//! Each is the greatest value s of a difference of support functions over normals N from E₁ to E₂. With r = x₂ − x₁,
//! Sₖ = Rₖ·diag(aₖ)²·Rₖᵀ and hₖ = √(NᵀSₖN), growing E₁ by ρ = √(1 + m), keeping the two apart by d, or scaling both by
//! α:
//!
//! | | s | maximises | where |
//! |---|---|---|---|
//! | margin | ρ | N·r − h₂ | h₁ = 1 |
//! | distance | d | N·r − h₁ − h₂ | ‖N‖ = 1 |
//! | common scale | α | N·r | h₁ + h₂ = 1 |
//!
//! In all three the objective is N·r − f·(‖N‖, h₁, h₂) and the constraint γ(N) = g·(‖N‖, h₁, h₂) = 1, with weights f
//! and g of 0 and 1. The multiplier of the constraint is s itself, since all is homogeneous in N, so that with k = f +
//! s·g
//!
//! > L(N) = N·r − k₀‖N‖ − k₁h₁(N) − k₂h₂(N)
//!
//! is stationary: the bodies grown by k₁ and k₂ have a slab of width k₀ between them. [`contact`] has the formulas that
//! follow. A motion of a body is a translation δ and a rotation vector ω about the body's own centre, both in world
//! axes: x ↦ x + δ, R ↦ exp([ω]×)R.

mod contact;
mod margin;
mod motion;
mod shape;
mod side;
mod value_of_contact;

pub use self::shape::ShapeGradient;
