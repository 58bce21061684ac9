//! Invalid linkages, paths and boxes of joint values.

use core::error::Error;
use core::fmt::{self, Display, Formatter};

use convex_support::InvalidShape;

use super::path_answer::{BodyPair, Met};
use crate::RayCastError;

/// Why a linkage, a path or a box of joint values was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LinkageError {
    /// The parent of a joint does not come before it, as in a circle of joints.
    ParentNotBefore {
        /// The index of the joint.
        joint: usize,
        /// The index of its parent.
        parent: usize,
    },
    /// The pose of a joint is invalid: a number is not finite, or its quaternion is zero.
    Pose {
        /// The index of the joint.
        joint: usize,
        /// What is wrong with its translation or rotation.
        why: InvalidShape,
    },
    /// The axis of a joint is zero, or a coordinate of it is not finite.
    Axis {
        /// The index of the joint.
        joint: usize,
    },
    /// The joint of a link does not exist.
    NoSuchJoint {
        /// The index of the link.
        link: usize,
        /// The index of its joint.
        joint: usize,
    },
    /// No link hangs from a joint that moves, nor from one that it carries:
    /// [`check_joints`](crate::Linkage::check_joints).
    CarriesNothing {
        /// The index of the joint.
        joint: usize,
    },
    /// There is no joint to tell the frame of.
    NoSuchFrame {
        /// The index that was asked for.
        joint: usize,
    },
    /// A body of a link has no finite ball around it.
    BodyNotFinite {
        /// The index of the link.
        link: usize,
        /// The index of the body in it.
        body: usize,
    },
    /// A link, or a body of it, does not exist.
    NoSuchBody {
        /// The index of the link.
        link: usize,
        /// The index of the body in it.
        body: usize,
    },
    /// A pair names a link that does not exist, or one link twice.
    Pair {
        /// The index of the pair.
        pair: usize,
    },
    /// A path has no waypoint.
    EmptyPath,
    /// The number of values of a waypoint, or of intervals of a box, is not the number of joints that move.
    Count {
        /// The index of the waypoint; 0 for a box.
        waypoint: usize,
        /// How many joints move.
        joints: usize,
        /// How many values there are.
        values: usize,
    },
    /// A joint value is not finite.
    Value {
        /// The index of the waypoint; 0 for a box. For a trajectory it is the index of the edge.
        waypoint: usize,
        /// The index of the value.
        value: usize,
    },
    /// A bound of a trajectory is negative or not finite.
    Bounds {
        /// The index of the edge.
        edge: usize,
        /// The index of the value.
        value: usize,
    },
    /// An interval of a box ends before it begins.
    Interval {
        /// The index of the value.
        value: usize,
    },
    /// The joint value around which a free box is to grow is not within its limits.
    OutsideLimits {
        /// The index of the value.
        value: usize,
    },
    /// At the joint values around which a free box is to grow, two bodies are not certainly farther apart than the
    /// target distance.
    NotFree {
        /// Which bodies they are.
        bodies: BodyPair,
    },
    /// An option is NaN, or the target distance infinite.
    Option(RayCastError),
}

impl Display for LinkageError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::ParentNotBefore { joint, parent } => {
                write!(f, "joint {joint} hangs from joint {parent}, which does not come before it, as in a loop")
            }
            Self::Pose { joint, why } => write!(f, "the pose of joint {joint} is none: {why}"),
            Self::Axis { joint } => write!(f, "the axis of joint {joint} is zero or not finite"),
            Self::NoSuchJoint { link, joint } => write!(f, "link {link} hangs from joint {joint}, which is not there"),
            Self::CarriesNothing { joint } => {
                write!(f, "joint {joint} moves, but no link hangs from it or from a joint that it carries")
            }
            Self::NoSuchFrame { joint } => write!(f, "there is no joint {joint}"),
            Self::BodyNotFinite { link, body } => write!(f, "body {body} of link {link} is not finite"),
            Self::NoSuchBody { link, body } => write!(f, "there is no body {body} of a link {link}"),
            Self::Pair { pair } => write!(f, "pair {pair} is not of two links of the linkage"),
            Self::EmptyPath => f.write_str("the path has no waypoint"),
            Self::Count { waypoint, joints, values } => {
                write!(f, "waypoint {waypoint} has {values} values, but {joints} joints move")
            }
            Self::Value { waypoint, value } => write!(f, "value {value} of waypoint {waypoint} is not finite"),
            Self::Bounds { edge, value } => write!(f, "a bound for value {value} of edge {edge} is none"),
            Self::Interval { value } => write!(f, "the interval of value {value} ends before it begins"),
            Self::OutsideLimits { value } => write!(f, "value {value} is not within its limits"),
            Self::NotFree { bodies: BodyPair { link, body, met } } => {
                write!(f, "body {body} of link {link} is not certainly free of ")?;
                match met {
                    Met::Obstacle(obstacle) => write!(f, "obstacle {obstacle}"),
                    Met::Member { obstacle, member } => write!(f, "member {member} of obstacle {obstacle}"),
                    Met::Link { link, body } => write!(f, "body {body} of link {link}"),
                }?;
                f.write_str(" at the values to grow around")
            }
            Self::Option(why) => write!(f, "{why}"),
        }
    }
}

impl Error for LinkageError {}

impl From<RayCastError> for LinkageError {
    fn from(why: RayCastError) -> Self {
        Self::Option(why)
    }
}
