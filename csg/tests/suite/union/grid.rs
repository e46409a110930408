//! Boxes on a small lattice, straight, sheared and turned, against voxels.

use glam::{DMat3, DVec3};
use planecut_check::check_topology;
use planecut_csg::{Brush, BrushFace, Evaluation, MaterialId, Model};

use super::voxels::Voxels;
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, ensure, ensure_eq, half_space, model, sweep};
use planecut_testkit::soundness::{area_by_material, evaluate_soundly};

/// Cells along each axis of the lattice.
pub(crate) const SIZE: i32 = 6;

/// A box of lattice cells.
#[derive(Debug, Clone)]
pub(crate) struct GridBox {
    pub(crate) low: [i32; 3],
    pub(crate) high: [i32; 3],
    /// Of the sides towards `+x, −x, +y, −y, +z, −z`.
    pub(crate) materials: [u32; 6],
}

impl GridBox {
    pub(crate) fn material(&self, (axis, sign): (usize, i32)) -> u32 {
        self.materials[2 * axis + usize::from(sign < 0)]
    }
}

/// Lattice boxes in an affine frame.
#[derive(Debug, Clone)]
pub(crate) struct GridScene {
    pub(crate) boxes: Vec<GridBox>,
    /// Row `k` is the gradient of lattice coordinate `k` in space; not unit, not orthogonal.
    pub(crate) rows: [DVec3; 3],
    /// Added to lattice coordinates.
    pub(crate) shift: [f64; 3],
    /// Scales that planes are given at, in turn.
    pub(crate) plane_scales: &'static [f64],
}

impl Scene for GridScene {
    fn model(&self) -> Model {
        let mut scales = self.plane_scales.iter().cycle();
        let brush = |b: &GridBox| {
            let mut faces = Vec::new();
            for axis in 0..3 {
                for (sign, at) in [(1, b.high[axis]), (-1, b.low[axis])] {
                    let scale = scales.next().expect("a cycle") * f64::from(sign);
                    let plane = half_space(self.rows[axis] * scale, (f64::from(at) + self.shift[axis]) * scale);
                    faces.push(BrushFace { half_space: plane, material: MaterialId(b.material((axis, sign))) });
                }
            }
            Brush { faces, ..Brush::default() }
        };
        model(self.boxes.iter().map(brush).collect())
    }

    fn smaller(&self) -> Vec<Self> {
        let without = |k| {
            let mut boxes = self.boxes.clone();
            boxes.remove(k);
            Self { boxes, ..self.clone() }
        };
        (0..self.boxes.len()).map(without).collect()
    }
}

/// A coordinate on the lattice.
fn steps(rng: &mut Rng, low: i32, high: i32) -> i32 {
    rng.integer(low.into(), high.into()) as i32
}

/// Two to twelve boxes: some at random, some touching, inside or equal to earlier ones.
pub(crate) fn random_boxes(rng: &mut Rng, materials: u32) -> Vec<GridBox> {
    let mut boxes: Vec<GridBox> = Vec::new();
    let largest = steps(rng, 1, SIZE);
    for _ in 0..rng.integer(2, 12) {
        let (mut low, mut high) = ([0; 3], [0; 3]);
        let kin = (!boxes.is_empty() && rng.chance(0.5)).then(|| boxes[rng.below(boxes.len())].clone());
        for axis in 0..3 {
            // Towards kin: begin where it ends, end where it begins, or do as it does.
            let choice = rng.integer(0, 5);
            (low[axis], high[axis]) = match (&kin, choice) {
                (Some(kin), 0) if kin.high[axis] < SIZE => (kin.high[axis], steps(rng, kin.high[axis] + 1, SIZE)),
                (Some(kin), 1) if kin.low[axis] > 0 => (steps(rng, 0, kin.low[axis] - 1), kin.low[axis]),
                (Some(kin), 2 | 3) => (kin.low[axis], kin.high[axis]),
                _ => {
                    let low = steps(rng, 0, SIZE - 1);
                    (low, (low + steps(rng, 1, largest)).min(SIZE))
                }
            };
        }
        let one = rng.below(materials as usize) as u32;
        let mixed = rng.chance(0.5);
        let materials = std::array::from_fn(|_| if mixed { rng.below(materials as usize) as u32 } else { one });
        boxes.push(GridBox { low, high, materials });
    }
    boxes
}

fn straight(boxes: Vec<GridBox>) -> GridScene {
    GridScene { boxes, rows: DVec3::AXES, shift: [0.0; 3], plane_scales: &[1.0] }
}

/// An invertible matrix of small integers, not too flat.
fn random_shear(rng: &mut Rng) -> [DVec3; 3] {
    loop {
        let rows: [DVec3; 3] =
            std::array::from_fn(|_| DVec3::new(rng.whole(-3, 3), rng.whole(-3, 3), rng.whole(-3, 3)));
        if DMat3::from_cols(rows[0], rows[1], rows[2]).determinant() != 0.0 {
            return rows;
        }
    }
}

fn random_turn(rng: &mut Rng) -> [DVec3; 3] {
    let (rotation, scale) = (rng.rotation(), 10_f64.powi(rng.integer(-3, 3) as i32));
    DVec3::AXES.map(|axis| rotation * axis * scale)
}

/// The rank of materials by name.
pub(crate) fn rank_by_name(model: &Model) -> Vec<u32> {
    let rank = |name: &str| model.materials.iter().filter(|other| *other.name < *name).count() as u32;
    model.materials.iter().map(|material| rank(&material.name)).collect()
}

/// Everything that can be counted, and the measures to rounding; exactly, where the lattice is that of the integers.
fn judge(scene: &GridScene) -> Result<(), String> {
    let model = scene.model();
    let rank = rank_by_name(&model);
    let voxels = Voxels::new(&scene.boxes, |m| rank[m as usize]);
    let evaluation = evaluate_soundly(&model)?;
    let (mesh, solid) = (&evaluation.mesh, &evaluation.solid);
    if scene.boxes.is_empty() {
        return Ok(());
    }
    let report = check_topology(&mesh.positions, &mesh.triangles);
    ensure_eq!(mesh.faces.len(), voxels.faces(), "faces");
    ensure_eq!(report.components, voxels.components(), "components");
    ensure_eq!(report.euler_characteristic, voxels.euler_characteristic(), "Euler characteristic");

    let determinant = DMat3::from_cols(scene.rows[0], scene.rows[1], scene.rows[2]).determinant().abs();
    // Area of a lattice side across axis k: |r_k| / |det|.
    let area = |sides: [usize; 3]| (0..3).map(|k| sides[k] as f64 * scene.rows[k].length()).sum::<f64>() / determinant;
    let exact = scene.rows == DVec3::AXES && scene.shift == [0.0; 3];
    let noise = if evaluation.model.snapped_planes > 0 { 1e-9 } else { 1e-12 };
    let reach = 1.0 + solid.min.abs().max(solid.max.abs()).max_element() / (solid.max - solid.min).min_element();
    let close = |found: f64, expected: f64| {
        if exact && evaluation.model.snapped_planes == 0 {
            found == expected
        } else {
            (found - expected).abs() <= noise * reach * expected
        }
    };
    let volume = voxels.cells.len() as f64 / determinant;
    ensure!(close(solid.volume, volume), "volume {}, expected {volume}", solid.volume);
    let total = area(voxels.sides());
    ensure!(close(solid.area, total), "area {}, expected {total}", solid.area);
    for (material, found) in area_by_material(mesh).into_iter().enumerate() {
        let expected = area(voxels.sides_of(material as u32));
        ensure!(
            (found - expected).abs() <= 10.0 * noise * reach * total,
            "area {found} of material {material}, expected {expected}"
        );
    }
    if exact {
        judge_integers(&evaluation, &voxels, scene)?;
    }
    Ok(())
}

/// What holds only on the integer lattice: exact positions, triangles flat and facing outward, centroid, box, planes.
fn judge_integers(evaluation: &Evaluation, voxels: &Voxels, scene: &GridScene) -> Result<(), String> {
    let (mesh, solid) = (&evaluation.mesh, &evaluation.solid);
    // A repeated edge is split at its midpoint, once or more.
    let is_dyadic = |v: f64| (v * 1024.0).fract() == 0.0;
    let off = mesh.positions.iter().find(|p| !p.to_array().into_iter().all(is_dyadic));
    ensure!(off.is_none(), "vertex off the lattice: {off:?}");
    for (triangle, face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        let (cross, normal) = ((b - a).cross(c - a), mesh.faces[*face as usize].normal);
        ensure!(
            cross == normal * cross.length() && cross != DVec3::ZERO,
            "triangle {a} {b} {c} of a face with normal {normal}"
        );
    }
    let center = |cell: &[i32; 3]| DVec3::from_array(cell.map(|v| f64::from(v) + 0.5));
    let mean = voxels.cells.iter().map(center).sum::<DVec3>() / voxels.cells.len() as f64;
    ensure!(solid.centroid.distance(mean) < 1e-12, "centroid {}, expected {mean}", solid.centroid);
    let low = voxels.cells.iter().map(center).fold(DVec3::INFINITY, DVec3::min) - 0.5;
    let high = voxels.cells.iter().map(center).fold(DVec3::NEG_INFINITY, DVec3::max) + 0.5;
    ensure_eq!((solid.min, solid.max), (low, high), "box");
    let planes: std::collections::BTreeSet<(usize, i32)> =
        scene.boxes.iter().flat_map(|b| (0..3).flat_map(|k| [(k, b.low[k]), (k, b.high[k])])).collect();
    ensure_eq!(evaluation.model.planes, planes.len(), "planes");
    let sum: i32 = scene.boxes.iter().map(|b| (0..3).map(|k| b.high[k] - b.low[k]).product::<i32>()).sum();
    ensure!((evaluation.model.brush_volume_sum - f64::from(sum)).abs() < 1e-9, "sum of the brushes' volumes");
    Ok(())
}

#[test]
fn straight_boxes_match_voxels() {
    sweep(2000, |rng| straight(random_boxes(rng, 1)), judge);
}

#[test]
fn straight_boxes_of_many_materials_match_voxels() {
    sweep(1500, |rng| straight(random_boxes(rng, 3)), judge);
}

#[test]
fn planes_given_at_many_scales_match_voxels() {
    let generate = |rng: &mut Rng| GridScene {
        plane_scales: &[1.0, 3.0, 1.0 / 7.0, 0.3, 1e6, 1e-5, 49.0],
        ..straight(random_boxes(rng, 2))
    };
    sweep(500, generate, judge);
}

#[test]
fn sheared_boxes_match_voxels() {
    let generate = |rng: &mut Rng| GridScene {
        rows: random_shear(rng),
        plane_scales: &[1.0, 3.0, 2.0, 5.0],
        ..straight(random_boxes(rng, 2))
    };
    sweep(800, generate, judge);
}

#[test]
fn turned_boxes_match_voxels() {
    let generate = |rng: &mut Rng| GridScene { rows: random_turn(rng), ..straight(random_boxes(rng, 2)) };
    sweep(800, generate, judge);
}

#[test]
fn turned_boxes_with_rounded_scales_match_voxels() {
    let generate = |rng: &mut Rng| GridScene {
        rows: random_turn(rng),
        plane_scales: &[1.0, 3.0, 1.0 / 7.0, 0.3, 1e6, 1e-5],
        ..straight(random_boxes(rng, 2))
    };
    sweep(500, generate, judge);
}

#[test]
fn boxes_far_from_the_origin_match_voxels() {
    let generate = |rng: &mut Rng| {
        let scene = straight(random_boxes(rng, 2));
        let rows = if rng.chance(0.5) { random_turn(rng) } else { random_shear(rng) };
        GridScene { rows, shift: [1e6 + 0.1, -1e6, 1e5 + 0.7], ..scene }
    };
    sweep(500, generate, judge);
}

#[test]
fn boxes_on_a_lattice_of_tenths_match_voxels() {
    let generate =
        |rng: &mut Rng| GridScene { rows: DVec3::AXES.map(|axis| axis * 10.0), ..straight(random_boxes(rng, 2)) };
    sweep(500, generate, judge);
}
