//! Arms that several test files need: with a closed form, nearly with one, geared, two on one lift.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};
use std::fmt::Write as _;

use ikcore::load::{Dh, DhTable};
use ikcore::math::pose;
use ikcore::nalgebra::Vector3;
use ikcore::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};

const Q: f64 = FRAC_PI_2;

/// Arm without limits from rows (a, alpha, d).
pub fn arm<const N: usize>(name: &str, rows: [[f64; 3]; N]) -> Robot {
    let column = |k: usize| rows.iter().map(|row| row[k]).collect();
    Robot::from_dh(name, &DhTable::new(Dh::Standard, column(0), column(1), column(2))).unwrap()
}

pub fn puma560() -> Robot {
    let link = [[0.0, Q, 0.0], [0.4318, 0.0, 0.0], [0.0203, -Q, 0.15005]];
    let wrist = [[0.0, Q, 0.4318], [0.0, -Q, 0.0], [0.0, 0.0, 0.1]];
    arm("Puma 560", [link[0], link[1], link[2], wrist[0], wrist[1], wrist[2]])
}

/// UR10 with axes that deviate by up to `off` (rad).
pub fn calibrated_ur10(off: f64) -> Robot {
    let upper = [[0.0, Q, 0.1273], [-0.612, off, 0.0], [-0.5723, -0.7 * off, 0.0]];
    let wrist = [[0.0, Q, 0.163941], [0.0, -Q + 0.3 * off, 0.1157], [0.0, 0.0, 0.0922]];
    arm("calibrated", [upper[0], upper[1], upper[2], wrist[0], wrist[1], wrist[2]])
}

pub fn jaco2() -> Robot {
    let arm_rows = [[0.0, Q, 0.2755], [0.41, PI, 0.0], [0.0, Q, -0.0098]];
    let wrist = [[0.0, FRAC_PI_3, -0.2501], [0.0, FRAC_PI_3, -0.0856], [0.0, PI, -0.2028]];
    arm("JACO 2", [arm_rows[0], arm_rows[1], arm_rows[2], wrist[0], wrist[1], wrist[2]])
}

/// UR10 with joint 3 geared by `scale` from `offset`; with `twice`, it drives another axis too.
pub fn geared(scale: f64, offset: f64, twice: bool) -> Robot {
    let links = [[0.0, Q, 0.1273], [-0.612, 0.0, 0.0], [-0.5723, 0.0, 0.0], [0.0, Q, 0.1639], [0.0, -Q, 0.1157]];
    let mut chain = ChainBuilder::new("geared", "base");
    for (k, [a, alpha, d]) in links.into_iter().chain([[0.0, 0.0, 0.0922]]).enumerate() {
        let joint = chain.add_joint(Joint::new(format!("j{}", k + 1), JointKind::Revolute).with_range(-PI, PI));
        let drive = if k == 2 { Drive { scale, offset } } else { Drive::DIRECT };
        chain.moving(joint, JointKind::Revolute, Vector3::z(), drive);
        chain.fixed(pose::translation(a, 0.0, d) * pose::from_rpy([alpha, 0.0, 0.0], [0.0; 3]));
        chain.link(format!("l{}", k + 1));
    }
    if twice {
        chain.moving(0, JointKind::Revolute, Vector3::x(), Drive::DIRECT);
    }
    chain.build().unwrap()
}

/// Lift that carries two arms of seven joints with spherical wrists, 0.6 m apart, and a camera between them.
pub fn two_arms() -> String {
    let mut urdf = String::from(
        r#"<robot name="pair"><link name="floor"/><link name="chest"/><link name="camera"/>
        <joint name="lift" type="prismatic"><parent link="floor"/><child link="chest"/><origin xyz="0 0 0.5"/><axis xyz="0 0 1"/>
        <limit lower="0" upper="0.4" velocity="0.2"/></joint>
        <joint name="neck" type="fixed"><parent link="chest"/><child link="camera"/><origin xyz="0 0 0.5"/></joint>"#,
    );
    let axes = ["0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1"];
    let offsets = [0.1, 0.1, 0.2, 0.2, 0.2, 0.2, 0.0];
    for (side, y) in [("left", 0.3), ("right", -0.3)] {
        let mut parent = String::from("chest");
        for (i, (axis, z)) in axes.iter().zip(offsets).enumerate() {
            let (link, y) = (format!("{side}_{i}"), if i == 0 { y } else { 0.0 });
            let capsule = if i % 2 == 1 {
                r#"<collision><origin xyz="0 0 0.1"/><geometry><capsule radius="0.05" length="0.2"/></geometry></collision>"#
            } else {
                ""
            };
            _ = write!(
                urdf,
                r#"<link name="{link}">{capsule}</link><joint name="{side}_joint_{i}" type="revolute"><parent link="{parent}"/>
                <child link="{link}"/><origin xyz="0 {y} {z}"/><axis xyz="{axis}"/><limit lower="-2.8" upper="2.8" velocity="2"/></joint>"#
            );
            parent = link;
        }
        _ = write!(
            urdf,
            r#"<link name="{side}_tool"/><joint name="{side}_mount" type="fixed"><parent link="{parent}"/><child link="{side}_tool"/>
            <origin xyz="0 0 0.1"/></joint><link name="{side}_badge"/><joint name="{side}_pin" type="fixed"><parent link="{parent}"/>
            <child link="{side}_badge"/></joint>"#
        );
    }
    urdf + "</robot>"
}
