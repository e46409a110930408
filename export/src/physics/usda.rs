//! USD as text, with UsdPhysics schemas.

use std::io::Write;

use glam::DVec3;
use planecut_csg::Mesh;

use super::names::{VISUAL, collider_names, prim_name};
use super::{Cuboid, RigidBody};
use crate::decimal::write_digits;
use crate::{ExportError, material_color};

/// Writes a stage whose default prim is the body.
pub(super) fn write_usda(body: &RigidBody<'_>, out: &mut dyn Write) -> Result<(), ExportError> {
    let name = prim_name(body.name);
    write!(
        out,
        "#usda 1.0
(
    defaultPrim = \"{name}\"
    doc = \"planecut {}\"
    kilogramsPerUnit = 1
    metersPerUnit = 1
    upAxis = \"Z\"
)

def Xform \"{name}\" (
    kind = \"component\"
    prepend apiSchemas = [\"PhysicsRigidBodyAPI\", \"PhysicsMassAPI\"]
)
{{
    bool physics:rigidBodyEnabled = 1
",
        env!("CARGO_PKG_VERSION")
    )?;
    let (mass, principal) = (&body.mass, body.mass.principal());
    for value in [mass.mass].into_iter().chain(principal.moments.to_array()) {
        if !(value as f32).is_normal() {
            return Err(ExportError::MassRange { value });
        }
    }
    let [w, x, y, z] = principal.rotation.map(single);
    writeln!(out, "    float physics:mass = {}", single(mass.mass))?;
    writeln!(out, "    point3f physics:centerOfMass = {}", triple(mass.center))?;
    writeln!(out, "    float3 physics:diagonalInertia = {}", triple(principal.moments))?;
    writeln!(out, "    quatf physics:principalAxes = ({w}, {x}, {y}, {z})")?;
    if !body.visual.triangles.is_empty() {
        writeln!(out, "\n    def Mesh \"{VISUAL}\"\n    {{")?;
        write_mesh(body.visual, "        ", out)?;
        write_colors(body.visual, out)?;
        out.write_all(b"    }\n")?;
    }
    out.write_all(b"\n    def Scope \"collision\"\n    {\n")?;
    for (collider, name) in body.colliders.iter().zip(collider_names(body, prim_name)) {
        match &collider.cuboid {
            Some(cuboid) => write_cube(cuboid, &name, out)?,
            None => {
                writeln!(
                    out,
                    "        def Mesh \"{name}\" (
            prepend apiSchemas = [\"PhysicsCollisionAPI\", \"PhysicsMeshCollisionAPI\"]
        )
        {{
            uniform token physics:approximation = \"convexHull\"
            uniform token purpose = \"guide\""
                )?;
                write_mesh(collider.mesh, "            ", out)?;
                out.write_all(b"        }\n")?;
            }
        }
    }
    Ok(out.write_all(b"    }\n}\n")?)
}

/// A box: a cube of side 2, scaled, turned and moved.
fn write_cube(cuboid: &Cuboid, name: &str, out: &mut dyn Write) -> Result<(), ExportError> {
    let [w, x, y, z] = cuboid.rotation.map(single);
    Ok(writeln!(
        out,
        "        def Cube \"{name}\" (
            prepend apiSchemas = [\"PhysicsCollisionAPI\"]
        )
        {{
            float3[] extent = [(-1, -1, -1), (1, 1, 1)]
            uniform token purpose = \"guide\"
            double size = 2
            quatf xformOp:orient = ({w}, {x}, {y}, {z})
            double3 xformOp:scale = {}
            double3 xformOp:translate = {}
            uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\", \"xformOp:scale\"]
        }}",
        double_triple(cuboid.half_sizes),
        double_triple(cuboid.center)
    )?)
}

fn write_mesh(mesh: &Mesh, indent: &str, out: &mut dyn Write) -> Result<(), ExportError> {
    let low = mesh.positions.iter().fold(DVec3::INFINITY, |low, position| low.min(*position));
    let high = mesh.positions.iter().fold(DVec3::NEG_INFINITY, |high, position| high.max(*position));
    writeln!(out, "{indent}float3[] extent = [{}, {}]", triple(low), triple(high))?;
    write!(out, "{indent}int[] faceVertexCounts = [")?;
    write_list(mesh.triangles.iter(), out, |_, out| Ok(out.write_all(b"3")?))?;
    write!(out, "]\n{indent}int[] faceVertexIndices = [")?;
    write_list(mesh.triangles.iter().flatten(), out, |corner, out| Ok(write_digits(u64::from(*corner), out)?))?;
    write!(out, "]\n{indent}uniform token orientation = \"rightHanded\"\n{indent}point3f[] points = [")?;
    write_list(mesh.positions.iter().enumerate(), out, |(vertex, position), out| {
        match position.to_array().into_iter().find(|value| !(*value as f32).is_finite()) {
            Some(value) => Err(ExportError::CoordinateRange { vertex, value }),
            None => Ok(write!(out, "{}", triple(*position))?),
        }
    })?;
    Ok(writeln!(out, "]\n{indent}uniform token subdivisionScheme = \"none\"")?)
}

/// The colour of each triangle; one for all where they are alike.
fn write_colors(mesh: &Mesh, out: &mut dyn Write) -> Result<(), ExportError> {
    let colors: Vec<[f32; 3]> = mesh.materials.iter().map(material_color).collect();
    let of_face: Vec<[f32; 3]> =
        mesh.triangle_faces.iter().map(|face| colors[mesh.faces[*face as usize].material.0 as usize]).collect();
    let Some(first) = of_face.first() else { return Ok(()) };
    let is_one = of_face.iter().all(|color| color == first);
    let (colors, interpolation) = if is_one { (&of_face[..1], "constant") } else { (&of_face[..], "uniform") };
    out.write_all(b"        color3f[] primvars:displayColor = [")?;
    write_list(colors.iter(), out, |[r, g, b], out| Ok(write!(out, "({r:.4}, {g:.4}, {b:.4})")?))?;
    Ok(writeln!(out, "] (\n            interpolation = \"{interpolation}\"\n        )")?)
}

/// Things with commas between them.
fn write_list<T>(
    things: impl Iterator<Item = T>,
    out: &mut dyn Write,
    mut write: impl FnMut(T, &mut dyn Write) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    for (place, thing) in things.enumerate() {
        if place > 0 {
            out.write_all(b", ")?;
        }
        write(thing, out)?;
    }
    Ok(())
}

/// Single precision, as the schemas have it; without a sign on zero.
fn single(value: f64) -> f32 {
    value as f32 + 0.0
}

/// Double precision: of numbers that single precision holds, the shortest text for that is another number here.
fn double_triple(v: DVec3) -> String {
    let DVec3 { x, y, z } = v + 0.0;
    format!("({x}, {y}, {z})")
}

fn triple(v: DVec3) -> String {
    format!("({}, {}, {})", single(v.x), single(v.y), single(v.z))
}
