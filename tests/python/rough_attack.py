"""An attack whose cases end their process, hang, or break a promise."""

# ruff: noqa: ARG002

import os
import threading
from typing import Any, ClassVar

import numpy as np
from campaign.attack import Attack, BrokenError, Case


class Rough(Attack):
    name = "rough_attack:Rough"
    promise, page = "none", "none"
    deadline: ClassVar[float] = 1.0

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        return {"numbers": [float(number) for number in random.normal(size=9)], "fate": int(random.integers(8))}

    def program(self, case: Case) -> str:
        return f"numbers = {case['numbers']}\nfate = {case['fate']}"

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        match left["fate"]:
            case 3:
                os.abort()
            case 4:
                threading.Event().wait()
            case 5 if max(left["numbers"]) > 0.1:
                raise BrokenError("a number is positive", max(left["numbers"]))
        return len(left["numbers"])
