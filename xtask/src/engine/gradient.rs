//! What the queries share that may carry `"gradient": true`.

use convex_support::{AngularVelocity as _, Scalar as _, SupportMap};
use gjk_raycast::{Impact, MotionGradient, RigidMotion, SignedDistanceOptions, Smoothness, signed_distance};

use crate::wire::answer::{Answer, Field, Number};
use crate::wire::shape::{Solid, Space};

/// The derivatives of a scalar by the poses of both shapes.
#[derive(Debug)]
pub(super) struct Gradient<V: Space> {
    a: MotionGradient<V>,
    b: MotionGradient<V>,
    is_smooth: bool,
}

impl<V: Space> Gradient<V> {
    pub(super) fn new(a: MotionGradient<V>, b: MotionGradient<V>, smoothness: Smoothness) -> Self {
        Self { a, b, is_smooth: smoothness == Smoothness::Smooth }
    }

    /// Of the time of a hit of bodies that move so.
    pub(super) fn of_impact(
        hit: Impact<V>,
        (a, motion_a): (&Solid<V>, &RigidMotion<V>),
        (b, motion_b): (&Solid<V>, &RigidMotion<V>),
    ) -> Self {
        let features = hit.closest_features(a, motion_a, b, motion_b);
        let smooth = features.and_then(|features| {
            let gradient = hit.refined(&features).gradient(motion_a, motion_b)?;
            Some(Self::new(gradient.pose_a, gradient.pose_b, features.smoothness()))
        });
        smooth.unwrap_or_else(|| Self::at_floor(a, b))
    }

    /// Of a scalar that is at its floor where the shapes overlap: it stays there unless they merely touch.
    pub(super) fn at_floor<A, B>(a: &A, b: &B) -> Self
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
    {
        let none = MotionGradient::force(V::ZERO, V::ZERO);
        let depth = signed_distance(a, b, SignedDistanceOptions::default());
        Self { a: none, b: none, is_smooth: depth.upper < V::Scalar::ZERO }
    }
}

/// The answer with `gradient_a`, `gradient_b` and `smooth`, where they were asked for.
pub(super) fn with<V: Space>(answer: Answer, gradient: Option<Gradient<V>>) -> Answer {
    let Some(Gradient { a, b, is_smooth }) = gradient else { return answer };
    answer
        .with("gradient_a", Field::Answer(by_pose(a)))
        .with("gradient_b", Field::Answer(by_pose(b)))
        .with("smooth", Field::Flag(is_smooth))
}

/// By a translation, and by a turn about the world's origin.
fn by_pose<V: Space>(gradient: MotionGradient<V>) -> Answer {
    let rotation = moment::<V>(gradient.rotation_about(V::ZERO));
    Answer::default().with("translation", Field::vector(gradient.translation)).with("rotation", rotation)
}

/// A derivative by a turn: a vector in 3D, a number in 2D.
pub(super) fn moment<V: Space>(moment: V::AngularVelocity) -> Field {
    let coordinate = |i| Number::of(moment.coordinate(i));
    if V::DIM == 2 { Field::Number(coordinate(0)) } else { Field::Numbers((0..3).map(coordinate).collect()) }
}
