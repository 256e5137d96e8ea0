//! The native module `beetle_ik._core`: registration of classes and functions. Each file wraps one module of the core.

mod batch;
mod calibration;
mod convert;
mod error;
mod gate;
mod goal;
mod hash;
mod ik;
mod indexing;
mod joint_entries;
mod joint_order;
mod keep;
mod limits;
mod minimize;
mod monitor;
mod motion;
mod obstacle;
mod options;
mod outcome;
mod path;
mod pickling;
mod planning;
mod pose;
mod posture;
mod python_calls;
mod reach;
mod robot;
mod self_motion;
mod signals;
mod solve_all;
mod solve_arguments;
mod solver;
mod start_gate;
mod task;
mod tip_keys;
mod tips;
mod tracking;
mod trajectory;
mod traversal;
mod units;
mod wording;

use pyo3::prelude::*;

// Requires the interpreter's lock: free-threaded Python enables it and warns. Running without it is untested.
#[pymodule(gil_used = true)]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("_instructions", ikcore::math::instructions())?;
    error::register(module)?;
    solver::register(module)?;
    module.add_class::<robot::PyRobot>()?;
    module.add_class::<robot::PyBody>()?;
    module.add_class::<robot::PyInertia>()?;
    module.add_class::<robot::PyVelocityEllipsoid>()?;
    module.add_function(wrap_pyfunction!(pose::pose, module)?)?;
    module.add_class::<limits::PySinusoid>()?;
    module.add_class::<limits::PyLimits>()?;
    module.add_class::<ik::PySolution>()?;
    module.add_function(wrap_pyfunction!(ik::solve, module)?)?;
    module.add_class::<solve_all::PySolutionSet>()?;
    module.add_function(wrap_pyfunction!(solve_all::solve_all, module)?)?;
    module.add_class::<self_motion::PySelfMotion>()?;
    module.add_function(wrap_pyfunction!(self_motion::self_motion, module)?)?;
    task::register(module)?;
    goal::register(module)?;
    module.add_class::<keep::PyKeep>()?;
    module.add_function(wrap_pyfunction!(keep::upright, module)?)?;
    module.add_class::<batch::PyBatchSolution>()?;
    module.add_function(wrap_pyfunction!(batch::solve_batch, module)?)?;
    module.add_function(wrap_pyfunction!(batch::batch_message, module)?)?;
    module.add_class::<reach::PyMapGrid>()?;
    module.add_function(wrap_pyfunction!(reach::map_chunks, module)?)?;
    module.add_class::<posture::PyCircleSwarm>()?;
    module.add_class::<posture::PyPlanarPosture>()?;
    module.add_function(wrap_pyfunction!(posture::planar_posture, module)?)?;
    module.add_class::<minimize::PyMinimum>()?;
    module.add_function(wrap_pyfunction!(minimize::minimize_function, module)?)?;
    calibration::register(module)?;
    path::register(module)?;
    obstacle::register(module)?;
    module.add_function(wrap_pyfunction!(motion::state_to_state, module)?)?;
    planning::register(module)?;
    tracking::register(module)?;
    module.add_class::<trajectory::PyTrajectory>()?;
    gate::install(module)?;
    // Only the package itself calls it: without gates.
    module.add_class::<joint_entries::PyJointEntries>()?;
    // Removes `__all__`: the package lists the public names, and a second list would become outdated.
    module.dict().del_item("__all__")
}
