//! The getters that all results share.

/// Defines the getters `success`, `status`, `message`, `evaluations` and `elapsed` of a result's class. Success is the status
/// SOLVED. Its meaning differs between classes, so that three getters take their docstrings as arguments.
macro_rules! outcome {
    (
        $class:ident = |$result:ident|
        $(#[$success_note:meta])* success,
        $(#[$status_note:meta])* status: $status:expr,
        message: $message:expr,
        $(#[$evaluations_note:meta])* evaluations: $evaluations:expr,
        elapsed: $elapsed:expr $(,)?
    ) => {
        #[pymethods]
        impl $class {
            $(#[$success_note])*
            #[getter]
            fn success(&self) -> bool {
                let $result = self;
                $status == ikcore::solver::Status::Solved
            }

            $(#[$status_note])*
            #[getter]
            fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                let $result = self;
                $crate::solver::status(py, $status)
            }

            /// A sentence that says what happened and what to try.
            #[getter]
            fn message(&self) -> String {
                let $result = self;
                $crate::wording::said(&$message)
            }

            $(#[$evaluations_note])*
            #[getter]
            fn evaluations(&self) -> usize {
                let $result = self;
                $evaluations
            }

            fn _repr_html_<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
                $crate::python_calls::html(slf.into_any(), "result")
            }

            /// Time taken (s).
            #[getter]
            fn elapsed(&self) -> f64 {
                let $result = self;
                $elapsed.as_secs_f64()
            }
        }
    };
}

pub(crate) use outcome;
