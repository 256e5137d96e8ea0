"""Messages for calls whose arguments do not fit: the argument, its value, and what is expected.

The native module calls `worded` when PyO3 cannot read arguments (`crates/ikpy-bind/src/gate.rs`). Functions in Python
use the decorator `worded_call`.
"""

import inspect
import os
import re
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from .._core import CallError
from .names import meant

_Arguments = ParamSpec("_Arguments")
_Made = TypeVar("_Made")
_UNKNOWN = re.compile(r"\(\) got an unexpected keyword argument '([^']*)'")
_MISFIT = re.compile(r"^while processing '(\w+)'$")
_NO_INSTANCE = re.compile(r" object is not an instance of '(\w+)'$")
_NO_CONVERSION = re.compile(r"cannot be converted to '?(\w+)'?$|must be (real number), not")
_KINDS = {
    "bool": "True or False",
    "int": "a whole number",
    "float": "a number",
    "real number": "a number",
    "str": "text",
    "Sequence": "a list",
    "dict": "a dict",
}
_EXAMPLES = {
    "Limits": "Limits(velocity=1.5, acceleration=5.0)",
    "Path": "bik.paths.circle(...)",
    "Robot": "Robot.named('panda')",
    "Stop": "Stop(max_evaluations=1000)",
}
_SHOWN = 60  # characters of a value
_NAMELESS = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)


def worded(error: Exception, call: Any, arguments: tuple[Any, ...], keywords: Mapping[str, Any]) -> Exception:
    """Returns the error of a call in words of this library; an error that is not about its arguments unchanged."""
    text = str(error)
    signature = _signature(call)
    if signature is None:
        return error
    name = _name(call)
    for note in getattr(error, "__notes__", ()):
        if of_type := _MISFIT.search(note):
            return CallError(_misfit_of(call, signature, of_type[1], error, _given(signature, arguments, keywords)))
    if unknown := _UNKNOWN.search(text):
        return CallError(f"{name}{unknown[0]}{_instead(unknown[1], signature)}")
    if re.search(r"\(\) missing \d+ required ", text):
        return CallError(f"{name}(){text.partition('()')[2]}: call it as {name}{_shape(signature)}")
    if re.search(r"\(\) takes .* positional arguments? but ", text):
        return CallError(f"{name}(){text.partition('()')[2]}: {_by_keyword(name, signature)}")
    return error


def worded_call(function: Callable[_Arguments, _Made]) -> Callable[_Arguments, _Made]:
    """Decorates a Python function so that calls with wrong arguments get the messages of this library."""

    @wraps(function)
    def call(*arguments: _Arguments.args, **keywords: _Arguments.kwargs) -> _Made:
        try:
            return function(*arguments, **keywords)
        except TypeError as error:
            if error.__traceback__ is None or error.__traceback__.tb_next is not None:
                raise  # raised within the function
            raise worded(error, function, arguments, keywords) from None

    return call


def _name(call: Any) -> str:
    """Returns the name of a function, or of the class that a constructor makes."""
    return str(call.__name__ if call.__name__ != "__init__" else call.__qualname__.split(".")[-2])


def _signature(call: Any) -> inspect.Signature | None:
    """Returns the signature of a call without `self`."""
    try:
        signature = inspect.signature(call)
    except (TypeError, ValueError):
        return None
    parameters = [parameter for parameter in signature.parameters.values() if parameter.name != "self"]
    return signature.replace(parameters=parameters)


def _positional(signature: inspect.Signature) -> list[str]:
    return [parameter.name for parameter in signature.parameters.values() if parameter.kind in _NAMELESS]


def _given(signature: inspect.Signature, arguments: tuple[Any, ...], keywords: Mapping[str, Any]) -> dict[str, Any]:
    return dict(zip(_positional(signature), arguments, strict=False)) | dict(keywords)


def misfit(argument: str, value: object, error: Exception) -> str:
    """Returns the message for a value of the wrong kind, with a way to make a right one."""
    kind = _kind(str(error))
    if kind is None:
        return f"{argument}: {error}, got {shown(value)}"
    return f"{argument} must be {_in_words(kind)}{example(kind, value)}, got {shown(value)}"


def example(kind: str, value: object) -> str:
    """Returns an example of a value of this kind, as in ", such as Robot.named('panda')"; empty for most kinds."""
    if kind == "Robot" and isinstance(value, str | os.PathLike):
        return f", such as {_robot_from(os.fspath(value))}"
    return f", such as {_EXAMPLES[kind]}" if kind in _EXAMPLES else ""


def _misfit_of(
    call: Any, signature: inspect.Signature, argument: str, error: Exception, given: Mapping[str, Any]
) -> str:
    """Returns the message for an argument of the wrong kind; recognises two arguments in swapped order."""
    message, kind = misfit(argument, given.get(argument), error), _kind(str(error))
    swapped = any(type(value).__name__ == kind for name, value in given.items() if name != argument)
    if swapped and argument in _positional(signature):
        return f"{message}; the order is {_name(call)}{_shape(signature)}"
    default = signature.parameters[argument].default
    return f"{message} (default: {default!r})" if kind == "str" and isinstance(default, str) else message


def _kind(text: str) -> str | None:
    """Returns the kind that an error of PyO3 expects; None for other errors."""
    if "object cannot be interpreted as an integer" in text:
        return "int"
    found = _NO_INSTANCE.search(text) or _NO_CONVERSION.search(text)
    return next((group for group in found.groups() if group), None) if found else None


def _in_words(kind: str) -> str:
    return _KINDS.get(kind) or with_article(kind)


def with_article(name: str) -> str:
    """Returns the name of a class after "a" or "an"."""
    return f"{'an' if name[0] in 'AEIOaeio' else 'a'} {name}"


def _robot_from(text: str) -> str:
    return f"Robot.from_urdf({text!r:.60})" if "." in text or os.sep in text else f"Robot.named({text!r:.60})"


def shown(value: object) -> str:
    """Returns the repr of a value on one line, cut if it is long; the shape of an array."""
    shape = getattr(value, "shape", None)
    if isinstance(shape, tuple) and shape:
        return f"an array of shape {shape}"
    try:
        text = " ".join(repr(value).split())
    except Exception:  # a repr of the caller's class may raise anything
        return f"an object of class {type(value).__name__}"
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


def _instead(unknown: str, signature: inspect.Signature) -> str:
    """Returns a suggestion of the intended argument, and the list of all."""
    known = list(signature.parameters)
    if not known:
        return "; it takes none"
    return f"{meant(unknown, known)}; its arguments: {', '.join(known)}"


def _shape(signature: inspect.Signature) -> str:
    """Returns the arguments of a call in short, for example "(robot, path, *, dt, ...)"."""
    parts, optional = [], False
    for parameter in signature.parameters.values():
        if parameter.default is not inspect.Parameter.empty:
            optional = True
        elif parameter.kind is inspect.Parameter.KEYWORD_ONLY:
            parts.append(f"{parameter.name}=...")
        else:
            parts.append(parameter.name)
    return f"({', '.join([*parts, '...'] if optional else parts)})"


def _by_keyword(name: str, signature: inspect.Signature) -> str:
    """Returns the advice to name keyword-only arguments."""
    named = [key for key, value in signature.parameters.items() if value.kind is inspect.Parameter.KEYWORD_ONLY]
    if not named:
        return f"call it as {name}{_shape(signature)}"
    return f"name the others, such as {named[0]}=..."
