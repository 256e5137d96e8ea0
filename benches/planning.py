"""Plans among obstacles on MotionBenchMaker: this library, an earlier state of it, roboplan and mplib, one run.

    python benches/planning.py --data DIR --old FOLDER --peers PYTHON --out DIR [--docs docs]

DIR holds `panda.json`, `ur5.json` and `robots/`, as in the README of the data; FOLDER holds the package of commit
c1eaf41 with its module, and PYTHON is an interpreter with roboplan and mplib. A planner without its folder or library
is named and left out. Each runs in a process of its own; they take turns, problem by problem. Bodies are the spheres
that decide there what is valid; scenes are prepared before the clock starts. Times are those of the processor, so that
a busy machine counts less; of a call that takes less than 50 ms, the median of three counts.

A judge that shares no code with any planner samples every motion so densely that no sphere moves more than 1 mm from
sample to sample (`peers/sphere_judge.py`).

`--docs docs` writes the tables and the figures of `docs/benchmarks_motion.md`.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import itertools
import json
import sys
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from peers import plan_report, planners
from peers.barriers import held
from peers.clear import ALWAYS_TOUCH, ARMS, MotionBenchArm
from peers.plan_batches import batch_line
from peers.plan_report import IMPROVING, OTHERS, OURS, Result
from peers.plan_worker import Worker
from peers.planners import Arm, Planner
from peers.sphere_arm import SphereArm
from peers.sphere_judge import SphereJudge

import beetle_ik as bik

ACCELERATION = 5.0  # rad/s^2


def main() -> None:
    """Measures both arms and writes tables and figures."""
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    results: list[Result] = []
    batches: list[list[str]] = []
    with tempfile.TemporaryDirectory() as scratch:
        for name in arguments.arms:
            arm = MotionBenchArm(arguments.data, name)
            spheres = SphereArm(arm.urdf, arm.urdf.with_name(f"{name}.srdf"), list(arm.robot.joint_names), ALWAYS_TOUCH)
            described = describe(arm, spheres, Path(scratch))
            problems = [problem for problem in arm.problems() if problem["start_valid"]][:: arguments.every]
            print(f"{name}: {len(problems)} problems", flush=True)
            results += measure(wanted((*OURS, *OTHERS), arguments), described, spheres, problems, arguments)
            few = problems[:: -(-len(problems) // arguments.improve)] if arguments.improve else []
            results += measure(wanted(IMPROVING, arguments), described, spheres, few, arguments)
            batches += batch_line(arm, problems, ACCELERATION)
    plan_report.write(arguments.out, results, batches)
    if arguments.docs:
        plan_report.publish(arguments.out, arguments.docs, arguments.data, ACCELERATION)


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder of MotionBenchMaker's problems")
    parser.add_argument("--arms", nargs="*", default=list(ARMS), help="arms (default: all)")
    parser.add_argument("--every", type=int, default=1, help="take one of so many problems (default: all)")
    parser.add_argument("--slow", type=int, default=1, help="the others get one of so many of these (default: all)")
    parser.add_argument("--only", nargs="*", default=[], help="names that a planner must contain one of (default: all)")
    parser.add_argument("--old", type=Path, help="folder that holds the package beetle_ik of commit c1eaf41")
    parser.add_argument(
        "--peers", default=sys.executable, help="interpreter with roboplan and mplib (default: this one)"
    )
    parser.add_argument(
        "--improve", type=int, default=0, help="problems of each arm planned for 1 s and 5 s (default: none)"
    )
    parser.add_argument("--out", type=Path, default=Path("planning"), help="where the results go")
    parser.add_argument("--docs", type=Path, help="folder of the site, to be brought up to date")
    return parser.parse_args()


def wanted(planner_types: tuple[type[Planner], ...], arguments: argparse.Namespace) -> list[type[Planner]]:
    """Selects the planners that the command line names."""
    return [each for each in planner_types if not arguments.only or any(name in each.name for name in arguments.only)]


def describe(arm: MotionBenchArm, spheres: SphereArm, scratch: Path) -> Arm:
    """Writes the arm for all planners: one file with fixed fingers, and one with every pair of links that may touch."""
    urdf, srdf = scratch / f"{arm.name}.urdf", scratch / f"{arm.name}.srdf"
    urdf.write_text(held(arm), encoding="utf-8")
    root = ET.Element("robot", name=ET.parse(arm.urdf).getroot().get("name"))
    tested = spheres.tested_links()
    for one, other in itertools.combinations(sorted(set(spheres.links)), 2):
        if frozenset((one, other)) not in tested:
            ET.SubElement(root, "disable_collisions", link1=one, link2=other, reason="Never")
    srdf.write_text(ET.tostring(root, encoding="unicode"), encoding="utf-8")
    capsules = json.loads(arm.urdf.with_name("capsules.json").read_text(encoding="utf-8"))["capsules"]
    return Arm(
        arm.name,
        str(urdf),
        str(srdf),
        ARMS[arm.name],
        spheres.moving,
        spheres.velocity,
        ACCELERATION,
        pairs=sorted((min(pair), max(pair)) for pair in tested),
        capsules=[(each["link"], each["a"], each["b"], each["radius"]) for each in capsules],
    )


def measure(
    planner_types: list[type[Planner]],
    arm: Arm,
    spheres: SphereArm,
    problems: list[dict[str, Any]],
    arguments: argparse.Namespace,
) -> list[Result]:
    """Runs the planners by turns on the problems, and judges their motions."""
    workers = list(started(planner_types, arm, arguments)) if problems else []
    order, results, scene = np.random.default_rng(0), [], None
    for number, problem in enumerate(problems):
        judge = SphereJudge(spheres, problem)
        for worker in [workers[i] for i in order.permutation(len(workers))]:
            if worker.planner in OTHERS and number % arguments.slow:
                continue
            try:
                if problem["scene"] != scene and not issubclass(worker.planner, IMPROVING):
                    worker.plan(problem)  # what is loaded at the first call is not timed
                answer = worker.plan(problem)
                verdict = judge.judge(worker.motion(answer), ACCELERATION) if answer.claimed else None
            except ImportError as reason:
                print(f"- {arm.name}, {problem['scene']} {problem['index']}: {reason}", flush=True)
                workers.remove(worker)
                continue
            results.append(Result(worker.planner.name, arm.name, problem, answer, verdict))
        scene = problem["scene"]
        if number % 20 == 19:
            print(f"  {number + 1} of {len(problems)}", flush=True)
    for worker in workers:
        worker.close()
    return results


def started(planner_types: list[type[Planner]], arm: Arm, arguments: argparse.Namespace) -> Iterator[Worker]:
    """Starts a process for each available planner."""
    own = Path(bik.__file__).parents[1]
    for planner in planner_types:
        old, ours = issubclass(planner, planners.Old), issubclass(planner, planners.BeetleIk)
        if old and not arguments.old:
            print(f"- {planner.name}: no --old")
            continue
        python, folder = (sys.executable, arguments.old if old else own) if ours else (arguments.peers, None)
        try:
            yield Worker(planner, arm, python, folder)
        except ImportError as reason:
            print(f"- {planner.name}: {reason}")


if __name__ == "__main__":
    main()
