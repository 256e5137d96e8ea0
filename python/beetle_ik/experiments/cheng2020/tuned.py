"""The settings that `tuning.py` chose, from `tuned.json`."""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from .boxes import ErrorBox, Setting
from .methods import METHODS

FILE = Path(__file__).with_name("tuned.json")
BUDGETED = "whole box, by budget"  # the smallest error with so many evaluations a step


@dataclass(frozen=True)
class Tuned:
    """The setting that tuning chose."""

    setting: Setting
    evaluations: float
    """A step, mean over the tuning seeds."""
    missed: int
    """Steps outside the band, of all tuning seeds."""


@cache
def all_tuned() -> dict[tuple[str, float, str], Tuned]:
    """By box, goal and method."""
    kinds = {method.name: method.kind for method in METHODS}
    found = {}
    for record in json.loads(FILE.read_text(encoding="utf-8")):
        solver = kinds[record["method"]](**record["options"])
        setting = ErrorBox(solver=solver, reach=record["reach"]) if "reach" in record else solver
        key = record["box"], record["goal"], record["method"]
        found[key] = Tuned(setting, record["evaluations"], record["missed"])
    return found
