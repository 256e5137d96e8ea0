"""Settings chosen by `tuning.py`, from `tuned.json`."""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from .boxes import ErrorBox, Setting
from .methods import METHODS

FILE = Path(__file__).with_name("tuned.json")
BUDGETED = "whole box, by budget"  # the smallest error within an evaluation budget of each step


@dataclass(frozen=True)
class Tuned:
    """A setting chosen by tuning, and its cost."""

    setting: Setting
    evaluations: float
    """Evaluations of a step, mean over the tuning seeds."""
    missed: int
    """Steps of all tuning seeds outside the band."""


@cache
def all_tuned() -> dict[tuple[str, float, str], Tuned]:
    """Returns all chosen settings, by box, goal and method."""
    kinds = {method.name: method.kind for method in METHODS}
    found = {}
    for record in json.loads(FILE.read_text(encoding="utf-8")):
        solver = kinds[record["method"]](**record["options"])
        setting = ErrorBox(solver=solver, reach=record["reach"]) if "reach" in record else solver
        key = record["box"], record["goal"], record["method"]
        found[key] = Tuned(setting, record["evaluations"], record["missed"])
    return found
