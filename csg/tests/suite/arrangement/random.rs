//! Random combinations of meshes with planted coincidences.

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{CombinedMeshes, Inside, MeshBody, combine_meshes};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

use super::soup::Soup;
use super::winding::winding;

/// How far from a triangle points are taken: far more than rounding, far less than what is told apart on the grid.
const STEP: f64 = 1.0 / (1 << 20) as f64;

fn combined(seed: u64, meshes: &[MeshBody], is_solid: impl Fn(&Inside<'_>) -> bool) -> CombinedMeshes {
    combine_meshes(meshes, Vec::new(), is_solid).unwrap_or_else(|error| panic!("seed {seed}: {error}"))
}

/// Meshes of which some share tetrahedra with the one before.
fn soups(rng: &mut Rng) -> Vec<Soup> {
    let size = 2 + rng.below(4);
    let mut soups: Vec<Soup> = Vec::new();
    for _ in 0..2 + rng.below(2) {
        let mut soup = Soup::random(rng, size);
        if let Some(last) = soups.last().filter(|_| rng.chance(0.2)) {
            soup.push(last);
        }
        soups.push(soup);
    }
    soups
}

/// A combination by a table of truth: the value for each set of meshes that a point lies in.
fn by_table<'a>(table: u32, count: usize) -> impl Fn(&Inside<'_>) -> bool + 'a {
    move |inside| {
        let set: u32 = (0..count).filter(|k| inside.of(*k)).map(|k| 1 << k).sum();
        table >> set & 1 == 1
    }
}

/// Makes sure that just outside of every triangle of a combination it is empty, just inside not, by winding numbers in integers, and that its
/// mesh is closed and has the volume that is stated. Gives how many triangles were large enough to be asked.
pub(super) fn assert_combined(seed: u64, soups: &[Soup], table: u32) -> usize {
    let mut asked = 0;
    let meshes: Vec<MeshBody> = soups.iter().map(Soup::mesh).collect();
    let CombinedMeshes { mesh, solid, .. } = combine_meshes(&meshes, Vec::new(), by_table(table, soups.len()))
        .unwrap_or_else(|error| panic!("seed {seed}, table {table:#x}: {error}, {soups:?}"));
    let is_in = |point: DVec3| {
        let windings: Option<Vec<i32>> = soups.iter().map(|soup| winding(soup, point)).collect();
        windings.map(|windings| {
            let set: u32 = (0..soups.len()).filter(|k| windings[*k] > 0).map(|k| 1 << k).sum();
            table >> set & 1 == 1
        })
    };
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
        let normal = (b - a).cross(c - a);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        if normal.length() < 64.0 * STEP * longest {
            continue;
        }
        // not the centroid, through which edges that just touch the triangle may run
        let (middle, step) = (0.417 * a + 0.226 * b + 0.357 * c, STEP * normal.normalize());
        if let (Some(outside), Some(inside)) = (is_in(middle + step), is_in(middle - step)) {
            asked += 1;
            assert!(!outside && inside, "seed {seed}, table {table:#x}, at {middle}: {soups:?}");
        }
    }
    let report = check_mesh(&mesh.positions, &mesh.triangles, &CheckOptions::default());
    assert!(mesh.triangles.is_empty() || report.is_sound(), "seed {seed}, table {table:#x}: {report:?} {soups:?}");
    let volume = report.topology.measures.volume;
    assert!((volume - solid.volume).abs() < 1e-9, "seed {seed}: volume {volume}, stated {}", solid.volume);
    asked
}

/// Just outside of every triangle the combination is empty, just inside it is not: by winding numbers in integers.
#[test]
fn points_beside_triangles_are_where_winding_numbers_say() {
    let mut asked = 0;
    for seed in 0..scaled(1000) {
        let mut rng = Rng::spread(seed);
        let soups = soups(&mut rng);
        let table = u32::try_from(rng.bits() >> 40).expect("24 bits") & !1;
        asked += assert_combined(seed, &soups, table);
    }
    assert!(asked > 10_000, "only {asked} triangles were large enough");
}

/// `|A ∪ B| + |A ∩ B| = |A| + |B|`, `|A − B| + |A ∩ B| = |A|`, `A − A = ∅`, whatever is done to the coordinates.
fn assert_volumes(seed: u64) {
    let mut rng = Rng::spread(seed + 10_000);
    let mut soups = soups(&mut rng);
    let (scale, shift) = match seed % 6 {
        0 => (2_f64.powi(-70), DVec3::ZERO),
        1 => (1.0 / 3.0, DVec3::new(1e6 + 0.1, -3e5, 7.7)),
        2 => (2_f64.powi(-236), DVec3::ZERO),
        _ => (1.0, DVec3::ZERO),
    };
    let jitter = if seed % 6 == 3 { 1e-9 } else { 0.0 };
    for soup in &mut soups {
        let move_point = |p: &mut DVec3| {
            let noise = DVec3::from_array([0; 3].map(|_| rng.float(-jitter, jitter + f64::MIN_POSITIVE)));
            *p = *p * scale + shift + if jitter > 0.0 { noise } else { DVec3::ZERO };
        };
        soup.positions.iter_mut().for_each(move_point);
    }
    let meshes: Vec<MeshBody> = soups[..2].iter().map(Soup::mesh).collect();
    let volume =
        |is_solid: &dyn Fn(&Inside<'_>) -> bool| combined(seed, &meshes, is_solid).solid.volume / scale.powi(3);
    let [either, both, first, second, difference] = [
        volume(&|inside| inside.of(0) || inside.of(1)),
        volume(&|inside| inside.of(0) && inside.of(1)),
        volume(&|inside| inside.of(0)),
        volume(&|inside| inside.of(1)),
        volume(&|inside| inside.of(0) && !inside.of(1)),
    ];
    // far away coordinates are coarse
    let slack = 1e-9 * (1.0 + shift.length());
    assert!((either + both - first - second).abs() < slack, "seed {seed}: {either} + {both}, {first} + {second}");
    assert!((difference + both - first).abs() < slack, "seed {seed}: {difference} + {both}, {first}");
    let twice = [meshes[0].clone(), meshes[0].clone()];
    assert_eq!(combined(seed, &twice, |inside| inside.of(0) && !inside.of(1)).mesh.triangles.len(), 0, "seed {seed}");
    let (one, union) = (
        combined(seed, &meshes[..1], |inside| inside.of(0)),
        combined(seed, &twice, |inside| inside.of(0) || inside.of(1)),
    );
    assert_eq!(one.mesh, union.mesh, "seed {seed}");
}

#[test]
fn volumes_follow_inclusion_and_exclusion() {
    (0..scaled(1000)).for_each(assert_volumes);
}

/// Two needles some 1e-9 thick and one long have a part in common of a volume below 1e-19, which rounding of single products exceeds.
#[test]
fn needles_have_less_volume_than_rounding() {
    assert_volumes(11_751);
}

/// The same mesh on one thread and on several.
#[test]
fn outcomes_do_not_depend_on_the_number_of_threads() {
    let mut rng = Rng::spread(77);
    let mut all = [Soup::default(), Soup::default()];
    for k in 0..400 {
        let mut soup = Soup::random(&mut rng, 4);
        let corner = DVec3::new((k % 10) as f64, (k / 10 % 10) as f64, (k / 100) as f64) * 3.0;
        soup.positions.iter_mut().for_each(|position| *position += corner);
        all[k % 2].push(&soup);
    }
    let meshes = all.each_ref().map(Soup::mesh);
    let with_threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads");
        pool.install(|| combined(77, &meshes, |inside| inside.of(0) && !inside.of(1)))
    };
    let (one, three) = (with_threads(1), with_threads(3));
    assert!(!one.mesh.triangles.is_empty());
    assert_eq!((one.mesh, one.solid), (three.mesh, three.solid));
}
