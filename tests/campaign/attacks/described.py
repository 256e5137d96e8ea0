"""Robot files as they are written: MuJoCo models with equality constraints, and URDFs with missing or zero speeds."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from ..attack import Attack, BrokenError, Case

JOINTS = ("a", "b", "c", "d", "f", "g")  # four to the tip, and one in each finger
OPEN = 1e-3  # m, rad: more than the file's rounding, which the reader allows


class Equalities(Attack):
    """Joint couplings, locks and loops, on the chain and beside it."""

    name = "equalities"
    promise = "Each configuration of a MuJoCo model can keep its equalities, or the model is refused"
    page = "robots"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        def number() -> float:
            return float(random.choice([0.0, 1.0, -1.0, 0.5, random.uniform(-1, 1)]))

        def coupling() -> tuple[Any, ...]:
            follower, master = (int(i) for i in random.permutation(len(JOINTS))[:2])
            bends = [number() if hard and random.random() < 0.2 else 0.0 for _ in range(3)]
            lock = random.random() < 0.2
            return (follower, -1 if lock else master, number() / 4, number(), *bends, bool(random.random() < 0.9))

        loops = [(str(random.choice(["connect", "weld"])), *self._bodies(random)) for _ in range(int(hard))]
        joints = [
            (
                str(random.choice(["hinge", "hinge", "slide"])),
                tuple(int(i) for i in random.permutation([0, 0, 1])),
                number(),
            )
            for _ in JOINTS
        ]
        return {
            "joints": tuple(joints),
            "couplings": [coupling() for _ in range(random.integers(0, 4))],
            "loops": loops if random.random() < 0.5 else [],
        }

    def _bodies(self, random: np.random.Generator) -> tuple[str, str]:
        one, other = random.permutation(len(JOINTS))[:2]
        return f"body_{JOINTS[one]}", f"body_{JOINTS[other]}"

    def program(self, case: Case) -> str:
        return (
            f"model = '''{model(case)}'''\nrobot = bik.Robot.from_mjcf(model, tip='tool')\n"
            "q = robot.random_configurations(2, seed=1)\ntips = robot.fk(q)[:, :3, 3]"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        from scipy.optimize import least_squares

        robot, oracle = left["robot"], Oracle(left["model"], case)
        for q, tip in zip(left["q"], left["tips"], strict=True):
            known = dict(zip(robot.joint_names, q, strict=True))
            others = [name for name in JOINTS if name not in known]

            def error(x: Any, known: Any = known, others: Any = others, tip: Any = tip) -> Any:
                return oracle.error(known | dict(zip(others, x, strict=True)), tip)

            if not others:
                open_by = np.abs(error(np.zeros(0))).max()
            else:
                random = np.random.default_rng(0)
                starts = [
                    oracle.linear_start(known, others),
                    oracle.followed_start(known, others),
                    *random.uniform(-1, 1, (6, len(others))),
                    *random.uniform(-9, 9, (40, len(others))),  # a power of four goes far
                ]
                ends = (np.abs(least_squares(error, start).fun).max() for start in starts)
                open_by = np.inf
                while open_by > OPEN and (end := next(ends, None)) is not None:
                    open_by = min(open_by, end)
            if open_by > OPEN and oracle.on_chain:
                raise BrokenError("an equality of the chain is open", open_by)
        return len(left["q"])

    def judge_refusal(self, case: Case, error: Exception) -> None:
        """Linear couplings that agree with each other are not refused."""
        linear = [entry for entry in case["couplings"] if entry[-1]]
        if case["loops"] or any(any(entry[4:7]) and entry[1] >= 0 for entry in linear):
            return
        rows, totals = np.zeros((len(linear), len(JOINTS))), np.zeros(len(linear))
        for i, (follower, master, constant, scale, *_) in enumerate(linear):
            rows[i, follower] += 1.0
            totals[i] = constant
            if master >= 0:
                rows[i, master] -= scale
        # In offsets from the reference positions.
        agree = (
            np.linalg.matrix_rank(np.column_stack([rows, totals])) == np.linalg.matrix_rank(rows) if linear else True
        )
        if agree and "is not followed" in str(error):
            raise BrokenError("linear couplings that agree are refused", error)


class Oracle:
    """Residuals of the equalities and of the tip, by MuJoCo's kinematics alone."""

    def __init__(self, text: str, case: Case) -> None:
        import mujoco

        self.mujoco, self.model, self.case = mujoco, mujoco.MjModel.from_xml_string(text), case
        self.data, self.reference = mujoco.MjData(self.model), mujoco.MjData(self.model)
        mujoco.mj_kinematics(self.model, self.reference)
        # Equalities among fingers alone bind no joint of the chain: what they say is about held joints.
        beside = {4, 5}
        self.couplings = [entry for entry in case["couplings"] if entry[-1] and not {*entry[:2]} - {-1} <= beside]
        self.loops = [loop for loop in case["loops"] if not {loop[1], loop[2]} <= {"body_f", "body_g"}]
        self.on_chain = bool(self.couplings or self.loops)

    def error(self, positions: dict[str, float], tip: Any) -> Any:
        rest = {name: float(self.model.joint(name).qpos0[0]) for name in JOINTS}
        for name, value in positions.items():
            self.data.joint(name).qpos = value
        self.mujoco.mj_kinematics(self.model, self.data)
        off = {name: positions[name] - rest[name] for name in JOINTS}
        parts = [self.data.site("tool").xpos - tip]
        for follower, master, *factors, _ in self.couplings:
            at = off[JOINTS[master]] if master >= 0 else 0.0
            parts.append(np.atleast_1d(off[JOINTS[follower]] - np.polyval(factors[::-1], at)))
        for kind, one, other in self.loops:
            seen, first = self._relative(self.data, one, other), self._relative(self.reference, one, other)
            parts.append(seen[0] - first[0] if kind == "connect" else np.ravel(seen[0] - first[0]))
            parts += [np.ravel(seen[1] - first[1])] if kind == "weld" else []
        return np.concatenate(parts)

    def linear_start(self, known: dict[str, float], others: list[str]) -> Any:
        """Positions of the other joints where all couplings are linear."""
        rest = {name: float(self.model.joint(name).qpos0[0]) for name in JOINTS}
        rows, totals = np.zeros((len(self.couplings), len(JOINTS))), np.zeros(len(self.couplings))
        for i, (follower, master, constant, scale, *_) in enumerate(self.couplings):
            rows[i, follower] += 1.0
            totals[i] = constant
            if master >= 0:
                rows[i, master] -= scale
        for name, value in known.items():
            totals -= rows[:, JOINTS.index(name)] * (value - rest[name])
        found = np.linalg.lstsq(rows[:, [JOINTS.index(name) for name in others]], totals, rcond=None)[0]
        return found + np.array([rest[name] for name in others])

    def followed_start(self, known: dict[str, float], others: list[str]) -> Any:
        """Positions of the other joints where each follows its master, from those where all couplings are linear."""
        rest = {name: float(self.model.joint(name).qpos0[0]) for name in JOINTS}
        positions = known | dict(zip(others, self.linear_start(known, others), strict=True))
        for follower, master, *factors, _ in len(JOINTS) * self.couplings:
            name, driver = JOINTS[follower], JOINTS[max(master, 0)]
            if name in others:
                at = positions[driver] - rest[driver] if master >= 0 else 0.0
                positions[name] = rest[name] + float(np.polyval(factors[::-1], at))
        return np.array([positions[name] for name in others])

    def _relative(self, data: Any, one: str, other: str) -> tuple[Any, Any]:
        """The origin of the first body, where `connect` has its anchor, and its rotation, as the second sees it."""
        first, second = data.body(one), data.body(other)
        turn = second.xmat.reshape(3, 3).T
        return turn @ (first.xpos - second.xpos), turn @ first.xmat.reshape(3, 3)


def model(case: Case) -> str:
    """Returns the MJCF of a case."""
    bodies = []
    for name, (kind, axis, rest) in zip(JOINTS, case["joints"], strict=True):
        place = "0 0.1 0.2" if name in "abcd" else f"0 {0.05 if name == 'f' else -0.05} 0.1"
        along = " ".join(str(x) for x in axis)
        bodies.append(
            f"<body name='body_{name}' pos='{place}'><joint name='{name}' type='{kind}' axis='{along}' range='-9 9' "
            f"ref='{0.2 * rest}'/><geom size='.01'/>"
        )
    tree = "".join(bodies[:4]) + "<site name='tool' pos='.1 0 .1'/>" + "".join(f"{body}</body>" for body in bodies[4:])
    equalities = []
    for follower, master, *factors, active in case["couplings"]:
        second = f" joint2='{JOINTS[master]}'" if master >= 0 else ""
        numbers = " ".join(str(factor) for factor in factors)
        state = str(active).lower()
        equalities.append(f"<joint joint1='{JOINTS[follower]}'{second} polycoef='{numbers}' active='{state}'/>")
    for kind, one, other in case["loops"]:
        anchor = " anchor='0 0 0'" if kind == "connect" else ""
        equalities.append(f"<{kind} body1='{one}' body2='{other}'{anchor}/>")
    return (
        "<mujoco><compiler angle='radian' autolimits='true'/><worldbody>"
        f"{tree}</body></body></body></body></worldbody><equality>{''.join(equalities)}</equality></mujoco>"
    )


class Speeds(Attack):
    """Velocity limits that are missing or zero, in the file and in the call."""

    name = "file_speeds"
    promise = "A joint that nothing slows down, and one that cannot move, are named by each call"
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        speeds = [str(random.choice(["", "0", "0.0", "1", "0.5"] if hard else ["", "1"])) for _ in range(5)]
        given = ["", "velocity=inf", "velocity=0.7", "acceleration=5.0", "lower=-1.9", "velocity=0.0", "jerk=9.0"]
        return {
            "speeds": tuple(speeds),
            "given": str(random.choice(given)),
            "goal": tuple(random.uniform(-1, 1, 5).tolist()),
        }

    def program(self, case: Case) -> str:
        limits = f"limits = bik.Limits({case['given']})" if case["given"] else "limits = None"
        return (
            f"robot = bik.Robot.from_urdf('''{urdf(case['speeds'])}''')\n{limits}\n"
            f"start, goal = np.zeros(5), np.array({list(case['goal'])})\n"
            "def tracked():\n"
            "    tracker = bik.Tracker(robot, start, dt=0.01, limits=limits)\n"
            "    return [tracker.step(robot.fk(goal)) for _ in range(30)]\n"
            "def told(call):\n"
            "    try:\n        return call(), ''\n"
            "    except bik.BeetleIkError as error:\n        return None, str(error)\n"
            "plan, refusal = told(lambda: bik.plan_point_to_point(robot, start_q=start, end_q=goal, limits=limits))\n"
            "steps, tick_refusal = told(tracked)"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        given = case["given"]
        own = {"": np.inf} | {text: float(text) for text in case["speeds"] if text}
        value = float(given.partition("=")[2]) if given.startswith("velocity") else None
        speeds = [own[text] if value is None else value for text in case["speeds"]]
        paced = given.startswith(("acceleration", "jerk"))
        free = [f"'j{i}'" for i, speed in enumerate(speeds, 1) if speed == np.inf and not paced]
        locked = [f"'j{i}'" for i, speed in enumerate(speeds, 1) if speed == 0]
        steps, refusal, tick_refusal = left["steps"], left["refusal"], left["tick_refusal"]
        if (free or locked) and not all(name in refusal for name in locked or free):
            raise BrokenError("a planner does not name a joint", refusal)
        if free and value is None and not all(name in tick_refusal for name in free):
            raise BrokenError("a tracker does not name a joint that nothing slows down", tick_refusal)
        if not free and tick_refusal:
            raise BrokenError("a tracker refuses a right robot", tick_refusal)
        for step in steps or []:
            if np.any(np.abs(step.qd) > np.array(speeds) * (1 + 1e-9) + 1e-9):
                raise BrokenError("a tick is faster than its limit", step.qd.tolist())
        if steps and locked and "no nearer" in steps[-1].message:
            for name in locked:
                if name not in steps[-1].message:
                    raise BrokenError("a message does not name a locked joint", steps[-1].message)
        return 1


def urdf(speeds: tuple[str, ...]) -> str:
    """Returns an arm whose joints have these velocity limits; an empty text leaves one out."""
    links, axes = ["base", "a", "b", "c", "d", "tip"], ["0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0"]
    parts = []
    for i, ((parent, child), axis, speed) in enumerate(zip(pairwise(links), axes, speeds, strict=True), 1):
        velocity = f" velocity='{speed}'" if speed else ""
        parts.append(
            f"<link name='{child}'/><joint name='j{i}' type='revolute'><parent link='{parent}'/><child link='{child}'/>"
            f"<origin xyz='0.02 0 0.15'/><axis xyz='{axis}'/><limit lower='-2' upper='2'{velocity}/></joint>"
        )
    return f"<robot name='arm'><link name='base'/>{''.join(parts)}</robot>"


ATTACKS = (Equalities(), Speeds())
