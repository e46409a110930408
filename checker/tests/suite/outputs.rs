//! Meshes of models with many faces around one line or point: sound as they are, and with one fault each.

use glam::DVec3;
use planecut_check::{CheckOptions, TOLERANCE_F32, TOLERANCE_F64, check_mesh};
use planecut_testkit::pencils::{Kind, mesh_of, random_model};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;
use planecut_testkit::sheets::check_around_lines;

type Surface = (Vec<DVec3>, Vec<[u32; 3]>);

/// The problem that a check finds in a mesh.
fn problem((positions, triangles): &Surface, tolerance: f64) -> Option<String> {
    let options = CheckOptions { tolerance, ..CheckOptions::default() };
    check_mesh(positions, triangles, &options).first_problem().map(|problem| problem.to_string())
}

fn in_single_precision((positions, triangles): &Surface) -> Surface {
    (positions.iter().map(|p| p.as_vec3().as_dvec3()).collect(), triangles.clone())
}

/// A mesh that other code finds sound: of the right volume, and in exact order around each line where its planes have integer normals.
fn sound_mesh(seed: u64) -> Surface {
    let mut rng = Rng::spread(seed);
    let kind = Kind::ALL[seed as usize % 4];
    let turn = (seed / 4 % 2 == 1).then(|| rng.rotation());
    let model = random_model(kind, turn, &mut rng);
    let mesh = mesh_of(&model).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
    if turn.is_none() {
        check_around_lines(&model, &mesh).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
    }
    (mesh.positions, mesh.triangles)
}

#[test]
fn outputs_with_many_faces_around_a_line_are_sound() {
    let (mut judged, mut alarms) = (0, Vec::new());
    for seed in 0..scaled(200) {
        let surface = sound_mesh(seed);
        judged += usize::from(!surface.1.is_empty());
        let found = problem(&surface, TOLERANCE_F64).map(|problem| (problem, "double"));
        let found = found.or_else(|| Some((problem(&in_single_precision(&surface), TOLERANCE_F32)?, "single")));
        alarms.extend(found.map(|(problem, precision)| format!("seed {seed}, {precision} precision: {problem}")));
    }
    assert!(judged > 150, "{judged} meshes");
    assert!(alarms.is_empty(), "{} false alarms of {judged}: {alarms:#?}", alarms.len());
}

/// The triangles of both.
fn with((mut positions, mut triangles): Surface, other: &Surface) -> Surface {
    let shift = positions.len() as u32;
    positions.extend(&other.0);
    triangles.extend(other.1.iter().map(|t| t.map(|v| v + shift)));
    (positions, triangles)
}

/// Whether an edge pierces a triangle, its ends and the triangle's sides being `depth` or more from the place.
fn has_deep_crossing((positions, triangles): &Surface, depth: f64) -> bool {
    triangles.iter().any(|triangle| {
        let corners = triangle.map(|v| positions[v as usize]);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let is_pierced = |p: DVec3, q: DVec3| {
            let (hp, hq) = (normal.dot(p - corners[0]), normal.dot(q - corners[0]));
            if hp.abs() < depth || hq.abs() < depth || (hp > 0.0) == (hq > 0.0) {
                return false;
            }
            let place = p + (q - p) * (hp / (hp - hq));
            (0..3).all(|k| {
                let side = (corners[(k + 1) % 3] - corners[k]).normalize_or_zero();
                normal.cross(side).dot(place - corners[k]) > depth
            })
        };
        let edges = triangles.iter().flat_map(|t| (0..3).map(|k| (t[k], t[(k + 1) % 3])));
        edges.into_iter().any(|(a, b)| is_pierced(positions[a as usize], positions[b as usize]))
    })
}

/// The mesh with a vertex pushed through a face, where that is possible at random.
fn with_crossing(mesh: &Surface, rng: &mut Rng) -> Option<Surface> {
    (0..50).find_map(|_| {
        let (mut positions, triangles) = mesh.clone();
        let target = triangles[rng.below(triangles.len())].map(|v| positions[v as usize]);
        let centre = (target[0] + target[1] + target[2]) / 3.0;
        let vertex = rng.below(positions.len());
        positions[vertex] = positions[vertex].lerp(centre, rng.float(1.02, 1.5));
        let pushed = (positions, triangles);
        has_deep_crossing(&pushed, 1e-4).then_some(pushed)
    })
}

/// The mesh beside a copy that is moved within the plane of its widest triangle, so that this overlaps with itself.
fn with_overlap(mesh: &Surface) -> Surface {
    let (positions, triangles) = mesh;
    let corners = |t: &[u32; 3]| t.map(|v| positions[v as usize]);
    let area = |t: &[u32; 3]| {
        let [a, b, c] = corners(t);
        (b - a).cross(c - a).length()
    };
    let widest = triangles.iter().max_by(|t, u| area(t).total_cmp(&area(u))).expect("a triangle");
    let [a, b, c] = corners(widest);
    let moved = positions.iter().map(|&p| p + (b - a) * 0.11 + (c - a) * 0.07).collect();
    with(mesh.clone(), &(moved, triangles.clone()))
}

#[test]
fn each_planted_fault_is_found() {
    let mut planted = [0; 6];
    for seed in 1_000_000..1_000_000 + scaled(50) {
        let mesh = sound_mesh(seed);
        if mesh.1.is_empty() {
            continue;
        }
        let mut rng = Rng::spread(seed);
        let chosen = rng.below(mesh.1.len());
        let (mut hole, mut flip, mut double) = (mesh.clone(), mesh.clone(), mesh.clone());
        hole.1.remove(chosen);
        flip.1[chosen].swap(0, 1);
        double.1.push(mesh.1[chosen]);
        let faults = [
            ("overlap", Some(with_overlap(&mesh))),
            ("crossing", with_crossing(&mesh, &mut rng)),
            ("hole", Some(hole)),
            ("flip", Some(flip)),
            ("triangle doubled", Some(double)),
            ("mesh doubled", Some(with(mesh.clone(), &mesh))),
        ];
        for (k, (fault, surface)) in faults.into_iter().enumerate() {
            let Some(surface) = surface else { continue };
            planted[k] += 1;
            for (surface, tolerance) in [(&surface, TOLERANCE_F64), (&in_single_precision(&surface), TOLERANCE_F32)] {
                assert!(problem(surface, tolerance).is_some(), "seed {seed}, tolerance {tolerance}: {fault} is missed");
            }
        }
    }
    assert!(planted.iter().all(|count| *count > 10), "too few faults: {planted:?}");
}
