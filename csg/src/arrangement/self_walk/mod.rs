//! Which triangles of one operand may touch each other.
//!
//! Every triangle is near its neighbours, so this is most of the work where meshes are large. Boxes are in single precision, and in a
//! frame in which those around slivers are thin. They are grown by far more than rounding, so frame and precision decide nothing.
//!
//! Triangles are put in order by their size first, the largest ones in front, and by their place then: so those of a leaf are alike, and
//! slivers do not spoil the boxes of small triangles beside them. Each leaf is held against all that come after it. Where it is the larger
//! one, the planes of its triangles and through their edges are held against the boxes, too.

mod frame;
mod tile;
mod wide_boxes;
mod wide_corners;

use glam::DVec3;
use planecut_parallel::prelude::*;
use std::ops::Range;

use super::operand::Operand;
use crate::base::by_group;
use crate::ids::number32;
use frame::Frame;
use tile::{Tile, WidePlanes};
use wide_boxes::{Lanes, SLACK, SmallBox, WIDTH, WideBox, WideBoxes};
use wide_corners::{OTHER, WideCorners};

/// Triangles that one thread looks at in a row.
const CHUNK: usize = 1 << 12;

/// Leaves that are held against all others in a row.
const LEAVES: usize = 32;

/// The classes of sizes: one for each factor of 8, the middle one around the mean.
const CLASSES: usize = 64;

/// The exponent of the numbers from 1 to 2, as it is written in their bits.
const ONE_EXPONENT: usize = 1023;

/// Boxes around the triangles of an operand.
pub(super) struct SelfTree<'a> {
    operand: &'a Operand<'a>,
    /// The places of vertices in the frame.
    places: Vec<DVec3>,
    /// The triangles in order.
    order: Vec<u32>,
    /// For each leaf the corners of its triangles around which triangles have nothing in common but edges; [`OTHER`] for others.
    simple: Vec<WideCorners>,
    boxes: WideBoxes,
}

impl<'a> SelfTree<'a> {
    pub(super) fn new(operand: &'a Operand<'a>) -> Self {
        let frame = Frame::new(operand);
        let in_frame = |position: &DVec3| frame.place(*position);
        let places: Vec<DVec3> = operand.positions().par_iter().with_min_len(CHUNK).map(in_frame).collect();
        let slack = if frame.is_known { SLACK } else { f32::INFINITY };
        let near = operand.tree().order();
        let small_box = |triangle: &u32| {
            SmallBox::around(operand.triangles()[*triangle as usize].map(|vertex| places[vertex as usize]), slack)
        };
        let in_place: Vec<SmallBox> = near.par_iter().with_min_len(CHUNK).map(small_box).collect();
        let by_size = by_size(&in_place);
        let order: Vec<u32> = by_size.iter().map(|k| near[*k as usize]).collect();
        let sorted: Vec<SmallBox> = by_size.iter().map(|k| in_place[*k as usize]).collect();
        let simple = |vertex: u32| if operand.is_simple(vertex) { vertex } else { OTHER };
        let of_triangle = |triangle: &u32| operand.triangles()[*triangle as usize].map(simple);
        let of_leaf = |leaf: &[u32]| WideCorners::new(leaf.iter().map(of_triangle));
        let simple = order.par_chunks(WIDTH).with_min_len(CHUNK / WIDTH).map(of_leaf).collect();
        Self { operand, places, order, simple, boxes: WideBoxes::new(&sorted) }
    }

    /// Ranges of leaves that hold all of them.
    pub(super) fn tasks(&self) -> Vec<Range<usize>> {
        let count = self.boxes.leaves();
        (0..count).step_by(LEAVES).map(|first| first..(first + LEAVES).min(count)).collect()
    }

    /// Calls for each pair of triangles that may touch, one of them in these leaves and the other in the same one or a later one.
    pub(super) fn walk(&self, leaves: Range<usize>, visit: &mut impl FnMut(u32, u32)) {
        let mut waiting = Vec::new();
        for leaf in leaves {
            let mut query = Query::new(self, leaf);
            let root = self.boxes.levels.len() - 1;
            waiting.push((root, 0));
            while let Some((level, node)) = waiting.pop() {
                let boxes = &self.boxes.levels[level][node];
                for k in boxes.touching(&query.around) {
                    let child = WIDTH * node + k;
                    // the leaves below it, and which of them come first
                    if (child + 1) << (3 * (level - 1)) <= leaf {
                        continue;
                    }
                    let bounds = boxes.get(k);
                    if level > 1 {
                        if !query.is_larger(&bounds) || !query.near(&bounds).is_empty() {
                            waiting.push((level - 1, child));
                        }
                        continue;
                    }
                    let near = query.near(&bounds);
                    query.compare(child, near, visit);
                }
            }
        }
    }

    fn corners(&self, place: usize) -> [DVec3; 3] {
        self.operand.triangles()[self.order[place] as usize].map(|vertex| self.places[vertex as usize])
    }
}

/// A leaf that is held against others.
struct Query<'a> {
    tree: &'a SelfTree<'a>,
    leaf: usize,
    boxes: &'a WideBox,
    around: SmallBox,
    /// The mean size of its boxes.
    size: f32,
    tiles: [Option<Tile>; WIDTH],
    planes: Option<WidePlanes>,
}

impl<'a> Query<'a> {
    fn new(tree: &'a SelfTree<'a>, leaf: usize) -> Self {
        let boxes = &tree.boxes.levels[0][leaf];
        let count = WIDTH.min(tree.order.len() - WIDTH * leaf);
        let sizes: f32 = (0..count).map(|k| boxes.get(k).extent()).sum();
        let size = sizes / [1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0][count];
        let around = tree.boxes.levels[1][leaf / WIDTH].get(leaf % WIDTH);
        Self { tree, leaf, boxes, around, size, tiles: [const { None }; WIDTH], planes: None }
    }

    /// Whether its triangles are larger than a box, so that planes may tell that they are apart.
    fn is_larger(&self, bounds: &SmallBox) -> bool {
        bounds.extent() < self.size
    }

    /// Its triangles that are near a box.
    fn near(&mut self, bounds: &SmallBox) -> Lanes {
        let near = self.boxes.touching(bounds);
        if near.is_empty() || !self.is_larger(bounds) {
            return near;
        }
        let Self { tree, leaf, tiles, planes, .. } = self;
        let planes = planes.get_or_insert_with(|| {
            let count = WIDTH.min(tree.order.len() - WIDTH * *leaf);
            for (k, tile) in tiles.iter_mut().enumerate().take(count) {
                tile.get_or_insert_with(|| Tile::new(tree.corners(WIDTH * *leaf + k)));
            }
            WidePlanes::new(tiles)
        });
        near.and(planes.near(bounds))
    }

    /// Compares some of its triangles with those of another leaf.
    fn compare(&mut self, other: usize, near: Lanes, visit: &mut impl FnMut(u32, u32)) {
        let tree = self.tree;
        let (others, corners) = (&tree.boxes.levels[0][other], &tree.simple[other]);
        let mut tiles: [Option<Tile>; WIDTH] = [const { None }; WIDTH];
        for i in near {
            let sharing = corners.sharing(tree.simple[self.leaf].get(i));
            let mut touching = others.touching(&self.boxes.get(i)).without(sharing);
            if other == self.leaf {
                touching = touching.after(i);
            }
            let one = WIDTH * self.leaf + i;
            for j in touching {
                let another = WIDTH * other + j;
                let tile = self.tiles[i].get_or_insert_with(|| Tile::new(tree.corners(one)));
                if tile.has_beyond(&tree.corners(another)) {
                    continue;
                }
                let tile = tiles[j].get_or_insert_with(|| Tile::new(tree.corners(another)));
                if !tile.has_beyond(&tree.corners(one)) {
                    visit(tree.order[one], tree.order[another]);
                }
            }
        }
    }
}

/// The places of boxes in a list, those of the largest class of sizes first; of one class in the order of the list.
fn by_size(boxes: &[SmallBox]) -> Vec<u32> {
    let sum: f64 = boxes.iter().map(|one| f64::from(one.extent())).sum();
    let class = |one: &SmallBox| {
        // the mean size comes to lie in the middle of its class
        let share = f64::from(one.extent()) / sum * boxes.len() as f64 * 8.0_f64.sqrt();
        let exponent = usize::try_from(share.to_bits() >> 52 & 0x7FF).expect("eleven bits");
        (ONE_EXPONENT + 3 * CLASSES / 2).saturating_sub(exponent).div_euclid(3).min(CLASSES - 1)
    };
    by_group(CLASSES, boxes.len(), |k| class(&boxes[k]), number32).1
}
