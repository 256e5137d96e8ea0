//! Gates: wrappers of all functions, which word argument errors in the terms of this library.
//!
//! PyO3 reads arguments before any function of this library runs. Its errors ("'bool' object is not an instance of
//! 'str'") name neither the argument nor the value, and it offers no hook to replace them. So each function, method and
//! constructor of the module is wrapped in a gate, which calls it and, if the arguments did not fit, lets
//! `beetle_ik.calls.wording` word the error, or calls it again with keywords that `beetle_ik.calls.renamed` has renamed. The
//! usual path costs a few nanoseconds.

#![allow(unsafe_code, reason = "C functions of Python")]

use std::collections::HashMap;
use std::ffi::CString;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use pyo3::exceptions::{PyOverflowError, PyRuntimeError, PyTypeError};
use pyo3::ffi::{
    self, METH_FASTCALL, METH_KEYWORDS, METH_STATIC, METH_VARARGS, PyCFunctionFastWithKeywords, PyMethodDef, PyObject,
};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyCFunction, PyDict, PyString, PyTuple, PyType};

use crate::{python_calls, units};

/// Calling convention of PyO3 functions, except functions without arguments or with arbitrary keywords.
const FAST: i32 = METH_FASTCALL | METH_KEYWORDS;

/// A function or method as made by PyO3.
struct Member {
    object: Py<PyAny>,
    /// C function of the member; for a method, known once it is bound to an instance.
    call: OnceLock<PyCFunctionFastWithKeywords>,
}

/// Members behind the [`GATES`], by index.
static MEMBERS: [OnceLock<Member>; GATES.len()] = [const { OnceLock::new() }; GATES.len()];

/// Constructors made by PyO3, by the address of their class.
static CONSTRUCTORS: OnceLock<HashMap<usize, ffi::newfunc>> = OnceLock::new();

/// One C function for each member, since a C function receives neither its name nor its object.
const GATES: [PyCFunctionFastWithKeywords; 128] = gates();

macro_rules! sixteen {
    ($gates:ident, $first:literal: $($i:literal)*) => { $( $gates[$first + $i] = gate::<{ $first + $i }>; )* };
    ($gates:ident, $($first:literal)*) => {
        $( sixteen!($gates, $first: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15); )*
    };
}

const fn gates() -> [PyCFunctionFastWithKeywords; 128] {
    let mut gates: [PyCFunctionFastWithKeywords; 128] = [gate::<0>; 128];
    sixteen!(gates, 0 16 32 48 64 80 96 112);
    gates
}

unsafe extern "C" fn gate<const I: usize>(
    this: *mut PyObject,
    arguments: *const *mut PyObject,
    count: ffi::Py_ssize_t,
    names: *mut PyObject,
) -> *mut PyObject {
    if !numpy_is_imported() {
        return std::ptr::null_mut();
    }
    let Some(member) = MEMBERS[I].get() else { return std::ptr::null_mut() };
    let Some(call) = member.call.get().or_else(|| member.resolved(this)) else { return std::ptr::null_mut() };
    units::begin_call();
    // SAFETY: these are the arguments of a call by Python, passed on as they are.
    let mut made = unsafe { call(this, arguments, count, names) };
    if made.is_null() {
        made = Python::attach(|py| {
            let member = member.object.bind(py);
            // SAFETY: as above: `count` positional arguments, then one for each entry of the tuple `names`.
            let given = || unsafe { vector_arguments(py, arguments, count, names) };
            // A method needs its instance too; none of them has a deprecated keyword.
            recall(py, member, given, |arguments, keywords| member.call(arguments, Some(keywords)).map(Bound::into_ptr))
        });
    }
    with_doubts(made)
}

/// Ends a call with this result, null after an error. A warning that is made an error takes the place of the result.
fn with_doubts(made: *mut PyObject) -> *mut PyObject {
    if made.is_null() {
        units::end_call_with_error();
        return made;
    }
    let Err(error) = units::end_call() else { return made };
    Python::attach(|py| {
        // SAFETY: a result of this call, to which nothing else refers.
        drop(unsafe { Bound::from_owned_ptr_or_opt(py, made) });
        error.restore(py);
    });
    std::ptr::null_mut()
}

/// Imports numpy at the first call; sets an exception where that fails. The crate numpy panics if its own first import is interrupted by
/// Ctrl-C, and a panic cannot leave a C function.
fn numpy_is_imported() -> bool {
    static IMPORTED: AtomicBool = AtomicBool::new(false);
    if IMPORTED.load(Ordering::Relaxed) {
        return true;
    }
    Python::attach(|py| match py.import(intern!(py, "numpy")) {
        Ok(_) => IMPORTED.store(true, Ordering::Relaxed),
        Err(error) => error.restore(py),
    });
    IMPORTED.load(Ordering::Relaxed)
}

impl Member {
    /// Finds the C function of a method by an instance; sets an exception for another calling convention.
    fn resolved(&self, this: *mut PyObject) -> Option<&PyCFunctionFastWithKeywords> {
        Python::attach(|py| {
            let object = self.object.bind(py);
            // SAFETY: Python calls methods with an instance.
            let this = unsafe { Bound::from_borrowed_ptr_or_opt(py, this) };
            let found = object.call_method1(intern!(py, "__get__"), (this,)).and_then(|bound| fast_call(&bound));
            match found {
                Ok(Some(call)) => Some(self.call.get_or_init(|| call)),
                Ok(None) => {
                    PyRuntimeError::new_err(format!("{object} is called in a way that has no gate")).restore(py);
                    None
                }
                Err(error) => {
                    error.restore(py);
                    None
                }
            }
        })
    }
}

/// Returns the C function of a function or bound method; None if it has another calling convention.
fn fast_call(function: &Bound<'_, PyAny>) -> PyResult<Option<PyCFunctionFastWithKeywords>> {
    let function = function.cast::<PyCFunction>()?.as_ptr();
    // SAFETY: it is a function of C, and the flags say which signature it has.
    unsafe {
        if ffi::PyCFunction_GetFlags(function) & !METH_STATIC != FAST {
            return Ok(None);
        }
        let call = ffi::PyCFunction_GetFunction(function);
        Ok(call.map(|call| std::mem::transmute::<ffi::PyCFunction, PyCFunctionFastWithKeywords>(call)))
    }
}

/// Positional arguments and keywords of a call.
type Given<'py> = (Bound<'py, PyTuple>, Bound<'py, PyDict>);

/// Collects the arguments of a call, without `self`.
///
/// # Safety
/// `arguments` has `count` entries, and one more for each entry of the tuple `names`, which may be null.
unsafe fn vector_arguments<'py>(
    py: Python<'py>,
    arguments: *const *mut PyObject,
    count: ffi::Py_ssize_t,
    names: *mut PyObject,
) -> PyResult<Given<'py>> {
    // SAFETY: upheld by the caller.
    let entry = |i: usize| unsafe { Bound::from_borrowed_ptr(py, *arguments.add(i)) };
    // SAFETY: the same.
    let names = unsafe { Bound::from_borrowed_ptr_or_opt(py, names) };
    let count = usize::try_from(count)?;
    let keywords = PyDict::new(py);
    for (i, name) in names.iter().flat_map(|names| names.try_iter()).flatten().enumerate() {
        keywords.set_item(name?, entry(count + i))?;
    }
    Ok((PyTuple::new(py, (0..count).map(entry))?, keywords))
}

/// Treats a pending error of a call: if deprecated keywords are its reason, returns the result of `again` with their new names;
/// else null, with argument errors of PyO3 replaced by errors in the terms of this library.
fn recall<'py>(
    py: Python<'py>,
    member: &Bound<'py, PyAny>,
    given: impl FnOnce() -> PyResult<Given<'py>>,
    again: impl FnOnce(&Bound<'py, PyTuple>, &Bound<'py, PyDict>) -> PyResult<*mut PyObject>,
) -> *mut PyObject {
    let made = match PyErr::take(py) {
        Some(error) if is_of_arguments(py, &error) => given().and_then(|(arguments, keywords)| {
            let (error, keywords) = match python_calls::renamed(member, &keywords)? {
                None => (error, keywords),
                Some(renamed) => match again(&arguments, &renamed) {
                    Err(error) if is_of_arguments(py, &error) => (error, renamed),
                    result => return result,
                },
            };
            Err(python_calls::worded(py, &error, member, &arguments, &keywords).unwrap_or(error))
        }),
        Some(error) => Err(error),
        None => return std::ptr::null_mut(),
    };
    made.unwrap_or_else(|error| {
        error.restore(py);
        std::ptr::null_mut()
    })
}

/// Whether PyO3 could not read the arguments. Errors raised by Python code, for example by a callback, have a traceback.
fn is_of_arguments(py: Python<'_>, error: &PyErr) -> bool {
    let kind = error.is_instance_of::<PyTypeError>(py) || error.is_instance_of::<PyOverflowError>(py);
    kind && error.traceback(py).is_none()
}

/// Wraps the functions, methods and constructors of the module in gates.
pub fn install(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let mut free = 0..GATES.len();
    let mut constructors = HashMap::new();
    let staticmethod = py.import("builtins")?.getattr("staticmethod")?;
    let method = py.import("types")?.getattr("MethodDescriptorType")?;
    for (name, value) in module.dict() {
        if value.is_instance_of::<PyCFunction>() {
            if let Some(gated) = gated_function(&value, module, Some(&module.name()?), &mut free)? {
                module.setattr(name.cast()?, gated)?;
            }
            continue;
        }
        let Ok(class) = value.cast::<PyType>() else { continue };
        for entry in class.getattr("__dict__")?.call_method0("items")?.try_iter()?.collect::<PyResult<Vec<_>>>()? {
            let (key, value): (String, Bound<'_, PyAny>) = entry.extract()?;
            let gated = if key == "__new__" {
                gated_constructor(class, &mut constructors)?
            } else if value.is_exact_instance(&staticmethod) {
                let gated = gated_function(&value.getattr("__func__")?, class, None, &mut free)?;
                gated.map(|gated| staticmethod.call1((gated,))).transpose()?
            } else if value.is_exact_instance(&method) {
                gated_method(class, &value, &mut free)?
            } else {
                None
            };
            if let Some(gated) = gated {
                class.setattr(key.as_str(), gated)?;
            }
        }
    }
    let _ = CONSTRUCTORS.set(constructors);
    Ok(())
}

/// Returns a gated function: of `module`, or a static method of a class if `module` is None.
fn gated_function<'py>(
    function: &Bound<'py, PyAny>,
    owner: &Bound<'py, PyAny>,
    module: Option<&Bound<'py, PyString>>,
    free: &mut impl Iterator<Item = usize>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Some(call) = fast_call(function)? else { return Ok(None) };
    let kind = if module.is_some() { 0 } else { METH_STATIC };
    let definition = behind_gate(function, Some(call), kind, free)?;
    let name = module.map_or(std::ptr::null_mut(), |name| name.as_ptr());
    // SAFETY: the definition is never freed; Python counts its own references to `owner` and `name`.
    let made = unsafe { ffi::PyCFunction_NewEx(definition, owner.as_ptr(), name) };
    // SAFETY: a new reference, or null with an exception.
    unsafe { Bound::from_owned_ptr_or_err(function.py(), made) }.map(Some)
}

fn gated_method<'py>(
    class: &Bound<'py, PyType>,
    method: &Bound<'py, PyAny>,
    free: &mut impl Iterator<Item = usize>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let signature: Option<String> = method.getattr("__text_signature__")?.extract()?;
    if signature.is_none_or(|signature| signature == "($self)") {
        return Ok(None);
    }
    let definition = behind_gate(method, None, 0, free)?;
    // SAFETY: the definition is never freed, and `class` is a type object.
    let made = unsafe { ffi::PyDescr_NewMethod(class.as_type_ptr(), definition) };
    // SAFETY: a new reference, or null with an exception.
    unsafe { Bound::from_owned_ptr_or_err(class.py(), made) }.map(Some)
}

/// Defines a function with the name and the docstring of a member, which calls the next free gate.
fn behind_gate(
    member: &Bound<'_, PyAny>,
    call: Option<PyCFunctionFastWithKeywords>,
    kind: i32,
    free: &mut impl Iterator<Item = usize>,
) -> PyResult<*mut PyMethodDef> {
    let text = |attribute: &str| member.getattr(attribute)?.extract::<Option<String>>();
    let name = text("__name__")?.unwrap_or_default();
    let doc = format!(
        "{name}{}\n--\n\n{}",
        text("__text_signature__")?.unwrap_or_default(),
        text("__doc__")?.unwrap_or_default()
    );
    let too_many = || PyRuntimeError::new_err("more functions than gates");
    let i = free.next().ok_or_else(too_many)?;
    let known = call.map_or_else(OnceLock::new, OnceLock::from);
    let _ = MEMBERS[i].set(Member { object: member.clone().unbind(), call: known });
    Ok(Box::into_raw(Box::new(PyMethodDef {
        ml_name: CString::new(name)?.into_raw(),
        ml_meth: ffi::PyMethodDefPointer { PyCFunctionFastWithKeywords: GATES[i] },
        ml_flags: FAST | kind,
        ml_doc: CString::new(doc)?.into_raw(),
    })))
}

/// Returns `__new__` behind a gate; None for a class without a constructor in Python.
fn gated_constructor<'py>(
    class: &Bound<'py, PyType>,
    constructors: &mut HashMap<usize, ffi::newfunc>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    if class.getattr("__text_signature__")?.is_none() {
        return Ok(None);
    }
    // SAFETY: `class` is a type object, and its slot holds the constructor made by PyO3.
    let slot = unsafe { ffi::PyType_GetSlot(class.as_type_ptr(), ffi::Py_tp_new) };
    if slot.is_null() {
        return Ok(None);
    }
    // SAFETY: the slot has this type.
    let make = unsafe { std::mem::transmute::<*mut std::ffi::c_void, ffi::newfunc>(slot) };
    constructors.insert(class.as_ptr() as usize, make);
    let definition = Box::into_raw(Box::new(PyMethodDef {
        ml_name: c"__new__".as_ptr(),
        ml_meth: ffi::PyMethodDefPointer { PyCFunctionWithKeywords: construct },
        ml_flags: METH_VARARGS | METH_KEYWORDS,
        ml_doc: std::ptr::null(),
    }));
    // SAFETY: the definition is never freed.
    let made = unsafe { ffi::PyCFunction_NewEx(definition, class.as_ptr(), std::ptr::null_mut()) };
    // SAFETY: a new reference, or null with an exception.
    unsafe { Bound::from_owned_ptr_or_err(class.py(), made) }.map(Some)
}

/// Makes an instance. The first argument is the class or a subclass of it.
unsafe extern "C" fn construct(class: *mut PyObject, given: *mut PyObject, keywords: *mut PyObject) -> *mut PyObject {
    if !numpy_is_imported() {
        return std::ptr::null_mut();
    }
    Python::attach(|py| {
        // SAFETY: Python calls with the class that the function belongs to, a tuple, and a dict or null.
        let [class, given] = unsafe { [class, given].map(|object| Bound::from_borrowed_ptr(py, object)) };
        match derived(&class, &given) {
            Ok((make, made, arguments)) => {
                units::begin_call();
                // SAFETY: `made` derives from the class of the constructor.
                let instance = |keywords| unsafe { make(made.as_type_ptr(), arguments.as_ptr(), keywords) };
                let mut first = instance(keywords);
                if first.is_null() {
                    // SAFETY: as above.
                    let named = unsafe { Bound::from_borrowed_ptr_or_opt(py, keywords) };
                    let named = named.and_then(|named| named.cast_into().ok()).unwrap_or_else(|| PyDict::new(py));
                    let again = |_: &Bound<'_, PyTuple>, renamed: &Bound<'_, PyDict>| {
                        let second = instance(renamed.as_ptr());
                        if second.is_null() { Err(PyErr::fetch(py)) } else { Ok(second) }
                    };
                    first = recall(py, made.as_any(), || Ok((arguments.clone(), named)), again);
                }
                with_doubts(first)
            }
            Err(error) => {
                error.restore(py);
                std::ptr::null_mut()
            }
        }
    })
}

/// Returns the constructor of a class, the class to instantiate, and the remaining arguments.
fn derived<'py>(
    class: &Bound<'py, PyAny>,
    given: &Bound<'py, PyAny>,
) -> PyResult<(ffi::newfunc, Bound<'py, PyType>, Bound<'py, PyTuple>)> {
    let given = given.cast::<PyTuple>()?;
    let made = given.get_item(0).ok().and_then(|made| made.cast_into::<PyType>().ok());
    let make = CONSTRUCTORS.get().and_then(|all| all.get(&(class.as_ptr() as usize)));
    match (make, made) {
        (Some(make), Some(made)) if made.is_subclass(class)? => Ok((*make, made, given.get_slice(1, given.len()))),
        _ => Err(PyTypeError::new_err(format!("__new__() needs {class} first, or a class derived from it"))),
    }
}
