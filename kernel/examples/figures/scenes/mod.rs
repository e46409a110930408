//! One figure each.

mod certificate;
mod fill;
mod infinity;
mod patch;
mod removal;
mod unclip;

use planecut_kernel::{DVec3, HalfSpace, HalfSpaceError, IncrementalPolytope, PlaneIdx};

/// All figures by file name.
pub(crate) fn all() -> Result<Vec<(&'static str, String)>, HalfSpaceError> {
    Ok(vec![
        ("unclip.svg", unclip::figure()?),
        ("removal.svg", removal::figure()?),
        ("fill.svg", fill::figure()?),
        ("certificate.svg", certificate::figure()?),
        ("infinity.svg", infinity::figure()?),
        ("patch.svg", patch::figure()?),
    ])
}

/// The names of the planes of a ring.
const LETTERS: [&str; 12] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"];

/// Adds `normal·x ≤ offset`.
fn add(polytope: &mut IncrementalPolytope, normal: [f64; 3], offset: f64) -> Result<PlaneIdx, HalfSpaceError> {
    Ok(polytope.add_plane(HalfSpace::new(DVec3::from_array(normal), offset)?).plane())
}

/// A floor, sloping sides (normal, offset), and a top at a height.
fn roof(sides: &[([f64; 3], f64)], top: f64) -> Result<(IncrementalPolytope, Vec<PlaneIdx>, PlaneIdx), HalfSpaceError> {
    let mut polytope = IncrementalPolytope::new();
    add(&mut polytope, [0.0, 0.0, -1.0], 0.0)?;
    let sides = sides.iter().map(|(normal, offset)| add(&mut polytope, *normal, *offset)).collect::<Result<_, _>>()?;
    let top = add(&mut polytope, [0.0, 0.0, 1.0], top)?;
    Ok((polytope, sides, top))
}

/// A ball of 12 pentagons and 20 hexagons, slightly irregular: the vertices of a dodecahedron and of an icosahedron as
/// normals.
fn ball() -> Result<(IncrementalPolytope, Vec<PlaneIdx>), HalfSpaceError> {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut normals = Vec::new();
    for s in [-1.0, 1.0] {
        for t in [-1.0, 1.0] {
            for axis in 0..3 {
                for [x, y, z] in [[0.0, s, t * golden], [0.0, s * golden, t / golden]] {
                    let v = [x, y, z];
                    normals.push(DVec3::new(v[axis % 3], v[(axis + 1) % 3], v[(axis + 2) % 3]));
                }
            }
            normals.extend([-1.0, 1.0].map(|u| DVec3::new(s, t, u)));
        }
    }
    let mut state = 7_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
    };
    let mut polytope = IncrementalPolytope::new();
    let mut planes = Vec::new();
    for normal in normals {
        let normal = (normal.normalize() + DVec3::new(noise(), noise(), noise()) * 0.12).normalize();
        planes.push(add(&mut polytope, normal.to_array(), 1.0 + 0.02 * noise())?);
    }
    Ok((polytope, planes))
}
