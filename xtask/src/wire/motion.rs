//! Rigid motions as written.

use gjk_raycast::RigidMotion;

use super::error::Problem;
use super::fields::{AngularVelocity, Coordinates, Fields, Written};
use super::shape::{Space, vector};

/// A motion at constant velocity and angular velocity, as the query says it.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    velocity: Coordinates,
    angular_velocity: Option<AngularVelocity>,
    center: Coordinates,
}

impl Motion {
    /// The motion that an object is.
    pub fn read(written: Written<'_>) -> Result<Self, Problem> {
        let fields = written.fields(&["velocity", "angular_velocity", "center"], &[])?;
        Ok(Self {
            velocity: fields.vector_or_zero("velocity")?,
            angular_velocity: fields.angular_velocity("angular_velocity")?,
            center: fields.vector_or_zero("center")?,
        })
    }

    /// The motion that a field is; rest where it is left out.
    pub fn read_or_rest(fields: &Fields<'_>, key: &str) -> Result<Self, Problem> {
        if fields.has(key) { Self::read(fields.within(key)?) } else { Ok(Self::default()) }
    }

    /// The motion in a space.
    pub fn build<V: Space>(&self) -> RigidMotion<V> {
        RigidMotion {
            velocity: vector(&self.velocity),
            angular_velocity: self.angular_velocity.map(V::angular_velocity).unwrap_or_default(),
            center: vector(&self.center),
        }
    }
}
