//! Names of bodies that are not given again. An index is enough while bodies are not removed.

use convex_support::SupportMap;

use super::Scene;

/// A body of a scene by name, as [`Scene::handle`] tells it. Unlike an index it is not mistaken for the body that was
/// added later and took the index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyHandle {
    index: usize,
    /// How many bodies with this index were removed before.
    removed: u32,
}

impl<S: SupportMap> Scene<S> {
    /// The handle of the body with this index, if there is one. A body that is [replaced](Self::replace) keeps it.
    ///
    /// ```
    /// use convex_support::{Ball, glam::DVec2};
    /// use gjk_raycast::Scene;
    ///
    /// let mut scene = Scene::new([Ball::<DVec2>::new(1.0)?])?;
    /// let handle = scene.handle(0).ok_or("it is there")?;
    /// assert_eq!(scene.index_of(handle), Some(0));
    /// scene.remove(0);
    /// assert_eq!(scene.insert(Ball::new(2.0)?)?, 0); // another body with the same index
    /// assert_eq!(scene.index_of(handle), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    #[doc(alias = "generation", alias = "entity", alias = "key")]
    pub fn handle(&self, index: usize) -> Option<BodyHandle> {
        self.slot(index)?;
        Some(BodyHandle { index, removed: self.removed.get(index).copied().unwrap_or(0) })
    }

    /// The index of the body with this handle, if it has not been removed.
    #[must_use]
    pub fn index_of(&self, handle: BodyHandle) -> Option<usize> {
        (self.handle(handle.index) == Some(handle)).then_some(handle.index)
    }

    /// Notes that a body was removed.
    pub(super) fn forget(&mut self, index: usize) {
        if self.removed.len() <= index {
            self.removed.resize(index + 1, 0);
        }
        self.removed[index] = self.removed[index].wrapping_add(1);
    }
}
