"""What searches and closed forms promise: complete sets, the same bits, exact budgets, the best point kept."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case
from .solving import TURN, check_solution, inside, refuse_only_locked, size, wanted

SAME = 1e-5  # rad: solutions nearer than this are one
BESIDE = 5e-3  # rad: how far the tolerances admit configurations beside a solution
SINGULAR = 1e-6  # smallest singular value of the Jacobian below which solutions are not told apart


class CompleteSets(Attack):
    name = "complete_sets"
    promise = "A set of solutions that is called complete contains every solution that a search finds"
    page = "all_solutions"
    kinds = ("spherical", "parallel", "any", "planar", "five", "nearly", "nearly five")

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Arms with closed forms; hard poses are at limits, at zero, and those of arms that are off by a little."""
        kind = str(random.choice(self.kinds))
        joints = arms.easy_arm(random, {"planar": 3, "five": 5, "nearly five": 5}.get(kind, 6))
        for joint in joints:
            joint.update(kind="revolute", lower=-float(random.uniform(1, 6)), upper=float(random.uniform(1, 6)))
        if kind == "nearly five":  # flat beyond the first joint: half a turn of it nearly gives further solutions
            for joint, axis in zip(joints, ("z", "y", "y", "y", "x"), strict=True):
                x, _, z = joint["xyz"]
                joint.update(rpy=(0.0, 0.0, 0.0), xyz=(x, 0.0, z), axis=tuple(float(name == axis) for name in "xyz"))
        if kind in ("spherical", "nearly"):
            for joint in joints[4:]:
                joint["xyz"] = (0.0, 0.0, 0.0)
        if kind in ("parallel", "planar"):
            for joint in joints[1:] if kind == "planar" else joints[2:4]:
                joint.update(rpy=(0.0, 0.0, 0.0), axis=joints[0 if kind == "planar" else 1]["axis"])
        if kind in ("nearly", "nearly five"):
            most = -3 if kind == "nearly" else -6
            for joint in joints:
                off = 10.0 ** random.uniform(-9, most) * random.normal(size=3)
                joint["xyz"] = arms.triple(np.array(joint["xyz"]) + off)
        arms.put(joints, random, hard)
        return {"joints": joints, "starts": int(random.integers(2**31))}

    def program(self, case: Case) -> str:
        target = wanted(case).tolist()
        return f"{arms.written(case['joints'])}target = np.array({target})\nfound = bik.solve_all(robot, target)"

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        found, target, joints = left["found"], wanted(case), case["joints"]
        for solution in found:
            check_solution(case, solution, target, rotation=True)
        if not found.complete or found.singular:
            return 1
        lower, upper = arms.bounds(joints)
        starts = np.random.default_rng(case["starts"]).uniform(lower, upper, (60, len(lower)))
        known = inside(joints, np.vstack([arms.configurations(joints)[:1], arms.descended(joints, target, starts)]))
        poses, jacobians = arms.kinematics(joints, known)
        away, angle = arms.pose_error(poses, target)
        steepness = np.linalg.svd(jacobians, compute_uv=False)[:, -1]
        exact = (away < 1e-9 * size(case)) & (angle < 1e-9)
        within = (away < 5e-7) & (angle < 5e-7)  # half of the tolerances
        for which, same in ((exact, SAME), (within, BESIDE)):
            for q in known[which & (steepness > 1e-3)]:
                apart = found.q - q
                if not (np.abs(apart - TURN * np.round(apart / TURN)).max(axis=1, initial=0.0) < same).any():
                    raise BrokenError("a complete set lacks a solution", q.tolist())
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        refuse_only_locked(case, error)


class SameBits(Attack):
    name = "same_bits"
    promise = "The same call gives the same bits: for any number of threads, alone or in a batch, and after a pickle"
    page = "batches"
    options = (
        "", "goals=bik.goals.Centring()", "solver=bik.papers.BAS(), stop=bik.Stop(max_evaluations=300)",
        "solver=bik.papers.PSO(), stop=bik.Stop(max_evaluations=300)", "task=bik.tasks.Position()",
        "task=bik.tasks.Pointing()",
        "solver=bik.MultiStart(bik.LevenbergMarquardt())", "prefer='best', goals=bik.goals.Manipulability()",
    )  # fmt: skip

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (2, 8))
        arms.put(joints, random, hard, int(random.integers(2, 12)))
        option = int(random.integers(len(self.options)))
        return {
            "joints": joints,
            "shift": arms.triple(random.normal(0.0, 0.1, 3) * (random.random() < 0.3)),
            "option": option,
            "seed": int(random.integers(1000)),
        }

    def program(self, case: Case) -> str:
        poses = arms.kinematics(case["joints"], arms.configurations(case["joints"]))[0]
        poses[:, :3, 3] += np.array(case["shift"])
        options = f"seed={case['seed']}, {self.options[case['option']]}"
        return (
            f"import pickle\n{arms.written(case['joints'])}targets = np.array({poses.tolist()})\n"
            f"given = dict({options})\n"
            "one = bik.solve_batch(robot, targets, threads=1, **given)\n"
            "three = bik.solve_batch(robot, targets, threads=3, **given)\n"
            "fewer = bik.solve_batch(robot, targets[:-1], threads=2, **given)\n"
            "alone = bik.solve(robot, targets[0], **given)\n"
            "copied = bik.solve(pickle.loads(pickle.dumps(robot)), targets[0], **given)\n"
            "stored = pickle.loads(pickle.dumps(one))"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        one, alone = left["one"], left["alone"]
        for name, other in (
            ("threads", left["three"]),
            ("pickle", left["stored"]),
            ("length of the batch", left["fewer"]),
        ):
            count = len(other)
            for part in ("q", "status", "evaluations", "position_error", "rotation_error"):
                if getattr(one, part)[:count].tobytes() != getattr(other, part).tobytes():
                    raise BrokenError(f"other bits by {name}", part)
        for name, other in (("alone", alone), ("a copied robot", left["copied"])):
            if one.q[0].tobytes() != other.q.tobytes() or one.evaluations[0] != other.evaluations:
                raise BrokenError(f"other bits by {name}", (one.q[0].tolist(), other.q.tolist()))
        return len(one)

    def judge_refusal(self, case: Case, error: Exception) -> None:
        """Goals of arms that cannot have them are refused."""


class Budgets(Attack):
    name = "budgets"
    promise = "Budgets are exact, and the best point found is never lost, whatever a user's function returns"
    page = "limits"
    solvers = (
        "None",
        "bik.papers.BAS()",
        "bik.papers.PSO()",
        "bik.papers.QPSO()",
        "bik.papers.Genetic()",
        "bik.papers.Firefly()",
        "bik.papers.BeeColony()",
        "bik.papers.BeetleSwarm()",
        "bik.DifferentialEvolution()",
        "bik.papers.BeetleSwarm(direction='downhill')",
        "bik.MultiStart(bik.papers.BAS(variant='greedy'))",
        "bik.DifferentialEvolution(update='immediate')",
    )
    functions = ("float(np.sum((x - 0.3) ** 2))", "float(np.sum(x**4 - x**2))", "float(np.abs(x).max())")
    hard_functions = (
        "nan", "inf if x[0] > 0 else float(np.sum(x**2))", "-1e308 * float(np.sum(x**2))", "float(np.sign(x[0]))",
        "float(np.sum(x**2)) if len(seen) % 7 else nan", "float(np.sum(np.sin(1e6 * x)))", "0.0",
        "-inf if abs(x[0]) < 0.1 else 1.0",
    )  # fmt: skip

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        count = int(random.integers(1, 5))
        lower = random.normal(size=count) * (10.0 ** random.uniform(-6, 6) if hard else 1.0)
        width = np.abs(random.normal(size=count)) * (random.choice([0.0, 1e-12, 1.0, 1e6]) if hard else 1.0)
        functions = self.hard_functions if hard else self.functions
        return {
            "solver": str(random.choice(self.solvers)), "function": str(random.choice(functions)),
            "box": [(float(low), float(low + wide)) for low, wide in zip(lower, width, strict=True)],
            "budget": int(random.choice([1, 2, 7, 50] if random.random() < 0.3 else [50, 51, 97, 333])),
            "seed": int(random.integers(100)),
        }  # fmt: skip

    def program(self, case: Case) -> str:
        lower, upper = ([ends[side] for ends in case["box"]] for side in (0, 1))
        solver = "" if case["solver"] == "None" else f", solver={case['solver']}"
        return (
            "seen = []\n\n\ndef function(x):\n"
            f"    value = {case['function']}\n    seen.append((x.copy(), value))\n    return value\n\n\n"
            f"stop = bik.Stop(max_evaluations={case['budget']})\n"
            f"found = bik.minimize(function, {lower}, {upper}, seed={case['seed']}, stop=stop{solver})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        seen, found = left["seen"], left["found"]
        if not found.evaluations == len(seen) <= case["budget"]:
            raise BrokenError("the budget is not exact", (found.evaluations, len(seen), case["budget"]))
        lower, upper = np.array(case["box"]).T
        points, values = np.array([x for x, _ in seen]), np.array([value for _, value in seen])
        if ((points < lower) | (points > upper)).any():
            raise BrokenError("the function is asked outside the box", points.tolist()[:3])
        finite = values[np.isfinite(values)]
        if len(finite) and not found.value <= finite.min():
            raise BrokenError("the best value is lost", (found.value, finite.min()))
        if len(finite) and not any(np.array_equal(found.x, x) and value == found.value for x, value in seen):
            raise BrokenError("the best point was never asked", found.x.tolist())
        return len(seen)


class BestKept(Attack):
    name = "best_kept"
    promise = "A search that runs out of budget returns a configuration no worse than its start, inside the limits"
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (2, 8))
        arms.put(joints, random, hard, 2)
        by_derivative = ("LevenbergMarquardt", "APPS", "JacobianTranspose", "NewtonRaphson")
        solvers = [*Budgets.solvers[1:], *(f"bik.{name}()" for name in by_derivative)]
        shift = arms.triple(random.normal(size=3) * (random.random() < 0.3))
        return {
            "joints": joints, "solver": str(random.choice(solvers)), "shift": shift,
            "budget": int(random.choice([1, 2, 5, 50, 60, 200])), "seed": int(random.integers(100)),
        }  # fmt: skip

    def program(self, case: Case) -> str:
        start = arms.configurations(case["joints"])[1].tolist()
        return (
            f"{arms.written(case['joints'])}target = np.array({wanted(case)[:3, 3].tolist()})\n"
            f"start, stop = np.array({start}), bik.Stop(max_evaluations={case['budget']})\n"
            f"given = dict(solver={case['solver']}, stop=stop, seed={case['seed']})\n"
            "solution = bik.solve(robot, target, start_q=start, **given)"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        solution, target = left["solution"], wanted(case)
        check_solution(case, solution, target, rotation=False)
        at_start = arms.pose_error(arms.kinematics(case["joints"], left["start"][None])[0], target)[0][0]
        if solution.position_error > at_start * (1 + 1e-9) + 1e-12 * size(case):
            raise BrokenError("worse than the start", (solution.position_error, at_start))
        if solution.evaluations > case["budget"]:
            raise BrokenError("the budget is exceeded", (solution.evaluations, case["budget"]))
        return 1


ATTACKS = [CompleteSets(), SameBits(), Budgets(), BestKept()]
