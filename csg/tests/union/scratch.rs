use crate::scene::model_of;
#[test]
fn scratch() {
    let model = model_of(&[
        &[
            ([-1.0, -1.0, -1.0], 0.3666666666666666, 0),
            ([1.0, 0.0, 0.0], 1.1, 0),
            ([-1.0, -0.0, -0.0], 0.2333333333333333, 0),
            ([0.0, 1.0, 0.0], 1.1, 0),
            ([0.0, 0.0, 1.0], 0.7666666666666666, 0),
            ([-0.0, -0.0, -1.0], 0.5666666666666667, 0),
        ],
        &[
            ([1.0, -0.0, -0.0], 0.1, 0),
            ([0.0, -1.0, -0.0], -0.1, 0),
            ([0.0, -0.0, -1.0], 0.5666666666666667, 0),
            ([-1.0, 1.0, 1.0], 0.1, 0),
        ],
    ]);
    let e = planecut_csg::evaluate(&model).unwrap();
    println!("{:?}\n{:?}", e.solid, e.model);
    for (k, p) in e.mesh.positions.iter().enumerate() {
        println!("{k} {p:?}");
    }
    for (t, f) in e.mesh.triangles.iter().zip(&e.mesh.triangle_faces) {
        let [a, b, c] = t.map(|v| e.mesh.positions[v as usize]);
        let n = e.mesh.faces[*f as usize].normal;
        println!("{t:?} face {f} n {n} area {} ", 0.5 * (b - a).cross(c - a).dot(n));
    }
}
