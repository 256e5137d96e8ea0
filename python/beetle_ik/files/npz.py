"""npz files: the ending of their names, and their contents."""

import os
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInputError
from .whole import path_of

_ENDING = ".npz"


def with_ending(file: str | os.PathLike[str]) -> Path:
    """Returns the path to write to: a name without any ending gets that of `numpy.savez`."""
    path = path_of(file)
    return path if path.suffix else path.with_name(path.name + _ENDING)


def read_arrays(file: str | os.PathLike[str]) -> dict[str, NDArray[Any]]:
    """Returns all arrays of an npz file; a name without ending may be that which `with_ending` was given.

    Raises:
        InvalidInputError: the file, which the message names, is not an npz file or is damaged.
    """
    path = path_of(file)
    with (path if path.exists() or not with_ending(path).exists() else with_ending(path)).open("rb") as stream:
        if not zipfile.is_zipfile(stream):
            raise InvalidInputError(f"{os.fspath(file)}: not an npz file")
        stream.seek(0)
        try:
            archive = np.load(stream, allow_pickle=False)
            if isinstance(archive, np.ndarray):  # an npy file with something behind it
                raise ValueError("it holds a single array")
            with archive:
                return {name: archive[name] for name in archive.files}
        except Exception as error:  # numpy and zipfile raise a dozen kinds for damage
            raise InvalidInputError(f"{os.fspath(file)}: damaged npz file: {error!s:.200}") from error
