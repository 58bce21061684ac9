//! Building by the surface area heuristic, in bins.
//!
//! A question meets a box about as often as its surface is large, so that a split into two parts costs about n₁·area₁ +
//! n₂·area₂. Of the splits between 16 bins of the centres along the longest axis the cheapest is taken, and a node's
//! range is split three times for its four children (I. Wald, *On fast construction of SAH-based bounding volume
//! hierarchies*, 2007).

use alloc::vec::Vec;

use super::frame::Frame;
use super::node::{Boxes, Link, Node, Slot, WIDTH};
use super::{Bvh, node};
use crate::glam::{Vec3A, Vec4};
use crate::{Aabb, Vector, compiled_once};

const BINS: usize = 16;

/// An item to be put into the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) around: Aabb<Vec3A>,
    pub(super) item: u32,
}

impl Entry {
    /// Twice the centre, which orders entries as well as the centre does.
    #[inline(always)]
    fn center(&self) -> Vec3A {
        self.around.min + self.around.max
    }
}

/// A part of the entries, with the box around it and that around the centres.
#[derive(Clone, Copy)]
struct Range {
    start: usize,
    end: usize,
    extent: Extent,
}

impl Range {
    fn len(&self) -> usize {
        self.end - self.start
    }
}

/// The box around some entries, and that around their (twice) centres.
#[derive(Clone, Copy)]
struct Extent {
    around: Aabb<Vec3A>,
    centers: Aabb<Vec3A>,
}

impl Extent {
    const NOTHING: Aabb<Vec3A> = Aabb { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY };
    const EMPTY: Self = Self { around: Self::NOTHING, centers: Self::NOTHING };

    fn of(entries: &[Entry]) -> Self {
        entries.iter().fold(Self::EMPTY, |sum, entry| sum.with(entry))
    }

    #[inline(always)]
    fn with(self, entry: &Entry) -> Self {
        let center = entry.center();
        self.union(&Self { around: entry.around, centers: Aabb { min: center, max: center } })
    }

    #[inline(always)]
    fn union(&self, other: &Self) -> Self {
        Self { around: self.around.union(&other.around), centers: self.centers.union(&other.centers) }
    }
}

compiled_once! {
    /// [`Bvh::rebuild`].
    fn rebuild<V>(tree: &mut Bvh<V>) -> () {
        tree.build_all();
    }
}

/// A range that a node is to be made of, in that place, and the levels it may take.
struct Task {
    node: usize,
    range: Range,
    levels: u32,
}

impl<V: Vector> Bvh<V> {
    /// The tree of these boxes; box `i` is item `i`. It takes time proportional to n log n.
    ///
    /// # Panics
    /// If there are 2³⁰ boxes or more.
    #[must_use]
    pub fn new(boxes: &[Aabb<V>]) -> Self {
        let mut tree = Self {
            nodes: alloc::vec![Node::empty(Slot::NONE)],
            frame: Frame::empty(),
            boxes: boxes.to_vec(),
            // Every item is in the tree from here on; where is to be found out.
            slots: alloc::vec![Slot::new(0, 0); boxes.len()],
            dead: 0,
            built_cost: 0.0,
        };
        tree.rebuild();
        tree
    }

    /// Rebuilds the tree over the present boxes.
    pub fn rebuild(&mut self) {
        rebuild(self);
    }

    fn build_all(&mut self) {
        let items = || (0..self.boxes.len()).filter(|&item| self.slots[item] != Slot::NONE);
        let count = items().count();
        self.frame = Frame::of(count, items().map(|item| self.boxes[item]));
        let entry = |item| Entry { around: self.frame.outwards(&self.boxes[item]), item: node::index(item) };
        let entries: Vec<_> = items().map(entry).collect();
        self.nodes.truncate(1);
        self.nodes.reserve(count / 2);
        self.dead = 0;
        self.build(0, entries);
        self.built_cost = self.cost();
    }

    /// Makes the entries all there is under node `root`; its place in its parent stays.
    pub(super) fn build(&mut self, root: usize, mut entries: Vec<Entry>) {
        self.nodes[root] = Node { count: entries.len() as u32, ..Node::empty(self.nodes[root].parent) };
        let range = Range { start: 0, end: entries.len(), extent: Extent::of(&entries) };
        let mut tasks = alloc::vec![Task { node: root, range, levels: allowed_levels(entries.len()) }];
        while let Some(Task { node, range, levels }) = tasks.pop() {
            let (parts, count) = split_in_four::<V>(&mut entries, range, levels);
            for (lane, part) in parts[..count].iter().enumerate() {
                let slot = Slot::new(node, lane);
                self.nodes[node].boxes.set(lane, part.extent.around);
                self.nodes[node].children[lane] = if part.len() == 1 {
                    let item = entries[part.start].item as usize;
                    self.slots[item] = slot;
                    Link::item(item)
                } else {
                    let child = self.nodes.len();
                    self.nodes.push(Node { count: part.len() as u32, ..Node::empty(slot) });
                    tasks.push(Task { node: child, range: *part, levels: levels - 1 });
                    Link::node(child)
                };
            }
        }
    }

    /// How much work a random question is expected to be: the area of all inner boxes by that of the whole. Not a
    /// number where areas over- or underflow.
    pub(super) fn cost(&self) -> f64 {
        let of_nodes = |node: &Node| {
            let areas = areas::<V>(&node.boxes).to_array().into_iter().zip(node.children);
            areas.map(|(area, link)| if link.is_node() { area } else { 0.0 }).sum::<f32>()
        };
        let live = self.nodes.iter().filter(|node| node.parent != Slot::DEAD);
        live.map(|node| f64::from(of_nodes(node))).sum::<f64>() / f64::from(area::<V>(&self.nodes[0].boxes.union()))
    }
}

/// Half the surfaces of a node's boxes, as [`area`] does.
#[inline(always)]
fn areas<V: Vector>(boxes: &Boxes) -> Vec4 {
    let [x, y, z] = [0, 1, 2].map(|axis| boxes.max(axis) - boxes.min(axis));
    if V::DIM == 2 { x + y } else { x * y + y * z + z * x }
}

/// The levels of the shallowest tree of `count` items: ⌈log₄ count⌉.
pub(super) fn least_levels(count: usize) -> u32 {
    let bits = usize::BITS - count.saturating_sub(1).leading_zeros();
    bits.div_ceil(2)
}

/// The levels that a tree may be built with: some more, for the heuristic.
fn allowed_levels(count: usize) -> u32 {
    let least = least_levels(count);
    least + least / 2 + 2
}

/// Up to four parts of the range, of which there is at least one unless it is empty.
///
/// The part with the largest surface is split first. Where the levels that remain are only just enough, the largest
/// part is split in halves instead: a quarter of the items needs a level less.
fn split_in_four<V: Vector>(entries: &mut [Entry], range: Range, levels: u32) -> ([Range; WIDTH], usize) {
    let mut parts = [range; WIDTH];
    if range.len() <= WIDTH {
        for (i, part) in parts[..range.len()].iter_mut().enumerate() {
            let start = range.start + i;
            *part = Range { start, end: start + 1, extent: Extent::of(&entries[start..=start]) };
        }
        return (parts, range.len());
    }
    let halves = levels <= least_levels(range.len()) + 1;
    for count in 1..WIDTH {
        let mut widest = 0;
        for i in 1..count {
            let wider = if halves || parts[widest].len() == 1 {
                parts[i].len() > parts[widest].len()
            } else {
                parts[i].len() > 1 && area::<V>(&parts[i].extent.around) > area::<V>(&parts[widest].extent.around)
            };
            if wider {
                widest = i;
            }
        }
        [parts[widest], parts[count]] = split::<V>(entries, &parts[widest], halves);
    }
    (parts, WIDTH)
}

/// Orders the entries of a range, of which there are two or more, so that those of its first part come first.
fn split<V: Vector>(entries: &mut [Entry], range: &Range, halves: bool) -> [Range; 2] {
    let &Range { start, end, extent: Extent { centers, .. } } = range;
    let entries = &mut entries[start..end];
    let size = centers.max - centers.min;
    let axis = (1..V::DIM).fold(0, |a, i| if size[i] > size[a] { i } else { a });
    let bins = Bins::new(axis, &centers, entries.len());
    if !halves
        && bins.per_bin.is_finite()
        && let Some((last, [first, second])) = bins.cheapest_split::<V>(entries)
    {
        let middle = start + partition(entries, |entry| bins.of(entry) <= last);
        return [Range { start, end: middle, extent: first }, Range { start: middle, end, extent: second }];
    }
    let middle = entries.len() / 2;
    entries.select_nth_unstable_by(middle, |a, b| {
        let [x, y] = [a, b].map(|entry| entry.center()[axis]);
        x.partial_cmp(&y).unwrap_or(core::cmp::Ordering::Equal).then(a.item.cmp(&b.item))
    });
    let [first, second] = [&entries[..middle], &entries[middle..]].map(Extent::of);
    [Range { start, end: start + middle, extent: first }, Range { start: start + middle, end, extent: second }]
}

/// Bins of equal width along an axis.
struct Bins {
    axis: usize,
    low: f32,
    per_bin: f32,
    /// Of few entries, as many as there are.
    count: usize,
}

impl Bins {
    fn new(axis: usize, centers: &Aabb<Vec3A>, entries: usize) -> Self {
        let count = entries.min(BINS);
        let (low, high) = (centers.min[axis], centers.max[axis]);
        Self { axis, low, per_bin: count as f32 / (high - low), count }
    }

    #[inline(always)]
    fn of(&self, entry: &Entry) -> usize {
        let bin = (entry.center()[self.axis] - self.low) * self.per_bin;
        (bin as usize).min(self.count - 1)
    }

    /// The last bin of the first part of the cheapest split, and the extents of both parts; `None` where no split is
    /// cheaper than any other.
    fn cheapest_split<V: Vector>(&self, entries: &[Entry]) -> Option<(usize, [Extent; 2])> {
        let (mut counts, mut extents) = ([0_u32; BINS], [Extent::EMPTY; BINS]);
        for entry in entries {
            let bin = self.of(entry);
            counts[bin] += 1;
            extents[bin] = extents[bin].with(entry);
        }
        let (counts, extents) = (&counts[..self.count], &extents[..self.count]);
        // What the part behind each split costs, from the end; then what the part before it does.
        let mut behind = [0.0; BINS];
        let (mut count, mut around) = (0, Extent::NOTHING);
        for bin in (1..counts.len()).rev() {
            (count, around) = (count + counts[bin], around.union(&extents[bin].around));
            behind[bin - 1] = count as f32 * area::<V>(&around);
        }
        let (mut count, mut around) = (0, Extent::NOTHING);
        let (mut least, mut best) = (f32::INFINITY, None);
        for bin in 0..counts.len() - 1 {
            (count, around) = (count + counts[bin], around.union(&extents[bin].around));
            let cost = count as f32 * area::<V>(&around) + behind[bin];
            if cost < least && count > 0 && count < entries.len() as u32 {
                (least, best) = (cost, Some(bin));
            }
        }
        let sum = |bins: &[Extent]| bins.iter().fold(Extent::EMPTY, |sum, extent| sum.union(extent));
        best.map(|last| (last, [sum(&extents[..=last]), sum(&extents[last + 1..])]))
    }
}

/// Brings the entries that `first` picks to the front, and returns their number. Every one is exchanged, which takes
/// no branch, since no processor can predict which are picked.
#[inline(always)]
fn partition<T>(entries: &mut [T], first: impl Fn(&T) -> bool) -> usize {
    let mut picked = 0;
    for i in 0..entries.len() {
        let is_first = first(&entries[i]);
        entries.swap(i, picked);
        picked += usize::from(is_first);
    }
    picked
}

/// Half the surface of a box; half the circumference in 2D.
#[inline]
pub(super) fn area<V: Vector>(b: &Aabb<Vec3A>) -> f32 {
    let d = b.max - b.min;
    if V::DIM == 2 { d.x + d.y } else { d.x * d.y + d.y * d.z + d.z * d.x }
}
