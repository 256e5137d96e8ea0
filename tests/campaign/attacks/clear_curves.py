"""The curve that drives execute close past thin bodies and around edges, judged between the ticks by coal."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from .. import arms, shapes
from ..attack import BrokenError, Case
from .clearance import EXACT, ROBOTS, Clear, placed
from .keeping import SAMPLES, executed

FARTHEST = 1.3  # m/rad: no point of an arm is farther from the axis of a joint

# Three slides that carry a ball: nothing bends between the ticks but the spline itself.
GANTRY = "".join(
    f"<link name='l{i}'/><joint name='j{i}' type='prismatic'><parent link='{f'l{i - 1}' if i else 'base'}'/>"
    f"<child link='l{i}'/><axis xyz='{axis}'/><limit lower='-2' upper='2' velocity='100' effort='1'/></joint>"
    for i, axis in enumerate(("1 0 0", "0 1 0", "0 0 1"))
)

# Half of the extents of a shape, in terms of its `size`.
HALF = {"sphere": np.ones(3), "capsule": np.array([1.0, 0.0, 0.0]), "box": np.full(3, 0.5)}

LIFE = """
q, statuses = [start], []
for target, ticks in life:
    for _ in range(ticks):
        step = tracker.step(np.array(target))
        q.append(step.q)
        statuses.append(step.status)
q = np.array(q)
"""


class ClearCurves(Clear):
    name = "clear_curves"
    promise = "Under acceleration and jerk limits the curve between the ticks keeps the margin, past rods and edges too"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard case is a gantry with targets at the faces, edges and corners of what is in its way."""
        name = "gantry" if hard else str(random.choice(list(ROBOTS)))
        robot = self.robot_of(name, radius := float(random.choice([0.002, 0.01, 0.03])))
        start = np.full(3, 0.5) if hard else 0.5 * (np.maximum(robot.lower, -2.5) + np.minimum(robot.upper, 2.5))
        home = np.zeros(3) if hard else robot.fk(start)[:3, 3]
        near = float(random.choice([0.0, 0.0, 0.001, 0.02]))
        scene, life = [], []
        for _ in range(int(random.integers(1, 5))):
            thing = self.thing(random, home + random.uniform(-0.3, 0.3, 3) * (0.3 if hard else 1.0))
            if shapes.clearance(robot, start, shapes.pieces(thing)) > near + 0.02:
                scene.append(thing)
        for _ in range(int(random.integers(100, 300) if hard else random.integers(3, 15))):
            target = home + random.normal(size=3) * 0.15
            if hard and scene and random.random() < 0.9:
                thing = scene[random.integers(len(scene))]
                beside = HALF[thing["kind"]] * np.array(thing["size"])
                beside += radius + near + random.choice([0.0, 1e-3, 0.01, 0.03])
                target = np.array(thing["center"]) + shapes.rotation(thing) @ (random.choice([-1, 0, 1], 3) * beside)
            life.append((arms.triple(target), int(random.integers(1, 15))))
        rates = {
            "velocity": random.choice([1.0, 3.0, 10.0]),
            "acceleration": random.choice([20.0, 100.0, 400.0] if hard else [5.0, 20.0, 100.0]),
        }
        if random.random() < 0.5:
            rates["jerk"] = random.choice([200.0, 2000.0, 20000.0])
        return {
            "robot": name, "radius": radius, "start": tuple(start.tolist()), "scene": scene, "life": life,
            "margin": near, "rates": tuple((kind, float(rate)) for kind, rate in rates.items()),
            "dt": float(random.choice([0.02, 0.05] if hard else [0.01, 0.02, 0.05])),
        }  # fmt: skip

    def thing(self, random: np.random.Generator, center: np.ndarray) -> shapes.Shape:
        """A small ball, a thin rod, or a box."""
        kind = str(random.choice(["sphere", "capsule", "box"]))
        size = {
            "sphere": random.choice([0.001, 0.01, 0.05]) * np.ones(3),
            "capsule": np.array([random.choice([0.001, 0.01]), 0.4, 0.0]),
            "box": random.uniform(0.004, 0.3, 3),
        }[kind]
        turned = arms.triple(random.uniform(-3, 3, 3)) if random.random() < 0.5 else (0.0, 0.0, 0.0)
        return {"kind": kind, "center": arms.triple(center), "rpy": turned, "size": arms.triple(size)}

    def robot_of(self, name: str, radius: float) -> bik.Robot:
        """The robot of a case."""
        return eval(self.expression(name, radius), {"bik": bik})

    def expression(self, name: str, radius: float) -> str:
        """The expression that makes it."""
        if name != "gantry":
            return f"bik.Robot.named({name!r}).with_capsules(radius={ROBOTS[name]})"
        model = f"<robot name='gantry'><link name='base'/>{GANTRY}</robot>"
        ball = ("l2", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), radius)
        return f'bik.Robot.from_urdf("{model}", tip="l2").with_capsules([{ball}])'

    def program(self, case: Case) -> str:
        scene = "".join(f"    {shapes.written(thing)},\n" for thing in case["scene"])
        limits = ", ".join(f"{kind}={rate}" for kind, rate in case["rates"])
        return (
            f"robot = {self.expression(case['robot'], case['radius'])}\nscene = bik.Scene([\n{scene}])\n"
            f"start, life = {case['start']}, {case['life']}\n"
            f"tracker = bik.Tracker(robot, start, dt={case['dt']}, limits=bik.Limits({limits}), obstacles=scene,\n"
            f"                      margin={case['margin']}){LIFE}"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        q, things, robot, least = left["q"], placed(case["scene"]), left["robot"], case["margin"] - EXACT
        if shapes.clearance(robot, q[0], things) < case["margin"] + EXACT:
            return 0  # it has to move out
        if bik.Status.IN_COLLISION in left["statuses"]:
            raise BrokenError("a tick is in collision", left["statuses"].index(bik.Status.IN_COLLISION))
        curve = executed(q, spline=True)
        far = FARTHEST * np.concatenate([[0.0], np.cumsum(np.abs(np.diff(curve, axis=0)).sum(axis=1))])
        i = 0
        while i < len(curve):
            apart = shapes.clearance(robot, curve[i], things)
            if apart < least:
                raise BrokenError("between ticks the curve is nearer than the margin", (i / SAMPLES, apart))
            i = max(i + 1, int(np.searchsorted(far, far[i] + apart - least)))  # nothing moves farther before
        return len(q)


ATTACKS = [ClearCurves()]
