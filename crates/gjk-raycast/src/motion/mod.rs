//! Motion: the first contact of bodies that turn, how near they come on the way, and motions of any kind.
//!
//! [`motion_cast`] and [`motion_clearance`] ask, along a [`RigidMotion`], a [`ChainMotion`] of joints, or a
//! [`Trajectory`] of your own. For bodies that move straight [`linear_cast`](crate::linear_cast()) is quicker.

mod bent_plane;
mod box_look;
mod chain_motion;
mod clearance;
mod first_contact;
mod free_interval;
mod from_contact;
mod in_contact;
mod instant;
mod least;
mod motion_cast;
mod moving_body;
mod moving_pair;
mod near_look;
mod next_time;
mod over_half_space;
mod placed;
mod proved_steps;
mod rigid_motion;
mod trajectory;

pub(crate) use chain_motion::Bounds;
pub use chain_motion::ChainMotion;
pub(crate) use clearance::clearance_within;
pub use clearance::{MotionClearance, MotionClearanceOptions, motion_clearance, motion_clearance_with};
pub use first_contact::{MotionCast, MotionCastOptions, MotionIterate};
pub(crate) use motion_cast::{check, checked};
pub use motion_cast::{motion_cast, motion_cast_with};
pub(crate) use placed::Moved;
pub(crate) use proved_steps::ProvedSteps;
pub use rigid_motion::Pose;
pub use trajectory::{Displacement, MovingBall, RigidMotion, Trajectory, TurningPlane};
