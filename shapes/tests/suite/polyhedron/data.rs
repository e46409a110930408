//! Meshes that others made.

use glam::DVec3;
use planecut_shapes::polyhedron::Precision;
use planecut_testkit::data::data;

use super::judge::{Given, ensure_membership, ensure_skin};

planecut_testkit::tests_on_data!(hulls_of_convex_decompositions_are_one_cell_each, a_snowflake_is_cut_exactly);

/// The objects of a file of triangles.
fn objects(name: &str) -> Vec<Given> {
    let text = std::fs::read_to_string(data("convex").join(name)).expect(name);
    let mut points = Vec::new();
    let mut objects: Vec<Given> = Vec::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.first() {
            Some(&"v") => points.push(DVec3::from_array([1, 2, 3].map(|k| words[k].parse().expect("a number")))),
            Some(&"o") => objects.push(Given::default()),
            Some(&"f") => {
                let number = |word: &&str| word.split('/').next().and_then(|n| n.parse().ok()).expect("a number");
                let facet: Vec<u32> = words[1..]
                    .iter()
                    .map(|word| {
                        let n: u32 = number(word);
                        n - 1
                    })
                    .collect();
                if objects.is_empty() {
                    objects.push(Given::default());
                }
                objects.last_mut().expect("an object").facets.push(facet);
            }
            _ => {}
        }
    }
    objects.iter_mut().for_each(|object| object.points.clone_from(&points));
    objects
}

fn hulls_of_convex_decompositions_are_one_cell_each() {
    let files = ["chassis_vhacd", "cup_vhacd", "duck_vhacd", "lego_vhacd", "link2_vhacd"];
    let files = files.map(|name| (format!("bullet3/{name}.obj"), Precision::Places(6)));
    for (name, precision) in files.into_iter().chain([("coacd/SnowFlake_coacd.obj".to_owned(), Precision::Single)]) {
        for (number, object) in objects(&name).into_iter().enumerate() {
            let solid = object.cells(precision).unwrap_or_else(|error| panic!("{name} {number}: {error}"));
            assert_eq!(solid.cells.len(), 1, "{name} {number}");
            assert!((solid.volume / object.volume() - 1.0).abs() < 1e-9, "{name} {number}");
        }
    }
}

fn a_snowflake_is_cut_exactly() {
    let objects = objects("coacd/SnowFlake.obj");
    let given = &objects[0];
    let solid = given.cells(Precision::Places(6)).expect("a closed surface");
    assert!((solid.volume / given.volume() - 1.0).abs() < 1e-13);
    ensure_membership(given, &solid.cells, 100, 1e-9).expect("the membership of the mesh");
    // 1080 vertices, 3312 edges, 2208 triangles: 2 - 2 g = -24
    assert_eq!(ensure_skin(&solid.cells, given.volume(), 1e-12 * given.volume()), Ok((1, Some(13))));
    // 304 of its upright edges are reflex
    assert!(solid.cells.len() < 304, "{} cells", solid.cells.len());
}
