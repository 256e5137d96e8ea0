//! `Path` and the functions of `bik.paths`.

mod curves;
mod reference;
mod sampled;

use pyo3::prelude::*;

pub use reference::{PyPath, path_argument};

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyPath>()?;
    module.add_function(wrap_pyfunction!(curves::circle, module)?)?;
    module.add_function(wrap_pyfunction!(curves::letter_m, module)?)?;
    module.add_function(wrap_pyfunction!(curves::hypotrochoid, module)?)?;
    module.add_function(wrap_pyfunction!(curves::pentagram, module)?)?;
    module.add_function(wrap_pyfunction!(curves::rose, module)?)?;
    module.add_function(wrap_pyfunction!(curves::polyline, module)?)?;
    module.add_function(wrap_pyfunction!(curves::from_samples, module)?)?;
    module.add_function(wrap_pyfunction!(curves::from_function, module)?)
}
