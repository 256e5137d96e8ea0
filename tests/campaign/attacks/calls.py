"""Every public call with hostile arguments."""

from __future__ import annotations

import inspect
from functools import cache
from typing import Any

import numpy as np

import beetle_ik as bik

from .. import hostile
from ..attack import Attack, BrokenError, Case

# Drawings, servers, and files that other attacks deform.
ELSEWHERE = (
    "plot.",
    "Viewer",
    "view",
    "show_versions",
    "Robot.from_mjcf",
    "Robot.from_description",
    "Scene.",
    "Trajectory.from_csv",
    "Trajectory.from_npz",
    "Trajectory.to_",
)
SETUP = "from test_every_call import CALLS, needed  # of tests/python\n\n"


# The right value in another form, or nearly right.
NEARLY = (
    "np.array({}, dtype='f4')", "np.array({}, dtype='>f8')", "np.asfortranarray({})", "np.array({}, dtype=object)",
    "np.stack([{}] * 2, axis=-1)[..., 0]", "np.flip(np.array({}))", "np.array({}).tolist()", "[{}]",
    "1e3 * np.array({})", "1e-9 * np.array({})", "np.array({}) + 1e-7", "np.nextafter(np.array({}), inf)",
    "np.broadcast_to(np.array({}), np.shape({}))",
)  # fmt: skip


class Arguments(Attack):
    name = "arguments"
    promise = "A wrong argument raises a declared error: no panic, no hang, and no NaN in a result that says success"
    page = "concepts"
    refusals = (bik.BeetleIkError, TypeError, ValueError, OverflowError, MemoryError, FileNotFoundError)

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """One wrong argument, or, hard, several."""
        names = list(callable_names())
        name = names[random.integers(len(names))]
        parameters = callable_names()[name]
        count = min(len(parameters), int(random.integers(2, 4)) if hard else 1)
        chosen = random.choice(parameters, count, replace=False)
        return {"call": name, "arguments": [(str(each), self.value(str(each), random)) for each in chosen]}

    @staticmethod
    def value(argument: str, random: np.random.Generator) -> str:
        """Draws an expression for an argument."""
        if random.random() < 0.6:
            return hostile.value(random)
        return str(random.choice(NEARLY)).replace("{}", f"right.get({argument!r}, 1.0)")

    def program(self, case: Case) -> str:
        name = case["call"]
        arguments = "".join(f", {key!r}: {value}" for key, value in case["arguments"])
        return (
            f"{SETUP}call, right = CALLS[{name!r}], needed({name!r})\n"
            "right = {key: value for key, value in right.items() if key in inspect.signature(call).parameters}\n"
            f"result = call(**{{**right{arguments}}})"
        ).replace(SETUP, f"import inspect\n{SETUP}")

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        result = left["result"]
        if getattr(result, "success", None) is True:
            for name in ("q", "x", "value", "position_error", "cost"):
                if not np.isfinite(getattr(result, name, 0.0)).all():
                    raise BrokenError("success, and not finite", f"{case['call']}: {name}")
        return 1


@cache
def callable_names() -> dict[str, list[str]]:
    """The public calls that are attacked here, and the names of their arguments."""
    from test_every_call import CALLS, MADE_BY_THE_LIBRARY

    found = {}
    for name, call in CALLS.items():
        if name.startswith(ELSEWHERE) or name in MADE_BY_THE_LIBRARY:
            continue
        parameters = [
            each
            for each in inspect.signature(call).parameters
            if each not in ("progress", "file", "path_or_xml", "srdf", "kwargs", "args")
        ]
        if parameters:
            found[name] = parameters
    return found


ATTACKS = [Arguments()]
