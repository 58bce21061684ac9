//! A linkage, printed as the tree that its tables say.

use alloc::vec::Vec;
use core::fmt::{self, Display, Formatter};

use convex_support::{SupportMap, Vector};

use super::joint::JointKind;
use super::robot::Linkage;

/// One line for each joint, under the joint that carries it, and one for each link; then the pairs of links that are
/// tested against one another.
///
/// ```
/// use convex_support::{Ball, glam::DVec2};
/// use gjk_raycast::{Joint, JointKind, Link, Linkage, Pose};
///
/// let joint = |parent, kind| Joint { parent, pose: Pose { translation: DVec2::X, ..Pose::default() }, kind };
/// let link = |joint| Link { joint, bodies: vec![Ball::new(0.2).expect("a radius")] };
/// let arm = Linkage::new(
///     [joint(None, JointKind::Revolute(1.0)), joint(Some(0), JointKind::Prismatic(DVec2::Y))],
///     [link(None), link(Some(0)), link(Some(1))],
/// )?
/// .with_pairs([[0, 2]])?;
/// let tree = "\
/// world
///   link 0, bodies: 1
///   joint 0 at (1, 0), turns about 1, value 0
///     link 1, bodies: 1
///     joint 1 at (1, 0), slides along (0, 1), value 1
///       link 2, bodies: 1
/// pair of links 0 and 2
/// ";
/// assert_eq!(arm.to_string(), tree);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl<S: SupportMap> Display for Linkage<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let joints = &self.skeleton.joints;
        f.write_str("world\n")?;
        // Joints to be printed, the next one last, each with its depth.
        let mut open: Vec<(Option<usize>, usize)> = alloc::vec![(None, 1)];
        while let Some((joint, depth)) = open.pop() {
            if let Some(index) = joint {
                let place = &joints[index];
                write!(f, "{:1$}joint {index} at ", "", 2 * (depth - 1))?;
                vector(f, place.joint.pose.translation)?;
                match place.joint.kind {
                    JointKind::Fixed => f.write_str(", fixed\n")?,
                    JointKind::Revolute(axis) => {
                        f.write_str(", turns about ")?;
                        let axis = convex_support::numerics::angular::vector::<S::Vector>(axis);
                        if S::Vector::DIM == 2 { write!(f, "{}", axis.get(0))? } else { vector(f, axis)? }
                    }
                    JointKind::Prismatic(axis) => {
                        f.write_str(", slides along ")?;
                        vector(f, axis)?;
                    }
                }
                if let Some(value) = place.carrier.filter(|_| !matches!(place.joint.kind, JointKind::Fixed)) {
                    writeln!(f, ", value {value}{}", if place.is_idle() { ", carries nothing" } else { "" })?;
                }
            }
            for (link, balls) in self.skeleton.links.iter().enumerate().filter(|(_, balls)| balls.joint == joint) {
                writeln!(f, "{:1$}link {link}, bodies: {2}", "", 2 * depth, balls.each.len())?;
            }
            let carried = joints.iter().enumerate().rev().filter(|(_, place)| place.joint.parent == joint);
            open.extend(carried.map(|(index, _)| (Some(index), depth + 1)));
        }
        let pairs = self.skeleton.views.iter().filter_map(|view| Some((view.link, view.base?)));
        pairs.into_iter().try_for_each(|(a, b)| writeln!(f, "pair of links {a} and {b}"))
    }
}

/// A vector by its coordinates.
fn vector<V: Vector>(f: &mut Formatter<'_>, v: V) -> fmt::Result {
    for i in 0..V::DIM {
        write!(f, "{}{}", if i == 0 { "(" } else { ", " }, v.get(i))?;
    }
    f.write_str(")")
}
