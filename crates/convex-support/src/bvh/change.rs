//! Items that are moved, added and removed.
//!
//! A new item goes down to the child whose box it enlarges least and takes the first free place, or shares an item's.
//! That alone can grow a chain (items inserted in order do), so that the rule of scapegoat trees is added (Galperin and
//! Rivest 1993): after an insertion `h` levels below a node with `n` items,
//!
//! > h ≤ 2·⌈log₄ n⌉ + 4,
//!
//! or the lowest node for which it does not hold is built anew, with at most 1.5·⌈log₄ n⌉ + 2 levels. So the depth is
//! at most 34 for the 2³⁰ items that a tree can hold, and rebuilding costs a constant number of levels' work for each
//! insertion in the long run.

use alloc::vec::Vec;

use super::Bvh;
use super::build::{Entry, area, least_levels};
use super::node::{Child, Link, Node, Slot, WIDTH};
use super::search::MAX_DEPTH;
use crate::glam::Vec3A;
use crate::{Aabb, Vector};

/// How much worse a refitted tree may become before it is rebuilt.
const WORSE: f64 = 1.5;

impl<V: Vector> Bvh<V> {
    /// Gives every item the box that `box_of` returns, in time proportional to their number. If the boxes have moved so
    /// far that the tree has become half as costly again as when it was built, it is rebuilt.
    ///
    /// `box_of` is called for the items in the order of their numbers.
    pub fn refit(&mut self, mut box_of: impl FnMut(usize) -> Aabb<V>) {
        for (item, around) in self.boxes.iter_mut().enumerate() {
            if self.slots[item] != Slot::NONE {
                *around = box_of(item);
            }
        }
        // Children come after their parents, so that a node is complete before its box is wanted.
        for index in (0..self.nodes.len()).rev() {
            let node = &mut self.nodes[index];
            if node.parent == Slot::DEAD {
                continue;
            }
            for lane in 0..WIDTH {
                if let Child::Item(item) = node.children[lane].child() {
                    node.boxes.set(lane, self.frame.outwards(&self.boxes[item]));
                }
            }
            if index > 0 {
                let (around, parent) = (node.boxes.union(), node.parent);
                self.nodes[parent.node()].boxes.set(parent.lane(), around);
            }
        }
        if self.frame.sees_beyond(&self.nodes[0].boxes.union()) || self.cost() > self.built_cost * WORSE {
            self.rebuild();
        }
    }

    /// Gives one item another box, in time proportional to the depth. An item that is not in the tree is inserted.
    ///
    /// # Panics
    /// If `item` is 2³⁰ or more.
    pub fn set(&mut self, item: usize, around: Aabb<V>) {
        match self.slots.get(item) {
            Some(&slot) if slot != Slot::NONE => {
                self.boxes[item] = around;
                self.nodes[slot.node()].boxes.set(slot.lane(), self.frame.outwards(&around));
                self.tell_parents(slot.node());
                self.rebuild_if_beyond(&around);
            }
            _ => self.insert(item, around),
        }
    }

    /// Adds an item. An item that is in the tree already gets this box.
    ///
    /// # Panics
    /// If `item` is 2³⁰ or more.
    pub fn insert(&mut self, item: usize, around: Aabb<V>) {
        if self.get(item).is_some() {
            return self.set(item, around);
        }
        let link = Link::item(item);
        if item >= self.slots.len() {
            self.slots.resize(item + 1, Slot::NONE);
            self.boxes.resize(item + 1, around);
        }
        self.boxes[item] = around;
        let seen = self.frame.outwards(&around);
        let mut node = 0;
        // The depth is bounded; this says so.
        for _ in 0..=MAX_DEPTH {
            let lane = self.lane_for(node, &seen);
            let slot = Slot::new(node, lane);
            match self.nodes[node].children[lane].child() {
                Child::Node(child) => node = child,
                Child::None => {
                    self.put(slot, link, seen);
                    break;
                }
                Child::Item(_) => {
                    let (other, its_box) = (self.nodes[node].children[lane], self.nodes[node].boxes.get(lane));
                    node = self.nodes.len();
                    self.nodes.push(Node { count: 1, ..Node::empty(slot) });
                    self.put(slot, Link::node(node), its_box);
                    self.put(Slot::new(node, 0), other, its_box);
                    self.put(Slot::new(node, 1), link, seen);
                    break;
                }
            }
        }
        self.tell_parents(node);
        self.count_in(node);
        self.rebuild_if_beyond(&around);
    }

    /// Removes an item; returns whether it was there.
    pub fn remove(&mut self, item: usize) -> bool {
        let slot = self.slots.get(item).copied().unwrap_or(Slot::NONE);
        if slot == Slot::NONE {
            return false;
        }
        self.slots[item] = Slot::NONE;
        let node = slot.node();
        self.nodes[node].children[slot.lane()] = Link::NONE;
        self.nodes[node].boxes.clear(slot.lane());
        let mut above = Slot::new(node, 0);
        while above != Slot::NONE {
            let holder = &mut self.nodes[above.node()];
            holder.count -= 1;
            above = holder.parent;
        }
        let mut changed = node;
        let parent = self.nodes[node].parent;
        let mut rest = self.nodes[node].children.into_iter().enumerate().filter(|(_, link)| *link != Link::NONE);
        // A node of one child gives its place to the child.
        if let (Some((lane, only)), None, true) = (rest.next(), rest.next(), parent != Slot::NONE) {
            self.put(parent, only, self.nodes[node].boxes.get(lane));
            self.nodes[node].parent = Slot::DEAD;
            self.dead += 1;
            changed = parent.node();
        }
        self.tell_parents(changed);
        self.rebuild_if_mostly_dead();
        true
    }

    /// The place for a box under a node: one that is free, or of the child that grows least.
    fn lane_for(&self, node: usize, around: &Aabb<Vec3A>) -> usize {
        let Node { children, boxes, .. } = &self.nodes[node];
        if let Some(free) = children.iter().position(|link| *link == Link::NONE) {
            return free;
        }
        let growth = |lane| {
            let before = boxes.get(lane);
            area::<V>(&before.union(around)) - area::<V>(&before)
        };
        let mut best = (growth(0), 0);
        for lane in 1..WIDTH {
            let growth = growth(lane);
            if growth < best.0 {
                best = (growth, lane);
            }
        }
        best.1
    }

    /// Puts a child into a place.
    fn put(&mut self, slot: Slot, link: Link, around: Aabb<Vec3A>) {
        let node = &mut self.nodes[slot.node()];
        node.children[slot.lane()] = link;
        node.boxes.set(slot.lane(), around);
        match link.child() {
            Child::Item(item) => self.slots[item] = slot,
            Child::Node(child) => self.nodes[child].parent = slot,
            Child::None => {}
        }
    }

    /// Brings the boxes above a node up to date.
    fn tell_parents(&mut self, mut node: usize) {
        while self.nodes[node].parent != Slot::NONE {
            let (around, parent) = (self.nodes[node].boxes.union(), self.nodes[node].parent);
            let holder = &mut self.nodes[parent.node()];
            if holder.boxes.get(parent.lane()) == around {
                return;
            }
            holder.boxes.set(parent.lane(), around);
            node = parent.node();
        }
    }

    /// Counts a new item under a node and all above it, and builds anew what has become too deep for what it holds.
    fn count_in(&mut self, node: usize) {
        let (mut above, mut height, mut lopsided) = (Slot::new(node, 0), 0, None);
        while above != Slot::NONE {
            let index = above.node();
            let holder = &mut self.nodes[index];
            holder.count += 1;
            height += 1;
            if lopsided.is_none() && height > 2 * least_levels(holder.count as usize) + 4 {
                lopsided = Some(index);
            }
            above = holder.parent;
        }
        if let Some(root) = lopsided {
            let entries = self.entries_under(root);
            self.build(root, entries);
            self.rebuild_if_mostly_dead();
        }
    }

    /// The items under a node with their boxes. All nodes under it are dead from then on.
    fn entries_under(&mut self, root: usize) -> Vec<Entry> {
        let mut entries = Vec::with_capacity(self.nodes[root].count as usize);
        let mut below = alloc::vec![root];
        while let Some(index) = below.pop() {
            let node = self.nodes[index];
            for (lane, link) in node.children.into_iter().enumerate() {
                match link.child() {
                    Child::Item(item) => entries.push(Entry { around: node.boxes.get(lane), item: item as u32 }),
                    Child::Node(child) => below.push(child),
                    Child::None => {}
                }
            }
            if index != root {
                self.nodes[index].parent = Slot::DEAD;
                self.dead += 1;
            }
        }
        entries
    }

    /// Builds anew, in a frame that fits, where a box has come that is far from all others.
    fn rebuild_if_beyond(&mut self, around: &Aabb<V>) {
        if self.frame.is_beyond(around) {
            self.rebuild();
        }
    }

    fn rebuild_if_mostly_dead(&mut self) {
        if 2 * self.dead > self.nodes.len() + 2 * WIDTH {
            self.rebuild();
        }
    }
}
