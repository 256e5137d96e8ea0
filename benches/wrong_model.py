"""A wrong model, mended or lived with: wrong arms track a circle with their model, calibrated, and without a model.

    python benches/wrong_model.py --arms 20 --out docs

writes `wrong_model.csv` and `images/wrong_model_error.png`. Calibration and tracking have the same sensor: positions
with 0.1 mm of noise on each axis, of an arm that is 1 mm and 0.5 degrees off. `track_model_free` measures the tip while
it runs, once or several times in a tick of 20 ms; the others run without a sensor.
"""

import argparse
import csv
import statistics
from pathlib import Path

import numpy as np
from calibration import ANGLE, LENGTH, SIGMA, model_of
from peers.calibration_judge import Array, built

import beetle_ik as bik

START = np.array([0.0, -0.4, 0.0, -2.2, 0.0, 1.8, 0.8])
DT, DURATION, APPROACH = 0.02, 20.0, 1.0  # s


def circle(model: bik.Robot) -> bik.Path:
    """A circle that begins at the tip of the start."""
    tip = model.fk(START)[:3, 3]
    return bik.paths.circle(tip - [0.1, 0.0, 0.0], diameter=0.2, duration=DURATION)


def errors(truth: bik.Robot, q: Array, path: bik.Path) -> Array:
    """Distances of the tip from the path (m) at each tick."""
    time = np.minimum(DT * np.arange(len(q)), DURATION)
    return np.asarray(np.linalg.norm(truth.fk(q)[:, :3, 3] - path.position(time), axis=1))


def one_arm(seed: int) -> dict[str, Array]:
    """Errors over time of each way."""
    rng = np.random.default_rng([29, seed])
    model = model_of("panda")
    truth = built(model, rng, LENGTH, ANGLE)
    path, found = circle(model), {}
    found["the model as it is"] = errors(truth, bik.track(model, path, START, dt=DT).q, path)
    for poses in (15, 40, 100):
        q = model.random_configurations(poses, seed=seed)
        measured = truth.fk(q)[:, :3, 3] + rng.normal(0, SIGMA, (poses, 3))
        mended = bik.calibrate(model, q, measured).robot
        found[f"calibrated with {poses} positions"] = errors(truth, bik.track(mended, path, START, dt=DT).q, path)
    plant = bik.KinematicPlant(truth, noise=SIGMA, seed=seed)
    for name, controller in (
        ("without a model, one measurement a tick", bik.BroydenBAS(max_evaluations_per_step=1)),
        ("without a model, several a tick", bik.BroydenBAS()),
    ):
        run = bik.track_model_free(plant, path, START, dt=DT, controller=controller)
        found[name] = errors(truth, run.q, path)
    return found


def draw(runs: dict[str, Array], file: Path) -> None:
    """Draws the errors of one arm over time."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(8.0, 3.6), layout="constrained", dpi=120)
    for name, values in runs.items():
        axes.semilogy(DT * np.arange(len(values)), 1e3 * np.maximum(values, 1e-6), label=name, linewidth=1.0)
    axes.set(xlabel="time [s]", ylabel="error of the tip [mm]")
    axes.legend(fontsize="small", loc="upper center", bbox_to_anchor=(0.5, 1.25), ncols=2, frameon=False)
    figure.savefig(file)


def main() -> None:
    """Runs all arms and writes table and figure."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--arms", type=int, default=20)
    options.add_argument("--out", type=Path, default=Path())
    given = options.parse_args()
    runs = [one_arm(seed) for seed in range(given.arms)]
    with (given.out / "wrong_model.csv").open("w", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(
            ["way", "error after 1 s [mm], median", "largest after 1 s [mm], median", "largest of all arms [mm]"]
        )
        for name in runs[0]:
            settled = [1e3 * run[name][round(APPROACH / DT) :] for run in runs]
            largest = [float(values.max()) for values in settled]
            typical = statistics.median(float(np.sqrt((values**2).mean())) for values in settled)
            writer.writerow([name, f"{typical:.3f}", f"{statistics.median(largest):.3f}", f"{max(largest):.3f}"])
            print(name, typical, statistics.median(largest), max(largest))
    (given.out / "images").mkdir(exist_ok=True)
    draw(runs[0], given.out / "images" / "wrong_model_error.png")


if __name__ == "__main__":
    main()
