//! Python's garbage collector: which objects a class holds.

use pyo3::{Py, PyTraverseError, PyVisit};

/// A field through which the garbage collector can reach Python objects.
pub trait Traversed {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError>;
}

impl<T> Traversed for Py<T> {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(self)
    }
}

impl<T: Traversed> Traversed for Option<T> {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.as_ref().map_or(Ok(()), |field| field.traverse(visit))
    }
}

/// A value that another thread holds at the moment is alive in any case.
impl<T: Traversed> Traversed for std::sync::Mutex<T> {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.try_lock().map_or(Ok(()), |held| held.traverse(visit))
    }
}

impl<T: Traversed> Traversed for Box<T> {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        (**self).traverse(visit)
    }
}

impl<T: Traversed, const N: usize> Traversed for [T; N] {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.iter().try_for_each(|field| field.traverse(visit))
    }
}

/// Shows the garbage collector the fields of a class that can lead to objects of the user, for example callables. Arrays of
/// numbers lead nowhere and are left out.
///
/// No class needs `__clear__`: all are frozen, so every cycle passes through a mutable object (a dict, a closure, an
/// instance), and Python breaks it there, as it does for cycles through tuples.
macro_rules! traversed {
    ($class:ident: $($field:ident),+) => {
        #[pymethods]
        impl $class {
            fn __traverse__(&self, visit: pyo3::PyVisit<'_>) -> Result<(), pyo3::PyTraverseError> {
                $($crate::traversal::Traversed::traverse(&self.$field, &visit)?;)+
                Ok(())
            }
        }
    };
}

pub(crate) use traversed;
