//! Motion: the first contact of bodies that turn, and motions of any kind.

mod approach;
mod box_look;
mod boxes;
mod chain_bounds;
mod chain_motion;
mod closest_points;
mod contact;
mod corners;
mod first_contact;
mod free_interval;
mod from_contact;
mod in_contact;
mod instant;
mod motion_cast;
mod moved;
mod moving_body;
mod moving_pair;
mod near_look;
mod next_time;
mod options;
mod over_half_space;
mod pass_through;
mod placed;
mod result;
mod rigid_motion;
mod rough_look;
mod trajectory;

pub(crate) use chain_bounds::Bounds;
pub use chain_motion::ChainMotion;
pub(crate) use motion_cast::{check, checked};
pub use motion_cast::{motion_cast, motion_cast_with};
pub(crate) use moved::Moved;
pub use options::MotionCastOptions;
pub use result::MotionIterate;
pub use rigid_motion::{Pose, RigidMotion};
pub use trajectory::{Displacement, MovingBall, Trajectory, TurningPlane};
