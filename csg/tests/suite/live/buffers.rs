//! Faces in single precision against the triangles that they are made of.

use std::collections::{BTreeMap, BTreeSet};

use planecut_csg::{FaceId, LiveModel, Material, ModelBuffers, Role};
use planecut_kernel::DVec3;
use planecut_testkit::edited::{PLATE, PLATE_TOP, plate, turned_far_away};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{cuboid, half_space};

use crate::tree::random::{Kind, random_leaf};

/// A triangle by its corners, and its normal, all in single precision.
type Drawn = ([[u32; 3]; 3], [u32; 3]);

fn bits(v: [f32; 3]) -> [u32; 3] {
    v.map(|c| (c + 0.0).to_bits())
}

/// What a renderer holds: the triangles of each face.
#[derive(Default)]
struct Renderer(BTreeMap<FaceId, Vec<Drawn>>);

impl Renderer {
    fn take(&mut self, buffers: &ModelBuffers) {
        assert_eq!(buffers.positions.len(), buffers.normals.len());
        for range in &buffers.faces {
            let triangles = &buffers.indices[range.triangles.start as usize..range.triangles.end as usize];
            let used: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
            assert!(used.iter().copied().eq(range.vertices.clone()), "each corner of the face is used, and no other");
            let at = |corner: &u32| bits(buffers.positions[*corner as usize]);
            let drawn = |corners: &[u32; 3]| {
                let normals = corners.map(|corner| bits(buffers.normals[corner as usize]));
                assert_eq!(normals, [normals[0]; 3], "a face has one normal");
                (corners.each_ref().map(at), normals[0])
            };
            assert!(self.0.insert(range.face, triangles.iter().map(drawn).collect()).is_none(), "{:?}", range.face);
        }
    }

    fn compare(&self, live: &LiveModel, center: DVec3) {
        let expected = live.faces().map(|(id, face)| {
            let normal = bits(face.normal().as_vec3().to_array());
            let at = |(_, place): (u32, DVec3)| bits((place - center).as_vec3().to_array());
            (id, face.triangles().map(|corners| (corners.map(at), normal)).collect())
        });
        assert_eq!(self.0, expected.collect());
    }
}

#[test]
fn what_edits_add_is_all_that_a_renderer_needs() {
    let mut triangles = 0;
    for seed in 0..20 {
        let rng = &mut Rng::spread(seed);
        let center = rng.point(-1.0, 1.0);
        let mut live = LiveModel::new(vec![Material::named("stone")]);
        let mut renderer = Renderer::default();
        for _ in 0..20 {
            let role = if rng.chance(0.6) { Role::Add } else { Role::Subtract };
            let change = match rng.below(3) {
                0 => live.undo(),
                _ => live.add_brush(random_leaf(rng, Kind::Turned), role).map(|added| added.1),
            };
            let Ok(change) = change else { continue };
            change.removed.iter().for_each(|face| _ = renderer.0.remove(face));
            renderer.take(&live.buffers(&change.added, center));
            renderer.compare(&live, center);
            triangles += renderer.0.values().map(Vec::len).sum::<usize>();
        }
    }
    assert!(triangles > 10_000, "{triangles}");
}

#[test]
fn a_face_has_each_of_its_corners_once() {
    let model = plate(5);
    let mut live = LiveModel::from_model(model).unwrap();
    let (top, _) = live.pick(DVec3::new(0.01, 0.01, 9.0), -DVec3::Z).unwrap();
    let face = live.face(top).unwrap();
    let buffers = face.buffers(DVec3::new(0.0, 0.0, 1.0));
    assert_eq!((buffers.positions.len(), buffers.normal), (4 + 25 * 24, [0.0, 0.0, 1.0]));
    assert_eq!(buffers.indices.len(), face.triangles().len());
    assert!(buffers.positions.iter().all(|at| at[2] == 0.0));
    // what is no longer there is left out
    let change = live.move_plane(PLATE, PLATE_TOP, half_space(DVec3::Z, 1.5)).unwrap();
    let gone: Vec<FaceId> = change.removed.iter().copied().filter(|face| live.face(*face).is_none()).collect();
    assert_eq!(live.buffers(&gone, DVec3::ZERO), ModelBuffers::default());
}

#[test]
fn a_center_keeps_the_digits_of_what_is_far_away() {
    let live = LiveModel::from_model(turned_far_away(&plate(1))).unwrap();
    let center = live.faces().next().unwrap().1.triangles().next().unwrap()[0].1;
    for (_, face) in live.faces() {
        let buffers = face.buffers(center);
        let corners =
            face.triangles().zip(&buffers.indices).flat_map(|(corners, triangle)| corners.into_iter().zip(*triangle));
        for ((_, place), corner) in corners {
            let drawn = DVec3::from(buffers.positions[corner as usize].map(f64::from));
            assert!((drawn + center - place).length() < 1e-6);
        }
    }
    let mut near = LiveModel::new(vec![Material::named("stone")]);
    near.add_brush(cuboid(DVec3::ZERO, DVec3::ONE), Role::Add).unwrap();
    assert_eq!(near.buffers(&[], DVec3::ZERO), ModelBuffers::default());
}
