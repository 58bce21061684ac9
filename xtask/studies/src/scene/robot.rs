//! A robot from a URDF file: which links have a body, and where they are for given joint values.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use convex_support::glam::{DMat3, DQuat, DVec3};
use convex_support::{Polytope, Posed};
use gjk_raycast::{Joint as Jointing, JointKind, Link as Carried, Linkage, Pose as Placed, RigidMotion};
use roxmltree::{Document, Node};
use xtask::mesh::Meshes;

/// A rigid motion: rotate, then translate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    pub(crate) rotation: DQuat,
    pub(crate) translation: DVec3,
}

impl Pose {
    const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, translation: DVec3::ZERO };

    /// First `inner`, then `self`.
    fn after(self, inner: Self) -> Self {
        Self {
            rotation: (self.rotation * inner.rotation).normalize(),
            translation: self.rotation * inner.translation + self.translation,
        }
    }

    /// The `origin` of an element: roll, pitch and yaw about the fixed axes, in this order, then a translation.
    fn of(element: Node<'_, '_>) -> Result<Self, String> {
        let Some(origin) = child(element, "origin") else { return Ok(Self::IDENTITY) };
        let [roll, pitch, yaw] = numbers(origin, "rpy")?.unwrap_or_default();
        let rotation = DMat3::from_rotation_z(yaw) * DMat3::from_rotation_y(pitch) * DMat3::from_rotation_x(roll);
        let translation = DVec3::from_array(numbers(origin, "xyz")?.unwrap_or_default());
        Ok(Self { rotation: DQuat::from_mat3(&rotation), translation })
    }
}

/// A link that has a mesh.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) mesh: PathBuf,
    /// The frame of the mesh in that of the link.
    origin: Pose,
    /// The place of its frame among all frames of the robot.
    frame: usize,
}

/// A frame of the robot, hung from an earlier one by a joint.
#[derive(Clone, Debug)]
struct Frame {
    /// None for the root.
    parent: Option<usize>,
    origin: Pose,
    motion: Motion,
    /// The column of the joint among the joint values.
    column: Option<usize>,
    /// Between which values it moves.
    limits: [f64; 2],
}

#[derive(Clone, Copy, Debug)]
enum Motion {
    Fixed,
    Revolute(DVec3),
    Prismatic(DVec3),
}

/// The links with a mesh, and the tree of frames that carries them.
#[derive(Clone, Debug)]
pub(crate) struct Robot {
    pub(crate) links: Vec<Link>,
    frames: Vec<Frame>,
}

/// A robot, all of whose joints move, as one linkage of the hulls of its meshes.
pub(crate) struct Jointed {
    pub(crate) linkage: Linkage<Posed<Arc<Polytope<DVec3>>>>,
    /// The names of its links, those without a mesh left out.
    pub(crate) links: Vec<String>,
    /// The limits of its joints, in the order of the linkage's values.
    pub(crate) limits: Vec<[f64; 2]>,
}

impl Robot {
    /// Reads the robot; `joints` names the joint values it will be given. Joints that are not named stay at 0.
    pub(crate) fn read(path: &Path, joints: &[String]) -> Result<Self, String> {
        let failed = |why: String| format!("{}: {why}", path.display());
        let text = fs::read_to_string(path).map_err(|why| failed(why.to_string()))?;
        let document = Document::parse(&text).map_err(|why| failed(why.to_string()))?;
        Self::of(document.root_element(), path.parent().unwrap_or(Path::new("")), joints).map_err(failed)
    }

    /// The robot that an element `robot` describes, its meshes relative to `folder`.
    fn of(robot: Node<'_, '_>, folder: &Path, names: &[String]) -> Result<Self, String> {
        let all: Vec<Joint<'_>> =
            children(robot, "joint").map(|joint| Joint::of(joint, names)).collect::<Result<_, _>>()?;
        if let Some(name) = names.iter().find(|name| !all.iter().any(|j| j.name == **name)) {
            return Err(format!("there is no joint {name:?}"));
        }
        let roots = children(robot, "link").map(|link| attribute(link, "name")).collect::<Result<Vec<_>, _>>()?;
        let roots = roots.into_iter().filter(|link| !all.iter().any(|j| j.child == *link));
        let (frames, of_link) = frames(roots, &all)?;
        let mut links = Vec::new();
        for link in children(robot, "link") {
            let name = attribute(link, "name")?;
            for collision in children(link, "collision") {
                let mesh = child(collision, "geometry").and_then(|geometry| child(geometry, "mesh"));
                let Some(mesh) = mesh.filter(|mesh| !mesh.has_attribute("scale")) else {
                    return Err(format!("the collision shape of {name} is not a mesh in its own size"));
                };
                links.push(Link {
                    name: name.to_owned(),
                    mesh: folder.join(attribute(mesh, "filename")?),
                    origin: Pose::of(collision)?,
                    frame: of_link[name],
                });
            }
        }
        Ok(Self { links, frames })
    }

    /// Reads the robot with all of its joints.
    pub(crate) fn read_jointed(path: &Path) -> Result<Jointed, String> {
        let text = fs::read_to_string(path).map_err(|why| format!("{}: {why}", path.display()))?;
        let document = Document::parse(&text).map_err(|why| format!("{}: {why}", path.display()))?;
        let joints = children(document.root_element(), "joint");
        let moving = joints.filter(|joint| joint.attribute("type") != Some("fixed"));
        let names: Vec<String> = moving.filter_map(|joint| joint.attribute("name").map(str::to_owned)).collect();
        Self::read(path, &names)?.jointed()
    }

    fn jointed(&self) -> Result<Jointed, String> {
        let joints = self.frames.iter().map(|frame| Jointing {
            parent: frame.parent,
            pose: Placed { rotation: frame.origin.rotation, translation: frame.origin.translation },
            kind: match frame.motion {
                Motion::Revolute(axis) => JointKind::Revolute(axis),
                Motion::Prismatic(axis) => JointKind::Prismatic(axis),
                Motion::Fixed => JointKind::Fixed,
            },
        });
        let meshes = Meshes::relative_to("");
        let (mut links, mut names) = (Vec::<Carried<Posed<Arc<Polytope<DVec3>>>>>::new(), Vec::<String>::new());
        for Link { name, mesh, origin, frame } in &self.links {
            let failed = |why: String| format!("{}: {why}", mesh.display());
            let hull = meshes.load(mesh).map_err(|problem| problem.message)?.hull_f64();
            let hull = hull.map_err(|why| failed(why.to_string()))?;
            let body = Posed::new(hull, origin.rotation, origin.translation).map_err(|why| failed(why.to_string()))?;
            match names.iter().position(|known| known == name) {
                Some(link) => links[link].bodies.push(body),
                None => {
                    links.push(Carried { joint: Some(*frame), bodies: vec![body] });
                    names.push(name.clone());
                }
            }
        }
        let linkage = Linkage::new(joints, links).map_err(|why| why.to_string())?;
        let moving = self.frames.iter().filter(|frame| !matches!(frame.motion, Motion::Fixed));
        Ok(Jointed { linkage, links: names, limits: moving.map(|frame| frame.limits).collect() })
    }

    /// Where the meshes of the links are in the frame of the root, for these joint values.
    pub(crate) fn poses(&self, values: &[f64]) -> Vec<Pose> {
        let poses = self.frames_at(values);
        self.links.iter().map(|link| poses[link.frame].after(link.origin)).collect()
    }

    /// The joints that carry each link, the one nearest to the base first: how each would move alone at its rate, from
    /// where it is at these joint values.
    pub(super) fn joints(&self, values: &[f64], rates: &[f64]) -> Vec<Vec<RigidMotion<DVec3>>> {
        let poses = self.frames_at(values);
        // A joint leaves its own axis where it is, so that the frame after it tells that too.
        let motion = |frame: &Frame, pose: Pose| {
            let rate = rates[frame.column?];
            match frame.motion {
                Motion::Fixed => None,
                Motion::Revolute(axis) => Some(RigidMotion::rotation(pose.rotation * axis * rate, pose.translation)),
                Motion::Prismatic(axis) => Some(RigidMotion::translation(pose.rotation * axis * rate)),
            }
        };
        let mut chains: Vec<Vec<RigidMotion<DVec3>>> = Vec::with_capacity(self.frames.len());
        for (frame, pose) in self.frames.iter().zip(poses) {
            let mut chain = frame.parent.map_or_else(Vec::new, |parent| chains[parent].clone());
            chain.extend(motion(frame, pose));
            chains.push(chain);
        }
        self.links.iter().map(|link| chains[link.frame].clone()).collect()
    }

    /// The frames in that of the root.
    fn frames_at(&self, values: &[f64]) -> Vec<Pose> {
        let mut poses: Vec<Pose> = Vec::with_capacity(self.frames.len());
        for frame in &self.frames {
            let value = frame.column.map_or(0.0, |column| values[column]);
            let moved = match frame.motion {
                Motion::Fixed => Pose::IDENTITY,
                Motion::Revolute(axis) => {
                    Pose { rotation: DQuat::from_axis_angle(axis, value), translation: DVec3::ZERO }
                }
                Motion::Prismatic(axis) => Pose { rotation: DQuat::IDENTITY, translation: axis * value },
            };
            let parent = frame.parent.map_or(Pose::IDENTITY, |parent| poses[parent]);
            poses.push(parent.after(frame.origin).after(moved));
        }
        poses
    }
}

/// A joint as URDF writes it.
struct Joint<'x> {
    name: &'x str,
    parent: &'x str,
    child: &'x str,
    origin: Pose,
    motion: Motion,
    column: Option<usize>,
    limits: [f64; 2],
}

impl<'x> Joint<'x> {
    fn of(joint: Node<'x, '_>, names: &[String]) -> Result<Self, String> {
        let name = attribute(joint, "name")?;
        let link = |end: &'static str| match child(joint, end) {
            Some(end) => attribute(end, "link"),
            None => Err(format!("the joint {name} has no {end}")),
        };
        // Left out, it is x.
        let axis = child(joint, "axis").map_or(Ok(None), |axis| numbers(axis, "xyz"))?;
        let axis = DVec3::from_array(axis.unwrap_or([1.0, 0.0, 0.0])).normalize_or_zero();
        let motion = match attribute(joint, "type")? {
            "fixed" => Motion::Fixed,
            "revolute" | "continuous" if axis != DVec3::ZERO => Motion::Revolute(axis),
            "prismatic" if axis != DVec3::ZERO => Motion::Prismatic(axis),
            _ => return Err(format!("the joint {name} neither turns nor slides along one axis")),
        };
        let column = names.iter().position(|column| *column == name);
        // Without limits it turns all the way round.
        let limit = |end| match child(joint, "limit").and_then(|limit| limit.attribute(end)) {
            Some(text) => {
                text.trim().parse::<f64>().map(Some).map_err(|_| format!("{end}={text:?} of {name} is no number"))
            }
            None => Ok(None),
        };
        let limits = match (limit("lower")?, limit("upper")?) {
            (None, None) => [-PI, PI],
            (lower, upper) => [lower, upper].map(Option::unwrap_or_default),
        };
        let (parent, child) = (link("parent")?, link("child")?);
        Ok(Self { name, parent, child, origin: Pose::of(joint)?, motion, column, limits })
    }
}

/// The frames in an order in which parents come first, and the place of each link's among them.
fn frames<'x>(
    roots: impl Iterator<Item = &'x str>,
    joints: &[Joint<'x>],
) -> Result<(Vec<Frame>, HashMap<&'x str, usize>), String> {
    let mut frames = Vec::new();
    let mut places = HashMap::new();
    for link in roots {
        places.insert(link, frames.len());
        let (origin, motion) = (Pose::IDENTITY, Motion::Fixed);
        frames.push(Frame { parent: None, origin, motion, column: None, limits: [0.0; 2] });
    }
    // Each pass hangs at least one more joint onto what is there, or none ever will be.
    let mut waiting: Vec<&Joint<'_>> = joints.iter().collect();
    while !waiting.is_empty() {
        let before = waiting.len();
        waiting.retain(|joint| {
            let Some(&parent) = places.get(joint.parent) else { return true };
            places.insert(joint.child, frames.len());
            let Joint { origin, motion, column, limits, .. } = **joint;
            frames.push(Frame { parent: Some(parent), origin, motion, column, limits });
            false
        });
        if waiting.len() == before {
            return Err(format!("the joint {} hangs from no link of the robot", waiting[0].name));
        }
    }
    Ok((frames, places))
}

fn children<'x, 'i>(element: Node<'x, 'i>, name: &'static str) -> impl Iterator<Item = Node<'x, 'i>> {
    element.children().filter(move |child| child.has_tag_name(name))
}

fn child<'x, 'i>(element: Node<'x, 'i>, name: &'static str) -> Option<Node<'x, 'i>> {
    children(element, name).next()
}

fn attribute<'x>(element: Node<'x, '_>, name: &str) -> Result<&'x str, String> {
    element.attribute(name).ok_or_else(|| format!("<{}> has no attribute {name:?}", element.tag_name().name()))
}

/// Three numbers, as in `xyz="0 0 1"`, if they are given.
fn numbers(element: Node<'_, '_>, name: &str) -> Result<Option<[f64; 3]>, String> {
    let Some(text) = element.attribute(name) else { return Ok(None) };
    let numbers: Vec<f64> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
    match numbers.try_into() {
        Ok(three) => Ok(Some(three)),
        Err(_) => Err(format!("{name}={text:?} is not three numbers")),
    }
}
