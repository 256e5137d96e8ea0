//! Tracking of a path, with a model of the robot and without.

mod arguments;
mod control;
mod filters;
mod model_free;
mod plant;
mod record;
mod session;
mod step;
mod track;
mod tracker;
mod weighted_pseudo_inverse;
mod znnbas;

use pyo3::prelude::*;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<weighted_pseudo_inverse::PyWeightedPseudoInverse>()?;
    module.add_class::<track::PyTrackResult>()?;
    module.add_function(wrap_pyfunction!(track::track, module)?)?;
    module.add_class::<filters::PyLowPass>()?;
    module.add_class::<filters::PyOneEuro>()?;
    module.add_class::<step::PyStep>()?;
    module.add_class::<tracker::PyTracker>()?;
    module.add_class::<znnbas::PyZnnbas>()?;
    module.add_class::<control::PyControlSession>()?;
    module.add_class::<plant::PyKinematicPlant>()?;
    module.add_class::<model_free::PyModelFreeResult>()?;
    module.add_function(wrap_pyfunction!(model_free::track_model_free, module)?)
}
