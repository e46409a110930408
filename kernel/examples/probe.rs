//! Times removal and re-insertion of one plane in place.
use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, PlaneIdx};
use std::time::Instant;
fn fib(n: usize) -> Vec<HalfSpace> {
    let g = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..n).map(|i| { let z = 1.0 - (2.0 * i as f64 + 1.0) / n as f64; let r = (1.0 - z * z).sqrt(); let t = g * i as f64;
        HalfSpace::new(DVec3::new(r * t.cos(), r * t.sin(), z), 1.0).unwrap() }).collect()
}
fn main() {
    for n in [30, 100, 200, 1000, 10000, 100000] {
        let hs = fib(n);
        let t = Instant::now();
        let mut p = IncrementalPolytope::new();
        let mut ids: Vec<PlaneIdx> = hs.iter().map(|h| p.add_plane(*h).plane()).collect();
        let build = t.elapsed().as_secs_f64() * 1e6;
        if n < 2000 { p.check_invariants().unwrap(); }
        assert!(p.is_bounded());
        let reps = 200_000;
        let mut best = f64::MAX;
        for _ in 0..5 {
        let t = Instant::now();
        for k in 0..reps / 5 { let i = (k * 7919) % n; let h = *p.plane(ids[i]).unwrap(); p.remove_plane(ids[i]); ids[i] = p.add_plane(h).plane(); }
        best = best.min(t.elapsed().as_secs_f64() * 1e6 / (reps / 5) as f64);
        }
        println!("{n}: build {build:.0} us, remove+add {:.3} us, V {}", best, p.vertex_count());
        if n < 2000 { p.check_invariants().unwrap(); }
    }
}
