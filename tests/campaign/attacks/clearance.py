"""What is called clear, against coal."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from .. import arms, shapes
from ..attack import Attack, BrokenError, Case
from .motion import check_rates

EXACT = 2e-6  # m: what coal is exact to
BELOW = 1e-7  # m: by how much a distance may be below the true one
ROBOTS = {"panda": 0.05, "ur5e": 0.04, "iiwa14": 0.06}  # and the radius of their links (m)


def check_said(said: float, exact: float, what: str) -> None:
    """Checks a clearance; how deep bodies overlap is measured in another way by coal."""
    if said > max(exact, 0.0) + EXACT:
        raise BrokenError(f"the clearance of {what} is above the true one", (said, exact))


def placed(scene: list[shapes.Shape]) -> list[shapes.Placed]:
    """All pieces of a scene."""
    return [piece for thing in scene for piece in shapes.pieces(thing)]


def nearest(own: shapes.Shape, other: shapes.Shape) -> float:
    """The distance of two shapes."""
    return min(shapes.apart(one, two) for one in shapes.pieces(own) for two in shapes.pieces(other))


class Distances(Attack):
    name = "distances"
    promise = "A distance is never above the true one, and at most 1e-7 m below, 1e-9 m between capsules"
    page = "scenes"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        own = shapes.shape(random, random.uniform(-0.5, 0.5, 3), 0.4, hard, shapes.CONVEX)
        near = 0.0 if hard and random.random() < 0.2 else random.uniform(0.2, 1.5)
        if near == 0.0 and random.random() < 0.5:  # deep inside
            own["size"] = shapes.arms.triple(0.1 * np.array(own["size"]))
        return {
            "own": own,
            "other": shapes.shape(random, np.array(own["center"]) + random.normal(size=3) * near, 0.4, hard),
        }

    def program(self, case: Case) -> str:
        return (
            "robot = bik.Robot.planar([1.0])\nframe = robot.link_poses([0.0])[-1]\n"
            f"own, other = {shapes.written(case['own'])}, {shapes.written(case['other'])}\n"
            "robot = robot.with_base(bik.pose(-frame[:3, 3])).with_attached(robot.link_names[-1], own)\n"
            "robot = robot.with_collision_pairs([])\ndistance = bik.obstacles.clearance(robot, [0.0], [other])"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        exact, found = nearest(case["own"], case["other"]), left["distance"]
        if exact <= EXACT or found <= EXACT:
            if max(exact, found) > 2 * EXACT:
                raise BrokenError("one says that they overlap", (found, exact))
        elif found > exact + EXACT:
            raise BrokenError("the distance is above the true one", (found, exact))
        elif found < exact - EXACT - BELOW:
            raise BrokenError("the distance is below the true one", (found, exact))
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        """Shapes too thin for their size are refused."""


class AnySize(Attack):
    """Two shapes as in `Distances`, magnified by a power of two, which changes nothing but the exponents."""

    name = "any_size"
    promise = "No shape of any size and at any place is called clear of what it is not clear of"
    page = "scenes"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard ones are so small or large that squares of their coordinates vanish or overflow."""
        case = Distances().draw(random, hard=False)
        return case | {"power": int(random.integers(-1060, 1020) if hard else random.integers(-40, 333))}

    def program(self, case: Case) -> str:
        return (
            "robot = bik.Robot.planar([1.0])\nframe = robot.link_poses([0.0])[-1]\n"
            f"own = {shapes.written(case['own'], case['power'])}\n"
            f"other = {shapes.written(case['other'], case['power'])}\n"
            "robot = robot.with_base(bik.pose(-frame[:3, 3])).with_attached(robot.link_names[-1], own)\n"
            "robot = robot.with_collision_pairs([])\ndistance = bik.obstacles.clearance(robot, [0.0], [other])\n"
            "found = bik.solve(robot, robot.fk([0.0]), obstacles=[other], margin=0.0)"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        unit = 2.0 ** case["power"]
        exact, said = nearest(case["own"], case["other"]), left["distance"]
        if not said <= max(exact, 0.0) * unit + EXACT * unit + 1e-15:
            raise BrokenError("the distance is above the true one", (said, exact * unit))
        if left["found"].success and exact < -EXACT and unit > 1e-9:
            raise BrokenError("a solution that overlaps is called clear", (said, exact * unit))
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        """Sizes that no shape can have are refused."""


class Clear(Attack):
    """A robot with capsules, a configuration or two, and a scene about it."""

    page = "scenes"
    things = (1, 7)

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard scenes are close to the arm, and its configurations at limits."""
        made = self.drawn(random)
        robot = eval(made, {"bik": bik})
        tried = robot.random_configurations(40, seed=int(random.integers(2**31)))
        ends = tried[np.argsort(-bik.obstacles.clearance(robot, tried))[:4]]
        if hard:  # the second one is at a limit
            joint, before = random.integers(robot.dof), ends[1].copy()
            ends[1, joint] = np.clip(robot.upper[joint], -3.0, 3.0)
            ends[1] = ends[1] if bik.obstacles.clearance(robot, ends[1]) > 0.02 else before
        scene, alone = [], robot.with_collision_pairs([])
        for _ in range(int(random.integers(*self.things))):
            links = robot.all_link_poses(ends[random.integers(4)])
            link = links[random.integers(1, len(links)), :3, 3]
            thing = shapes.shape(random, link + random.normal(0.0, 0.1 if hard else 0.3, 3), 0.25, hard=False)
            near = min(shapes.clearance(alone, q, shapes.pieces(thing)) for q in ends[:2])
            if near > 0.03 or random.random() < 0.1:
                scene.append(thing)
        margin = random.choice([0.0, 0.001, 0.02])
        return {
            "robot": made,
            "ends": ends.tolist(),
            "scene": scene,
            "margin": float(margin),
            "seed": int(random.integers(2**31)),
        }

    def drawn(self, random: np.random.Generator) -> str:
        """The expression that makes a robot with capsules: a named one."""
        name = str(random.choice(list(ROBOTS)))
        return f"bik.Robot.named({name!r}).with_capsules(radius={ROBOTS[name]})"

    def made(self, case: Case) -> str:
        """The lines that make robot, configurations and scene."""
        scene = "".join(f"    {shapes.written(thing)},\n" for thing in case["scene"])
        return f"robot = {case['robot']}\nends = np.array({case['ends']})\nscene = bik.Scene([\n{scene}])\n"

    def check_clear(self, case: Case, robot: bik.Robot, q: np.ndarray, said: float, what: str) -> None:
        """Checks a configuration that is called clear."""
        exact = shapes.clearance(robot, q, placed(case["scene"]))
        if exact < case["margin"] - EXACT:
            raise BrokenError(f"{what} is called clear", f"{exact} of {case['margin']} m")
        check_said(said, exact, what)


class ClearSolutions(Clear):
    name = "clear_solutions"
    promise = "A solution among obstacles is clear by the margin, of obstacles and of the robot's own links"

    def program(self, case: Case) -> str:
        return (
            f"{self.made(case)}targets = robot.fk(ends)\n"
            f"found = bik.solve_batch(robot, targets, obstacles=scene, margin={case['margin']}, threads=1)\n"
            f"every = bik.solve_all(robot, targets[0], obstacles=scene, margin={case['margin']})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        robot = left["robot"]
        for solution in [*left["found"], *left["every"]]:
            if solution.success:
                self.check_clear(case, robot, solution.q, solution.clearance, "a solution")
        blocked = [i for i, solution in enumerate(left["found"]) if solution.status == bik.Status.IN_COLLISION]
        scene = placed(case["scene"])
        for i in blocked:
            if robot.dof == 6 and shapes.clearance(robot, left["ends"][i], scene) > case["margin"] + EXACT:
                raise BrokenError("a clear solution exists, and IN_COLLISION is said", left["ends"][i].tolist())
        return len(left["found"]) + len(left["every"])


class ClearPlans(Clear):
    name = "clear_plans"
    promise = "A plan that is called clear keeps its margin and its limits at every instant"
    # Limits on velocity, acceleration and jerk: in most of them two are reached at once.
    rates = ((2.0, 5.0), (2.0, 5.0, 50.0), (1.0, 10.0, 100.0), (0.5, 5.0, 50.0), (2.0, 10.0, 50.0), (1.0, 1.0, 1.0))

    def limits(self, case: Case) -> dict[str, float]:
        """Its limits by name."""
        return dict(zip(("velocity", "acceleration", "jerk"), self.rates[case["seed"] % len(self.rates)], strict=False))

    def program(self, case: Case) -> str:
        return (
            f"{self.made(case)}limits = bik.Limits(**{self.limits(case)})\n"
            f"given = dict(limits=limits, obstacles=scene, margin={case['margin']})\n"
            "plan = bik.plan_point_to_point(robot, start_q=ends[0], end_q=ends[1], end_turns='as_given', **given)"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        plan = left["plan"]
        if not plan.success:
            return 1
        motion, robot = plan.trajectory, left["robot"]
        check_rates(motion, {kind: np.full(robot.dof, rate) for kind, rate in self.limits(case).items()}, 1e-6)
        if np.abs(motion.q[[0, -1]] - left["ends"][:2]).max() > 1e-7:
            raise BrokenError("the plan misses its ends", motion.q[[0, -1]].tolist())
        for q in motion.at(np.linspace(0.0, motion.duration, 150))[0]:
            self.check_clear(case, robot, q, -np.inf, "a plan")
        return 1


class TwoArmPlans(ClearPlans):
    name = "two_arm_plans"
    promise = "A plan of two arms on a torso keeps its margin between the arms too"

    def drawn(self, random: np.random.Generator) -> str:
        """Two arms of three to seven joints each."""
        torso, left, right = (arms.easy_arm(random, n) for n in (1, *random.integers(3, 8, 2)))
        branches = {"l": [*torso, *left], "a": right}
        tips = [f"{name}{len(joints)}" for name, joints in branches.items()]
        capsules = [
            (f"{name}{i}", (0.0, 0.0, 0.0), joint["xyz"], 0.02)
            for name, joints in branches.items()
            for i, joint in enumerate(joints)
            if i > 0
        ]
        return f'bik.Robot.from_urdf("""{arms.urdf(*branches.values())}""", tip={tips}).with_capsules({capsules})'


class ClearTicks(Clear):
    name = "clear_ticks"
    promise = "Among obstacles no tick comes nearer than the margin, between ticks too, while scenes come and go"

    def program(self, case: Case) -> str:
        orders = ("velocity=1.5", "velocity=1.5, acceleration=5.0", "velocity=1.5, acceleration=5.0, jerk=50.0")
        return (
            f"{self.made(case)}limits = bik.Limits({orders[case['seed'] % 3]})\n"
            f"given = dict(limits=limits, obstacles=scene, margin={case['margin']})\n"
            "tracker = bik.Tracker(robot, ends[0], dt=0.01, **given)\n"
            "ways = []\n"
            "for tick in range(160):\n"
            "    for _ in range(round(tracker.stop() / 0.01) + 2 if tick == 80 else 0):  # at rest when it comes back\n"
            "        tracker.step(None)\n"
            "    if tick % 40 == 0:  # the last obstacle goes and comes back\n"
            "        tracker.obstacles = scene if tick % 80 == 0 else scene[:-1]\n"
            "    before, step = tracker.q, tracker.step(robot.fk(ends[1 + tick // 55]))\n"
            "    ways.append((tick % 80 < 40, before, step.q, step.clearance, step.status))"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        robot, margin = left["robot"], case["margin"]
        kept = [placed(case["scene"][:-1]), placed(case["scene"])]
        clear = False
        for whole, before, after, said, status in left["ways"]:
            things = kept[whole]
            at_first = shapes.clearance(robot, before, things)
            now = shapes.clearance(robot, after, things)
            check_said(said, now, "a tick")
            clear = at_first >= margin + EXACT  # a scene that comes back may stand where the arm is
            if clear and min(now, shapes.clearance(robot, 0.5 * (before + after), things)) < margin - EXACT:
                raise BrokenError("a tick is nearer than the margin", (at_first, now, margin))
            if status != bik.Status.IN_COLLISION and now < margin - EXACT:
                raise BrokenError("a tick in collision is not called so", (now, margin, status))
        return len(left["ways"])


ATTACKS = [Distances(), AnySize(), ClearSolutions(), ClearPlans(), TwoArmPlans(), ClearTicks()]
