//! Robots: bodies carried by joints, along a path, and anywhere in a box of joint values.

mod error;
mod frame;
mod joint;
mod joint_box;
mod link_motion;
#[allow(clippy::module_inception, reason = "it is the type that the folder is about")]
mod linkage;
mod path;
mod result;
mod sweep;
mod trajectory;

pub use error::LinkageError;
pub use joint::{Joint, JointKind, Link};
pub use joint_box::{JointBox, JointBoxOutcome};
pub use linkage::Linkage;
pub use result::{FreeBox, FreeInterval, Met, Path, PathContact};
pub use sweep::PathWorkspace;
pub use trajectory::{JointBounds, JointState, JointTrajectory};
