//! Normals, texture coordinates, tangents, colours and sources.

use glam::{DVec2, DVec3, DVec4};
use planecut_csg::{Brush, Material, MaterialId, Mesh, Model, TextureAxes, TextureUnit, Tree, evaluate};
use planecut_export::{ExportError, ExportOptions, Format, Part, Projection, Shading, TextureMapping, encode};
use planecut_shapes::primitives;

use super::support::written;
use planecut_testkit::meshes::{box_mesh, cube_with_hole, random_boxes};

fn sphere() -> Mesh {
    let ball = primitives::sphere(2.0, 48, MaterialId(0)).expect("a sphere");
    evaluate(&Model { materials: vec![Material::named("m")], tree: ball.into() }).expect("evaluated").mesh
}

fn smooth(crease: f64) -> ExportOptions {
    ExportOptions { shading: Shading::Smooth { crease }, ..ExportOptions::default() }
}

fn textured(projection: Projection) -> ExportOptions {
    ExportOptions { texture: Some(TextureMapping { projection, size: 2.0 }), ..ExportOptions::default() }
}

#[test]
fn a_ball_is_round_within_its_crease_angle() {
    let mesh = sphere();
    let file = written(&[Part::new("ball", &mesh)], &smooth(30.0));
    let vertices = || file.parts.iter().flatten().flat_map(|primitive| &primitive.vertices);
    assert_eq!(vertices().count(), mesh.positions.len(), "no vertex is split");
    // a segment of 48 turns by 7.5 degrees
    let turned = (7.5_f64).to_radians().cos();
    assert!(vertices().all(|vertex| vertex.normal.dot(vertex.position.normalize()) > turned));
    let flat = written(&[Part::new("ball", &mesh)], &smooth(0.0));
    let faces = written(&[Part::new("ball", &mesh)], &ExportOptions::default());
    assert_eq!(flat.parts[0][0].vertices.len(), faces.parts[0][0].vertices.len(), "all edges are creases");
}

#[test]
fn a_cube_keeps_its_edges_unless_they_are_within_the_crease_angle() {
    let mesh = box_mesh(DVec3::ZERO, DVec3::ONE, "m");
    for (crease, vertices) in [(0.0, 24), (89.0, 24), (90.0, 8), (180.0, 8)] {
        let file = written(&[Part::new("cube", &mesh)], &smooth(crease));
        let found = &file.parts[0][0].vertices;
        assert_eq!(found.len(), vertices, "at {crease}");
        let diagonal = |vertex: &super::support::Vertex| (vertex.position - 0.5).normalize();
        let is_right = |vertex: &super::support::Vertex| match vertices {
            8 => vertex.normal.abs_diff_eq(diagonal(vertex), 1e-6),
            _ => vertex.normal.abs().max_element() > 1.0 - 1e-6,
        };
        assert!(found.iter().all(is_right), "at {crease}");
    }
}

#[test]
fn boxes_project_lengths_as_they_are() {
    let mesh = cube_with_hole();
    let file = written(&[Part::new("m", &mesh)], &textured(Projection::Box));
    for primitive in file.parts.iter().flatten() {
        for triangle in &primitive.triangles {
            let [a, b, c] = primitive.corners(*triangle);
            let [p, q, r] = [a, b, c].map(|corner| corner.texture.expect("texture coordinates") * 2.0);
            // of faces along the axes nothing is lost; seen from outside, v runs down
            let area = (b.position - a.position).cross(c.position - a.position).dot(a.normal);
            assert!(((q - p).perp_dot(r - p) + area).abs() < 1e-5, "{a:?} {b:?} {c:?}");
            if a.normal.z.abs() < 0.5 {
                assert!((a.texture.expect("some").y * 2.0 + a.position.z).abs() < 1e-6, "upright on walls");
            }
        }
    }
}

#[test]
fn sources_say_how_textures_lie_and_where_faces_come_from() {
    let blocks = [0.0, 1.0, 2.5].map(|x| Brush::cuboid(DVec3::splat(x), DVec3::splat(x + 2.0), MaterialId(0)));
    let axes = |brush: usize, plane: usize| TextureAxes {
        u: DVec3::new(0.5, 0.25 * brush as f64, 1.0),
        v: DVec3::new(1.0, -1.0, plane as f64),
        offset: DVec2::new(brush as f64, -(plane as f64)),
        // those of one brush count whole pictures, which have no size of texels
        unit: if brush == 1 { TextureUnit::Pictures } else { TextureUnit::Texels },
        anchor: None,
    };
    let textures: Vec<Vec<_>> = (0..3).map(|brush| (0..6).map(|plane| Some(axes(brush, plane))).collect()).collect();
    let model = Model { materials: vec![Material::named("m")], tree: Tree::union_of(blocks.to_vec()) };
    let (split, sources) = model.split_by_source(&textures, true);
    let mesh = evaluate(&split).expect("evaluated").mesh;
    let part = Part { name: "m", mesh: &mesh, sources: &sources };
    let options = ExportOptions { source_ids: true, ..textured(Projection::Source) };
    let file = written(&[part], &options);
    let mut checked = 0;
    for primitive in file.parts.iter().flatten() {
        let mut triangles = primitive.triangles.iter();
        for run in primitive.extras["faces"].as_array().expect("faces") {
            let [count, brush, plane] = [0, 1, 2].map(|k| run[k].as_u64().expect("a number") as usize);
            let half_space = blocks[brush].faces[plane].half_space;
            for triangle in triangles.by_ref().take(count) {
                for corner in primitive.corners(*triangle) {
                    assert!(half_space.signed_distance(corner.position).abs() < 1e-6, "{brush} {plane}");
                    let size = if brush == 1 { 1.0 } else { 2.0 };
                    let expected = axes(brush, plane).at(corner.position) / size;
                    assert!(corner.texture.expect("some").abs_diff_eq(expected, 1e-5));
                    checked += 1;
                }
            }
        }
        assert!(triangles.next().is_none(), "every triangle has a source");
    }
    assert_eq!(checked, 3 * mesh.triangles.len());
    assert_eq!(file.parts[0].len(), 1, "materials that look alike are one primitive");
}

#[test]
fn tangents_follow_the_texture() {
    let meshes = [random_boxes(30, 5), cube_with_hole()];
    for (mesh, projection) in meshes.iter().zip([Projection::Box, Projection::Box]) {
        let file = written(&[Part::new("m", mesh)], &ExportOptions { tangents: true, ..textured(projection) });
        for primitive in file.parts.iter().flatten() {
            for triangle in &primitive.triangles {
                let corners = primitive.corners(*triangle);
                let [a, b, c] = corners.map(|corner| corner.position);
                let [p, q, r] = corners.map(|corner| corner.texture.expect("some"));
                // the direction in which u grows: solves along both sides
                let (s, t) = (q - p, r - p);
                let along_u = ((b - a) * t.y - (c - a) * s.y) / s.perp_dot(t);
                for corner in corners {
                    let tangent = corner.tangent.expect("a tangent");
                    assert!(tangent.truncate().dot(corner.normal).abs() < 1e-5);
                    assert!((tangent.truncate().length() - 1.0).abs() < 1e-5);
                    assert!(tangent.truncate().dot(along_u.normalize()) > 1.0 - 1e-4, "{tangent} {along_u}");
                    assert_eq!(tangent.w, 1.0, "no projection of a box is mirrored");
                }
            }
        }
    }
}

#[test]
fn colours_of_vertices_stand_for_materials() {
    let mesh = random_boxes(40, 9);
    let plain = written(&[Part::new("m", &mesh)], &ExportOptions::default());
    assert!(plain.parts[0].len() > 1);
    let colored = written(&[Part::new("m", &mesh)], &ExportOptions { vertex_colors: true, ..ExportOptions::default() });
    assert_eq!(colored.json["materials"].as_array().map(Vec::len), Some(1), "all are white");
    let mut expected: Vec<(DVec3, DVec4)> = Vec::new();
    for primitive in &plain.parts[0] {
        let material = plain.json["materials"].as_array().expect("materials").iter();
        let material = material.clone().find(|m| m["name"].as_str() == primitive.material.as_deref()).expect("named");
        let factor = &material["pbrMetallicRoughness"]["baseColorFactor"];
        let color = DVec4::from([0, 1, 2, 3].map(|k| factor[k].as_f64().unwrap_or(1.0)));
        expected.extend(primitive.vertices.iter().map(|vertex| (vertex.position, color)));
    }
    for vertex in colored.parts[0].iter().flat_map(|primitive| &primitive.vertices) {
        let color = vertex.color.expect("a colour");
        let is_one =
            |(position, other): &(DVec3, DVec4)| *position == vertex.position && other.abs_diff_eq(color, 1e-4);
        assert!(expected.iter().any(is_one), "{vertex:?}");
    }
}

#[test]
fn numbers_that_mean_nothing_are_refused() {
    let mesh = box_mesh(DVec3::ZERO, DVec3::ONE, "m");
    let refused = |options: ExportOptions| encode(&mesh, Format::Glb, &options).expect_err("refused");
    for crease in [-1.0, 181.0, f64::NAN] {
        assert!(matches!(refused(smooth(crease)), ExportError::CreaseAngle(_)));
    }
    for size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let texture = Some(TextureMapping { projection: Projection::Box, size });
        assert!(matches!(refused(ExportOptions { texture, ..ExportOptions::default() }), ExportError::TextureSize(_)));
    }
    let tangents = ExportOptions { tangents: true, ..ExportOptions::default() };
    assert!(matches!(refused(tangents), ExportError::TangentsWithoutTexture));
}

#[cfg(not(feature = "meshopt"))]
#[test]
fn packed_buffers_need_a_feature() {
    let options = ExportOptions { meshopt: true, ..ExportOptions::default() };
    let error = encode(&cube_with_hole(), Format::Glb, &options).expect_err("no library").to_string();
    assert_eq!(error, "EXT_meshopt_compression is not in this build, expected one with the feature `meshopt`");
}
