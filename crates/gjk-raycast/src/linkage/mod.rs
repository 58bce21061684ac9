//! Robots: bodies carried by joints, at one configuration, along a path, and anywhere in a box of joint values.
//!
//! A [`Linkage`] has [`Joint`]s and [`Link`]s, as a URDF file has, and answers all questions: is it free, how near does
//! it come, which joint helps, is a path free at every time, do two links ever meet.

mod configuration;
mod error;
mod frame;
mod grown_box;
mod joint;
mod joint_box;
mod joint_trajectory;
mod link_motion;
mod path;
mod path_answer;
mod path_clearance;
mod robot;
mod sweep;
mod tree;

pub use configuration::{ConfigurationWorkspace, LinkClearance};
pub use error::LinkageError;
pub use frame::LinkFrame;
pub use grown_box::{FaceStop, GrownBox};
pub use joint::{Joint, JointKind, Link};
pub use joint_box::{JointBox, JointBoxOutcome};
pub use joint_trajectory::{JointBounds, JointState, JointTrajectory};
pub use path_answer::{BodyPair, FreeBox, FreeInterval, Met, NearestOnPath, Path, PathClearance, PathContact};
pub use robot::Linkage;
pub use sweep::PathWorkspace;
