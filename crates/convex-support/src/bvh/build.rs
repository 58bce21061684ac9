//! Building by the surface area heuristic, in bins.
//!
//! A question meets a box about as often as its surface is large, so that a split into two parts costs about n₁·area₁ +
//! n₂·area₂. Of the splits between 16 bins of the centres along the longest axis the cheapest is taken, and a node's range
//! is split three times for its four children (I. Wald, *On fast construction of SAH-based bounding volume hierarchies*,
//! 2007).

use alloc::vec::Vec;

use num_traits::Float as _;

use super::Bvh;
use super::node::{Child, Link, Node, Slot, WIDTH};
use crate::{Aabb, Scalar, Vector};

const BINS: usize = 16;

/// An item to be put into the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<V: Vector> {
    pub(super) around: Aabb<V>,
    pub(super) item: usize,
}

/// A part of the entries, with the box around it.
#[derive(Clone, Copy)]
struct Range<V: Vector> {
    start: usize,
    end: usize,
    around: Aabb<V>,
}

/// A range that a node is to be made of, in that place, and the levels it may take.
struct Task<V: Vector> {
    node: usize,
    range: Range<V>,
    levels: u32,
}

impl<V: Vector> Bvh<V> {
    /// The tree of these boxes; box `i` is item `i`. Takes time proportional to n log n.
    ///
    /// # Panics
    /// If there are 2³⁰ boxes or more.
    #[must_use]
    pub fn new(boxes: &[Aabb<V>]) -> Self {
        let entries: Vec<_> = boxes.iter().enumerate().map(|(item, &around)| Entry { around, item }).collect();
        let mut tree = Self {
            nodes: Vec::with_capacity(boxes.len() / 2 + 1),
            slots: alloc::vec![Slot::NONE; boxes.len()],
            dead: 0,
            built_cost: V::Scalar::ZERO,
        };
        tree.nodes.push(Node::empty(Slot::NONE));
        tree.build(0, entries);
        tree.built_cost = tree.cost();
        tree
    }

    /// Makes the entries all there is under node `root`; its place in its parent stays.
    pub(super) fn build(&mut self, root: usize, mut entries: Vec<Entry<V>>) {
        self.nodes[root] = Node { count: entries.len() as u32, ..Node::empty(self.nodes[root].parent) };
        let range = Range { start: 0, end: entries.len(), around: union(&entries) };
        let mut tasks = alloc::vec![Task { node: root, range, levels: allowed_levels(entries.len()) }];
        while let Some(Task { node, range, levels }) = tasks.pop() {
            let (parts, count) = split_in_four(&mut entries, range, levels);
            for (lane, part) in parts[..count].iter().enumerate() {
                let slot = Slot::new(node, lane);
                self.nodes[node].boxes.set(lane, part.around);
                self.nodes[node].children[lane] = if part.end - part.start == 1 {
                    let item = entries[part.start].item;
                    self.slots[item] = slot;
                    Link::item(item)
                } else {
                    let child = self.nodes.len();
                    self.nodes.push(Node { count: (part.end - part.start) as u32, ..Node::empty(slot) });
                    tasks.push(Task { node: child, range: *part, levels: levels - 1 });
                    Link::node(child)
                };
            }
        }
    }

    /// How much work a random question is expected to be: the area of all inner boxes by that of the whole. Not a number
    /// where areas over- or underflow.
    pub(super) fn cost(&self) -> V::Scalar {
        let mut sum = V::Scalar::ZERO;
        for node in self.nodes.iter().filter(|node| node.parent != Slot::DEAD) {
            for (lane, link) in node.children.iter().enumerate() {
                if let Child::Node(_) = link.child() {
                    sum += area(&node.boxes.get(lane));
                }
            }
        }
        sum / area(&self.nodes[0].boxes.union())
    }
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
/// The part with the largest surface is split first. Where the levels that remain are only just enough, the largest part is
/// split in halves instead: a quarter of the items needs a level less.
fn split_in_four<V: Vector>(entries: &mut [Entry<V>], range: Range<V>, levels: u32) -> ([Range<V>; WIDTH], usize) {
    let mut parts = [range; WIDTH];
    let length = |part: &Range<V>| part.end - part.start;
    if length(&range) <= WIDTH {
        for (i, entry) in entries[range.start..range.end].iter().enumerate() {
            parts[i] = Range { start: range.start + i, end: range.start + i + 1, around: entry.around };
        }
        return (parts, length(&range));
    }
    let halves = levels <= least_levels(length(&range)) + 1;
    for count in 1..WIDTH {
        let mut widest = 0;
        for i in 1..count {
            let wider = if halves || length(&parts[widest]) == 1 {
                length(&parts[i]) > length(&parts[widest])
            } else {
                length(&parts[i]) > 1 && area(&parts[i].around) > area(&parts[widest].around)
            };
            if wider {
                widest = i;
            }
        }
        let Range { start, end, .. } = parts[widest];
        let middle = start + split(&mut entries[start..end], halves);
        parts[widest] = Range { start, end: middle, around: union(&entries[start..middle]) };
        parts[count] = Range { start: middle, end, around: union(&entries[middle..end]) };
    }
    (parts, WIDTH)
}

/// Orders the entries, of which there are two or more, so that a part of them comes first, and returns its length.
fn split<V: Vector>(entries: &mut [Entry<V>], halves: bool) -> usize {
    let (mut low, mut high) = (center(&entries[0]), center(&entries[0]));
    for entry in &entries[1..] {
        (low, high) = (low.min(center(entry)), high.max(center(entry)));
    }
    let size = high - low;
    let axis = (1..V::DIM).fold(0, |a, i| if size.get(i) > size.get(a) { i } else { a });
    let per_bin = V::Scalar::from_f64(BINS as f64) / size.get(axis);
    if !halves && per_bin.is_finite() {
        let bins = Bins { axis, low: low.get(axis), per_bin };
        if let Some(last) = bins.cheapest_split(entries) {
            let middle = partition(entries, |entry| bins.of(entry) <= last);
            if middle > 0 && middle < entries.len() {
                return middle;
            }
        }
    }
    let middle = entries.len() / 2;
    entries.select_nth_unstable_by(middle, |a, b| {
        let [x, y] = [a, b].map(|entry| center(entry).get(axis));
        x.partial_cmp(&y).unwrap_or(core::cmp::Ordering::Equal).then(a.item.cmp(&b.item))
    });
    middle
}

/// Bins of equal width along an axis.
struct Bins<S> {
    axis: usize,
    low: S,
    per_bin: S,
}

impl<S: Scalar> Bins<S> {
    #[inline]
    fn of<V: Vector<Scalar = S>>(&self, entry: &Entry<V>) -> usize {
        let bin = (center(entry).get(self.axis) - self.low) * self.per_bin;
        (bin.as_f64() as usize).min(BINS - 1)
    }

    /// The last bin of the first part of the cheapest split; `None` where no split is cheaper than any other.
    fn cheapest_split<V: Vector<Scalar = S>>(&self, entries: &[Entry<V>]) -> Option<usize> {
        let mut counts = [0_u32; BINS];
        let mut around = [empty(); BINS];
        for entry in entries {
            let bin = self.of(entry);
            counts[bin] += 1;
            around[bin] = around[bin].union(&entry.around);
        }
        // What lies behind each split, from the end; then what lies before it.
        let mut behind = [S::ZERO; BINS];
        let (mut sum, mut count) = (empty(), 0);
        for bin in (1..BINS).rev() {
            (sum, count) = (sum.union(&around[bin]), count + counts[bin]);
            behind[bin - 1] = cost(count, &sum);
        }
        (sum, count) = (empty(), 0);
        let mut best = (S::infinity(), None);
        for bin in 0..BINS - 1 {
            (sum, count) = (sum.union(&around[bin]), count + counts[bin]);
            let total = cost(count, &sum) + behind[bin];
            if total < best.0 && count > 0 && (count as usize) < entries.len() {
                best = (total, Some(bin));
            }
        }
        best.1
    }
}

fn cost<V: Vector>(count: u32, around: &Aabb<V>) -> V::Scalar {
    if count == 0 { V::Scalar::ZERO } else { V::Scalar::from_f64(f64::from(count)) * area(around) }
}

/// Brings the entries that `first` picks to the front, and returns their number.
fn partition<T>(entries: &mut [T], first: impl Fn(&T) -> bool) -> usize {
    let (mut i, mut j) = (0, entries.len());
    while i < j {
        if first(&entries[i]) {
            i += 1;
        } else {
            j -= 1;
            entries.swap(i, j);
        }
    }
    i
}

#[inline]
fn center<V: Vector>(entry: &Entry<V>) -> V {
    entry.around.center()
}

/// Half the surface of a box; half the circumference in 2D.
#[inline]
pub(super) fn area<V: Vector>(b: &Aabb<V>) -> V::Scalar {
    let d = b.max - b.min;
    if V::DIM == 2 {
        return d.get(0) + d.get(1);
    }
    d.get(0) * d.get(1) + d.get(1) * d.get(2) + d.get(2) * d.get(0)
}

/// The box around nothing.
fn empty<V: Vector>() -> Aabb<V> {
    Aabb { min: V::splat(V::Scalar::infinity()), max: V::splat(V::Scalar::neg_infinity()) }
}

fn union<V: Vector>(entries: &[Entry<V>]) -> Aabb<V> {
    entries.iter().fold(empty(), |sum, entry| sum.union(&entry.around))
}
