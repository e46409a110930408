//! URDF: a robot of one link.

use std::io::{self, Write};

use glam::{DMat3, DVec3};

use super::names::{VISUAL, body_name, collider_names, collision};
use super::{Cuboid, RigidBody, main_color};
use crate::material::linear_to_srgb;
use crate::xml::{escaped, write_numbers, write_vector};

/// Writes a robot, whose meshes are in `folder`.
pub(super) fn write_urdf(body: &RigidBody<'_>, folder: &str, out: &mut dyn Write) -> io::Result<()> {
    let (name, folder) = (body_name(body.name), escaped(folder));
    writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<robot name=\"{name}\">")?;
    // MuJoCo drops folders from paths, and what is only seen, unless it is told not to; others pass over the element
    writeln!(out, "  <mujoco>\n    <compiler strippath=\"false\" discardvisual=\"false\"/>\n  </mujoco>")?;
    writeln!(out, "  <link name=\"{name}\">")?;
    let mass = &body.mass;
    out.write_all(b"    <inertial>\n      <origin")?;
    write_vector("xyz", mass.center, out)?;
    out.write_all(b" rpy=\"0 0 0\"/>\n      <mass")?;
    write_numbers("value", &[mass.mass], out)?;
    out.write_all(b"/>\n      <inertia")?;
    let (m, p) = (mass.moments, mass.products);
    let entries = [("ixx", m.x), ("ixy", p.x), ("ixz", p.y), ("iyy", m.y), ("iyz", p.z), ("izz", m.z)];
    for (name, value) in entries {
        write_numbers(name, &[value], out)?;
    }
    out.write_all(b"/>\n    </inertial>\n")?;
    if !body.visual.triangles.is_empty() {
        writeln!(out, "    <visual name=\"{VISUAL}\">\n      <geometry>")?;
        writeln!(out, "        <mesh filename=\"{folder}/{VISUAL}.obj\"/>\n      </geometry>")?;
        if let Some(color) = main_color(body.visual) {
            let [r, g, b] = color.map(linear_to_srgb);
            writeln!(out, "      <material name=\"{VISUAL}\">")?;
            writeln!(out, "        <color rgba=\"{r:.4} {g:.4} {b:.4} 1\"/>\n      </material>")?;
        }
        out.write_all(b"    </visual>\n")?;
    }
    for (number, (collider, name)) in body.colliders.iter().zip(collider_names(body, escaped)).enumerate() {
        writeln!(out, "    <collision name=\"{name}\">")?;
        match &collider.cuboid {
            Some(cuboid) => write_box(cuboid, out)?,
            None => writeln!(
                out,
                "      <geometry>\n        <mesh filename=\"{folder}/{}.obj\"/>\n      </geometry>",
                collision(number)
            )?,
        }
        out.write_all(b"    </collision>\n")?;
    }
    out.write_all(b"  </link>\n</robot>\n")
}

fn write_box(cuboid: &Cuboid, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"      <origin")?;
    write_vector("xyz", cuboid.center, out)?;
    let angles = if cuboid.is_along_axes() { DVec3::ZERO } else { roll_pitch_yaw(DMat3::from_quat(cuboid.turn())) };
    write_vector("rpy", angles, out)?;
    out.write_all(b"/>\n      <geometry>\n        <box")?;
    write_vector("size", cuboid.half_sizes * 2.0, out)?;
    out.write_all(b"/>\n      </geometry>\n")
}

/// Angles in radians about the fixed axes x, y and z, one after another.
fn roll_pitch_yaw(rotation: DMat3) -> DVec3 {
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = rotation.to_cols_array_2d();
    let across = (xx * xx + xy * xy).sqrt();
    let pitch = libm::atan2(-xz, across);
    if across < 1e-9 {
        // looking along z, roll and yaw turn the same way: all of it is roll
        return DVec3::new(libm::atan2(-rotation.z_axis.y, yy), pitch, 0.0);
    }
    DVec3::new(libm::atan2(yz, zz), pitch, libm::atan2(xy, xx))
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn angles_give_the_rotation_back() {
        let mut rng = Rng::new(9);
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let straight = [[half, 0.0, half, 0.0], [0.5, 0.5, 0.5, 0.5], [half, 0.0, -half, 0.0], [0.0, 1.0, 0.0, 0.0]];
        let random = std::iter::repeat_with(|| std::array::from_fn(|_| rng.integer(-1000, 1000) as f64 + 0.5));
        for [w, x, y, z] in straight.into_iter().chain(random.take(500)) {
            let rotation = DMat3::from_quat(DQuat::from_xyzw(x, y, z, w).normalize());
            let DVec3 { x: roll, y: pitch, z: yaw } = roll_pitch_yaw(rotation);
            let back = DMat3::from_rotation_z(yaw) * DMat3::from_rotation_y(pitch) * DMat3::from_rotation_x(roll);
            assert!(back.abs_diff_eq(rotation, 2e-8), "seed 9: {rotation}, {back}");
        }
    }
}
