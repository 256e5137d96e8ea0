"""Files that are damaged, deformed or cut: read, or refused by name."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

import numpy as np

import beetle_ik as bik

from .. import hostile
from ..attack import Attack, BrokenError, Case

CORPUS = Path(__file__).parents[2] / "corpus"


class Reader(Attack):
    """A file of the corpus, deformed, for one reader."""

    page = "robots"
    folder: ClassVar[str]
    call: ClassVar[str]  # what reads the file named {file}, as `found`

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        files = sorted((CORPUS / self.folder).iterdir())
        file = files[random.integers(len(files))]
        return {"suffix": file.suffix, "data": hostile.deformed(file.read_bytes(), random, hard)}

    def program(self, case: Case) -> str:
        file = "case" + case["suffix"]
        return f"open({file!r}, 'wb').write({case['data']!r})\n{self.call.format(file=file)}"

    def judge_refusal(self, case: Case, error: Exception) -> None:
        if not str(error).strip():
            raise BrokenError("the message is empty", repr(error))


class Urdf(Reader):
    name = "urdf"
    promise = "A damaged URDF is read or refused by name, and a robot that was read works"
    folder = "urdf"
    call = (
        "tip = 'b' if b'name=\"p\"' in open({file!r}, 'rb').read() else 'tool'\n"
        "robot = bik.Robot.from_urdf({file!r}, tip=tip, collision=None)\n"
        "q = robot.random_configurations(3)\npose = robot.fk(q)\nagain = bik.solve(robot, pose[0])"
    )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        if not np.isfinite(left["pose"]).all():
            raise BrokenError("a robot was read whose poses are not finite", left["pose"][0].tolist())
        return 1


class Srdf(Reader):
    name = "srdf"
    promise = "A damaged SRDF is read or refused by name"
    folder = "srdf"
    call = (
        f"urdf = {str(CORPUS / 'urdf' / 'arm.urdf')!r}\n"
        "robot = bik.Robot.from_urdf(urdf, tip='tool', srdf={file!r})\n"
        "pairs, stances = robot.collision_pairs, robot.stances"
    )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        if not all(np.isfinite(stance).all() for stance in left["stances"].values()):
            raise BrokenError("a stance is not finite", left["stances"])
        return 1


class SceneFile(Reader):
    name = "scene_json"
    promise = "A damaged scene is read or refused by name, and one that was read is saved and loaded equal"
    page = "scenes"
    folder = "scene"
    call = "scene = bik.Scene.load({file!r})\nscene.save('again.json')\nagain = bik.Scene.load('again.json')"

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        if left["scene"] != left["again"]:
            raise BrokenError("a saved scene is loaded differently", left["scene"])
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        if "case" not in str(error):
            raise BrokenError("the message does not name the file", error)


class MoveitScene(SceneFile):
    name = "moveit_scene"
    promise = "A damaged planning scene of MoveIt is read or refused by name"
    folder = "moveit"
    call = "scene = bik.Scene.from_moveit({file!r})\nagain = scene"


class Octomap(SceneFile):
    name = "octomap"
    promise = "A damaged octomap is read or refused by name"
    folder = "octomap"
    call = "scene = bik.Scene.from_octomap({file!r}, region=((-1, -1, -1), (1, 1, 1)))\nagain = scene"


class Csv(SceneFile):
    name = "csv"
    promise = "A damaged CSV file is read or refused by name, and a motion that was read is written and read equal"
    page = "motion"
    folder = "csv"
    call = (
        "motion = bik.Trajectory.from_csv({file!r})\nmotion.to_csv('again.csv')\n"
        "again = bik.Trajectory.from_csv('again.csv')"
    )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        motion, again = left["motion"], left["again"]
        if not np.isfinite(motion.coefficients).all():
            raise BrokenError("a motion was read that is not finite", motion.coefficients.tolist())
        off = np.abs(motion.q - again.q).max(initial=0.0)
        powers = np.diff(motion.time)[:, None, None] ** np.arange(motion.coefficients.shape[2])
        if (
            off > 1e-12 * (1 + np.abs(motion.coefficients * powers).max(initial=0.0))
            or motion.joint_names != again.joint_names
        ):
            raise BrokenError("a motion is written and read differently", off)
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        """Times that do not increase are refused by the motion, which knows no file."""


class GcodeFile(SceneFile):
    name = "gcode"
    promise = "A damaged program in G-code is read or refused by name"
    page = "surfaces"
    folder = "gcode"
    call = "program = bik.paths.from_gcode({file!r})\nposes, seams = program.poses, program.seams()"

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        if not np.isfinite(left["poses"]).all():
            raise BrokenError("a program was read whose poses are not finite")
        return 1


class Npz(Reader):
    name = "npz"
    promise = "A damaged npz file, or one with other arrays, is read or refused by name"
    page = "motion"
    folder = "npz"
    call = "motion = bik.Trajectory.from_npz({file!r})"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        if hard:
            return super().draw(random, hard=True)
        arrays = {
            "time": "np.arange(3.0)",
            "coefficients": "np.tile(np.eye(1, 4), (2, 2, 1))",
            "joint_names": "np.array(['a', 'b'])",
        }
        name = str(random.choice(list(arrays)))
        changes = (
            ".tolist()",
            "[::-1]",
            ".astype('f4')",
            ".astype('O')",
            "[:, None]",
            "[..., ::2]",
            ".T",
            ".astype('U9')",
        )
        change = changes[random.integers(len(changes) if name != "joint_names" else 2)]
        arrays[name] = hostile.array(random) if random.random() < 0.3 else f"{arrays[name]}{change}"
        return {"arrays": arrays}

    def program(self, case: Case) -> str:
        if "data" in case:
            return super().program(case)
        arrays = ", ".join(f"{name}={array}" for name, array in case["arrays"].items())
        return f"np.savez('case.npz', {arrays})\n{self.call.format(file='case.npz')}"

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        if not np.isfinite(left["motion"].coefficients).all():
            raise BrokenError("a motion was read that is not finite")
        return 1


class MapFile(Reader):
    name = "map_npz"
    promise = "A damaged map of the reach, or one with other arrays, is read or refused by name"
    page = "scale"
    folder = "map"
    call = (
        "found = bik.ReachabilityMap.load({file!r})\n"
        "seen = [found.index, found.query(np.eye(4)), repr(found), found.manipulability]\n"
        "found.to_npz('again.npz')\nagain = bik.ReachabilityMap.load('again.npz')"
    )
    arrays = ("reachability_map", "robot", "grid", "bits", "manipulability")

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """An easy case has another array, a hard one other bytes."""
        if hard:
            return super().draw(random, hard=True)
        return {"name": str(random.choice(self.arrays)), "array": hostile.array(random)}

    def program(self, case: Case) -> str:
        if "data" in case:
            return super().program(case)
        whole = str(CORPUS / "map" / "map.npz")
        return (
            f"arrays = dict(np.load({whole!r}))\narrays[{case['name']!r}] = {case['array']}\n"
            f"np.savez('case.npz', **arrays)\n{self.call.format(file='case.npz')}"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        if left["found"] != left["again"]:
            raise BrokenError("a saved map is loaded differently")
        return 1


class Mesh(Reader):
    name = "mesh"
    promise = "A damaged mesh (STL, OBJ, DAE) is read or refused by name, and the bodies that cover it are finite"
    folder = "mesh"
    call = (
        "urdf = \"<robot name='r'><link name='a'/><link name='b'><collision><geometry>\"\n"
        "urdf += \"<mesh filename='{file}'/></geometry></collision></link>\"\n"
        "urdf += \"<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>\"\n"
        "open('mesh.urdf', 'w').write(urdf)\nrobot = bik.Robot.from_urdf('mesh.urdf', collision='hulls')\n"
        "far = bik.obstacles.clearance(robot, [0.0], [bik.obstacles.Sphere((3, 0, 0), 0.1)])"
    )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        if np.isnan(left["far"]):
            raise BrokenError("the distance of a mesh is not a number")
        return 1


class Stored(Attack):
    name = "stored"
    promise = "Pickles whose bytes were changed are refused by name, or hold values that can be used"
    page = "batches"
    refusals = (bik.BeetleIkError,)

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A hard case has the checksum of its changed bytes, so that they are decoded."""
        values = list(samples().items())
        name, stored = values[random.integers(len(values))]
        data = hostile.forged(stored, random) if hard else hostile._torn(stored, random)
        return {"of": {"type": name}, "data": data}

    def program(self, case: Case) -> str:
        kind = case["of"]["type"]
        use = "found.fk(found.random_configurations(2))\n" if kind == "Robot" else ""
        return (
            f"found = bik.{kind}._restore({case['data']!r})\n{use}"
            "seen = [repr(getattr(found, name)) for name in dir(found) if name[0] != '_']"
        )


_SAMPLES: dict[str, bytes] = {}


def samples() -> dict[str, bytes]:
    """Stored values of each class that is restored from bytes alone, by the name of the class."""
    if not _SAMPLES:
        robot = bik.Robot.planar([0.5, 0.25, 0.25], velocity=1.0).with_capsules(radius=0.02)
        limits = bik.Limits(velocity=1.0, acceleration=2.0)
        values = [
            robot,
            robot.bodies[0],
            robot.velocity_ellipsoid([0.1, 0.2, 0.3]),
            bik.paths.circle((0.5, 0.2, 0.0), diameter=0.2, duration=2.0),
            bik.solve(robot, (0.5, 0.2, 0.0)),
            bik.solve_batch(robot, [(0.5, 0.2, 0.0), (9.0, 0.0, 0.0)]),
            bik.solve_all(robot, (0.5, 0.2, 0.0), limit=2),
            bik.plan_point_to_point(robot, start_q=[0.1, 0.2, 0.3], end_q=[0.5, 0.2, -0.3], limits=limits),
            bik.track(robot, bik.paths.circle((0.5, 0.2, 0.0), diameter=0.2, duration=0.5), dt=0.1),
            bik.Tracker(robot, [0.1, 0.2, 0.3], dt=0.1).step((0.5, 0.2, 0.0)),
            bik.papers.planar_posture(bik.Robot.planar([1.0] * 3), (1.5, 1.0, 0.0)),
        ]
        for one in values:
            try:
                _, arguments = one.__reduce__()
            except TypeError:
                continue
            if len(arguments) == 1 and isinstance(arguments[0], bytes):
                _SAMPLES[type(one).__name__] = arguments[0]
    return _SAMPLES


ATTACKS = [
    Urdf(),
    Srdf(),
    SceneFile(),
    MoveitScene(),
    Octomap(),
    Csv(),
    GcodeFile(),
    Npz(),
    MapFile(),
    Mesh(),
    Stored(),
]
