//! Planning: point-to-point motions, motions along paths, and time-optimal timing.

mod along_path;
mod batch_plan;
mod endpoints;
mod move_report;
mod moves;
mod path_break;
mod plan;
mod plan_arguments;
mod plan_moves;
mod point_to_point;
mod straight_line;
mod time_optimal;
mod tpbso;
mod violation;

use pyo3::prelude::*;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<straight_line::PyStraightLine>()?;
    module.add_class::<tpbso::PyTpbso>()?;
    module.add_class::<violation::PyViolation>()?;
    module.add_class::<plan::PyPlan>()?;
    moves::register(module)?;
    module.add_class::<move_report::PyMoveReport>()?;
    module.add_class::<move_report::PySpeedBound>()?;
    module.add_class::<path_break::PyBreak>()?;
    module.add_function(wrap_pyfunction!(plan_moves::plan_moves, module)?)?;
    module.add_function(wrap_pyfunction!(point_to_point::plan_point_to_point, module)?)?;
    module.add_class::<batch_plan::PyBatchPlan>()?;
    module.add_function(wrap_pyfunction!(batch_plan::plan_batch, module)?)?;
    module.add_function(wrap_pyfunction!(along_path::plan_along_path, module)?)?;
    module.add_function(wrap_pyfunction!(time_optimal::time_optimal, module)?)
}
