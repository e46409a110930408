//! MJCF: MuJoCo's model file.

use std::io::{self, Write};

use super::names::{VISUAL, body_name, collider_names, collision};
use super::{RigidBody, main_color};
use crate::material::linear_to_srgb;
use crate::xml::{escaped, write_numbers, write_vector};

/// Writes a model with one free body, whose meshes are in `folder`.
///
/// It may be included in a scene beside others: it has no settings of the compiler, which are the scene's own, and each name begins with that of the body.
pub(super) fn write_mjcf(body: &RigidBody<'_>, folder: &str, out: &mut dyn Write) -> io::Result<()> {
    let (name, folder) = (body_name(body.name), escaped(folder));
    let has_visual = !body.visual.triangles.is_empty();
    writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(out, r#"<mujoco model="{name}">"#)?;
    writeln!(
        out,
        r#"  <default>
    <default class="{name}_visual">
      <geom type="mesh" group="2" contype="0" conaffinity="0" density="0"/>
    </default>
    <default class="{name}_collision">
      <geom group="3"/>
    </default>
  </default>
  <asset>"#
    )?;
    // a surface says where a mesh is also where it has no volume, or next to none
    if has_visual {
        writeln!(out, r#"    <mesh name="{name}_{VISUAL}" file="{folder}/{VISUAL}.obj" inertia="shell"/>"#)?;
    }
    for number in (0..body.colliders.len()).filter(|number| body.colliders[*number].cuboid.is_none()) {
        let mesh = collision(number);
        writeln!(out, r#"    <mesh name="{name}_{mesh}" file="{folder}/{mesh}.obj" inertia="shell"/>"#)?;
    }
    writeln!(out, "  </asset>\n  <worldbody>\n    <body name=\"{name}\">\n      <freejoint name=\"{name}\"/>")?;
    let mass = &body.mass;
    out.write_all(b"      <inertial")?;
    write_vector("pos", mass.center, out)?;
    write_numbers("mass", &[mass.mass], out)?;
    write_numbers("fullinertia", &[mass.moments.to_array(), mass.products.to_array()].concat(), out)?;
    out.write_all(b"/>\n")?;
    if has_visual {
        write!(out, r#"      <geom name="{name}_{VISUAL}" class="{name}_visual" mesh="{name}_{VISUAL}""#)?;
        if let Some(color) = main_color(body.visual) {
            let [r, g, b] = color.map(linear_to_srgb);
            write!(out, r#" rgba="{r:.4} {g:.4} {b:.4} 1""#)?;
        }
        out.write_all(b"/>\n")?;
    }
    for (number, (collider, own)) in body.colliders.iter().zip(collider_names(body, escaped)).enumerate() {
        write!(out, r#"      <geom name="{name}_{own}" class="{name}_collision""#)?;
        match &collider.cuboid {
            Some(cuboid) => {
                out.write_all(b" type=\"box\"")?;
                write_vector("size", cuboid.half_sizes, out)?;
                write_vector("pos", cuboid.center, out)?;
                if !cuboid.is_along_axes() {
                    write_numbers("quat", &cuboid.rotation, out)?;
                }
            }
            None => write!(out, r#" type="mesh" mesh="{name}_{}""#, collision(number))?,
        }
        out.write_all(b"/>\n")?;
    }
    out.write_all(b"    </body>\n  </worldbody>\n</mujoco>\n")
}
