//! Cutting and un-cutting: planes are added to a solid and removed again in place, about a microsecond for each cell they reach.
//!
//! ```sh
//! cargo run --release --example cut_and_uncut
//! ```

use std::error::Error;
use std::time::Instant;

use planecut::csg::{Brush, MaterialId, Solid, Tree, primitives};
use planecut::kernel::{DVec3, HalfSpace};

/// How often the plane is moved on.
const STEPS: u32 = 64;

fn main() -> Result<(), Box<dyn Error>> {
    let stone = MaterialId(0);
    let block = Tree::from(Brush::cuboid(DVec3::splat(-10.0), DVec3::splat(10.0), stone));
    let ball = Tree::from(primitives::sphere(12.0, 48, stone)?);
    let bore = Tree::from(Brush::cuboid(DVec3::new(-4.0, -4.0, -20.0), DVec3::new(4.0, 4.0, 20.0), stone));
    let mut solid = Solid::from_tree(&((block & ball) - bore));
    let whole = solid.volume().ok_or("the solid is bounded")?;
    println!("{} cells, volume {whole}", solid.cells().count());

    // A section that sweeps through the solid: cut, look, take the cut back.
    let normal = DVec3::new(1.0, 2.0, 2.0);
    for step in 0..=8 {
        let offset = -30.0 + 60.0 * f64::from(step) / 8.0;
        let cut = solid.add_plane(HalfSpace::new(normal, offset)?);
        println!("  below {offset:6.1}: volume {:.6}", solid.volume().ok_or("the solid is bounded")?);
        solid.remove_plane(cut);
    }
    // Not nearly the same: the same.
    assert_eq!(solid.volume(), Some(whole));

    // Several cuts at once, removed in any order.
    let begin = Instant::now();
    let planes = (0..STEPS).map(|step| {
        let angle = f64::from(step) * std::f64::consts::TAU / f64::from(STEPS);
        HalfSpace::new(DVec3::new(angle.cos(), angle.sin(), 0.3), 9.5)
    });
    let cuts: Vec<_> = planes.map(|plane| plane.map(|plane| solid.add_plane(plane))).collect::<Result<_, _>>()?;
    let lathed = solid.volume().ok_or("the solid is bounded")?;
    for cut in cuts.iter().step_by(2).chain(cuts.iter().skip(1).step_by(2)) {
        solid.remove_plane(*cut);
    }
    println!("{STEPS} cuts and back in {:.2} ms; volume {lathed:.6} between", begin.elapsed().as_secs_f64() * 1e3);
    assert_eq!(solid.volume(), Some(whole));
    Ok(())
}
