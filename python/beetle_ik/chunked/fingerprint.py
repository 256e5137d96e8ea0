"""Fingerprints of arguments, by which a store recognises its job."""

import hashlib
import io
import pickle
from collections.abc import Mapping, Sequence
from numbers import Integral, Real

import numpy as np
from numpy.typing import NDArray

_SHOWN = 16  # digits of a hash in a message


def description(value: object) -> str | int | float | bool | None:
    """Returns a JSON value that identifies an argument: a plain value itself, any other by type and hash."""
    if value is None or isinstance(value, str | bool | np.bool_):
        return bool(value) if isinstance(value, np.bool_) else value
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Real):
        return float(value)
    name = getattr(value, "name", None)
    kind = f"{type(value).__name__} {name}" if isinstance(name, str) else type(value).__name__
    return f"{kind} {hashlib.sha256(_content(value)).hexdigest()[:_SHOWN]}"


def digest(arrays: Sequence[NDArray[np.generic]]) -> NDArray[np.uint8]:
    """Returns the SHA-256 of types, shapes and contents (32,)."""
    seen = hashlib.sha256()
    for array in arrays:
        seen.update(f"{array.dtype.str}{array.shape}".encode())
        seen.update(np.ascontiguousarray(array).data)
    return np.frombuffer(seen.digest(), np.uint8)


def sealed(job: bytes, number: int, arrays: Mapping[str, NDArray[np.generic]]) -> NDArray[np.uint8]:
    """Returns the SHA-256 of named arrays of a job, together with the job and their number in it (32,)."""
    names = sorted(arrays)
    seen = hashlib.sha256(hashlib.sha256(job).digest())
    seen.update(f"{number} {names}".encode())
    seen.update(digest([arrays[name] for name in names]).tobytes())
    return np.frombuffer(seen.digest(), np.uint8)


def _content(value: object) -> bytes:
    """Pickles a value without a memo, so that equal values give equal bytes whatever objects they share."""
    written = io.BytesIO()
    pickler = pickle.Pickler(written, protocol=5)
    pickler.fast = True
    pickler.dump(value)
    return written.getvalue()
