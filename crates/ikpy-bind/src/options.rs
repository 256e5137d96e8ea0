//! Options that are fields of a core value: conversion from and to Python, and `repr`.

use ikcore::solver::BasVariant;
use ikcore::solver::BeetleDirection;
use ikcore::solver::TrialUpdate;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::convert::{count, optional_count};
use crate::error::raise;

/// An option stored in the core.
pub trait Shown {
    /// The type of the option in Python.
    type Value;
    fn value(&self) -> Self::Value;
    /// Formats the option in Python syntax.
    fn text(&self) -> String;
}

/// An option whose argument and attribute have the same type in Python.
pub trait Taken: Shown + Sized {
    fn take(name: &str, given: Self::Value) -> PyResult<Self>;
}

impl Shown for f64 {
    type Value = f64;
    fn value(&self) -> f64 {
        *self
    }
    fn text(&self) -> String {
        if self.is_finite() { format!("{self:?}") } else { format!("float('{self}')") }
    }
}

impl Taken for f64 {
    fn take(_: &str, given: f64) -> PyResult<Self> {
        Ok(given)
    }
}

impl Shown for bool {
    type Value = bool;
    fn value(&self) -> bool {
        *self
    }
    fn text(&self) -> String {
        if *self { "True" } else { "False" }.into()
    }
}

impl Shown for usize {
    type Value = i128;
    fn value(&self) -> i128 {
        *self as i128
    }
    fn text(&self) -> String {
        self.to_string()
    }
}

impl Taken for usize {
    fn take(name: &str, given: i128) -> PyResult<Self> {
        count(name, given)
    }
}

impl<T: Shown> Shown for Option<T> {
    type Value = Option<T::Value>;
    fn value(&self) -> Self::Value {
        self.as_ref().map(T::value)
    }
    fn text(&self) -> String {
        self.as_ref().map_or_else(|| "None".into(), T::text)
    }
}

impl Taken for Option<usize> {
    fn take(name: &str, given: Option<i128>) -> PyResult<Self> {
        optional_count(name, given)
    }
}

/// Formats a list of numbers in Python syntax.
pub fn list_text(values: &[f64]) -> String {
    format!("[{}]", values.iter().map(f64::text).collect::<Vec<_>>().join(", "))
}

/// Implements both traits for options that are one of a few names.
macro_rules! named {
    ($($option:ty),*) => {$(
        impl Shown for $option {
            type Value = String;
            fn value(&self) -> String {
                self.to_string()
            }
            fn text(&self) -> String {
                format!("'{self}'")
            }
        }

        impl Taken for $option {
            fn take(_: &str, given: String) -> PyResult<Self> {
                given.parse().map_err(raise)
            }
        }
    )*};
}

named!(BeetleDirection, TrialUpdate, BasVariant);

/// Defines getters, `repr`, hash and pickling of a class whose options are the fields of its core value.
macro_rules! options {
    ($class:ident, $name:literal { $($(#[$note:meta])* $option:ident: $kind:ty,)* }) => {
        #[pymethods]
        impl $class {
            $($(#[$note])*
            #[getter]
            fn $option(&self) -> <$kind as $crate::options::Shown>::Value {
                $crate::options::Shown::value(&self.0.$option)
            })*

            fn __repr__(&self) -> String {
                let options = [$(format!("{}={}", stringify!($option), $crate::options::Shown::text(&self.0.$option))),*];
                format!("{}({})", $name, options.join(", "))
            }

            fn __hash__(&self) -> u64 {
                $crate::hash::content_hash(self)
            }

            fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<$crate::options::NewArguments<'py>> {
                $crate::options::keywords(slf, &[$(stringify!($option)),*])
            }
        }
    };
}

pub(crate) use options;

/// The result of `__getnewargs_ex__`: positional arguments, then keyword arguments.
pub type NewArguments<'py> = (Bound<'py, PyTuple>, Bound<'py, PyDict>);

/// Returns the constructor arguments of a value that takes keywords only and has a getter for each.
pub fn keywords<'py, T>(value: &Bound<'py, T>, names: &[&str]) -> PyResult<NewArguments<'py>> {
    let options = PyDict::new(value.py());
    for name in names {
        options.set_item(name, value.as_any().getattr(*name)?)?;
    }
    Ok((PyTuple::empty(value.py()), options))
}
