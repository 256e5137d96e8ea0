"""The functions and constants that an expression may name. None of them reads, writes or executes anything."""

import math
import re
from collections.abc import Callable, Mapping
from typing import Any

from ..own_files import RefusedError

_MOST_ITEMS = 100_000  # items of a range
_MOST_DIGITS = 100  # digits to round to

_CONSTANTS = ("e", "inf", "nan", "pi", "tau")
# Functions of `math`, without factorial, comb and perm, whose results may be too large to write down.
_MATHEMATICS = (
    *("acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "ceil", "copysign", "cos", "cosh", "degrees", "dist"),
    *("erf", "erfc", "exp", "expm1", "fabs", "floor", "fmod", "frexp", "fsum", "gamma", "gcd", "hypot", "isclose"),
    *("isfinite", "isinf", "isnan", "isqrt", "ldexp", "lgamma", "log", "log10", "log1p", "log2", "modf", "pow"),
    *("radians", "remainder", "sin", "sinh", "sqrt", "tan", "tanh", "trunc"),
)
_BUILTINS: tuple[Callable[..., Any], ...] = (
    *(abs, all, any, bool, dict, divmod, float, int, len, list, max, min, sorted, str, tuple),
)
_WORDS = {"True": True, "False": False}


class Reads:
    """Placeholder for a function of xacro that reads files; calls are refused."""


def _rounded(number: Any, ndigits: int | None = None) -> Any:
    if ndigits is not None and abs(ndigits) > _MOST_DIGITS:
        raise RefusedError(f"rounding to more than {_MOST_DIGITS} digits")
    return round(number, ndigits)


def _counted(*arguments: int) -> list[int]:
    numbers = range(*arguments)
    if numbers and (abs(numbers[-1] - numbers[0]) // abs(numbers.step)) >= _MOST_ITEMS:  # the length may overflow
        raise RefusedError(f"a range of more than {_MOST_ITEMS} numbers")
    return list(numbers)


def _sum(numbers: Any) -> Any:
    listed = list(numbers)
    if not all(isinstance(number, int | float) for number in listed):
        raise TypeError("sum() adds numbers")
    return sum(listed)


def mapped(function: Any, *values: Any) -> list[Any]:
    """Returns the result of Python's `map` as a list, for functions whose results are no longer than the items."""
    if function not in _OF_ITEMS:
        raise RefusedError("map() of another function than those of numbers and texts")
    return list(map(function, *values))


def _tokenized(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:
    parts = re.split(f"[{re.escape(sep)}]", text) if sep else [text]
    return [part for part in parts if part or not skip_empty]


def _silent(*_: Any, **__: Any) -> str:
    return ""


def _fatal(*arguments: Any) -> None:
    raise ValueError(" ".join(map(str, arguments)))


def _dotified(mapping: Any) -> Any:
    return mapping  # items of all dicts are read by a dot


_OF_MATH: dict[str, Any] = {name: getattr(math, name) for name in (*_CONSTANTS, *_MATHEMATICS)}
_OF_PYTHON: dict[str, Any] = {
    **_WORDS,
    **{function.__name__: function for function in _BUILTINS},
    **{"map": mapped, "range": _counted, "round": _rounded, "sum": _sum},
}
_OF_ITEMS = frozenset({abs, bool, float, int, len, str, *filter(callable, _OF_MATH.values())})
_READS = {"load_yaml": Reads(), "abs_filename": Reads()}
_SILENT = dict.fromkeys(("message", "warning", "error", "print_location"), _silent)

CALLABLE = frozenset(
    each
    for each in (*_OF_MATH.values(), *_OF_PYTHON.values(), _tokenized, _silent, _fatal, _dotified)
    if callable(each) and not isinstance(each, bool)
)
"""All functions that may be called; xacro adds `xacro.arg`."""


def symbols(argument: Callable[[str], Any]) -> Mapping[str, Any]:
    """Returns the global symbols of xacro; `argument` returns the value of an argument of the file."""
    of_xacro = {**_READS, **_SILENT, "dotify": _dotified, "fatal": _fatal, "tokenize": _tokenized, "arg": argument}
    namespaces = {"math": dict(_OF_MATH), "python": dict(_OF_PYTHON), "xacro": of_xacro}
    return {**_OF_MATH, **_OF_PYTHON, **_READS, "dotify": _dotified, **namespaces}
