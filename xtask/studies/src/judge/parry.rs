//! parry's answers, in either precision: by the functions that its users call, which pick a special case where there is
//! one.

/// parry3d: `f32`.
pub(super) mod single {
    use parry3d as parry;
    include!("parry/answers.rs");
}

/// parry3d-f64: `f64`.
#[allow(clippy::useless_conversion, reason = "the text is shared with `single`, where it is one")]
pub(super) mod double {
    use parry3d_f64 as parry;
    include!("parry/answers.rs");
}
