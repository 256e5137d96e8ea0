"""A tracker lives through anything: limits by finite differences of what it commands."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from .. import arms, typed
from ..attack import Attack, BrokenError, Case
from .solving import refuse_only_locked

SLACK = 1e-9  # of a limit
ROUNDING = 8.0 * np.finfo(float).eps  # of a finite difference, relative to the joint positions
KINDS = ("velocity", "acceleration", "jerk")

# The log tells, in order: ("q", q) after a tick, ("reset", q, qd, qdd), ("refused", what, unchanged, message).
LIFE = """
log = []
for what, *more in life:
    before = tracker.q, tracker.time
    try:
        if what == "reset":
            tracker.reset(*more)
            log.append(("reset", *more))
        elif what == "stop":
            for _ in range(round(tracker.stop() / tracker.dt) + 2):
                log.append(("q", tracker.step(None).q))
            log.append(("stopped", tracker.q))
        elif what == "late":
            log.append(("q", tracker.step(more[0], stamp=tracker.time - more[1]).q))
        else:
            log.append(("q", tracker.step(more[0]).q))
    except bik.BeetleIkError as error:
        unchanged = before[0].tobytes() == tracker.q.tobytes() and before[1] == tracker.time
        log.append(("refused", what, unchanged, str(error)))
"""


class TrackerLives(Attack):
    name = "tracker_lives"
    promise = "No tick moves a joint farther than its limits allow, up to jerk, and the arm can stop at any time"
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard life has late, missing and repeated targets, NaN, resets in motion, stops, and jumps out of reach.

        Limits are real numbers or round ones, which joints share or not.
        """
        joints = arms.easy_arm(random, int(random.integers(1, 8)))
        arms.put(joints, random, False, 6)
        for joint in joints:
            joint["rates"] = tuple((np.exp(random.uniform(np.log([0.1, 0.5, 5.0]), np.log([4.0, 50.0, 5e3])))).tolist())
            joint["moving"] = tuple(random.uniform(-0.3, 0.3, 2).tolist())
        if random.random() < 0.5:
            shared = typed.limits(random, -1, 1) if random.random() < 0.5 else None
            for joint in joints:
                joint["rates"] = shared or typed.limits(random, -1, 2)
                joint["moving"] = tuple(random.choice([0.0, 0.5, -0.5, 1.0, -1.0], 2).tolist())
        kinds = ("target", "none", "late", "jump", "nan", "reset", "stop", "same") if hard else ("target", "none")
        weights = np.array([6, 2, 2, 2, 1, 0.5, 0.5, 3] if hard else [5, 1])
        life = []
        for _ in range(int(random.integers(3, 30))):
            kind = str(random.choice(kinds, p=weights / weights.sum()))
            noise = 10.0 ** random.uniform(-7, -1) if random.random() < 0.3 else 0.0
            shift = arms.triple(random.normal(size=3) * (10.0 if kind == "jump" else noise))
            life.append(
                {
                    "do": kind,
                    "to": int(random.integers(6)),
                    "shift": shift,
                    "times": int(random.integers(1, 15)),
                    "age": float(random.uniform(0.0, 0.4)),
                }
            )
        return {
            "joints": joints, "life": life, "orders": int(random.integers(1, 4)), "pose": bool(random.random() < 0.6),
            "dt": float(random.choice([1e-3, 2e-3, 5e-3, 2e-2])), "timeout": bool(hard and random.random() < 0.3),
            "filter": str(random.choice(["None"] * 4 + ["bik.filters.LowPass(5.0)", "bik.filters.OneEuro()"])),
        }  # fmt: skip

    def program(self, case: Case) -> str:
        joints, at = case["joints"], arms.configurations(case["joints"])
        poses = arms.kinematics(joints, at)[0]
        life: list[tuple[Any, ...]] = []
        for event in case["life"]:
            kind, target = event["do"], poses[event["to"] % len(poses)].copy()
            target[:3, 3] += event["shift"]
            told = target.tolist() if case["pose"] else target[:3, 3].tolist()
            match kind:
                case "none":
                    life += [("step", None)] * event["times"]
                case "nan":
                    life.append(("step", [float("nan")] * 3))
                case "late":
                    life.append(("late", told, event["age"]))
                case "reset":
                    rates = np.array([joint["rates"] for joint in arms.free(joints)])
                    moving = np.array([joint["moving"] for joint in arms.free(joints)])
                    life.append(
                        (
                            "reset",
                            at[event["to"] % len(at)].tolist(),
                            (rates[:, 0] * moving[:, 0]).tolist(),
                            (rates[:, 1] * moving[:, 1]).tolist(),
                        )
                    )
                case "stop":
                    life.append(("stop",))
                case "same":
                    life += [("step", told)] * event["times"]
                case _:
                    life.append(("step", told))
        rates = self.limits(case)
        limits = ", ".join(f"{kind}={values.tolist()}" for kind, values in rates.items())
        return (
            f"{arms.written(joints)}life = {life!r}\n"
            f"tracker = bik.Tracker(robot, {at[0].tolist()}, dt={case['dt']}, limits=bik.Limits({limits}), "
            f"timeout={0.1 if case['timeout'] else None}, target_filter={case['filter']}){LIFE}"
        )

    def limits(self, case: Case) -> dict[str, np.ndarray]:
        """The limits of the free joints."""
        rates = np.array([joint["rates"] for joint in arms.free(case["joints"])])
        return dict(zip(KINDS[: case["orders"]], rates.T, strict=False))

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        dt, limits, ticks = case["dt"], self.limits(case), 0
        at = arms.configurations(case["joints"])[0]
        lives: list[list[np.ndarray]] = [[at, at, at]]
        for what, *more in left["log"]:
            if what == "q":
                lives[-1].append(more[0])
                ticks += 1
            elif what == "reset":
                q, qd, qdd = map(np.array, more)
                lives.append([q - dt * qd - dt * (qd - dt * qdd), q - dt * qd, q])
            elif what == "stopped" and not np.array_equal(lives[-1][-1], lives[-1][-2]):
                raise BrokenError("the arm moves after its stop", (lives[-1][-1] - lives[-1][-2]).tolist())
            elif what == "refused":
                check_refusal(more, "stamp" if len(limits) == 1 else "")
        for life in lives:
            check_limits(case, np.array(life), limits, dt)
        return ticks

    def judge_refusal(self, case: Case, error: Exception) -> None:
        refuse_only_locked(case, error)


def check_refusal(entry: list[Any], allowed: str) -> None:
    """Checks that only NaN, resets and stamps without limits are refused, and leave the tracker as it was."""
    what, unchanged, message = entry
    if not unchanged:
        raise BrokenError("a refused call changes the tracker", message)
    wrong = "finite" in message or "NaN" in message or "nan" in message
    if not (wrong or what == "reset" or (allowed and allowed in message)):
        raise BrokenError("a right step is refused", message)


def check_limits(case: Case, q: np.ndarray, limits: dict[str, np.ndarray], dt: float) -> None:
    """Checks finite differences of the commands; the first three rows are what was before."""
    if not np.isfinite(q).all():
        raise BrokenError("a command is not finite")
    lower, upper = arms.bounds(case["joints"])
    beyond = np.maximum(lower - q[2:], q[2:] - upper).max()
    rounding = ROUNDING * np.abs(q).max()
    if beyond > rounding:
        raise BrokenError("a command is outside the position limits", beyond)
    for order, kind in enumerate(KINDS, 1):
        if kind in limits and len(q) > 3:
            rates = np.abs(np.diff(q, order, axis=0))[3 - order :]
            excess = ((rates - rounding * 2**order) / (limits[kind] * dt**order)).max() - 1.0
            if excess > SLACK:
                raise BrokenError(f"the {kind} is beyond its limit", excess)


# Stops in a life among obstacles, then a target that stands still. The last obstacles have moved, or are given anew.
STOPS = """
home, stops = robot.fk(start), []
for away, ticks, noise, rare, given in life:
    target = home.copy()
    target[:3, 3] += away
    for k in range(ticks):
        shaken = target.copy()
        shaken[:3, 3] += noise * np.sin((2.0 + k) ** 2 * np.arange(1, 4))
        tracker.step(None if k % rare else shaken)
    if given is not None:
        tracker.obstacles = given
    said = tracker.stop()
    stops.append((said, np.array([tracker.q] + [tracker.step(None).q for _ in range(round(said / dt) + 20)])))
tracker.obstacles = scene
for _ in range(round(4.0 / dt)):
    step = tracker.step(target)
held, seconds = [tracker.step(target) for _ in range(round(1.0 / dt))], 1
while held[-1].message.startswith("on the way") and seconds < 60:  # by a motion of the joints, which takes its time
    held, seconds = [tracker.step(target) for _ in range(round(1.0 / dt))], seconds + 1
"""
AT_REST = 1e-9  # rad, m: a joint that moves less in a tick stands
SLOW = 1e-3  # rad/s, m/s
NEARER = 0.9  # of the error a second before: an arm that is on its way


class StopsAmongObstacles(Attack):
    name = "stops_among_obstacles"
    promise = "Among obstacles a stop takes as long as it says, and an arm that cannot come nearer comes to rest"
    page = "scenes"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard cases are round: configurations at limits and right angles, places, ties of limits; shapes come anew."""
        tens = random.choice([1.0, 2.0, 5.0], 3) * 10.0 ** random.integers(0, 2, 3)
        rates = tens * (0.5, 1.0, 10.0) if hard else np.array([1.5, 5.0, 50.0]) * random.uniform(0.5, 2.0, 3)

        def place(extent: float) -> tuple[float, float, float]:
            drawn = random.uniform(-extent, extent, 3)
            return arms.triple(np.round(drawn, 1) if hard and random.random() < 0.6 else drawn)

        def things() -> list[dict[str, Any]]:
            sizes = (0.1, 0.2, 0.5) if hard else random.uniform(0.05, 0.3, 3)
            velocities = [place(0.3) if random.random() < 0.4 else (0.0, 0.0, 0.0) for _ in range(4)]
            return [
                {"at": place(0.4), "size": arms.triple(random.permutation(sizes)), "velocity": velocity}
                for velocity in velocities[: int(random.integers(5))]
            ]

        life = [
            {
                "away": place(0.3),
                "ticks": int(random.integers(1, 60)),
                "noise": float(random.choice([0.0, 0.0, 1e-5, 1e-3])),
                "rare": int(random.choice([1, 1, 5])),
                "given": things() if hard and random.random() < 0.4 else None,
            }
            for _ in range(int(random.integers(1, 6)))
        ]
        return {
            "arm": str(random.choice(["panda", "iiwa14", "ur5e"])), "start": random.uniform(0.0, 1.0, 7).tolist(),
            "round": hard, "rates": arms.triple(rates), "orders": int(random.integers(1, 4)), "scene": things(),
            "life": life, "dt": float(random.choice([0.005, 0.01, 0.02])),
            "margin": float(random.choice([0.0, 0.001, 0.01])),
        }  # fmt: skip

    def program(self, case: Case) -> str:
        arm, dt = bik.Robot.named(case["arm"]), case["dt"]
        lower, upper = np.maximum(arm.lower, -3.0), np.minimum(arm.upper, 3.0)
        start = lower + (upper - lower) * np.array(case["start"])[: arm.dof]
        if case["round"]:
            start = np.clip(np.round(start / (np.pi / 4)) * (np.pi / 4), lower, upper)
        home = arm.fk(start)[:3, 3]

        def things(given: list[dict[str, Any]]) -> str:
            shapes = []
            for thing in given:
                shape = f"bik.obstacles.Box({(home + thing['at']).tolist()}, {thing['size']})"
                moves = f"bik.obstacles.Moving({shape}, velocity={thing['velocity']})"
                shapes.append(moves if any(thing["velocity"]) else shape)
            return f"[{', '.join(shapes)}]"

        rates = zip(KINDS[: case["orders"]], case["rates"], strict=False)
        events = (
            f"({life['away']}, {life['ticks']}, {life['noise']}, {max(life['rare'], 1)}, "
            f"{None if life['given'] is None else things(life['given'])})"
            for life in case["life"]
        )
        return (
            f"robot, dt = bik.Robot.named('{case['arm']}').with_capsules(radius=0.05), {dt}\n"
            f"start = {start.tolist()}\nscene = {things(case['scene'])}\nlife = [{', '.join(events)}]\n"
            f"limits = bik.Limits({', '.join(f'{kind}={rate}' for kind, rate in rates)})\n"
            f"given = dict(limits=limits, obstacles=scene, margin={case['margin']})\n"
            f"tracker = bik.Tracker(robot, start, dt=dt, **given){STOPS}"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        for said, q in left["stops"]:
            steps = np.abs(np.diff(q, axis=0)).max(axis=1)
            moving = np.flatnonzero(steps > AT_REST)
            if moving.size and moving[-1] > round(said / case["dt"]):
                raise BrokenError("an arm is later at rest than its stop said", (said, case["dt"] * (moving[-1] + 1)))
        held, moves = left["held"], any(any(thing["velocity"]) for thing in case["scene"])
        fastest = max(np.abs(step.qd).max() for step in held[-10:])
        errors = np.array([[step.position_error, step.rotation_error] for step in (held[0], held[-1])])
        on_its_way = (errors[1] < NEARER * errors[0]).any()
        if not (moves or on_its_way) and held[-1].status != bik.Status.IN_COLLISION and fastest > SLOW:
            raise BrokenError("an arm moves whose target stands still", (fastest, held[-1].status.name))
        return len(left["stops"])


ATTACKS = [TrackerLives(), StopsAmongObstacles()]
