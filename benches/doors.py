"""The doors for LeRobot and mplib beside what they replace, on the same inputs, in one run.

    python benches/doors.py lerobot --urdf so101.urdf --frame gripper_frame_link
    python benches/doors.py mplib --data DIR --problems 20

`lerobot` follows 1,000 poses at 50 Hz, made here: a hand that swings and turns about a home configuration. It needs
lerobot (installed without its dependencies) and placo. `mplib` needs mplib 0.2, toppra and numpy below 2; DIR holds
`panda.json` and `robots/` of MotionBenchMaker. A part whose library is missing says so.
"""

import argparse
import importlib.util
import json
import shutil
import sys
import tempfile
import time
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import beetle_ik as bik
from beetle_ik.interop import maniskill
from beetle_ik.interop.lerobot import RobotKinematics

RATE, POSES, ROUNDS = 50.0, 1000, 7


def main() -> None:
    """Runs one part."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parts = parser.add_subparsers(dest="part", required=True)
    lerobot = parts.add_parser("lerobot")
    lerobot.add_argument("--urdf", required=True)
    lerobot.add_argument("--frame", default="gripper_frame_link")
    lerobot.add_argument("--home", type=float, nargs="*", default=[0.0, -30.0, 40.0, 30.0, 0.0, 50.0], help="degrees")
    lerobot.set_defaults(run=lambda wanted: follow(wanted.urdf, wanted.frame, np.array(wanted.home)))
    mplib = parts.add_parser("mplib")
    mplib.add_argument("--data", type=Path, required=True)
    mplib.add_argument("--problems", type=int, default=20, help="of each scene")
    mplib.set_defaults(run=lambda wanted: plan(wanted.data, wanted.problems))
    wanted = parser.parse_args()
    wanted.run(wanted)


# --- LeRobot ------------------------------------------------------------------------------------


def follow(urdf: str, frame: str, home: np.ndarray) -> None:
    """Prints time, errors and jumps of both on one stream of poses."""
    ours = RobotKinematics(urdf, frame)
    poses = swing(ours.forward_kinematics(home))
    tracker = ours.tracker(home, dt=1.0 / RATE)
    report("beetle-ik", ours, home, poses, ours.inverse_kinematics)
    beside_plain_solve(ours, home, poses)
    report("beetle-ik, tracker", ours, home, poses, lambda _, pose: tracker.step(pose))
    theirs = placo_kinematics()
    if theirs is not None:
        placo = theirs(urdf, frame)
        placo.forward_kinematics(home)  # its first solve would use the Jacobian of the zero configuration
        report("LeRobot (placo)", ours, home, poses, placo.inverse_kinematics)


def beside_plain_solve(ours: RobotKinematics, home: np.ndarray, poses: list[np.ndarray]) -> None:
    """Prints the processor time of the door's call and, in turns, of `solve` with its task from the same joints."""
    task, q, calls = bik.tasks.Pose(first="position"), home, []
    for pose in poses:
        calls.append((q, np.radians(q[: ours.robot.dof]), pose))
        q = ours.inverse_kinematics(q, pose)
    least = [np.inf, np.inf]
    for _ in range(ROUNDS):
        begin = time.process_time()
        for degrees, _, pose in calls:
            ours.inverse_kinematics(degrees, pose)
        between = time.process_time()
        for _, radians, pose in calls:
            bik.solve(ours.robot, pose, task=task, start_q=radians)
        spent = between - begin, time.process_time() - between
        least = [min(pair) for pair in zip(least, spent, strict=True)]
    door, plain = (1e6 * seconds / len(calls) for seconds in least)
    print(f"beetle-ik, processor time: {door:.2f} us a call, plain solve {plain:.2f} us: {door / plain:.2f} times")


def placo_kinematics() -> type | None:
    """Returns LeRobot's class, from its source: importing the package would load torch."""
    lerobot, placo = importlib.util.find_spec("lerobot"), importlib.util.find_spec("placo")
    if lerobot is None or placo is None or not lerobot.submodule_search_locations:
        print(f"LeRobot: not measured: {'placo' if lerobot else 'lerobot'} is not installed")
        return None
    file = Path(lerobot.submodule_search_locations[0]) / "model" / "kinematics.py"
    module = types.ModuleType("kinematics")
    exec(compile(file.read_text(encoding="utf-8"), str(file), "exec"), module.__dict__)
    kinematics: type = module.RobotKinematics
    return kinematics


def swing(home: np.ndarray) -> list[np.ndarray]:
    """Returns the poses of a hand that swings by up to 12 cm and turns by up to 0.3 rad."""
    poses = []
    for t in np.arange(POSES) / RATE:
        turn = bik.pose([0, 0, 0], rotvec=[0.3 * np.sin(0.5 * t), 0.2 * np.sin(0.8 * t), 0.2 * np.sin(0.6 * t)])
        pose = home.copy()
        pose[:3, :3] = turn[:3, :3] @ home[:3, :3]
        pose[:3, 3] += [0.05 * np.sin(0.9 * t), 0.12 * np.sin(0.7 * t), 0.06 * np.sin(1.3 * t)]
        poses.append(pose)
    return poses


def report(
    name: str,
    judge: RobotKinematics,
    home: np.ndarray,
    poses: list[np.ndarray],
    call: Callable[[np.ndarray, np.ndarray], np.ndarray],
) -> None:
    """Calls once per pose, each from the joints of the last, and prints a line."""
    q, far, turned, jumps, seconds = home, [], [], [], []
    for pose in poses:
        begin = time.perf_counter()
        found = call(q, pose)
        seconds.append(time.perf_counter() - begin)
        here = judge.forward_kinematics(found)
        far.append(1e3 * np.linalg.norm(here[:3, 3] - pose[:3, 3]))
        turned.append(np.arccos(np.clip((np.trace(here[:3, :3].T @ pose[:3, :3]) - 1.0) / 2.0, -1.0, 1.0)))
        jumps.append(np.abs(found - q).max())
        q = found
    print(
        f"{name}: {1e6 * np.median(seconds):.0f} us a call; place off by {np.median(far):.3g} mm (median), "
        f"{max(far):.3g} mm (most); turn off by {np.median(turned):.3f} rad (median); "
        f"largest step of a joint {max(jumps):.2f} degrees"
    )


# --- mplib --------------------------------------------------------------------------------------


def plan(data: Path, count: int) -> None:
    """Prints success, times and limits of both on the same problems of MotionBenchMaker, from joints to joints."""
    problems = json.loads((data / "panda.json").read_text(encoding="utf-8"))["scenes"]
    # Spheres for collision shapes: mplib does not read the meshes. It writes a URDF beside the one it reads.
    folder = Path(shutil.copytree(data / "robots" / "panda", Path(tempfile.mkdtemp()) / "panda"))
    files = {
        "urdf": str(folder / "panda_spherized.urdf"),
        "srdf": str(folder / "panda.srdf"),
        "move_group": "panda_hand",
    }
    libraries = [("beetle-ik", maniskill, files)]
    if importlib.util.find_spec("mplib") is None:
        print("mplib: not measured: it is not installed")
    else:
        import mplib
        import mplib.collision_detection.fcl as shapes

        mplib.fcl = shapes
        libraries.append(("mplib", mplib, files))
    judges = [library.Planner(**arguments) for _, library, arguments in libraries]
    for scene, cases in problems.items():
        for (name, library, arguments), _ in zip(libraries, judges, strict=True):
            planner = library.Planner(**arguments)
            outcomes = [attempt(library, planner, judges, libraries, case) for case in cases[:count]]
            print(f"{scene}, {name}: {summary(outcomes)}", flush=True)


def attempt(
    library: Any, planner: Any, judges: list[Any], libraries: list[Any], case: dict[str, Any]
) -> dict[str, Any]:
    """Plans one problem, and has both libraries test the motion every 10 ms."""
    furnish(library, planner, case)
    begin = time.perf_counter()
    result = planner.plan_qpos([np.array(case["goal"])], np.array(case["start"]), time_step=0.01)
    outcome: dict[str, Any] = {"seconds": time.perf_counter() - begin, "solved": result["status"] == "Success"}
    if outcome["solved"]:
        q, limits = result["position"], np.array(planner.joint_limits)[:7]
        outcome["duration"] = result["duration"]
        outcome["at the goal"] = np.abs(q[-1] - case["goal"]).max() < 1e-3
        outcome["in limits"] = bool(
            np.all((limits[:, 0] - 1e-6 <= q) & (q <= limits[:, 1] + 1e-6))
            and np.abs(result["velocity"]).max() <= 1.01
            and np.abs(result["acceleration"]).max() <= 1.01
        )
        for judge, (name, kind, _) in zip(judges, libraries, strict=True):
            furnish(kind, judge, case)
            touching = [row for row in q if judge.check_for_env_collision(row) or judge.check_for_self_collision(row)]
            outcome[f"clear for {name}"] = not touching
    return outcome


def furnish(library: Any, planner: Any, case: dict[str, Any]) -> None:
    """Puts the objects of a problem into the world of a planner, in place of those before."""
    world = planner.planning_world
    for name in list(world.get_object_names()):
        world.remove_object(name)
    for thing in (*case["boxes"], *case["cylinders"]):
        x, y, z, w = thing["xyzw"]
        box = "half_extents" in thing
        size = 2.0 * np.array(thing["half_extents"]) if box else None
        shape = library.fcl.Box(size) if box else library.fcl.Cylinder(thing["radius"], thing["length"])
        pose = library.Pose(np.array(thing["position"]), np.array([w, x, y, z]))
        world.add_object(thing["name"], library.fcl.CollisionObject(shape, pose))


def summary(outcomes: list[dict[str, Any]]) -> str:
    """Returns counts of what holds for the motions found, and medians."""
    solved = [outcome for outcome in outcomes if outcome["solved"]]
    counts = [key for key in (solved[0] if solved else {}) if key not in ("seconds", "solved", "duration")]
    held = ", ".join(f"{key} {sum(outcome[key] for outcome in solved)}" for key in counts)
    seconds = [outcome["seconds"] for outcome in outcomes]
    duration = f"{np.median([outcome['duration'] for outcome in solved]):.2f} s long" if solved else ""
    return (
        f"{len(solved)} of {len(outcomes)} planned, {held}; {1e3 * np.median(seconds):.0f} ms (median), "
        f"{1e3 * max(seconds):.0f} ms (most); {duration} (median)"
    )


if __name__ == "__main__":
    sys.exit(main())
