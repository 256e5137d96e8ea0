"""Stops of every tracker: one arm, two arms, a tray, among obstacles that move and come anew, under all limits."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

import beetle_ik as bik

from .. import arms, typed
from ..attack import Attack, BrokenError, Case

KINDS = ("velocity", "acceleration", "jerk")
AT_REST = 1e-9  # rad, m: a joint that moves less in a tick stands
SLACK = 1e-6  # of a limit
ROUNDING = 64.0 * np.finfo(float).eps  # of a finite difference, relative to the joint positions
STANDS = 20  # ticks after the stop in which the arm stands

READY = {
    "panda": [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8],
    "iiwa14": [0.2, 0.6, 0.0, -1.4, 0.0, 0.9, 0.3],
    "ur5e": [0.3, -1.2, 1.6, -1.9, -1.5, 0.4],
    "gen3": [0.1, 0.5, 0.0, 1.4, 0.0, 0.9, 0.2],
    "kr210": [0.0, -1.2, 1.4, 0.0, 0.6, 0.0],
}

# Two arms on a lift, as the two hands of one robot.
SHAPE = "<collision><origin xyz='0 0 0.1'/><geometry><cylinder radius='0.04' length='0.2'/></geometry></collision>"
LENGTHS = (0.1, 0.1, 0.2, 0.2, 0.2, 0.2, 0.0)


def _joint(name: str, kind: str, links: tuple[str, str], at: str, rest: str) -> str:
    parent, child = links
    return (
        f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='{at}'/>{rest}</joint>"
    )


def _arm(side: str, y: float) -> str:
    parts, parent = [], "chest"
    for i, (axis, length) in enumerate(zip(("0 0 1", "0 1 0") * 4, LENGTHS, strict=False)):
        link, at = f"{side}_{i}", f"0 {0 if i else y} {length}"
        limit = f"<axis xyz='{axis}'/><limit lower='-2.8' upper='2.8' velocity='2'/>"
        parts.append(f"<link name='{link}'>{SHAPE if i % 2 else ''}</link>")
        parts.append(_joint(f"j_{link}", "revolute", (parent, link), at, limit))
        parent = link
    return "".join([*parts, f"<link name='{side}'/>", _joint(f"m_{side}", "fixed", (parent, side), "0 0 0.1", "")])


LIMIT = "<axis xyz='0 0 1'/><limit lower='0' upper='0.4' velocity='0.2'/>"
LIFT = _joint("lift", "prismatic", ("floor", "chest"), "0 0 0.5", LIMIT)
ARMS = f"{_arm('left', 0.3)}{_arm('right', -0.3)}"
PAIR = f"<robot name='pair'><link name='floor'/><link name='chest'/>{LIFT}{ARMS}</robot>"
HANDS = [0.2, 0.0, 0.6, 0.0, 0.9, 0.0, 0.6, 0.0, 0.0, 0.6, 0.0, 0.9, 0.0, 0.6, 0.0]

# `aim` is what the tracker is told: a pose, or one for each hand and the tray between them.
ONE_ARM = """
home = robot.fk(start)

def aim(shift, turn):
    pose = home.copy()
    pose[:3, 3] += shift
    pose[:3, :3] = bik.pose([0, 0, 0], rpy=turn)[:3, :3] @ pose[:3, :3]
    return pose
"""
TWO_ARMS = """
home, right = robot.fk(start)
tray = np.linalg.inv(home) @ right

def aim(shift, turn):
    pose = home.copy()
    pose[:3, 3] += shift
    pose[:3, :3] = bik.pose([0, 0, 0], rpy=turn)[:3, :3] @ pose[:3, :3]
    other = right.copy()
    other[:3, 3] -= shift
    return {"left": pose, ("left", "right"): tray} if holds else {"left": pose, "right": other}
"""

# Each stop is kept as what it said, when it began, and which tick of it called `stop` again and heard what.
LIVES = """
q, stops = [tracker.q], []
for shift, turn, drift, ticks, noise, rare, mass, reset, given, later, again in life:
    if mass is not None:
        tracker.robot = robot.with_payload(mass)
    shift, turn, drift = np.array(shift), np.array(turn), np.array(drift)
    for k in range(ticks):
        shaken = noise * np.sin((2.0 + k) ** 2 * np.arange(1, 4))
        told = aim(shift + drift * dt * k + shaken, turn + shaken)
        q.append(tracker.step(None if k % rare else told).q)
    if reset is not None:
        try:
            tracker.reset(tracker.q, *reset)
            q.append(None)
        except bik.BeetleIkError:
            pass
    if given is not None:
        tracker.obstacles = given
    said, left = tracker.stop(), []
    begin = len(q)
    for k in range(round(said / dt) + stands):
        if later is not None and k == later[0]:
            tracker.obstacles = later[1]
        if again and k % again == 0:
            left.append((k, tracker.stop()))
        q.append(tracker.step(None).q)
    stops.append((said, begin, left))
"""


class AnyStop(Attack):
    name = "any_stop"
    promise = "Every stop takes the time that it says, to within a tick, and the arm then stands"
    page = "tracking"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Easy limits are real numbers, hard ones round and very different; hard lives have resets too."""
        arm = str(random.choice([*READY, "pair", "pair"]))
        orders = int(random.integers(1, 4))
        rates = np.array([1.5, 5.0, 50.0]) * random.uniform(0.3, 3.0, 3)
        if hard:
            rates = np.array(typed.limits(random, -1, 2))
        return {
            "arm": arm, "holds": bool(random.random() < 0.7), "orders": orders, "rates": arms.triple(rates),
            "dt": float(random.choice([0.001, 0.002, 0.004, 0.01, 0.02, 1 / 30])),
            "margin": float(random.choice([0.0, 0.001, 0.01])), "scene": self.things(random, hard),
            "inside": bool(random.random() < 0.8), "self_collision": bool(random.random() < 0.2),
            "extra": self.extra(random, arm, orders),
            "life": [self.event(random, hard) for _ in range(int(random.integers(5, 25)))],
        }  # fmt: skip

    @staticmethod
    def extra(random: np.random.Generator, arm: str, orders: int) -> str:
        """One more argument of the tracker."""
        choices = [""] * 4 + ["filter", "timeout", "tip_speed", "sinusoid"] + ["upright"] * (random.random() < 0.2)
        if arm == "pair":
            choices = ["", "", "filter", "timeout"]
        elif arm == "panda" and orders > 1:
            choices += ["torque"] * 3
        return str(random.choice(choices))

    @staticmethod
    def things(random: np.random.Generator, hard: bool) -> list[dict[str, Any]]:
        """Up to five boxes, of which some move."""

        def place(extent: float) -> tuple[float, float, float]:
            drawn = random.uniform(-extent, extent, 3)
            return arms.triple(np.round(drawn, 1) if hard and random.random() < 0.5 else drawn)

        return [
            {
                "at": place(0.45),
                "size": arms.triple(random.uniform(0.03, 0.3, 3)),
                "velocity": place(0.4) if random.random() < 0.3 else (0.0, 0.0, 0.0),
            }
            for _ in range(int(random.integers(6)))
        ]

    def event(self, random: np.random.Generator, hard: bool) -> dict[str, Any]:
        """Targets that rest, jump, move and shake, with gaps; what happens before and during the stop after them."""

        def triple(extent: float, odds: float) -> tuple[float, float, float]:
            return arms.triple(random.uniform(-extent, extent, 3) * (random.random() < odds))

        return {
            "shift": triple(0.35, 0.9), "turn": triple(0.6, 0.5), "drift": triple(0.5, 0.4),
            "ticks": int(random.choice([random.integers(1, 10), random.integers(5, 40), random.integers(20, 80)])),
            "noise": float(random.choice([0.0, 0.0, 1e-5, 1e-3, 1e-2])),
            "rare": int(random.choice([1, 1, 1, 3, 8])),
            "mass": float(random.choice([0.0, 1.0, 3.0])) if random.random() < 0.3 else None,
            "reset": arms.triple(random.uniform(-1, 1, 3)) if hard and random.random() < 0.1 else None,
            "given": self.things(random, hard) if random.random() < 0.3 else None,
            "later": (int(random.integers(30)), self.things(random, hard)) if random.random() < 0.15 else None,
            "again": int(random.choice([0, 0, 0, 1, 7])) if hard else 0,
        }  # fmt: skip

    def program(self, case: Case) -> str:
        return self.made(case) + (TWO_ARMS if case["arm"] == "pair" else ONE_ARM) + LIVES

    def made(self, case: Case) -> str:
        """The robot, its tracker and its life."""
        rates = dict(zip(KINDS[: case["orders"]], case["rates"], strict=False))
        if case["arm"] == "pair":
            robot, start = bik.Robot.from_urdf(PAIR, tip=["left", "right"]), HANDS
            made = f"robot = bik.Robot.from_urdf({PAIR!r}, tip=['left', 'right'])\n"
            center = robot.fk(start)[:, :3, 3].mean(axis=0)
        else:
            robot, start = bik.Robot.named(case["arm"]), READY[case["arm"]]
            made = f"robot = bik.Robot.named('{case['arm']}').with_capsules(radius=0.05)\n"
            center = robot.fk(start)[:3, 3]

        def things(given: list[dict[str, Any]] | None) -> str:
            if given is None:
                return "None"
            shapes = []
            for thing in given:
                shape = f"bik.obstacles.Box({(center + thing['at']).tolist()}, {thing['size']})"
                moves = f"bik.obstacles.Moving({shape}, velocity={thing['velocity']})"
                shapes.append(moves if any(thing["velocity"]) else shape)
            return f"[{', '.join(shapes)}]"

        def event(of: dict[str, Any]) -> str:
            reset = None
            if of["reset"] is not None:
                moving = [
                    (share * rates[kind] * np.cos(np.arange(robot.dof))).tolist()
                    for share, kind in zip(of["reset"], KINDS[: min(2, case["orders"])], strict=False)
                ]
                reset = tuple(moving) if case["orders"] > 1 else ()
            before, later = "None", "None"
            if case["inside"]:
                before = things(of["given"])
                later = "None" if of["later"] is None else f"({of['later'][0]}, {things(of['later'][1])})"
            mass = of["mass"] if case["extra"] == "torque" else None
            stream = f"{of['shift']}, {of['turn']}, {of['drift']}, {of['ticks']}, {of['noise']}, {max(of['rare'], 1)}"
            return f"({stream}, {mass}, {reset}, {before}, {later}, {of['again']})"

        given = "limits=limits"
        if case["inside"]:
            given += f", obstacles={things(case['scene'])}, margin={case['margin']}"
            given += f", self_collision={case['self_collision']}"
        elif case["arm"] == "pair":
            given += ", self_collision=False"
        limits = ", ".join(f"{kind}={rate}" for kind, rate in rates.items())
        match case["extra"]:
            case "filter":
                given += ", target_filter=bik.filters.OneEuro()"
            case "timeout":
                given += ", timeout=0.03"
            case "tip_speed":
                limits += ", tip_speed=0.25"
            case "upright":
                given += ", keep=bik.upright(robot, direction=robot.fk(start)[:3, 2], tilt=0.2)"
            case "torque":
                limits += ", torque=np.maximum(1.4 * np.abs(robot.torques(start)), 6.0)"
            case "sinusoid":
                swing = 0.3 * rates["velocity"]
                wave = f"bik.Sinusoid(mean={rates['velocity']}, amplitude={swing}, angular_frequency=3.0)"
                limits = limits.replace(f"velocity={rates['velocity']}", f"velocity={wave}")
        return (
            f"{made}start, dt, stands, holds = {start}, {case['dt']}, {STANDS}, {case['holds']}\n"
            f"limits = bik.Limits({limits})\nlife = [{', '.join(map(event, case['life']))}]\n"
            f"tracker = bik.Tracker(robot, start, dt=dt, {given})\n"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        q, dt = left["q"], case["dt"]
        for said, begin, heard in left["stops"]:
            before = q[begin - 1] if q[begin - 1] is not None else q[begin - 2]  # None: a reset
            rows = np.array([before, *q[begin : begin + round(said / dt) + STANDS]])
            moving = np.flatnonzero(np.abs(np.diff(rows, axis=0)).max(axis=1) > AT_REST)
            if moving.size and moving[-1] > round(said / dt):
                raise BrokenError("an arm is later at rest than its stop said", (said, dt * (moving[-1] + 1)))
            for tick, time in heard:
                if time > max(0.0, said - tick * dt) + 3.5 * dt:  # the last ticks of a stop are rounding
                    raise BrokenError("a stop that is called again takes longer", (said, tick * dt, time))
        self.check_rates(case, q)
        return len(left["stops"])

    @staticmethod
    def check_rates(case: Case, q: list[np.ndarray | None]) -> None:
        """Checks finite differences of the commands from reset to reset."""
        if case["extra"] == "sinusoid":
            return
        cuts = [0, *(k + 1 for k, row in enumerate(q) if row is None), len(q) + 1]
        for first, last in pairwise(cuts):
            part = np.array(q[first : last - 1])
            rounding = ROUNDING * np.abs(part).max(initial=1.0)
            for order, (kind, rate) in enumerate(zip(KINDS[: case["orders"]], case["rates"], strict=False), 1):
                most = rate * case["dt"] ** order
                largest = np.abs(np.diff(part, order, axis=0)).max(initial=0.0)
                if largest > (1 + SLACK) * most + rounding:
                    raise BrokenError(f"the {kind} is beyond its limit", largest / most - 1.0)

    def judge_refusal(self, case: Case, error: Exception) -> None:
        raise BrokenError("a right tracker is refused", error)


ATTACKS = [AnyStop()]
