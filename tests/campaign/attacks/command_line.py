"""The command line with hostile words."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import hostile
from ..attack import Attack, BrokenError, Case

WORDS = (
    "",
    "-",
    "--",
    "nonsense",
    "--help",
    "1,2",
    ",",
    "0,0,0,0,0,0,0",
    "nan,0,0",
    "1e400",
    "..",
    "/",
    "/dev/null",
    "\u00e9",
)
ARM = "panda"
HOME = "0,-0.4,0,-2,0,1.6,0.8"
RIGHT = (
    ["robots"],
    ["fk", ARM, "--q", HOME],
    ["solve", ARM, "--position", "0.4,0.1,0.5"],
    ["solve", ARM, "--position", "0.4,0.1,0.5", "--rpy", "3.1,0,0", "--start", HOME, "--seed", "3"],
    ["solve", ARM, "--position", "0.4,0.1,0.5", "--link-radius", "0.05", "--max-evaluations", "90"],
    ["track", ARM, "--curve", "circle", "--center", "0.4,0,0.5", "--diameter", "0.1", "--duration", "1", "--dt", "0.1"],
    ["track", ARM, "--curve", "circle", "--duration", "1", "--dt", "0.1", "--start", HOME, "--acceleration-limit", "5"],
    [
        "plan",
        "point-to-point",
        ARM,
        "--start-q",
        HOME,
        "--end-q",
        "0.3,-0.4,0,-2,0,1.6,0.8",
        "--acceleration-limit",
        "5",
    ],
    ["plan", "along-path", ARM, "--curve", "circle", "--acceleration-limit", "5"],
)


class CommandLine(Attack):
    name = "command_line"
    promise = "The command line ends with status 0, 1 or 2 and a message, whatever it is told"
    page = "first_ten_minutes"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """One word is wrong, or, hard, several are, moved or left out."""
        words = list(RIGHT[random.integers(len(RIGHT))])
        for _ in range(int(random.integers(2, 5)) if hard else 1):
            place = int(random.integers(len(words) + 1))
            wrong = str(random.choice(WORDS + tuple(number for number in hostile.NUMBERS if number[0] != "1")))
            match random.integers(3) if hard else 0:
                case 0:
                    words[place : place + 1] = [wrong]
                case 1:
                    words.insert(place, wrong)
                case _:
                    del words[place : place + 1]
        return {"words": words}

    def program(self, case: Case) -> str:
        return (
            "from typer.testing import CliRunner\n\nfrom beetle_ik.cli.app import app\n\n"
            f"done = CliRunner().invoke(app, {case['words']})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        done = left["done"]
        if done.exception is not None and not isinstance(done.exception, SystemExit):
            raise BrokenError(f"the command line raises {type(done.exception).__name__}", done.exception)
        if done.exit_code not in (0, 1, 2):
            raise BrokenError("the status is none of 0, 1, 2", done.exit_code)
        if done.exit_code == 2 and not done.output.strip():
            raise BrokenError("nothing is said of what is wrong")
        return 1


ATTACKS = [CommandLine()]
