//! Many bodies: the first on a ray or a way, the nearest, all that are near, pairs, manifolds; layers and instances.
//!
//! [`Scene`] has the bodies, and a tree of their boxes. Questions are methods of [`Among`], which [`Scene::all`] and
//! [`Scene::among`] make. A [`Group`] is a scene that is a body of another one, as often as wanted. Answers are equal,
//! to the last bit, to those of a loop over all bodies.

mod among;
mod answers;
mod asked;
mod body;
mod bounds;
mod contacts;
mod error;
mod group;
mod handle;
mod hits;
mod instance;
mod instance_frame;
mod mesh_hits;
mod moving_pairs;
mod nearest;
mod nearest_pair;
mod pairs;

use alloc::boxed::Box;
use alloc::vec::Vec;

use convex_support::{Aabb, Bvh, Posed, SupportMap, Triangle, Vector, Vector3, outer_box};

use crate::{HalfSpace, Pose};

pub use among::Among;
pub use answers::{
    BodyContact, BodyDistance, BodyHit, BodySignedDistance, PairContact, PairDistance, PairImpact, SceneAnyHit,
    SceneAnyWithin, SceneCast, SceneDistance, SceneFirstContact, SceneHits, SceneLinearCast, SceneMotionCast,
    ScenePair, SceneRayCast, SceneSignedDistance, Work,
};
pub use body::Body;
pub use error::SceneError;
pub use handle::BodyHandle;
pub use instance::{Group, Instance};

/// A set of bodies with a tree of their boxes, for questions such as the first hit, the nearest body, or all near
/// pairs.
///
/// All bodies are of one type `S`, which is any [`SupportMap`]: one kind of shape, an enum of yours, or
/// `Box<dyn SupportMap<Vector = DVec3>>` for a mixture; by value or by reference. For methods that use several
/// threads, it has to be `Sync`: `Box<dyn SupportMap<Vector = DVec3> + Sync>`. A body is named by its index, which
/// stays the same until the body is removed. A half-space is no support map, since it has no end, but can be a body
/// too ([`insert_half_space`](Self::insert_half_space)).
///
/// Scenes answer ray casts, linear and motion casts, distances, contacts, and near or touching pairs, for
/// [`all`](Self::all) bodies or [`among`](Self::among) some. The first ray hit and the nearest body of all are also
/// methods of the scene itself.
///
/// # Answers
/// Every answer is the same, *to the last bit*, as if the single query were made for each body (or pair) in the order
/// of their indices; of equal answers the one with the lowest index counts. It does not depend on the number of
/// threads or on how the scene was built. A tree of boxes tells which bodies need no query. The box of a body has
/// room for the rounding of its queries, so that a box which is too far away is a proof about the query, not only
/// about the body. Every answer says how much was left out ([`Work`]).
///
/// If a query ends undecided, or with a hit whose bracket is still open, the box of the body may prove more than the
/// query did. Then the body counts from where its bracket begins or from where its box begins, whichever is later.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, SupportMap, glam::DVec3};
/// use gjk_raycast::{DistanceOptions, Ray, RayCastOptions, Scene};
///
/// type Body = Box<dyn SupportMap<Vector = DVec3>>;
/// let at = |x, y| DVec3::new(x, y, 0.0);
/// let scene = Scene::new([
///     Box::new(Posed::translated(Ball::new(1.0)?, at(20.0, 0.0))?) as Body,
///     Box::new(Posed::translated(Cuboid::new(DVec3::ONE)?, at(10.0, 0.0))?) as Body,
///     Box::new(Posed::translated(Cuboid::new(DVec3::ONE)?, at(10.0, 8.0))?) as Body,
/// ])?;
/// let ray = Ray { source: DVec3::ZERO, direction: DVec3::X };
/// let answer = scene.ray_cast(ray, RayCastOptions::default())?;
/// let first = answer.first.ok_or("two are in the way")?;
/// assert_eq!((first.body, first.hit.lambda), (1, 9.0));
/// // One is beside the ray, and one behind the hit.
/// assert_eq!((answer.work.tested, answer.work.culled), (1, 2));
///
/// let nearest = scene.nearest(&Ball::new(0.5)?, DistanceOptions::default());
/// assert_eq!(nearest.nearest.map(|n| (n.body, n.distance.distance)), Some((1, 8.5)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Bodies that move
/// [`update`](Self::update) moves all bodies and [`replace`](Self::replace) one; [`insert`](Self::insert) adds a
/// body, and [`remove`](Self::remove) takes one out. The tree is adjusted each time, and is rebuilt when that is
/// worth it.
///
/// [`Among::first_contacts`](crate::Among::first_contacts) finds the pairs of bodies that meet while all of them move
/// during a step, and when.
///
/// # Groups
/// A compound or a mesh that moves as one is a scene of its own, made a [`Group`]. A body of this scene may be an
/// [instance](Self::insert_group) of a group, with a pose; answers say which *member* of the body it was. The group may
/// be of another kind of shapes, so that this is also how a mesh, hulls and shapes of your own come into one scene.
///
/// # Layers
/// [`among`](Self::among) restricts a question to the bodies that a closure picks, such as those of a layer, and
/// [`Among::without_pairs`](crate::Among::without_pairs) leaves out pairs, such as those of neighbouring links.
#[doc(alias("world", "broad_phase", "query_pipeline", "collision_world", "compound", "trimesh"))]
#[derive(Clone, Debug)]
pub struct Scene<S: SupportMap> {
    bodies: Vec<Option<Occupant<S>>>,
    tree: Bvh<S::Vector>,
    /// The number of bodies, where each member of an instance counts as one.
    members: usize,
    /// The indices of half-spaces, which no box contains, in their order.
    half_spaces: Vec<usize>,
    /// Indices of removed bodies, to be used again.
    free: Vec<usize>,
    /// How many bodies with an index were removed, up to the highest index of one.
    removed: Vec<u32>,
}

/// What is at an index.
#[derive(Clone, Debug)]
enum Occupant<S: SupportMap> {
    Body(Body<S>),
    Instance(Box<Instance<S::Vector>>),
}

impl<S: SupportMap> Occupant<S> {
    fn body(&self) -> Option<&Body<S>> {
        match self {
            Self::Body(body) => Some(body),
            Self::Instance(_) => None,
        }
    }

    fn instance(&self) -> Option<&Instance<S::Vector>> {
        match self {
            Self::Instance(instance) => Some(instance),
            Self::Body(_) => None,
        }
    }

    /// The box around it, if it has one.
    fn around(&self) -> Option<Aabb<S::Vector>> {
        match self {
            Self::Body(body) => body.convex().and_then(outer_box),
            Self::Instance(instance) => Some(instance.around()),
        }
    }

    fn members(&self) -> usize {
        self.instance().map_or(1, |instance| instance.group().len())
    }
}

impl<S: SupportMap> Scene<S> {
    /// The scene of these bodies, with indices in their order.
    ///
    /// # Errors
    /// [`SceneError::NotFinite`] for the first body whose box is not finite.
    pub fn new(bodies: impl IntoIterator<Item = S>) -> Result<Self, SceneError> {
        let bodies: Vec<_> = bodies.into_iter().map(|body| Some(Occupant::Body(Body::Convex(body)))).collect();
        let around = |(body, slot): (_, &Occupant<S>)| slot.around().ok_or(SceneError::NotFinite { body });
        let boxes: Vec<_> = bodies.iter().flatten().enumerate().map(around).collect::<Result<_, _>>()?;
        Ok(Self { members: bodies.len(), bodies, tree: Bvh::new(&boxes), ..Self::default() })
    }

    /// The number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.bodies.len() - self.free.len()
    }

    /// Whether there are no bodies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The body with this index, if there is one: a shape, or a half-space. For instances of groups see
    /// [`instance`](Self::instance) and [`member`](Self::member).
    #[must_use]
    pub fn get(&self, body: usize) -> Option<&Body<S>> {
        self.slot(body)?.body()
    }

    /// The instance with this index, if there is one.
    #[must_use]
    pub fn instance(&self, body: usize) -> Option<&Instance<S::Vector>> {
        self.slot(body)?.instance()
    }

    /// The member of an instance as it is in the world, such as for the derivatives of an answer, or the certificate;
    /// `None` if there is none. Its single queries are, to the last bit, those of the scene.
    #[must_use]
    pub fn member(&self, body: usize, member: usize) -> Option<Posed<Box<dyn SupportMap<Vector = S::Vector> + '_>>> {
        self.instance(body)?.member(member)
    }

    #[inline]
    fn slot(&self, index: usize) -> Option<&Occupant<S>> {
        self.bodies.get(index)?.as_ref()
    }

    /// The bodies with their indices, which need not follow one another where bodies were removed. Instances are left
    /// out.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &Body<S>)> {
        self.bodies.iter().enumerate().filter_map(|(index, slot)| Some((index, slot.as_ref()?.body()?)))
    }

    /// The instances with their indices.
    pub fn instances(&self) -> impl Iterator<Item = (usize, &Instance<S::Vector>)> {
        self.bodies.iter().enumerate().filter_map(|(index, slot)| Some((index, slot.as_ref()?.instance()?)))
    }

    /// The tree of the bodies' boxes: its items are the indices of the bodies.
    #[must_use]
    pub fn tree(&self) -> &Bvh<S::Vector> {
        &self.tree
    }

    /// Adds a body and returns its index: the index that became free last, or a new one.
    ///
    /// # Errors
    /// [`SceneError::NotFinite`], with the index that the body would have had, if its box is not finite.
    pub fn insert(&mut self, body: S) -> Result<usize, SceneError> {
        let index = self.next_index();
        let around = outer_box(&body).ok_or(SceneError::NotFinite { body: index })?;
        self.put(index, Occupant::Body(Body::Convex(body)));
        self.tree.insert(index, around);
        Ok(index)
    }

    /// Adds an instance of a group, and returns its index. Its members are asked wherever bodies are, and have a number
    /// in the answer beside the index, but make no pairs with each other.
    ///
    /// # Errors
    /// With the index that the body would have had, [`SceneError::NoPose`] if a number of the pose is not finite or the
    /// quaternion is zero, and [`SceneError::NotFinite`] if the box is not finite; [`SceneError::TooDeep`] if there are
    /// too many members to count.
    pub fn insert_group(&mut self, group: &Group<S::Vector>, pose: Pose<S::Vector>) -> Result<usize, SceneError> {
        let index = self.next_index();
        let instance = Instance::new(index, group.clone(), pose)?;
        let around = instance.around();
        self.members.checked_add(group.len()).ok_or(SceneError::TooDeep)?;
        self.put(index, Occupant::Instance(Box::new(instance)));
        self.tree.insert(index, around);
        Ok(index)
    }

    /// Moves an instance. Only its own box changes, whatever its group is made of.
    ///
    /// # Errors
    /// [`SceneError::NoSuchInstance`], [`SceneError::NoPose`] or [`SceneError::NotFinite`]. The scene is then as
    /// before.
    pub fn place(&mut self, body: usize, pose: Pose<S::Vector>) -> Result<(), SceneError> {
        let Some(Some(Occupant::Instance(instance))) = self.bodies.get_mut(body) else {
            return Err(SceneError::NoSuchInstance { body });
        };
        instance.place(body, pose)?;
        self.tree.set(body, instance.around());
        Ok(())
    }

    fn next_index(&self) -> usize {
        self.free.last().copied().unwrap_or(self.bodies.len())
    }

    /// Adds a half-space, and returns its index.
    pub fn insert_half_space(&mut self, half_space: HalfSpace<S::Vector>) -> usize {
        let index = self.next_index();
        self.put(index, Occupant::Body(Body::HalfSpace(half_space)));
        let place = self.half_spaces.partition_point(|&other| other < index);
        self.half_spaces.insert(place, index);
        index
    }

    fn put(&mut self, index: usize, slot: Occupant<S>) {
        self.members += slot.members();
        if self.free.last() == Some(&index) {
            self.free.pop();
            self.bodies[index] = Some(slot);
        } else {
            self.bodies.push(Some(slot));
        }
    }

    /// Takes a body out and returns it; `None` if there is no body with this index, or an instance. A body that is
    /// added later may get the index, but not the [handle](Self::handle).
    pub fn remove(&mut self, body: usize) -> Option<Body<S>> {
        self.get(body)?;
        match self.take(body)? {
            Occupant::Body(removed) => Some(removed),
            Occupant::Instance(_) => None,
        }
    }

    /// Takes an instance out and returns it; `None` if there is no instance with this index.
    pub fn remove_instance(&mut self, body: usize) -> Option<Instance<S::Vector>> {
        self.instance(body)?;
        match self.take(body)? {
            Occupant::Instance(removed) => Some(*removed),
            Occupant::Body(_) => None,
        }
    }

    fn take(&mut self, index: usize) -> Option<Occupant<S>> {
        let removed = self.bodies.get_mut(index)?.take()?;
        self.members -= removed.members();
        self.free.push(index);
        self.forget(index);
        self.tree.remove(index);
        self.half_spaces.retain(|&half_space| half_space != index);
        Some(removed)
    }

    /// Puts another body in the place of one, moved or different, and returns the one that was there.
    ///
    /// # Errors
    /// [`SceneError::NoSuchBody`] if no bounded body has this index; [`SceneError::NotFinite`] if the box of the new
    /// one is not finite. The scene is then as before.
    pub fn replace(&mut self, index: usize, body: S) -> Result<S, SceneError> {
        let Some(Some(Occupant::Body(Body::Convex(place)))) = self.bodies.get_mut(index) else {
            return Err(SceneError::NoSuchBody { body: index });
        };
        let around = outer_box(&body).ok_or(SceneError::NotFinite { body: index })?;
        self.tree.set(index, around);
        Ok(core::mem::replace(place, body))
    }

    /// Replaces every bounded body by the one that `moved` returns for its index and the body, in the order of the
    /// indices, in time proportional to their number. Instances stay where they are.
    ///
    /// # Errors
    /// [`SceneError::NotFinite`] for the first body whose box would not be finite. All such bodies stay as they were,
    /// and the rest are moved.
    pub fn update(&mut self, mut moved: impl FnMut(usize, &S) -> S) -> Result<(), SceneError> {
        self.refit(|index, slot| {
            let Occupant::Body(Body::Convex(body)) = slot else { return Ok(slot.around()) };
            let next = moved(index, body);
            let around = outer_box(&next).ok_or(SceneError::NotFinite { body: index })?;
            *body = next;
            Ok(Some(around))
        })
    }

    /// Gives every instance the pose that `moved` returns for its index and the instance, in the order of the indices,
    /// in time proportional to the number of bodies. Other bodies stay where they are.
    ///
    /// # Errors
    /// [`SceneError::NoPose`] or [`SceneError::NotFinite`] for the first instance that has no place there. All such
    /// instances stay where they were, and the rest are moved.
    pub fn update_instances(
        &mut self,
        mut moved: impl FnMut(usize, &Instance<S::Vector>) -> Pose<S::Vector>,
    ) -> Result<(), SceneError> {
        self.refit(|index, slot| {
            if let Occupant::Instance(instance) = slot {
                instance.place(index, moved(index, instance))?;
            }
            Ok(slot.around())
        })
    }

    /// Gives every bounded body the box that `moved` returns, or its own if that is refused; returns the first error.
    fn refit(
        &mut self,
        mut moved: impl FnMut(usize, &mut Occupant<S>) -> Result<Option<Aabb<S::Vector>>, SceneError>,
    ) -> Result<(), SceneError> {
        let mut refused = Ok(());
        let bodies = &mut self.bodies;
        self.tree.refit(|index| {
            let around = bodies.get_mut(index).and_then(Option::as_mut).and_then(|slot| match moved(index, slot) {
                Ok(around) => around,
                Err(why) => {
                    refused = refused.and(Err(why));
                    slot.around()
                }
            });
            around.unwrap_or(Aabb { min: S::Vector::ZERO, max: S::Vector::ZERO })
        });
        refused
    }

    /// Rebuilds the tree. Nothing else changes; after many insertions, questions may become faster.
    pub fn rebuild(&mut self) {
        self.tree.rebuild();
    }
}

impl<S: SupportMap> Default for Scene<S> {
    fn default() -> Self {
        Self {
            bodies: Vec::new(),
            tree: Bvh::default(),
            members: 0,
            half_spaces: Vec::new(),
            free: Vec::new(),
            removed: Vec::new(),
        }
    }
}

impl<V: Vector> Scene<Triangle<V>> {
    /// The mesh of these triangles, each given by the indices of three vertices, of type `u32`, `usize` or any other
    /// that an index may have. Body `i` is triangle `i`; rays and shapes meet both of its sides.
    ///
    /// # Errors
    /// [`SceneError::NoSuchVertex`] if an index is that of no vertex, with `usize::MAX` for a negative one;
    /// [`SceneError::NotFinite`] if a coordinate of a triangle is not finite.
    #[doc(alias("trimesh", "triangle_mesh"))]
    pub fn mesh<I: Copy + TryInto<usize>>(vertices: &[V], triangles: &[[I; 3]]) -> Result<Self, SceneError> {
        let mut bodies = Vec::with_capacity(triangles.len());
        for (triangle, corners) in triangles.iter().enumerate() {
            let corners = corners.map(|vertex| vertex.try_into().unwrap_or(usize::MAX));
            if let Some(&vertex) = corners.iter().find(|&&vertex| vertex >= vertices.len()) {
                return Err(SceneError::NoSuchVertex { triangle, vertex });
            }
            let corners = corners.map(|vertex| vertices[vertex]);
            bodies.push(Triangle::new(corners).map_err(|_| SceneError::NotFinite { body: triangle })?);
        }
        Self::new(bodies)
    }
}

impl<V: Vector3> Scene<Triangle<V>> {
    /// Whether a ray or shape that moves along `direction` meets the front of a triangle, the side from which its
    /// corners are seen anticlockwise; `false` if no triangle has this index. This is for questions about one side of a
    /// mesh:
    ///
    /// ```
    /// use convex_support::glam::DVec3;
    /// use gjk_raycast::{Ray, RayCastOptions, Scene};
    ///
    /// let mesh = Scene::mesh(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
    /// let up = Ray { source: DVec3::new(0.2, 0.2, -1.0), direction: DVec3::Z };
    /// assert!(mesh.all().any_hit(up, RayCastOptions::default())?.hit);
    /// let front = |triangle| mesh.is_front(triangle, up.direction);
    /// assert!(!mesh.among(&front).any_hit(up, RayCastOptions::default())?.hit); // from behind
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn is_front(&self, triangle: usize, direction: V) -> bool {
        let Some(triangle) = self.get(triangle).and_then(|body| body.convex()) else { return false };
        let [a, b, c] = triangle.points();
        (b - a).cross(c - a).dot(direction) < V::Scalar::default()
    }
}
