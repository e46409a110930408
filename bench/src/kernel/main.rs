//! probe
mod inputs; mod library; mod verify; mod case;
fn main() {
    use library::*;
    for n in [30,200] { println!("{:?}", verify::simple_polytope::<PolySurge>("ps", &inputs::fibonacci_sphere(n), 200)); }
    for n in [30,200,10000,100000] { let t=std::time::Instant::now(); println!("{:?} {:?}", verify::simple_polytope::<Planecut>("pc", &inputs::fibonacci_sphere(n), if n<1000 {200} else {2}), t.elapsed()); }
    println!("{:?}", verify::counts_around_removal::<Planecut>(&inputs::pyramid(200)));
    println!("{:?}", verify::counts_around_removal::<PolySurge>(&inputs::pyramid(200)));
    println!("{:.2}", case::remove_and_add::<Planecut>(&inputs::fibonacci_sphere(30), 3000)());
    println!("{:.2}", case::remove_and_add::<PolySurge>(&inputs::fibonacci_sphere(30), 300)());
    println!("{:.2}", case::remove_and_add::<PolySurge>(&inputs::fibonacci_sphere(200), 300)());
    println!("{:.2}", case::clone_and_remove::<PolySurge>(&inputs::fibonacci_sphere(200), 300)());
    println!("{:.2}", case::remove_first::<Planecut>(&inputs::pyramid(200), 3)());
    println!("{:.2}", case::remove_first::<PolySurge>(&inputs::pyramid(200), 3)());
}
