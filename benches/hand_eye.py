"""Hand-eye calibration beside the five methods of OpenCV, in both arrangements, on simulated sets.

    python benches/hand_eye.py --sets 50 --out docs

writes `hand_eye.csv`: errors of the camera's pose. It needs `opencv-python-headless<5`, the last with these methods. An
arm without errors moves a board in front of a fixed camera, or a camera in front of a board; the poses that the camera
sees have noise.
"""

import argparse
import csv
import statistics
from pathlib import Path

import cv2
import numpy as np
from peers.calibration_judge import Array, transform
from scipy.spatial.transform import Rotation

import beetle_ik as bik

POSES, LENGTH_NOISE, ANGLE_NOISE = 15, 5e-4, 2e-3
METHODS = {
    "Tsai": cv2.CALIB_HAND_EYE_TSAI,
    "Park": cv2.CALIB_HAND_EYE_PARK,
    "Horaud": cv2.CALIB_HAND_EYE_HORAUD,
    "Andreff": cv2.CALIB_HAND_EYE_ANDREFF,
    "Daniilidis": cv2.CALIB_HAND_EYE_DANIILIDIS,
}


def simulated(camera: str, seed: int) -> tuple[bik.Robot, Array, Array, Array]:
    """Returns robot, joint angles, poses of the board as seen, and the pose of the camera."""
    rng = np.random.default_rng([7, seed])
    robot = bik.Robot.named("ur5e")
    q = np.array([0.0, -1.5, 1.5, -1.5, -1.5, 0.0]) + rng.uniform(-0.6, 0.6, (POSES, 6))
    tips = robot.fk(q)
    if camera == "hand":
        eye = transform(rng.uniform(-0.1, 0.1, 3), rng.uniform(-0.5, 0.5, 3))
        board = transform(np.array([0.5, 0.1, 0.0]) + rng.uniform(-0.1, 0.1, 3), rng.uniform(-0.5, 0.5, 3))
        seen = np.linalg.inv(tips @ eye) @ board
    else:
        eye = transform(np.array([1.0, 0.3, 0.8]) + rng.uniform(-0.2, 0.2, 3), rng.uniform(-1.5, 1.5, 3))
        board = transform(rng.uniform(-0.1, 0.1, 3), rng.uniform(-0.5, 0.5, 3))
        seen = np.linalg.inv(eye) @ tips @ board
    noise = [transform(rng.normal(0, LENGTH_NOISE, 3), np.zeros(3)) for _ in q]
    turns = Rotation.from_rotvec(rng.normal(0, ANGLE_NOISE, (POSES, 3))).as_matrix()
    for pose, shift, turn in zip(seen, noise, turns, strict=True):
        pose[:3, 3] += shift[:3, 3]
        pose[:3, :3] = turn @ pose[:3, :3]
    return robot, q, seen, eye


def by_opencv(method: int, camera: str, robot: bik.Robot, q: Array, seen: Array) -> Array:
    """Pose of the camera in the frame of the tip, or of the base."""
    arm = robot.fk(q)
    if camera == "fixed":
        arm = np.linalg.inv(arm)
    turn, shift = cv2.calibrateHandEye(arm[:, :3, :3], arm[:, :3, 3], seen[:, :3, :3], seen[:, :3, 3], method=method)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, shift.ravel()
    return pose


def errors(found: Array, exact: Array) -> tuple[float, float]:
    """Distance (m) and angle (rad)."""
    if not np.isfinite(found).all():
        return float("inf"), float("inf")
    apart = Rotation.from_matrix(exact[:3, :3].T @ found[:3, :3]).magnitude()
    return float(np.linalg.norm(found[:3, 3] - exact[:3, 3])), float(apart)


def main() -> None:
    """Runs both arrangements and writes the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--sets", type=int, default=50)
    options.add_argument("--out", type=Path, default=Path())
    given = options.parse_args()
    with (given.out / "hand_eye.csv").open("w", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(
            ["camera", "method", "position error [mm]", "worst [mm]", "rotation error [mrad]", "worst [mrad]"]
        )
        for camera in ("hand", "fixed"):
            found: dict[str, list[tuple[float, float]]] = {name: [] for name in ("beetle-ik", *METHODS)}
            for seed in range(given.sets):
                robot, q, seen, eye = simulated(camera, seed)
                result = bik.calibrate(robot, q, seen, camera=camera)
                found["beetle-ik"].append(errors(np.array(result.camera), eye))
                for name, method in METHODS.items():
                    found[name].append(errors(by_opencv(method, camera, robot, q, seen), eye))
            for name, all_errors in found.items():
                lengths, angles = zip(*all_errors, strict=True)
                figures = [statistics.median(lengths), max(lengths), statistics.median(angles), max(angles)]
                writer.writerow([camera, name, *(f"{1e3 * figure:.3f}" for figure in figures)])
                print(camera, name, *(f"{1e3 * figure:.3f}" for figure in figures))


if __name__ == "__main__":
    main()
