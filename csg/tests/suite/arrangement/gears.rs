//! Gears with corners by sine and cosine against copies of themselves: planes and corners that differ by single roundings, or by none.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use planecut_csg::{ClosedMesh, CombinedMeshes, Inside, MaterialId, MeshBody, combine_meshes};
use planecut_testkit::meshes::{assert_closed, volume};

/// How the caps of a gear are cut into triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Caps {
    /// Around a point in the middle.
    Fan,
    /// Each tooth cut off, the rest from one corner.
    Ears,
}

/// Corners and triangles.
#[derive(Debug, Clone)]
struct Gear {
    corners: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// Four points for each tooth, two at the larger radius.
fn outline(teeth: u32, turned: f64) -> Vec<DVec2> {
    let corner = |k: u32| {
        let radius = if k % 4 < 2 { 10.0 } else { 7.5 };
        let angle = TAU * (f64::from(k) + turned) / f64::from(4 * teeth);
        radius * DVec2::new(angle.cos(), angle.sin())
    };
    (0..4 * teeth).map(corner).collect()
}

impl Gear {
    /// A gear from `low` to `high` along z.
    fn new(outline: &[DVec2], [low, high]: [f64; 2], caps: Caps) -> Self {
        let count = u32::try_from(outline.len()).expect("few corners");
        let mut corners: Vec<DVec3> = [low, high].iter().flat_map(|z| outline.iter().map(|p| p.extend(*z))).collect();
        let next = |k: u32| (k + 1) % count;
        let mut triangles: Vec<[u32; 3]> =
            (0..count).flat_map(|k| [[k, next(k), count + next(k)], [k, count + next(k), count + k]]).collect();
        let cap: Vec<[u32; 3]> = match caps {
            Caps::Fan => {
                corners.extend([DVec3::new(0.0, 0.0, low), DVec3::new(0.0, 0.0, high)]);
                (0..count).map(|k| [2 * count, k, next(k)]).collect()
            }
            Caps::Ears => {
                // the last root, both tips, the next root
                let tooth = |t: u32| {
                    let [a, b, c, d] = [(4 * t + count - 1) % count, 4 * t, 4 * t + 1, 4 * t + 2];
                    [[a, b, c], [a, c, d]]
                };
                let inner: Vec<u32> = (0..count).filter(|k| k % 4 > 1).collect();
                let fan = (1..inner.len() - 1).map(|k| [inner[0], inner[k], inner[k + 1]]);
                (0..count / 4).flat_map(tooth).chain(fan).collect()
            }
        };
        let above = |vertex: u32| if vertex == 2 * count { vertex + 1 } else { vertex + count };
        triangles.extend(cap.iter().map(|[a, b, c]| [*b, *a, *c]));
        triangles.extend(cap.iter().map(|triangle| triangle.map(above)));
        Self { corners, triangles }
    }

    fn mirrored(&self, axis: usize) -> Self {
        let mirror = |p: &DVec3| {
            let mut p = *p;
            p[axis] = -p[axis];
            p
        };
        let turned = |[a, b, c]: &[u32; 3]| [*b, *a, *c];
        Self {
            corners: self.corners.iter().map(mirror).collect(),
            triangles: self.triangles.iter().map(turned).collect(),
        }
    }

    fn body(&self) -> MeshBody {
        let mesh = ClosedMesh::new(&self.corners, &self.triangles, |_| 0).expect("a gear is closed");
        MeshBody::new(mesh, vec![MaterialId(0)])
    }

    fn volume(&self) -> f64 {
        volume(self.triangles.iter().map(|t| t.map(|v| self.corners[v as usize])))
    }
}

/// Unites, intersects and subtracts two gears; volumes follow from one another.
fn check(one: &Gear, other: &Gear, what: &str) -> Result<(), String> {
    let bodies = [one.body(), other.body()];
    let measured = |name: &str, is_solid: &dyn Fn(&Inside<'_>) -> bool| {
        let what = format!("{what}, {name}");
        let combined = combine_meshes(&bodies, Vec::new(), is_solid).map_err(|error| format!("{what}: {error}"))?;
        let CombinedMeshes { mesh, solid, .. } = combined;
        assert_closed(&mesh, &what);
        let found = volume(mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])));
        if (found - solid.volume).abs() > 1e-9 {
            return Err(format!("{what}: volume {found}, stated {}", solid.volume));
        }
        Ok(found)
    };
    let union = measured("union", &|inside| inside.of(0) || inside.of(1))?;
    let both = measured("intersection", &|inside| inside.of(0) && inside.of(1))?;
    let less = measured("difference", &|inside| inside.of(0) && !inside.of(1))?;
    let [first, second] = [one, other].map(Gear::volume);
    if (union + both - first - second).abs() > 1e-9 || (less + both - first).abs() > 1e-9 {
        return Err(format!("{what}: {union} + {both} = {first} + {second}, {less} + {both} = {first}"));
    }
    Ok(())
}

/// Gears of 3 to 24 teeth with their mirror images, and with themselves turned by one tooth, at the same height and a little above.
#[test]
fn gears_and_their_images() {
    let mut failed = Vec::new();
    for teeth in 3..=24 {
        for caps in [Caps::Fan, Caps::Ears] {
            let gear = Gear::new(&outline(teeth, 0.0), [0.0, 3.0], caps);
            for axis in 0..3 {
                failed.extend(
                    check(&gear, &gear.mirrored(axis), &format!("{teeth} teeth, {caps:?}, mirrored {axis}")).err(),
                );
            }
            for heights in [[0.0, 3.0], [1.0, 4.0], [3.0, 4.0]] {
                let turned = Gear::new(&outline(teeth, 4.0), heights, caps);
                failed.extend(check(&gear, &turned, &format!("{teeth} teeth, {caps:?}, turned, {heights:?}")).err());
            }
        }
    }
    assert!(failed.is_empty(), "{} fail:\n{}", failed.len(), failed.join("\n"));
}
