"""A small part of the campaign with fixed seeds, and tests that its judges notice errors."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("coal")
pytest.importorskip("pinocchio")
if sys.platform == "win32":
    pytest.skip("the workers of a campaign are bounded as POSIX does", allow_module_level=True)
sys.path.insert(0, str(Path(__file__).parents[1]))

from campaign import attack, ledger, shrinking, soak, watch
from campaign.attacks import ATTACKS
from rough_attack import Rough

ORACLES = {"state_to_state": "ruckig", "time_optimal": "toppra", "equalities": "mujoco"}
CASES = {
    "clear_ticks": 1,
    "dead_ends": 6,
    "clear_plans": 2,
    "held_arms": 6,
    "two_arm_plans": 2,
    "time_optimal": 3,
    "out_of_reach": 6,
    "self_motions": 3,
    "paths_followed": 3,
    "looser_paths": 2,
    "recordings": 3,
    "plants": 5,
    "stops_among_obstacles": 4,
    "any_stop": 6,
    "complete_sets": 6,
    "arguments": 12,
}
FOUND = [("programs", 44, 243), ("programs", 46, 794), ("programs", 47, 1115)]
"""Motions 1e-8 beyond a limit that they begin at, under jerk limits, and a tip that was too fast between samples."""


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ATTACKS)
def test_promises_hold_in_a_few_cases(name: str) -> None:
    pytest.importorskip(ORACLES.get(name, "coal"))
    one = ATTACKS[name]
    for index in (i for i in range(1, 200, 2) if i // 2 < CASES.get(name, 16)):
        verdict = attack.tried(one, attack.drawn(one, 1, index))
        assert verdict.failure is None, f"python -m campaign repeat {name} --seed 1 --index {index}: {verdict}"


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(("name", "seed", "index"), FOUND)
def test_cases_that_failed_once_pass(name: str, seed: int, index: int) -> None:
    one = ATTACKS[name]
    verdict = attack.tried(one, attack.drawn(one, seed, index))
    assert verdict.failure is None, verdict


def test_a_case_is_the_same_whenever_it_is_drawn() -> None:
    for one in ATTACKS.values():
        assert one.program(attack.drawn(one, 3, 7)) == one.program(attack.drawn(one, 3, 7))
        assert one.program(attack.drawn(one, 3, 7)) != one.program(attack.drawn(one, 4, 7))


def test_each_promise_is_on_a_page() -> None:
    docs = Path(__file__).parents[2] / "docs"
    assert [one.name for one in ATTACKS.values() if not (docs / f"{one.page}.md").is_file()] == []


# For each attack what a defect would leave: the line that spoils the result, and what is then broken.
SPOILED = {
    "calls_in_degrees": (
        "found[:-1] *= 0.99",
        "position_error is not the error",
    ),
    "led_by_twists": ("q[-1] = q[-1] + 0.01", "the velocity is beyond its limit"),
    "torques": ("torques = torques + 1e-3", "torques differ"),
    "joint_weights": ("solution = Changed(solution, q=solution.q + 0.02)", "solved, but not within the tolerance"),
    "best_kept": ("solution = Changed(solution, evaluations=10**6)", "the budget is exceeded"),
    "command_line": ("done = Changed(done, exit_code=3)", "the status is none of 0, 1, 2"),
    "two_hands": ("solution = Changed(solution, q=solution.q + 1e-4)", "position_error is not the error"),
    "levels": (
        "solution = Changed(solution, q=solution.q + 1.0)",
        "q is outside the limits",
    ),
    "self_motions": (
        "curves = [Changed(curve, q=curve.q + 1e-6) for curve in curves]",
        "a configuration of the curve misses the target",
    ),
    "paths_followed": ("plan = Changed(plan, accuracy=-1.0)", "the plan is farther from the path than it says"),
    "starts_as_read": (
        "tracked = [q + 0.3 * (i == 5) for i, q in enumerate(tracked)]",
        "a tick exceeds the velocity limit on the way inside",
    ),
    "plants": ("found = Changed(found, q=10.0 * found.q)", "the velocity is beyond its limit"),
    "followed_targets": ("ways = 1.001 * ways", "it is not the pseudoinverse"),
    "poses": (
        "poses = poses + 1e-9",
        "pose differs",
    ),
    "solved": (
        "solution = Changed(solution, q=solution.q + 1e-4)",
        "position_error is not the error",
    ),
    "round_poses": (
        "statuses = np.full(len(poses), bik.Status.OUT_OF_REACH)",
        "a pose that the arm has is called out of reach",
    ),
    "calibrations": (
        "found = Changed(found, errors_after=found.errors_after + 1e-3)",
        "the errors after are not as told",
    ),
    "out_of_reach": (
        "solution = Changed(solution, q=solution.q * nan)",
        "q is not finite",
    ),
    "place_first": (
        "solution = Changed(solution, q=solution.q + 1e-4)",
        "position_error is not the error",
    ),
    "complete_sets": (
        "found = Changed(found, q=found.q[1:])",
        "a complete set lacks a solution",
    ),
    "same_bits": (
        "alone = Changed(alone, q=alone.q + 1e-15)",
        "other bits by alone",
    ),
    "budgets": (
        "seen.append((np.zeros(1), 0.0))",
        "the budget is not exact",
    ),
    "dead_ends": (
        "q = np.asarray(q) + 0.3",
        "the arm stays away from its target",
    ),
    "held_arms": (
        "rates[-1], statuses[-1], way_back = 0.01, bik.Status.CAPPED, 0",
        "a held arm moves on",
    ),
    "tracker_lives": (
        "log += [('q', tracker.q + 1.0)]",
        "a command is outside the position limits",
    ),
    "stops_among_obstacles": (
        "stops = [(said, q + 1e-3 * np.arange(len(q))[:, None]) for said, q in stops]",
        "an arm is later at rest than its stop said",
    ),
    "any_stop": (
        "q[-1] = q[-1] + 1e-6",
        "an arm is later at rest than its stop said",
    ),
    "state_to_state": (
        "motion = bik.Trajectory(motion.time, motion.coefficients + [1e-4, 0, 0, 0])",
        "the motion misses its start",
    ),
    "time_optimal": (
        "motion = bik.Trajectory(motion.time, 1.1 * motion.coefficients)",
        "the velocity is beyond its limit",
    ),
    "recordings": (
        "exact = Changed(exact, duration=0.0)",
        "more tolerance takes longer",
    ),
    "joint_plans": (
        "moved = plan.trajectory.coefficients + 1e-4 * np.eye(1, plan.trajectory.coefficients.shape[2])\n"
        "plan = Changed(plan, trajectory=bik.Trajectory(plan.trajectory.time, moved))",
        "the plan misses its ends",
    ),
    "tracker_keeps": (
        "q = q + np.linspace(0.0, 1.0, len(q))[:, None]",
        "what is kept does not hold",
    ),
    "path_breaks": (
        "points = points + 0.5",
        "the tip leaves the path between breaks",
    ),
    "tip_limits": (
        "powers = motion.coefficients\nscale = 1e4 ** np.arange(powers.shape[2])\n"
        "motion = bik.Trajectory(motion.time / 1e4, powers * scale)",
        "a tip is beyond its limit",
    ),
    "tracked_torques": (
        "q = np.array(commands)\ncommands = list(q[:1] + 1e3 * (q - q[:1]))\n"
        "statuses = [bik.Status.SOLVED] * len(statuses)",
        "a torque is beyond its limit",
    ),
    "kept_motions": (
        "told = [0.0 * each - 1.0 for each in told]",
        "the largest error is more than told",
    ),
    "programs": (
        "motion = bik.Trajectory(motion.time, motion.coefficients + 10.0 * np.eye(1, motion.coefficients.shape[2]))",
        "a joint is outside its limits",
    ),
    "programs_of_tips": (
        "reports = [Changed(report, start=0.0, end=motion.duration) for report in reports]",
        "a joint of the other tip moves",
    ),
    "looser_paths": (
        "plans += [(False, inf, '')]",
        "no plan with a wider tolerance",
    ),
    "trajectories": (
        "most = [0.5 * rate for rate in most]",
        "the largest derivative 1 is too small",
    ),
    "distances": (
        "distance += 1e-5",
        "the distance is above the true one",
    ),
    "any_size": (
        "distance = 2.0 * abs(distance) + 1.0",
        "the distance is above the true one",
    ),
    "clear_solutions": (
        "every = [Changed(found[0], success=True, q=q) for q in robot.random_configurations(300)]",
        "a solution is called clear",
    ),
    "clear_plans": (
        "moved = plan.trajectory.coefficients + 1e-4 * np.eye(1, plan.trajectory.coefficients.shape[2])\n"
        "plan = Changed(plan, trajectory=bik.Trajectory(plan.trajectory.time, moved))",
        "the plan misses its ends",
    ),
    "two_arm_plans": (
        "moved = plan.trajectory.coefficients + 1e-4 * np.eye(1, plan.trajectory.coefficients.shape[2])\n"
        "plan = Changed(plan, trajectory=bik.Trajectory(plan.trajectory.time, moved))",
        "the plan misses its ends",
    ),
    "clear_ticks": (
        "ways = [(*way[:3], way[3] + 1e-3, way[4]) for way in ways]",
        "the clearance of a tick is above the true one",
    ),
    "own_points": (
        "kept = kept[1:]\nremoved += 1",
        "a point is kept, or taken out, against the padding",
    ),
    "surface_line": (
        "poses = poses.copy()\nposes[:, :3, 3] += 0.01",
        "the tool points beside the surface",
    ),
    "gcode_moves": (
        "program = bik.paths.from_gcode(text.replace('G0 X0', 'G0 X1'))",
        "a move ends at another point",
    ),
    "gcode": (
        "poses = poses * nan",
        "a program was read whose poses are not finite",
    ),
    "urdf": (
        "pose = pose * nan",
        "a robot was read whose poses are not finite",
    ),
    "equalities": (
        "tips = tips + 0.01",
        "an equality of the chain is open",
    ),
    "file_speeds": (
        "tick_refusal = ''",
        "a tracker does not name a joint that nothing slows down",
    ),
    "scene_json": (
        "again = bik.Scene()",
        "a saved scene is loaded differently",
    ),
    "units": (
        "said = ['one', 'too', 'many']",
        "a value in another unit does not warn once",
    ),
    "csv": (
        "again = bik.Trajectory.from_samples([0.0, 1.0], [[1.0], [2.0]])",
        "a motion is written and read differently",
    ),
}


class Changed:
    """A result of which some properties say something else."""

    def __init__(self, result: Any, **properties: Any) -> None:
        self.__dict__.update({"result": result, **properties})

    def __getattr__(self, name: str) -> Any:
        return getattr(self.result, name)

    def __iter__(self) -> Iterator[Any]:
        return iter(self.result)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", SPOILED)
def test_a_broken_promise_is_noticed(name: str) -> None:
    pytest.importorskip(ORACLES.get(name, "coal"))
    one, (line, broken) = ATTACKS[name], SPOILED[name]
    told = set()
    for index in (i for i in range(400) if not attack.is_hard(i)):
        case, left = attack.drawn(one, 2, index), {"Changed": Changed}
        try:
            exec(f"{attack.HEADER}{one.program(case)}\n{line}", left)
            one.judge(case, left)
        except attack.BrokenError as error:
            told.add(error.what)
            if error.what == broken:
                return
        except (*one.refusals, ValueError):
            continue
    raise AssertionError(f"not noticed, only {told}")


def test_a_failing_case_shrinks_to_what_matters() -> None:
    case = {"numbers": [-1.0, 0.123456, 3.5, -2.0], "fixed": (1.5, 2.5), "data": b"abcdef", "text": "kept"}
    smallest = shrinking.shrunk(case, lambda smaller: max(smaller["numbers"], default=0.0) > 0.1)
    assert smallest == {"numbers": [1.0], "fixed": (0.0, 0.0), "data": b"", "text": "kept"}


def test_crashes_hangs_and_broken_promises_are_failures_with_their_program(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rough, count = Rough(), 12
    plan = watch.Plan({rough.name: rough}, 0, count, None, workers=2, first=0, out=tmp_path / "out")
    found = watch.campaign(plan)
    fates = [attack.drawn(rough, 0, index)["fate"] for index in range(count)]
    told = [line for line in capsys.readouterr().out.splitlines() if line.startswith("# rough_attack:Rough: ")]
    assert sum(row.cases for row in found.rows.values()) == count
    assert found.failures() == len(told) == sum(fates.count(fate) for fate in (3, 4, 5))
    assert told.count("# rough_attack:Rough: ends the process by SIGABRT") == fates.count(3) > 0
    assert told.count("# rough_attack:Rough: no answer") == fates.count(4) > 0
    assert told.count("# rough_attack:Rough: a number is positive") == fates.count(5) > 0
    repeated = (tmp_path / "out" / f"rough_attack:Rough-0-{fates.index(5)}.py").read_text()
    assert repeated.endswith("numbers = [1.0]\nfate = 5\n")
    rows = ledger.read([tmp_path / "out" / "ledger.csv"] * 2)
    assert [row.cases for row in rows] == [count, count]
    assert "| none ([none](none.md)) | `rough_attack:Rough` |" in ledger.markdown(rows)


@pytest.mark.parametrize("name", soak.TRIALS)
def test_rough_treatment_is_survived(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = [str(Path(__file__).parents[1]), *sys.path]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, paths)))
    amount = {"tracker": 1, "rows": 2000, "killed_writers": 4, "full_disk": 1, "threads": 1}.get(name)
    failed = soak.soak([name], amount=amount, long=False)
    assert failed == 0, capsys.readouterr().out
