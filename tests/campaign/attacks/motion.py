"""Motions in time: state to state against ruckig, timings against toppra, polynomials against numpy."""

from __future__ import annotations

import logging
from typing import Any

import numpy as np

import beetle_ik as bik

from .. import arms, ruckig_apart, typed
from ..attack import Attack, BrokenError, Case

RELATIVE = 1e-9  # excess over a limit that counts as rounding
ENDS = 1e-9  # rad
SAMPLES = 200  # a segment
SLOWER = 1.05  # a looser plan may take this much longer


def dense(motion: bik.Trajectory, order: int, samples: int = SAMPLES) -> np.ndarray:
    """Derivative of the motion by numpy, at many times of each segment: (segments, samples, n)."""
    powers = motion.coefficients
    for _ in range(order):
        powers = powers[:, :, 1:] * np.arange(1, powers.shape[2])
    widths = np.diff(motion.time)[:, None] * np.linspace(0.0, 1.0, samples)
    times = widths[:, :, None] ** np.arange(powers.shape[2])
    return np.einsum("stp,snp->stn", times, powers)


def check_rates(motion: bik.Trajectory, limits: dict[str, np.ndarray], slack: float = RELATIVE) -> None:
    """Checks velocity, acceleration and jerk of the polynomials at many times.

    Times are rounded, so that a velocity may be off by what an acceleration changes meanwhile, and so on.
    """
    resolution = 2.0 * np.spacing(motion.duration)
    kinds = ("velocity", "acceleration", "jerk")
    for order, (kind, rate) in enumerate(zip(kinds, (*kinds[1:], "jerk"), strict=True), 1):
        if kind in limits:
            rounding = resolution * limits[rate] if rate in limits and rate != kind else 0.0
            excess = ((np.abs(dense(motion, order)) - rounding) / limits[kind]).max(initial=0.0) - 1.0
            if not excess <= slack:
                raise BrokenError(f"the {kind} is beyond its limit", excess)


def _real_joint(random: np.random.Generator, hard: bool) -> Case:
    spread = 3.0 if hard else 0.7
    velocity, acceleration, jerk = np.exp(random.uniform(-spread, spread, 3)) * (1.5, 5.0, 50.0)
    at = random.uniform(-2, 2)
    far = random.uniform(-2, 2) if not hard or random.random() < 0.5 else at + 10.0 ** random.uniform(-9, -1)
    factor = random.choice([0.0, 1.0, 0.999999, 0.5]) if hard else 0.5
    signs = random.uniform(-1, 1, 2) if random.random() < 0.8 else random.choice([-1.0, 1.0], 2)
    speeds = velocity * factor * signs
    # What an acceleration may be at a speed: it must fade out before the limit.
    most = np.minimum(acceleration, np.sqrt(2 * jerk * np.maximum(0.0, velocity - np.abs(speeds))))
    rates = 0.99 * most * random.uniform(-1, 1, 2) * (random.random() < 0.7)
    return {
        "from": tuple(map(float, (at, speeds[0], rates[0]))),
        "to": tuple(map(float, (far, speeds[1], rates[1]))),
        "limits": tuple(map(float, (velocity, acceleration, jerk))),
    }


def _typed_joint(random: np.random.Generator) -> Case:
    limits = typed.limits(random)
    at = float(random.choice([0.0, 0.0, 1.0, -0.5, random.uniform(-2, 2)]))
    start = typed.rates(random, limits)
    end = (0.0, 0.0) if random.random() < 0.5 else typed.rates(random, limits, ends=True)
    return {
        "from": (at, *start),
        "to": (at + typed.displacement(random, limits), *end),
        "limits": limits,
    }


class StateToState(Attack):
    name = "state_to_state"
    promise = "Motions from state to state keep every limit, end exactly, and take no longer than those of ruckig"
    page = "motion"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Half of the joints have round limits that tie. Hard states are near each other, or limits very different."""
        halves = random.random(int(random.integers(1, 6))) < 0.5
        return {"joints": [_typed_joint(random) if is_typed else _real_joint(random, hard) for is_typed in halves]}

    def program(self, case: Case) -> str:
        columns = [
            [list(column) for column in zip(*(joint[key] for joint in case["joints"]), strict=True)]
            for key in ("from", "to", "limits")
        ]
        (q0, v0, a0), (q1, v1, a1), (velocity, acceleration, jerk) = columns
        return (
            f"limits = bik.Limits(velocity={velocity}, acceleration={acceleration}, jerk={jerk})\n"
            f"motion = bik.state_to_state({q0}, {q1}, limits, start_qd={v0}, start_qdd={a0}, end_qd={v1}, end_qdd={a1})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        motion = left["motion"]
        start, end, limits = (np.array([joint[key] for joint in case["joints"]]).T for key in ("from", "to", "limits"))
        kinds = dict(zip(("velocity", "acceleration", "jerk"), limits, strict=True))
        check_rates(motion, kinds, 1e-8)
        reach = motion.duration * limits[0].max()  # positions are as exact as those in between
        scale = np.array([1e-6 * reach, limits[0].max(), limits[1].max()])[:, None]
        for what, state, row in (("start", start, 0), ("end", end, -1)):
            found = np.array([dense(motion, order, 2)[row, row] for order in range(3)])
            resolution = 4.0 * np.spacing(motion.duration) * limits  # of times, see check_rates
            off = np.maximum(np.abs(found - state) - resolution, 0.0) / np.maximum(scale, 1.0)
            if off.max() > 1e-7:
                raise BrokenError(f"the motion misses its {what}", off.tolist())
        check_duration(motion, start, end, limits)
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        joints = case["joints"]  # when a case is made smaller, its numbers become zero
        right = all(
            min(joint["limits"]) > 0.0 and typed.stays(joint["limits"], joint["to"][1:], ends=True) for joint in joints
        )
        same = all(np.allclose(joint["from"], joint["to"], rtol=1e-14, atol=1e-300) for joint in joints)
        too_long = "times that long do not resolve its shortest phases" in str(error)  # years, as the page says
        if right and not same and not too_long:
            raise BrokenError("a right pair of states is refused", error)


def check_duration(motion: bik.Trajectory, start: np.ndarray, end: np.ndarray, limits: np.ndarray) -> None:
    """Checks that ruckig is not quicker, to where its motion really ends, if that keeps the limits."""
    theirs = ruckig_apart.motion(start, end, limits)
    if theirs is None or (np.array(theirs["rates"]) > limits[:2] * (1 + 1e-12)).any():
        return
    if motion.duration <= theirs["duration"] * (1 + 1e-6) + 1e-9:
        return
    there = np.array(theirs["end"])
    kinds = dict(zip(("velocity", "acceleration", "jerk"), limits.tolist(), strict=True))
    try:
        again = bik.state_to_state(
            start[0],
            there[0],
            bik.Limits(**kinds),
            start_qd=start[1],
            start_qdd=start[2],
            end_qd=there[1],
            end_qdd=there[2],
        )
    except bik.BeetleIkError:  # it ends outside the limits
        return
    if again.duration > theirs["duration"] * (1 + 1e-6) + 1e-9:
        raise BrokenError("slower than ruckig", (motion.duration, theirs["duration"]))


class TimeOptimal(Attack):
    name = "time_optimal"
    promise = (
        "Time-optimal motions keep velocity, acceleration and jerk limits at every instant and are as fast as toppra's"
    )
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard paths turn back, rest in some joints, have waypoints near each other, and very different limits."""
        n, k = int(random.integers(1, 8)), int(random.integers(2, 12))
        points = np.cumsum(random.normal(0.0, 0.5, (k, n)), axis=0)
        spread = 2.5 if hard else 0.5
        if hard:
            points[:, random.random(n) < 0.3] = 0.5
            if k > 3 and random.random() < 0.5:
                points[2] = points[1] + 10.0 ** random.uniform(-7, -2) * random.normal(size=n)
            if k > 3 and random.random() < 0.3:
                points[3] = points[1]
        limits = [tuple((np.exp(random.uniform(-spread, spread, 3)) * (1.5, 5.0, 50.0)).tolist()) for _ in range(n)]
        if random.random() < 0.5:
            points = np.round(points, 1)
            shared = typed.limits(random, -1, 1) if random.random() < 0.5 else None
            limits = [shared or typed.limits(random, -1, 2) for _ in range(n)]
        return {
            "points": [tuple(row) for row in points.tolist()],
            "limits": limits,
            "jerk": bool(random.random() < 0.3),
            "spline": str(random.choice(["natural", "natural", "clamped", "not-a-knot"])),
        }

    def program(self, case: Case) -> str:
        kinds = ("velocity", "acceleration", "jerk")[: 3 if case["jerk"] else 2]
        limits = ", ".join(
            f"{kind}={list(row)}" for kind, row in zip(kinds, zip(*case["limits"], strict=True), strict=False)
        )
        return (
            f"points = {case['points']}\nlimits = bik.Limits({limits})\n"
            f"motion = bik.time_optimal(points, limits, spline={case['spline']!r})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        motion, points = left["motion"], np.array(case["points"])
        velocity, acceleration, jerk = np.array(case["limits"]).T
        limits = {"velocity": velocity, "acceleration": acceleration} | ({"jerk": jerk} if case["jerk"] else {})
        check_rates(motion, limits, 1e-7)
        if np.abs(motion.q[[0, -1]] - points[[0, -1]]).max() > ENDS * (1 + np.abs(points).max()):
            raise BrokenError("the motion misses its ends", motion.q[[0, -1]].tolist())
        if not case["jerk"] and case["spline"] == "natural":
            theirs = toppra_duration(points, velocity, acceleration)
            if theirs is not None and motion.duration > 1.01 * theirs:
                raise BrokenError("slower than toppra", (motion.duration, theirs))
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        points = np.array(case["points"])
        if (np.abs(np.diff(points, axis=0)).max(axis=1) > 1e-9).all() and len(points) > 2:
            raise BrokenError("a right path is refused", error)


class Recordings(Attack):
    name = "recordings"
    promise = "Time-optimal motions with a tolerance stay within it, keep their limits, and never take longer for more"
    page = "planning"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Sines in the steps of an encoder, with rests; hard ones have joints that never move, and jumps."""
        n, rows = int(random.integers(1, 7)), int(random.integers(3, 200))
        progress = random.uniform(0, 10) * np.linspace(0, 1, rows)[:, None]
        phase = progress / random.uniform(0.5, 3, n) + random.normal(size=n)
        step = float(random.choice([2 * np.pi / 4096, 1e-3, 0.01, 0.1]))
        q = np.round(np.sin(phase) / step) * step
        if hard:
            q[:, random.random(n) < 0.3] = 0.5
            q[random.integers(0, rows) :] += random.choice([0.0, step, 1.0])
        at = int(random.integers(0, rows))
        q = np.insert(q, at, np.repeat(q[at : at + 1], int(random.integers(0, 20)), axis=0), axis=0)
        return {
            "rows": [tuple(row) for row in q.tolist()],
            "limits": typed.limits(random, -1, 2),
            "jerk": bool(random.random() < 0.4),
            "tolerance": float(random.choice([0.5, 1.0, 2.0, 10.0, random.uniform(0.1, 30)]) * step),
            "wider": float(random.choice([1.0, 1.5, 2.0, 4.0])),
        }

    def program(self, case: Case) -> str:
        kinds = ("velocity", "acceleration", "jerk")[: 3 if case["jerk"] else 2]
        limits = ", ".join(f"{kind}={value}" for kind, value in zip(kinds, case["limits"], strict=False))
        return (
            f"rows = {case['rows']}\nlimits = bik.Limits({limits})\n"
            "exact = bik.time_optimal(rows, limits)\n"
            f"motion = bik.time_optimal(rows, limits, tolerance={case['tolerance']})\n"
            f"wider = bik.time_optimal(rows, limits, tolerance={case['tolerance'] * case['wider']})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        rows, motion = np.array(case["rows"]), left["motion"]
        kinds = ("velocity", "acceleration", "jerk")[: 3 if case["jerk"] else 2]
        limits = {kind: np.full(rows.shape[1], value) for kind, value in zip(kinds, case["limits"], strict=False)}
        check_rates(motion, limits, 1e-7)
        durations = [left[name].duration for name in ("wider", "motion", "exact")]
        if (np.diff(durations) < -1e-9 * durations[0]).any():  # a timing under jerk limits ends at about that
            raise BrokenError("more tolerance takes longer", durations)
        passed = motion.at(np.linspace(0, motion.duration, 4000))[0]
        # Rows lie on the path; joints move little between two of 4,000 samples.
        gap = np.abs(np.diff(passed, axis=0)).max()
        missed = max(np.abs(passed - row).max(axis=1).min() for row in rows[:: max(1, len(rows) // 50)])
        if missed > case["tolerance"] + gap:
            raise BrokenError("the motion leaves its tolerance", (missed, case["tolerance"]))
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        if (np.ptp(np.array(case["rows"]), axis=0) > 0).any():
            raise BrokenError("a recording is refused", error)


def toppra_duration(points: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray) -> float | None:
    """How long toppra takes on the natural spline; None if it fails."""
    import toppra
    from toppra import algorithm, constraint

    logging.getLogger("toppra").setLevel(logging.CRITICAL)
    path = toppra.SplineInterpolator(np.linspace(0, 1, len(points)), points, bc_type="natural")
    grid = np.linspace(0, 1, 501)
    limits = [
        constraint.JointVelocityConstraint(np.column_stack((-velocity, velocity))),
        constraint.JointAccelerationConstraint(np.column_stack((-acceleration, acceleration))),
    ]
    _, speeds, _ = algorithm.TOPPRA(limits, path, gridpoints=grid).compute_parameterization(0, 0)
    return (
        None
        if speeds is None or np.isnan(speeds).any()
        else float(np.sum(2 * np.diff(grid) / (speeds[1:] + speeds[:-1])))
    )


class JointPlans(Attack):
    name = "joint_plans"
    promise = "Plans between configurations keep limits up to jerk at every instant, with lines at their ends too"
    page = "planning"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Limits are round and tie; hard configurations are at limits and at zero, or have joints in common."""
        joints = arms.easy_arm(random, int(random.integers(1, 8)))
        arms.put(joints, random, hard, 2)
        shared = [typed.limits(random, -1, 1) for _ in range(2)] if random.random() < 0.6 else None
        for joint in joints:
            joint["rates"], joint["slower"] = shared or [typed.limits(random, -1, 2) for _ in range(2)]
            joint["share"] = float(random.choice([0.0, 0.0, 0.5, 1.0, -1.0]))
            if hard and random.random() < 0.3:
                joint["at"] = (joint["at"][0],) * 2
        begins = ("rest", "rest", "zero", "moving", "line", "free")
        return {"joints": joints, "orders": int(random.integers(1, 4)), "begin": str(random.choice(begins))}

    def limits(self, case: Case, name: str = "rates") -> dict[str, np.ndarray]:
        """The limits of the free joints."""
        rates = np.array([joint[name] for joint in arms.free(case["joints"])])
        return dict(zip(("velocity", "acceleration", "jerk")[: case["orders"]], rates.T, strict=False))

    def program(self, case: Case) -> str:
        first, last = arms.configurations(case["joints"])
        speeds = [joint["share"] * joint["rates"][0] for joint in arms.free(case["joints"])]
        begin = {
            "zero": f", start_qd={[0.0] * len(first)}",
            "moving": f", start_qd={speeds}",
            "line": ", retreat=0.02, approach=0.01",
            "free": ", free_start=True",
        }.get(case["begin"] if case["orders"] > 1 else "rest", "")
        limits, slower = (
            ", ".join(f"{kind}={values.tolist()}" for kind, values in self.limits(case, name).items())
            for name in ("rates", "slower")
        )
        return (
            f"{arms.written(case['joints'])}limits = bik.Limits({limits})\n"
            f"given = dict(start_q={first.tolist()}, end_q={last.tolist()}, limits=limits{begin})\n"
            "plan = bik.plan_point_to_point(robot, **given)\n"
            f"again = plan.retime(bik.Limits({slower})) if plan.success else None"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        ends = arms.configurations(case["joints"])
        for plan, name in ((left["plan"], "rates"), (left["again"], "slower")):
            if plan is None or not plan.success:
                raise BrokenError("a straight motion is not found", getattr(plan, "message", ""))
            motion, limits = plan.trajectory, self.limits(case, name)
            check_rates(motion, limits, 1e-8)
            missed = motion.q[[0, -1]] - ends
            missed[1] -= 2 * np.pi * np.round(missed[1] / (2 * np.pi))  # joints without limits go the short way round
            if np.abs(missed).max() > ENDS:
                raise BrokenError("the plan misses its ends", motion.q[[0, -1]].tolist())
            for order in range(len(limits)):
                ends_of_segments = dense(motion, order, 2)
                jump = np.abs(np.diff(ends_of_segments.reshape(-1, len(ends[0])), axis=0)[1::2]).max(initial=0.0)
                if jump > 1e-6 * max(1.0, np.abs(ends_of_segments).max()):
                    raise BrokenError(f"derivative {order} jumps", jump)
        return 2

    def judge_refusal(self, case: Case, error: Exception) -> None:
        same = np.ptp(arms.configurations(case["joints"]), axis=0).max() == 0.0
        said = str(error)
        allowed = {
            "moving": "would get to" in said,  # too fast to stop before a position limit
            "line": "no straight" in said,
        }.get(case["begin"], False)
        jumps = "jumps" in said and case["orders"] == 3 and case["begin"] == "moving"  # from a velocity, retimed
        if not (same or allowed or jumps):
            raise BrokenError("a right plan is refused", error)


class Trajectories(Attack):
    name = "trajectories"
    promise = "A trajectory is its polynomials: samples, largest rates, files and pickles agree with them"
    page = "motion"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard ones have segments of very different length and rates."""
        n, k = int(random.integers(1, 5)), int(random.integers(2, 9))
        steps = 10.0 ** random.uniform(-5, 3, k - 1) if hard else random.uniform(0.1, 2.0, k - 1)
        rows = [
            {
                "step": float(step),
                "q": tuple(random.normal(size=n).tolist()),
                "qd": tuple(random.normal(size=n).tolist()),
                "qdd": tuple(random.normal(size=n).tolist()),
            }
            for step in [0.0, *steps]
        ]
        return {"rows": rows, "order": int(random.integers(0, 3))}

    def program(self, case: Case) -> str:
        time = np.cumsum([row["step"] for row in case["rows"]]).tolist()
        given = "".join(
            f", {name}={[list(row[name]) for row in case['rows']]}" for name in ("qd", "qdd")[: case["order"]]
        )
        return (
            f"import pickle\nq = {[list(row['q']) for row in case['rows']]}\n"
            f"motion = bik.Trajectory.from_samples({time}, q{given})\n"
            "motion.to_npz('motion.npz')\nmotion.to_csv('motion.csv')\n"
            "npz, csv = bik.Trajectory.from_npz('motion.npz'), bik.Trajectory.from_csv('motion.csv')\n"
            "most = motion.max_velocity(), motion.max_acceleration(), motion.max_jerk()\n"
            "copy = pickle.loads(pickle.dumps(motion))"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        motion = left["motion"]
        if not motion == left["npz"] == left["copy"]:
            raise BrokenError("a stored trajectory differs")
        off = np.abs(motion.q - left["csv"].q).max()
        powers = np.diff(motion.time)[:, None, None] ** np.arange(motion.coefficients.shape[2])
        if off > 1e-13 * np.abs(motion.coefficients * powers).max() or not np.array_equal(
            motion.time, left["csv"].time
        ):
            raise BrokenError("a trajectory written as CSV differs", off)
        for order, most in enumerate(left["most"], 1):
            sampled = np.abs(dense(motion, order)).max(axis=(0, 1)) if motion.coefficients.shape[2] > order else 0.0
            if not (sampled <= most * (1 + 1e-9) + 1e-12 * np.abs(motion.coefficients).max()).all():
                raise BrokenError(
                    f"the largest derivative {order} is too small", (most.tolist(), np.asarray(sampled).tolist())
                )
        for row, (start, width) in enumerate(zip(motion.time[:-1], np.diff(motion.time), strict=True)):
            at = np.array(motion.at(start + 0.3 * width)[:2])
            powers = (start + 0.3 * width - start) ** np.arange(motion.coefficients.shape[2])
            off = np.abs(at[0] - motion.coefficients[row] @ powers).max()
            if off > 1e-9 * (1 + np.abs(motion.coefficients[row] * powers).max()):
                raise BrokenError("a sample is not its polynomial", off)
        return len(case["rows"])

    def judge_refusal(self, case: Case, error: Exception) -> None:
        if (
            all(row["step"] > 1e-9 for row in case["rows"][1:])
            and case["rows"][0]["step"] == 0.0
            and len(case["rows"]) > 1
        ):
            raise BrokenError("right samples are refused", error)


class LooserPaths(Attack):
    name = "looser_paths"
    promise = (
        "A path that is followed is followed with wider tolerances, limits or speeds too, as quickly by an arm of six "
        "joints, and no point is called unreachable that has a configuration"
    )
    page = "planning"
    names = ("iiwa14", "panda", "ur5e", "kr210", "gen3", "ur10", "fr3")
    places = (0.0, 0.0, 0.0, 0.25, -0.25, 0.5, -0.5, 1.0, -1.0, 1 / 3, -1 / 6)  # of pi
    refusals = ()

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A line in joint space makes the path; a hard one passes round places, rests in joints and touches limits."""
        joints = None if random.random() < 0.7 else arms.easy_arm(random, int(random.integers(4, 8)))
        name = str(random.choice(self.names))
        robot = bik.Robot.named(name) if joints is None else bik.Robot.from_urdf(arms.urdf(joints))
        lower, upper = np.maximum(robot.lower, -3.2), np.minimum(robot.upper, 3.2)
        n = len(lower)
        first, last = (lower + (upper - lower) * random.random(n) for _ in range(2))
        if hard:
            round_ones = np.clip(np.pi * random.choice(self.places, (2, n)), lower, upper)
            first = np.where(random.random(n) < 0.7, round_ones[0], first)
            last = np.where(random.random(n) < 0.3, first, np.where(random.random(n) < 0.5, round_ones[1], last))
        last = first + float(random.choice([0.15, 0.4, 0.7])) * (last - first)
        if not np.abs(last - first).max() > 1e-3:
            last[0] = first[0] + (0.3 if first[0] + 0.3 < upper[0] else -0.3)
        widened = [random.random(6) < 0.5, np.arange(6) >= 3, np.ones(6, bool)][random.integers(3)]
        return {
            "name": name,
            "joints": None if joints is None else tuple(joints),
            "line": tuple(zip(first.tolist(), last.tolist(), strict=True)),
            "points": int(random.choice([40, 80])),
            "widened": tuple(map(bool, widened)),
            "ladder": str(random.choice(["tolerance", "tolerance", "window", "speed"])),
            "tightest": float(10.0 ** random.uniform(-3, -1)),
        }

    def program(self, case: Case) -> str:
        made = f"robot = bik.Robot.named({case['name']!r})\n"
        if case["joints"] is not None:
            made = arms.written(list(case["joints"]))
        first, last = (list(ends) for ends in zip(*case["line"], strict=True))
        ladder = {
            "tolerance": [[t if wide else 1e-4 for wide in case["widened"]] for t in (1e-4, 1e-3, 1e-2, 1e-1)],
            "window": [case["tightest"], 0.3, np.inf],
            "speed": [1.0, 2.0],
        }[case["ladder"]]
        return (
            f"{made}first, last = np.array({first}), np.array({last})\n"
            f"line = np.linspace(first, last, {case['points']})\n"
            "poses, low, high = robot.fk(line), line.min(axis=0), line.max(axis=0)\n\n\n"
            "def planned(tolerance=None, window=inf, speed=1.0):\n"
            "    lower, upper = np.maximum(robot.lower, low - window), np.minimum(robot.upper, high + window)\n"
            "    limits = bik.Limits(lower=lower, upper=upper, velocity=speed, acceleration=5.0 * speed)\n"
            "    task = tolerance and bik.tasks.Pose(tolerance=tolerance)\n"
            "    given = dict(limits=limits, task=task, stop=bik.Stop(max_evaluations=200))\n"
            "    try:\n"
            "        plan = bik.plan_along_path(robot, poses, **given)\n"
            "    except bik.InvalidInputError as error:\n"
            "        return False, inf, str(error)\n"
            "    return plan.success, plan.cost, plan.message\n\n\n"
            f"plans = [planned({case['ladder']}=value) for value in {ladder}]"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        """Plans of redundant arms are searched for, at random, and so not compared by their duration."""
        least, is_exact = np.inf, case["joints"] is None and len(case["line"]) == 6
        for success, cost, message in left["plans"]:
            if "cannot be reached" in message and "between points" not in message:
                raise BrokenError("a point that has a configuration is called unreachable", message)
            if not success and least < np.inf:
                raise BrokenError(f"no plan with a wider {case['ladder']}", message)
            if success and is_exact and cost > SLOWER * least:
                raise BrokenError(f"slower with a wider {case['ladder']}", (cost, least))
            least = min(least, cost if success else np.inf)
        return len(left["plans"])


ATTACKS = [StateToState(), TimeOptimal(), Recordings(), JointPlans(), Trajectories(), LooserPaths()]
