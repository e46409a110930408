//! Drawing, and looking at single pixels.

use glam::DVec3;
use planecut_csg::{CutMaterial, Material, MaterialId, Mesh, MeshFace};
use planecut_export::material_color;
use planecut_picture::{
    Background, CameraKind, Face, Paint, PaintedMesh, Picture, PreviewOptions, PreviewStyle, Tint, render,
};

use planecut_testkit::meshes;

pub(crate) const STYLES: [PreviewStyle; 4] =
    [PreviewStyle::Shaded, PreviewStyle::Technical, PreviewStyle::XRay, PreviewStyle::Wireframe];
pub(crate) const CAMERAS: [CameraKind; 2] = [CameraKind::Perspective, CameraKind::Orthographic];
pub(crate) const BACKGROUNDS: [Background; 3] = [Background::Light, Background::Dark, Background::Transparent];

pub(crate) const SMALL: PreviewOptions = PreviewOptions {
    width: 320,
    height: 240,
    style: PreviewStyle::Shaded,
    camera: CameraKind::Perspective,
    background: Background::Light,
    azimuth: -62.0,
    elevation: 32.0,
    dimensions: false,
    scale_bar: false,
    unit: None,
};

/// A mesh with the colours of its materials.
pub(crate) fn painted(mesh: &Mesh) -> PaintedMesh<'_> {
    with_paints(mesh, mesh.materials.iter().map(|material| tint_of(material).into()).collect())
}

/// The same with cuts hatched, in the colours of what was cut.
pub(crate) fn hatched<'a>(mesh: &'a Mesh, cuts: &[CutMaterial]) -> PaintedMesh<'a> {
    let mut painted = painted(mesh);
    for (number, cut) in (0..).zip(cuts) {
        let tint = cut.of.map_or(Tint::Clay, |id| tint_of(&mesh.materials[id.0 as usize]));
        painted.paints_mut()[cut.id.0 as usize] = Paint { tint, hatching: Some(number) };
    }
    painted
}

/// Cuts of materials that look like themselves.
pub(crate) fn own_cuts(materials: &[u32]) -> Vec<CutMaterial> {
    materials.iter().map(|&id| CutMaterial { id: MaterialId(id), of: Some(MaterialId(id)) }).collect()
}

/// A mesh in one colour.
pub(crate) fn in_one_color(mesh: &Mesh, color: [f32; 3]) -> PaintedMesh<'_> {
    with_paints(mesh, vec![Tint::Stated(color).into(); mesh.materials.len()])
}

fn with_paints(mesh: &Mesh, paints: Vec<Paint>) -> PaintedMesh<'_> {
    let positions = mesh.positions.iter().map(|position| position.to_array());
    let face = |face: &MeshFace| Face { normal: face.normal.to_array(), paint: face.material.0 };
    let faces = mesh.faces.iter().map(face).collect();
    PaintedMesh::new(positions, &mesh.triangles[..], &mesh.triangle_faces[..], faces, paints)
}

fn tint_of(material: &Material) -> Tint {
    let color = material_color(material);
    if material.color.is_some() { Tint::Stated(color) } else { Tint::Derived(color) }
}

pub(crate) fn draw(mesh: &Mesh, options: &PreviewOptions) -> Picture {
    render(&painted(mesh), options).expect("drawn")
}

pub(crate) fn pixel(picture: &Picture, x: u32, y: u32) -> [u8; 4] {
    let start = 4 * (y * picture.width + x) as usize;
    picture.pixels[start..start + 4].try_into().expect("four bytes")
}

/// Red, green and blue together, 0 to 765.
pub(crate) fn brightness([red, green, blue, _]: [u8; 4]) -> u32 {
    [red, green, blue].into_iter().map(u32::from).sum()
}

/// Linear light of a byte, as IEC 61966-2-1 says.
pub(crate) fn linear(byte: u8) -> f64 {
    let value = f64::from(byte) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Every place of a picture, row by row.
pub(crate) fn places(width: u32, height: u32) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

/// Where two pictures of one size differ.
pub(crate) fn differences(a: &Picture, b: &Picture) -> Vec<[u32; 2]> {
    assert_eq!([a.width, a.height], [b.width, b.height]);
    places(a.width, a.height).filter(|&[x, y]| pixel(a, x, y) != pixel(b, x, y)).collect()
}

/// The largest difference of any channel of two pictures of one size.
pub(crate) fn largest_difference(a: &Picture, b: &Picture) -> u8 {
    assert_eq!([a.width, a.height], [b.width, b.height]);
    a.pixels.iter().zip(&b.pixels).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// The least and the greatest coordinates of places, both included.
pub(crate) fn around(places: &[[u32; 2]]) -> [[u32; 2]; 2] {
    let first = *places.first().expect("a place");
    places
        .iter()
        .fold([first; 2], |[min, max], &[x, y]| [[min[0].min(x), min[1].min(y)], [max[0].max(x), max[1].max(y)]])
}

pub(crate) fn unit_box() -> Mesh {
    meshes::box_mesh(DVec3::splat(-1.0), DVec3::splat(1.0), "stone")
}

/// A box of the given sides with its lower corner at the origin.
pub(crate) fn block(sides: DVec3) -> Mesh {
    meshes::box_mesh(DVec3::ZERO, sides, "stone")
}

/// A tetrahedron at a corner of a cube.
pub(crate) fn tetrahedron(side: f64) -> Mesh {
    let mut mesh = unit_box();
    mesh.positions = vec![DVec3::ZERO, DVec3::X * side, DVec3::Y * side, DVec3::Z * side];
    mesh.triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    mesh.triangle_faces = vec![0, 1, 2, 3];
    let material = mesh.faces[0].material;
    let normals = [DVec3::NEG_Z, DVec3::NEG_Y, DVec3::NEG_X, DVec3::ONE.normalize()];
    mesh.faces = normals.map(|normal| MeshFace { normal, material }).to_vec();
    mesh
}
