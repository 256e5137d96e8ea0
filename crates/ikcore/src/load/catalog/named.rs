//! Built-in robots by name. To add a robot, write its [`Arm`] and list it in [`ROBOTS`].

use super::arm::Arm;
use super::{franka, hydraulic, kinova, kuka, universal_robots};
use crate::error::{Error, Result, shortened, suggestion};
use crate::robot::Robot;

/// Source of a built-in robot.
enum Source {
    /// A Denavit-Hartenberg table.
    Table(&'static Arm),
    /// Constructor, for robots that a table cannot describe.
    Made(fn() -> Result<Robot>),
}

use Source::{Made, Table};

const ROBOTS: &[(&str, Source)] = &[
    ("fr3", Table(&franka::FR3)),
    ("gen3", Table(&kinova::GEN3)),
    ("hydraulic3", Made(hydraulic::hydraulic3)),
    ("iiwa14", Table(&kuka::IIWA14)),
    ("iiwa7", Table(&kuka::IIWA7)),
    ("kr210", Table(&kuka::KR210)),
    ("kr210_yuan2016", Table(&kuka::KR210_YUAN2016)),
    ("panda", Table(&franka::PANDA)),
    ("planar5", Made(planar5)),
    ("ur10", Table(&universal_robots::UR10)),
    ("ur10e", Table(&universal_robots::UR10E)),
    ("ur3e", Table(&universal_robots::UR3E)),
    ("ur5", Table(&universal_robots::UR5)),
    ("ur5e", Table(&universal_robots::UR5E)),
];

impl Robot {
    /// Returns the names of the built-in robots, in alphabetical order.
    pub fn names() -> impl ExactSizeIterator<Item = &'static str> {
        ROBOTS.iter().map(|(name, _)| *name)
    }

    /// Returns a built-in robot.
    ///
    /// # Errors
    /// [`Error::UnknownRobot`], which lists the names.
    pub fn named(name: &str) -> Result<Self> {
        match ROBOTS.iter().find(|(known, _)| *known == name) {
            Some((_, Table(arm))) => arm.build(name),
            Some((_, Made(make))) => make(),
            None => Err(Error::UnknownRobot {
                name: shortened(name),
                suggestion: suggestion(name, Self::names()),
                known: Self::names().collect::<Vec<_>>().join(", "),
            }),
        }
    }
}

/// Planar arm with five links of 1 m: the arm of this library's experiments after Cheng et al., IEEE Access 2020, which does
/// not print its link lengths and limits.
fn planar5() -> Result<Robot> {
    Robot::planar(&[1.0; 5])
}
