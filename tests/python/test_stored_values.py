"""Pickles of earlier versions are read to the same bits, or refused by an error that names the formats."""

import json
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

# Solvers of 0.1.0 are of the top level; they are read from there with a warning.
pytestmark = pytest.mark.filterwarnings("ignore:beetle_ik.* is now beetle_ik.papers:DeprecationWarning")

FILES = sorted((Path(__file__).parent / "stored").glob("*/*.pickle"))
EARLIER = "it was stored in format 1 by an earlier version of beetle-ik, and this one reads format 3: make it anew"


def attributes(file: Path) -> dict[str, Any]:
    kept: dict[str, dict[str, Any]] = json.loads((file.parent / "attributes.json").read_text(encoding="utf-8"))
    return kept[file.stem]


def numbers(value: object) -> object:
    return [[str(number) for number in value.ravel()], list(value.shape)] if isinstance(value, np.ndarray) else value


def read(file: Path) -> object:
    """The value, or the text of the refusal."""
    try:
        return pickle.loads(file.read_bytes())
    except bik.InvalidInputError as refusal:
        return str(refusal)


@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}/{file.stem}")
def test_a_value_is_read_as_it_was_or_refused(file: Path) -> None:
    value, kept = read(file), attributes(file)
    if isinstance(value, str):
        assert re.fullmatch(f"cannot restore [a-z ]+: {EARLIER}", value)
    else:
        assert {name: numbers(getattr(value, name)) for name in kept} == kept


@pytest.mark.parametrize("name", ["box", "limits", "solver", "sphere", "stop", "task", "trajectory"])
def test_plain_values_of_the_last_version_are_read(name: str) -> None:
    (file,) = (file for file in FILES if file.stem == name and file.parent.name == "0.1.0")
    assert not isinstance(read(file), str)
