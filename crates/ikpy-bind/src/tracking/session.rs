//! The common part of `Tracker` and `ControlSession`.

/// Defines access to the session of a class, and the getters `q`, `time` and `dt`.
macro_rules! in_progress {
    ($class:ident, $session:ty) => {
        impl $class {
            /// Locks the session. A panic elsewhere cannot have left it half-changed: it is only written at the end of a call.
            fn session(&self) -> std::sync::MutexGuard<'_, $session> {
                self.session.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
            }
        }

        #[pymethods]
        impl $class {
            /// The last accepted configuration (n,) (rad, m).
            #[getter]
            fn q<'py>(&self, py: Python<'py>) -> Bound<'py, numpy::PyArray1<f64>> {
                $crate::convert::copied(py, self.session().q())
            }

            /// Time of the last accepted configuration (s).
            #[getter]
            fn time(&self) -> f64 {
                self.session().time()
            }

            /// Time step (s).
            #[getter]
            fn dt(&self) -> f64 {
                self.session().dt()
            }
        }
    };
}

pub(super) use in_progress;
