//! A scene as a group, of which other scenes have instances.

#[cfg(not(target_has_atomic = "ptr"))]
use alloc::rc::Rc as Arc;
#[cfg(target_has_atomic = "ptr")]
use alloc::sync::Arc;
use alloc::vec::Vec;

use convex_support::{Bvh, SupportMap, Vector};

use super::instance::{Group, Member, Members};
use super::{Occupant, Scene, SceneError};

/// How deep groups may be nested.
const MAX_LEVELS: usize = 16;

impl<S: SupportMap + Send + Sync> Members<S::Vector> for Scene<S> {
    fn tree(&self) -> &Bvh<S::Vector> {
        &self.tree
    }

    fn member(&self, index: usize) -> Option<Member<'_, S::Vector>> {
        match self.slot(index)? {
            Occupant::Body(body) => Some(Member::Shape(body.convex()?)),
            Occupant::Instance(instance) => Some(Member::Instance(instance)),
        }
    }
}

impl<V: Vector> Group<V> {
    /// The group of a scene's bodies; or of a scene that is shared already, such as a mesh that is asked elsewhere by
    /// its triangles.
    ///
    /// Members are named by numbers from zero, in the order of the bodies' indices. If the scene has no instances, the
    /// number of a member is the index of the body; for nested groups, [`path`](Self::path) says where the member is.
    ///
    /// # Errors
    /// [`SceneError::EmptyGroup`], also for a mesh without triangles; [`SceneError::UnboundedMember`] for the first
    /// half-space; [`SceneError::TooDeep`] if groups are nested more than 16 deep, or have too many members to count.
    pub fn new<S>(scene: impl Into<Arc<Scene<S>>>) -> Result<Self, SceneError>
    where
        S: SupportMap<Vector = V> + Send + Sync + 'static,
    {
        let scene: Arc<Scene<S>> = scene.into();
        if let Some(&member) = scene.half_spaces.first() {
            return Err(SceneError::UnboundedMember { member });
        }
        let around = scene.tree.around().ok_or(SceneError::EmptyGroup)?;
        let (mut first, mut end, mut levels) = (Vec::new(), 0_usize, 0);
        for slot in &scene.bodies {
            first.push(end);
            let (members, inner) = match slot {
                Some(Occupant::Instance(instance)) => (instance.group().end, instance.group().levels),
                _ => (1, 0),
            };
            end = end.checked_add(members).ok_or(SceneError::TooDeep)?;
            levels = levels.max(inner + 1);
        }
        if levels > MAX_LEVELS {
            return Err(SceneError::TooDeep);
        }
        if levels == 1 {
            first.clear();
        }
        Ok(Self { first: first.into(), end, len: scene.members, around, levels, scene })
    }
}
