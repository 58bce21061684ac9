//! The memory of one support query for the next.

/// The number of polytopes within one body that are remembered; any further ones are searched afresh each time.
const SLOTS: usize = 4;

/// The last support vertices of the polytopes within a body.
///
/// Successive support queries of an iterative method, and of successive frames, have nearly the same answer. If a large
/// polytope is given its last vertex, it climbs to the new one in a few steps. An empty hint (the default) is always
/// right, and an outdated one costs time, never correctness.
///
/// A body is a tree of combinators with shapes at its leaves; every query visits the leaves in the same order, and each
/// polytope among them takes the next slot. [`rewind`](Self::rewind) starts a query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hint {
    vertices: [u32; SLOTS],
    /// As wide as the others, so that a copy has no bytes between.
    next: u32,
}

impl Hint {
    /// The empty hint.
    #[must_use]
    pub const fn new() -> Self {
        Self { vertices: [0; SLOTS], next: 0 }
    }

    /// Starts a query of the whole body: its first polytope takes the first slot again.
    #[inline]
    pub fn rewind(&mut self) {
        self.next = 0;
    }

    /// The slot of the next polytope; `None` if a body has more polytopes than there are slots.
    #[inline]
    pub fn next_slot(&mut self) -> Option<&mut u32> {
        let slot = self.vertices.get_mut(self.next as usize)?;
        self.next += 1;
        Some(slot)
    }
}
