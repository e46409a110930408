//! Which face is seen at each pixel, and how far away, against the second opinion.

use glam::{DMat3, DVec2, DVec3, EulerRot};
use planecut_csg::Mesh;
use planecut_picture::{Background, Buffers, CameraKind, PreviewOptions, PreviewStyle, render_buffers};

use planecut_testkit::random::Rng;

use crate::oracle::{Seen, eye_of, hits, orthographic, perspective};
use crate::support::{CAMERAS, SMALL, draw, painted, pixel, places, tetrahedron};
use planecut_testkit::meshes;

/// Directions to look from; straight down and level ones are among them.
const VIEWS: [[f64; 2]; 7] =
    [[-62.0, 32.0], [0.0, 0.0], [17.0, -25.0], [135.5, 61.0], [-100.0, 90.0], [250.0, -90.0], [-90.0, 3.0]];

/// Boxes of any size and rotation that reach into each other.
fn scene(seed: u64) -> Mesh {
    let mut random = Rng::new(seed);
    let mut mesh = Mesh::default();
    for _ in 0..9 {
        let mut vector = |low: f64, high: f64| DVec3::from([0; 3].map(|_: i32| random.float(low, high)));
        let (center, half, turn) = (vector(-4.0, 4.0), vector(0.3, 2.0), vector(0.0, 6.0));
        let rotation = DMat3::from_euler(EulerRot::XYZ, turn.x, turn.y, turn.z);
        meshes::push_box(&mut mesh, center, half, rotation, "stone");
    }
    mesh
}

/// The scenes, each with a seed to be told.
fn scenes() -> impl Iterator<Item = (u64, Mesh)> {
    let turned = (1..4).map(|seed| (seed, scene(seed)));
    turned.chain((4..6).map(|seed| (seed, meshes::random_boxes(10, seed))))
}

fn buffers(mesh: &Mesh, options: &PreviewOptions) -> Buffers {
    render_buffers(&painted(mesh), options).expect("drawn")
}

/// The diagonal of the box around a mesh.
fn size_of(mesh: &Mesh) -> f64 {
    let min = mesh.positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let max = mesh.positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    min.distance(max)
}

/// Compares every pixel that is farther than `margin` from any side of a triangle. `nearer` is what the buffers' depths are less than
/// those of the opinion. Tells how many pixels that were, and how many of them show a face.
fn compare(mesh: &Mesh, seen: &Seen, found: &Buffers, nearer: f64, margin: f64, what: &str) -> [usize; 2] {
    let size = size_of(mesh);
    let mut counts = [0, 0];
    for (index, [x, y]) in places(found.width, found.height).enumerate() {
        let hits = hits(mesh, seen, DVec2::new(x.into(), y.into()) + 0.5);
        if hits.from_edge < margin {
            continue;
        }
        counts[0] += 1;
        let (depth, face) = (found.depth[index] + nearer, found.faces[index]);
        let Some((nearest, expected)) = hits.nearest() else {
            assert_eq!(face, None, "{what}: pixel {x}, {y} shows a face instead of nothing");
            assert_eq!(found.depth[index], f64::INFINITY, "{what}: pixel {x}, {y} has a depth");
            continue;
        };
        counts[1] += 1;
        let difference = (depth - nearest).abs() / size;
        assert!(difference < 1e-4, "{what}: the depth at pixel {x}, {y} is off by {difference} of the size");
        // Faces on one plane, or that cross within the pixel, may be told apart by rounding only.
        let is_close = |depth: f64| depth - nearest < 1e-5 * size;
        let tied: Vec<u32> = hits.layers.iter().filter(|layer| is_close(layer.0)).map(|layer| layer.1).collect();
        let is_right = if tied.len() == 1 { face == Some(expected) } else { face.is_some_and(|f| tied.contains(&f)) };
        assert!(is_right, "{what}: pixel {x}, {y} shows {face:?}, not one of {tied:?}");
    }
    counts
}

#[test]
fn orthographic_buffers_agree_with_every_triangle_at_every_pixel() {
    for (seed, mesh) in scenes() {
        for ([azimuth, elevation], [width, height]) in
            VIEWS.into_iter().zip([[160, 120], [90, 160], [131, 67]].into_iter().cycle())
        {
            let camera = CameraKind::Orthographic;
            let options = PreviewOptions { width, height, camera, azimuth, elevation, ..SMALL };
            let (seen, found) = (orthographic(&mesh, &options), buffers(&mesh, &options));
            let what = format!("seed {seed} from {azimuth}, {elevation}");
            // Where the plane through the eye lies is not said, other than in front of all.
            let first = places(width, height).zip(&found.depth).find_map(|([x, y], &depth)| {
                let hits = hits(&mesh, &seen, DVec2::new(x.into(), y.into()) + 0.5);
                (hits.from_edge > 0.2).then(|| hits.nearest()).flatten().map(|(nearest, _)| nearest - depth)
            });
            let nearer = first.expect("something is seen");
            let [compared, shown] = compare(&mesh, &seen, &found, nearer, 1e-3, &what);
            assert!(
                compared > 9 * (width * height) as usize / 10 && shown > compared / 20,
                "{what}: {compared}, {shown}"
            );
            assert!(found.depth.iter().all(|&depth| depth > 0.0), "{what}: the model reaches beyond the eye");
        }
    }
}

/// One eye puts the points of all pixels on the planes of their faces; what is seen from there is the picture.
#[test]
fn perspective_buffers_are_what_one_eye_sees() {
    let mut told = 0;
    for (seed, mesh) in scenes() {
        for [azimuth, elevation] in VIEWS {
            let options = PreviewOptions { width: 160, height: 120, azimuth, elevation, ..SMALL };
            let found = buffers(&mesh, &options);
            let what = format!("seed {seed} from {azimuth}, {elevation}");
            let shown: std::collections::BTreeSet<u32> = found.faces.iter().flatten().copied().collect();
            // Too few directions of planes to tell the eye from.
            if shown.len() < 8 {
                continue;
            }
            told += 1;
            let (eye, pixel, worst) = eye_of(&mesh, &options, &found);
            assert!(worst < 1e-4 * size_of(&mesh), "{what}: a point is {worst} off its face's plane");
            let seen = perspective(&mesh, &options, eye, pixel);
            let [compared, _] = compare(&mesh, &seen, &found, 0.0, 0.05, &what);
            assert!(compared > 8 * 160 * 120 / 10, "{what}: {compared}");
            // All of the model is on the picture, as far as its margin; one way at least, with as much on both sides.
            let ends = |axis: usize, side: f64| {
                let along = seen.points.iter().map(|point| point[axis] / side);
                along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
            };
            let ends = [ends(0, 160.0), ends(1, 120.0)];
            assert!(ends.iter().all(|[low, high]| *low > 0.04 && *high < 0.96), "{what}: {ends:?}");
            assert!(ends.iter().all(|[low, high]| (low + high - 1.0).abs() < 0.02), "{what}: {ends:?}");
            assert!(ends.iter().any(|[low, high]| high - low > 0.80), "{what}: {ends:?}");
        }
    }
    assert!(told >= 25, "only {told} views show enough faces");
}

/// 1 / depth changes by the same amount from pixel to pixel of one face, with perspective; the depth itself does not.
#[test]
fn nearness_is_linear_across_a_face() {
    let mesh = meshes::box_mesh(DVec3::ZERO, DVec3::new(2.0, 9.0, 1.0), "stone");
    for camera in CAMERAS {
        let found = buffers(&mesh, &PreviewOptions { azimuth: -70.0, camera, ..SMALL });
        let bends = |value: fn(f64) -> f64| {
            let mut worst = 0.0_f64;
            let rows = found.faces.chunks_exact(320).zip(found.depth.chunks_exact(320));
            for (faces, depth) in rows {
                for (faces, depth) in faces.windows(41).zip(depth.windows(41)) {
                    if faces.iter().all(|face| face.is_some() && *face == faces[0]) {
                        let [a, b, c] = [depth[0], depth[20], depth[40]].map(value);
                        worst = worst.max((a - 2.0 * b + c).abs() / b.abs());
                    }
                }
            }
            worst
        };
        let [depth, nearness] = [bends(|depth| depth), bends(|depth| 1.0 / depth)];
        match camera {
            CameraKind::Perspective => assert!(nearness < 1e-5 && depth > 1e-4, "{nearness}, {depth}"),
            CameraKind::Orthographic => assert!(depth < 1e-5 && nearness > 1e-4, "{nearness}, {depth}"),
        }
    }
}

/// The buffers tell of the picture that is drawn with the same options, whatever is written beside it.
#[test]
fn buffers_and_pictures_show_the_same() {
    let solid = meshes::random_boxes(6, 8);
    for mesh in [tetrahedron(3.0), solid] {
        for camera in CAMERAS {
            for dimensions in [false, true] {
                for azimuth in [-62.0, 40.0] {
                    let (style, background) = (PreviewStyle::Shaded, Background::Light);
                    let options = PreviewOptions { style, background, camera, dimensions, azimuth, ..SMALL };
                    let (found, shown) = (buffers(&mesh, &options), draw(&mesh, &options));
                    // What becomes red with a face is that face.
                    let face = found.faces.iter().flatten().next().copied().expect("a face");
                    let mut red = mesh.clone();
                    red.materials.push(red.materials[0].clone());
                    red.materials.last_mut().expect("one").color = Some([1.0, 0.0, 0.0]);
                    red.faces[face as usize].material.0 = red.materials.len() as u32 - 1;
                    let red = draw(&red, &options);
                    let size = [options.width as i64, options.height as i64];
                    let mut counts = [0, 0];
                    for [x, y] in places(options.width, options.height) {
                        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| [dx, dy])).map(|[dx, dy]| {
                            let at = [i64::from(x) + dx, i64::from(y) + dy];
                            let at = [at[0].clamp(0, size[0] - 1), at[1].clamp(0, size[1] - 1)];
                            found.faces[(at[1] * size[0] + at[0]) as usize]
                        });
                        let is_face: Vec<bool> = around.map(|other| other == Some(face)).collect();
                        let differs = pixel(&shown, x, y) != pixel(&red, x, y);
                        if is_face.iter().all(|&is| is) {
                            counts[0] += 1;
                            counts[1] += usize::from(differs);
                        } else if !is_face.contains(&true) {
                            assert!(!differs, "{camera:?} {dimensions}: pixel {x}, {y} is not on face {face}");
                        }
                    }
                    // Text and lines may cover some of it.
                    let share = counts[1] as f64 / counts[0] as f64;
                    assert!(counts[0] > 30 && share > 0.5, "{camera:?} {dimensions}: {counts:?}");
                }
            }
        }
    }
}
