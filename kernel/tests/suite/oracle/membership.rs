//! Random points: a point that fulfils all inequalities is inside the mesh, any other is outside.

use std::cell::RefCell;

use planecut_kernel::{DVec3, IncrementalPolytope};
use planecut_oracle::campaign::Campaign;
use planecut_oracle::category::Category;
use planecut_oracle::exact::Coefficients;
use planecut_oracle::random::Rng;
use planecut_oracle::replay::Replay;
use planecut_oracle::settings::{cases, first_seed, operations};
use planecut_oracle::test_each_category;

use super::mesh::{Mesh, check_closed, winding_number};

/// Operations per category unless `PLANECUT_OPS` says otherwise.
const OPERATIONS: usize = 1_200;
/// Random points per operation.
const POINTS: usize = 16;
/// Points nearer to a plane than this part of the body's size are not asked about: rounding may decide there.
const MARGIN: f64 = 1e-5;

thread_local! {
    /// Points that were found inside and outside by this test.
    static FOUND: RefCell<[usize; 2]> = const { RefCell::new([0; 2]) };
}

test_each_category!(mesh_and_inequalities_agree);

fn mesh_and_inequalities_agree(category: Category) {
    let campaign = Campaign {
        operations: operations(OPERATIONS),
        cases: cases(1),
        capacity: 20,
        // Bodies as thin as the default epsilon lose whole faces to contraction, as they should.
        start: if category == Category::MixedExponents {
            || IncrementalPolytope::with_epsilon(0.0)
        } else {
            IncrementalPolytope::new
        },
        check: ask_random_points,
    };
    FOUND.replace([0; 2]);
    campaign.run(category);
    let found = FOUND.take();
    println!("{found:?} points inside and outside");
    if !matches!(category, Category::Unbounded) {
        assert!(found.iter().all(|&n| n > 0), "{category:?}: {found:?} points inside and outside");
    }
}

fn ask_random_points(replay: &Replay) -> Result<(), String> {
    let polytope = &replay.polytope;
    if polytope.is_empty() || !polytope.is_bounded() {
        return Ok(());
    }
    let mesh = polytope.to_mesh();
    check_closed(&mesh)?;
    if mesh.0.is_empty() {
        return Ok(());
    }
    let (low, high) = bounds(&mesh);
    let margin = MARGIN * (high - low).length();
    let mut rng = Rng::new(first_seed() ^ replay.tally.operations as u64);
    for _ in 0..POINTS {
        let part = DVec3::from_array(std::array::from_fn(|_| rng.float(-0.2, 1.2)));
        let point = low + (high - low) * part;
        let planes = replay.planes();
        let distances: Vec<f64> = planes.iter().map(|&c| distance(c, point)).collect();
        let error = 1e-14 * (low.abs().max(high.abs())).length();
        if distances.iter().any(|d| d.abs() < margin + error) {
            continue;
        }
        let inside = distances.iter().all(|&d| d < 0.0);
        let winding = winding_number(&mesh, point);
        if (winding - f64::from(u8::from(inside))).abs() > 0.01 {
            return Err(format!("{point:?} is inside: {inside}, but its winding number is {winding}"));
        }
        FOUND.with_borrow_mut(|f| f[usize::from(!inside)] += 1);
    }
    Ok(())
}

fn bounds((positions, _): &Mesh) -> (DVec3, DVec3) {
    positions.iter().fold((positions[0], positions[0]), |(low, high), &p| (low.min(p), high.max(p)))
}

/// Signed distance; the row is scaled first so that no square overflows.
fn distance(c: Coefficients, point: DVec3) -> f64 {
    let n = DVec3::new(c[0], c[1], c[2]);
    let largest = n.abs().max_element();
    let unit = n / largest;
    (unit.dot(point) - c[3] / largest) / unit.length()
}
