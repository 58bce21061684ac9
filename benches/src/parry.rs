//! The workloads answered by parry, in either precision: its GJK functions on one side, and its front door, which picks
//! a special case where it has one, on the other.

/// parry3d: `f32`.
pub mod single {
    use parry3d as parry;
    include!("parry/solvers.rs");
}

/// parry3d-f64: `f64`.
#[allow(clippy::useless_conversion, reason = "the text is shared with `single`, where it is one")]
pub mod double {
    use parry3d_f64 as parry;
    include!("parry/solvers.rs");
}
