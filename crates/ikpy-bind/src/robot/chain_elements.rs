//! The elements of a robot's chain, which `beetle_ik.interop` reads and writes to convert models of other libraries.

use ikcore::nalgebra::Vector3;
use ikcore::robot::{ChainBuilder, Drive, Element, Joint, JointKind, Robot};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::PyRobot;
use crate::convert::{copied, point, pose_array, rigid};
use crate::error::{invalid, raise};

/// Returns the elements between base and tip, each ("fixed", pose (4, 4)), ("moving", joint, turns, axis (3,), scale,
/// offset) or ("link", name).
fn elements<'py>(py: Python<'py>, robot: &Robot) -> PyResult<Vec<Bound<'py, PyTuple>>> {
    robot.elements().iter().map(|element| shown(py, element)).collect()
}

fn shown<'py>(py: Python<'py>, element: &Element) -> PyResult<Bound<'py, PyTuple>> {
    match element {
        Element::Fixed(pose) => ("fixed", pose_array(py, pose)).into_pyobject(py),
        Element::Link(name) => ("link", name).into_pyobject(py),
        Element::Moving { axis, turns, joint, scale, offset } => {
            let axis: Bound<'py, PyArray1<f64>> = copied(py, axis.as_slice());
            ("moving", *joint, *turns, axis, *scale, *offset).into_pyobject(py)
        }
        Element::Curved { .. } => Err(invalid(
            "interop: a robot with a joint that follows another one by a polynomial cannot be converted".into(),
        )),
        Element::RotationVector { .. } => {
            Err(invalid("interop: a robot on a floating base cannot be converted; convert the arm alone".into()))
        }
    }
}

/// Returns the poses of the first link, and of the tip in the frame of the last link.
fn ends<'py>(py: Python<'py>, robot: &Robot) -> [Bound<'py, PyArray2<f64>>; 2] {
    [pose_array(py, robot.base()), pose_array(py, robot.tool())]
}

/// Joint: (name, kind, lower, upper, velocity).
type JointParts = (String, String, f64, f64, f64);
/// Moving element: (joint, turns, axis, scale, offset).
type MovingParts<'py> = (usize, bool, Bound<'py, PyAny>, f64, f64);

/// Makes a robot from joints and from the elements that follow link `base`.
fn built(name: &str, base: &str, joints: Vec<JointParts>, elements: &[Bound<'_, PyTuple>]) -> PyResult<Robot> {
    let mut chain = ChainBuilder::new(name, base);
    for (name, kind, lower, upper, velocity) in joints {
        let kind: JointKind = kind.parse().map_err(raise)?;
        chain.add_joint(Joint::new(name, kind).with_range(lower, upper).with_velocity(velocity));
    }
    for element in elements {
        append(&mut chain, element)?;
    }
    chain.build().map_err(raise)
}

fn append(chain: &mut ChainBuilder, element: &Bound<'_, PyTuple>) -> PyResult<()> {
    let kind: String = element.get_item(0)?.extract()?;
    match kind.as_str() {
        "fixed" => chain.fixed(rigid("fixed transform", &element.get_item(1)?)?),
        "link" => chain.link(element.get_item(1)?.extract::<String>()?),
        _ => {
            let (joint, turns, axis, scale, offset): MovingParts<'_> = element.get_slice(1, element.len()).extract()?;
            let kind = if turns { JointKind::Revolute } else { JointKind::Prismatic };
            chain.moving(joint, kind, Vector3::from(point("axis of a joint", &axis)?), Drive { scale, offset });
        }
    }
    Ok(())
}

#[pymethods]
impl PyRobot {
    /// Returns (base (4, 4), elements, tool (4, 4)) for `beetle_ik.interop`, with elements as in `_from_chain`.
    fn _chain<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.core.require_one_tip("interop").map_err(raise)?;
        let [base, tool] = ends(py, &self.core);
        (base, elements(py, &self.core)?, tool).into_pyobject(py)
    }

    /// Makes a robot for `beetle_ik.interop`. Joints are (name, kind, lower, upper, velocity); elements are ("fixed",
    /// pose (4, 4)), ("moving", joint, turns, axis (3,), scale, offset) or ("link", name).
    #[staticmethod]
    fn _from_chain(
        name: &str,
        base: &str,
        joints: Vec<JointParts>,
        elements: Vec<Bound<'_, PyTuple>>,
    ) -> PyResult<Self> {
        built(name, base, joints, &elements).map(Self::from)
    }
}
