//! What each style shows and what it hides, and how strong its lines are.

use glam::{DMat3, DVec2, DVec3};
use planecut_csg::Mesh;
use planecut_picture::{CameraKind, Picture, PreviewOptions, PreviewStyle, render, render_buffers};

use planecut_testkit::random::Rng;

use crate::oracle::orthographic;
use crate::support::{
    BACKGROUNDS, CAMERAS, SMALL, STYLES, block, brightness, differences, draw, hatched, linear, own_cuts, painted,
    pixel, unit_box,
};
use planecut_testkit::meshes;

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let mesh = meshes::random_boxes(60, 17);
    let mut options = Vec::new();
    for style in STYLES {
        for camera in CAMERAS {
            for background in BACKGROUNDS {
                let labels = background != planecut_picture::Background::Dark;
                let small = PreviewOptions { style, camera, background, width: 201, height: 143, ..SMALL };
                options.push(PreviewOptions { dimensions: labels, scale_bar: labels, ..small });
            }
        }
        options.push(PreviewOptions { style, width: 1001, height: 777, ..SMALL });
    }
    for options in options {
        // The last run is the second one with five threads.
        let pictures = [1, 2, 5, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| {
                let subject = hatched(&mesh, &own_cuts(&[1, 2]));
                let buffers = render_buffers(&subject, &options).expect("drawn");
                (render(&subject, &options).expect("drawn"), buffers.depth_png().expect("encoded"), buffers.faces)
            })
        });
        assert!(pictures.iter().all(|picture| *picture == pictures[0]), "{options:?}");
    }
}

/// Whatever is inside a closed box leaves no trace where surfaces hide it, and does in the styles that show it.
#[test]
fn what_is_inside_is_hidden_or_not() {
    let outside = meshes::random_boxes(1, 4);
    let mut with_inside = unit_box();
    for seed in 0..40 {
        let mut random = Rng::new(seed);
        let center = DVec3::from([0; 3].map(|_: i32| random.float(-0.6, 0.6)));
        let rotation = DMat3::from_euler(glam::EulerRot::XYZ, random.float(0.0, 3.0), random.float(0.0, 3.0), 0.0);
        meshes::push_box(&mut with_inside, center, DVec3::splat(random.float(0.05, 0.2)), rotation, "stone");
    }
    for style in STYLES {
        for camera in CAMERAS {
            for azimuth in [-62.0, 0.0, 17.0, 135.0] {
                for elevation in [-30.0, 0.0, 32.0, 90.0] {
                    let options = PreviewOptions { style, camera, azimuth, elevation, ..SMALL };
                    let [inside, empty] = [&with_inside, &unit_box()].map(|mesh| draw(mesh, &options));
                    let trace = differences(&inside, &empty).len();
                    let is_right = if style == PreviewStyle::Shaded { trace == 0 } else { trace > 500 };
                    assert!(is_right, "{style:?} {camera:?} from {azimuth}, {elevation}: {trace} pixels differ");
                    assert!(draw(&outside, &options) != empty);
                }
            }
        }
    }
}

/// A drawing at the size that widths are stated for, and where the corners of the box are on it.
fn drawing(mesh: &Mesh) -> (Picture, Vec<DVec2>) {
    let options = PreviewOptions {
        width: 960,
        height: 960,
        style: PreviewStyle::Technical,
        camera: CameraKind::Orthographic,
        azimuth: -65.0,
        elevation: 25.0,
        ..SMALL
    };
    let seen = orthographic(mesh, &options);
    (draw(mesh, &options), seen.points.iter().map(|point| point.truncate()).collect())
}

/// How much ink is across a steep line at a row, in pixels: what part of the light of the surface beside it is missing, added up.
fn ink_across(picture: &Picture, at: DVec2) -> f64 {
    let middle = at.x as u32;
    let light = |x: u32| linear(pixel(picture, x, at.y as u32)[1]);
    let beside = [light(middle - 8), light(middle + 8)];
    // Each side is compared with its own surface.
    let missing = |x: u32| (1.0 - light(x) / beside[usize::from(x >= middle)]).max(0.0);
    (middle - 5..middle + 6).map(missing).sum()
}

/// A point of the line between two corners.
fn between(points: &[DVec2], [from, to]: [usize; 2], part: f64) -> DVec2 {
    points[from].lerp(points[to], part)
}

#[test]
fn outlines_are_stronger_than_creases() {
    let (picture, points) = drawing(&block(DVec3::new(3.0, 2.0, 2.5)));
    // Upright edges start at the corners 0 to 3: nearest the eye is the one at x, 0.
    let mean = |edge: [usize; 2]| {
        let inks: Vec<f64> =
            (20..80).map(|part| ink_across(&picture, between(&points, edge, f64::from(part) / 100.0))).collect();
        inks.iter().sum::<f64>() / inks.len() as f64
    };
    let upright: Vec<[usize; 2]> = (0..4).map(|corner| [corner, corner + 4]).collect();
    let x = |edge: &[usize; 2]| points[edge[0]].x;
    let left = *upright.iter().min_by(|a, b| x(a).total_cmp(&x(b))).expect("four");
    let right = *upright.iter().max_by(|a, b| x(a).total_cmp(&x(b))).expect("four");
    let front = *upright.iter().max_by(|a, b| points[a[0]].y.total_cmp(&points[b[0]].y)).expect("four");
    let [left, right, crease] = [left, right, front].map(mean);
    println!("ink across the outlines {left} and {right}, across the crease {crease}");
    // Stated widths are 1.15 and 2.3 pixels.
    assert!((crease - 1.15).abs() < 0.2, "{crease}");
    for outline in [left, right] {
        assert!((outline - 2.3).abs() < 0.3, "{outline} against {crease}");
    }
}

/// Lengths of the runs of ink and of the gaps between them along a line, in pixels.
fn runs(picture: &Picture, [from, to]: [DVec2; 2]) -> Vec<(bool, f64)> {
    let length = from.distance(to);
    let steps = (length * 4.0) as usize;
    let mut runs: Vec<(bool, f64)> = Vec::new();
    for step in 0..steps {
        let at = from.lerp(to, (step as f64 + 0.5) / steps as f64);
        let inked = ink_across(picture, at) > 0.3;
        match runs.last_mut() {
            Some((last, length)) if *last == inked => *length += 0.25,
            _ => runs.push((inked, 0.25)),
        }
    }
    runs
}

/// Hidden edges have dashes of 9 pixels with gaps of 6 between them, seen ones have no gaps.
#[test]
fn hidden_edges_are_dashed() {
    let (picture, points) = drawing(&block(DVec3::new(3.0, 2.0, 2.5)));
    let along = |edge: [usize; 2]| runs(&picture, [between(&points, edge, 0.1), between(&points, edge, 0.9)]);
    // Farthest from the eye is the corner at 0, y; the nearest at x, 0.
    let hidden = along([2, 6]);
    let whole: f64 = hidden.iter().map(|run| run.1).sum();
    let dashes = hidden.iter().filter(|run| run.0).count() as f64;
    let inner = &hidden[1..hidden.len() - 1];
    assert!((dashes - whole / 15.0).abs() <= 1.5, "{dashes} dashes along {whole} pixels");
    for &(inked, length) in inner {
        let stated = if inked { 9.0 } else { 6.0 };
        assert!((length - stated).abs() < 2.5, "a run of {length} pixels: {hidden:?}");
    }
    let seen = along([1, 5]);
    assert!(seen.len() == 1 && seen[0].0, "{seen:?}");
}

/// On an orthographic picture every face of a box is a parallelogram, so that parallel edges are parallel and equally long: its pixels
/// lie the same from both sides of their middle. With perspective they do not.
#[test]
fn parallel_edges_stay_parallel_and_equally_long() {
    let mut random = Rng::new(9);
    for round in 0..6 {
        let rotation = DMat3::from_euler(glam::EulerRot::XYZ, random.float(0.0, 6.0), random.float(0.0, 6.0), 0.0);
        let mut mesh = Mesh::default();
        meshes::push_box(&mut mesh, DVec3::ONE, DVec3::new(1.5, 1.2, 1.0), rotation, "stone");
        let mut worst = [0.0_f64; 2];
        for (worst, camera) in worst.iter_mut().zip([CameraKind::Orthographic, CameraKind::Perspective]) {
            let options = PreviewOptions { camera, width: 640, height: 480, ..SMALL };
            let faces = render_buffers(&painted(&mesh), &options).expect("drawn").faces;
            for face in 0..6 {
                let pixels: Vec<[i64; 2]> = (0..faces.len() as i64)
                    .filter(|&index| faces[index as usize] == Some(face))
                    .map(|index| [index % 640, index / 640])
                    .collect();
                // Those that are seen almost along themselves have hardly anything but a rim.
                if pixels.len() < 4_000 {
                    continue;
                }
                let count = pixels.len() as f64;
                let sum = pixels.iter().fold([0; 2], |sum, at| [sum[0] + at[0], sum[1] + at[1]]);
                let turned = |at: &[i64; 2], axis: usize| (2.0 * sum[axis] as f64 / count).round() as i64 - at[axis];
                let missing = pixels.iter().filter(|at| {
                    let [x, y] = [turned(at, 0), turned(at, 1)];
                    let is_inside = (0..640).contains(&x) && (0..480).contains(&y);
                    !is_inside || faces[(y * 640 + x) as usize] != Some(face)
                });
                let rim = count.sqrt();
                *worst = worst.max(missing.count() as f64 / rim);
            }
        }
        println!("round {round} of seed 9: {worst:?}");
        assert!(worst[0] < 2.0 && worst[1] > 2.5, "round {round} of seed 9: {worst:?}");
    }
}

/// Hatching changes nothing but the faces of the materials that are named, and rules lines all over those.
#[test]
fn only_faces_of_the_materials_named_are_hatched() {
    let mut mesh = Mesh::default();
    for (number, material) in ["a", "b", "c"].into_iter().enumerate() {
        let center = DVec3::X * 2.5 * number as f64;
        meshes::push_box(&mut mesh, center, DVec3::ONE, DMat3::IDENTITY, material);
    }
    for style in [PreviewStyle::Shaded, PreviewStyle::Technical] {
        for camera in CAMERAS {
            let options = PreviewOptions { style, camera, width: 640, height: 480, ..SMALL };
            let plain = draw(&mesh, &options);
            let faces = render_buffers(&painted(&mesh), &options).expect("drawn").faces;
            let material = |x: u32, y: u32| {
                let face = faces[(y.min(479) * 640 + x.min(639)) as usize];
                face.map(|face| mesh.faces[face as usize].material.0)
            };
            for named in [vec![0], vec![1], vec![2, 0]] {
                let cuts = own_cuts(&named);
                let hatched = render(&hatched(&mesh, &cuts), &options).expect("drawn");
                let changed = differences(&plain, &hatched);
                for &[x, y] in &changed {
                    let mut around = (0..7).flat_map(|dy| (0..7).map(move |dx| [x + dx, y + dy]));
                    let is_near = around.any(|[x, y]| {
                        material(x.saturating_sub(3), y.saturating_sub(3)).is_some_and(|m| named.contains(&m))
                    });
                    assert!(is_near, "{style:?} {camera:?}: pixel {x}, {y} is not of {named:?}");
                }
                // Dark lines run across each row of the faces.
                for &number in &named {
                    let (mut lines, mut pixels) = (0, 0);
                    for y in 0..480 {
                        for x in (1..639).filter(|&x| (x - 1..=x + 1).all(|x| material(x, y) == Some(number))) {
                            pixels += 1;
                            let [left, here, right] = [x - 1, x, x + 1].map(|x| brightness(pixel(&hatched, x, y)));
                            lines += u32::from(here < left && here <= right && here + 60 < left.max(right));
                        }
                    }
                    // Lines are 6 pixels apart, across lines at 45 degrees 8.5.
                    let apart = f64::from(pixels) / f64::from(lines.max(1));
                    assert!(pixels > 2_000 && apart > 4.0 && apart < 16.0, "{style:?} {named:?}: {lines} in {pixels}");
                }
                assert!(!changed.is_empty(), "{style:?} {named:?}");
            }
        }
    }
}
