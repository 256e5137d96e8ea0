"""Live targets that jump and are noisy: `Tracker` compared with other libraries, tick by tick.

    python benches/noisy_targets.py --arms franka_panda ur5e iiwa14 --out DIR

Three parts, on the same targets for all: jumps of 0.2 m under noise (settling, deviation from the straight way, shaking
at rest, time a tick), a smooth path without noise (lag), and a noisy stream of 60 Hz (lag, error, acceleration, jerk).
`benches/README.md` says how to set it up.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import tempfile
import warnings
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from peers import arms, beetle_movers, differential_movers, motion, planned_movers
from peers.adapter import load
from peers.chain import Chain
from peers.live_report import (
    OVER_NOISE_COLUMNS,
    STREAM_SUMMARY_COLUMNS,
    SUMMARY_COLUMNS,
    over_noise_lines,
    plot_over_noise,
    rows,
    stream_summary_lines,
    summary_lines,
)
from peers.live_targets import (
    JUMP,
    PERIOD,
    RADIUS,
    SEED,
    STREAM_JITTER,
    STREAM_LATENCY,
    STREAM_NOISE,
    STREAM_RATE,
    jumps,
    smooth_path,
    stream,
)
from peers.mover import Mover, Setting
from peers.report import plain_section, write_table

JUMPING = [
    beetle_movers.BeetleIk,
    planned_movers.ToolboxThenRuckig,
    planned_movers.PlacoThenRuckig,
    planned_movers.ServoPy,
]
STREAMING = [
    beetle_movers.BeetleIk,
    beetle_movers.BeetleIkStream,
    beetle_movers.BeetleIkOneEuro,
    beetle_movers.BeetleIkLowPass,
    planned_movers.ToolboxThenRuckig,
    differential_movers.Mink,
    differential_movers.SlowMink,
    differential_movers.Pink,
    differential_movers.Placo,
]
VELOCITY, ACCELERATION, JERKS = 1.5, 5.0, (None, 50.0)
NOISES = (0.0, 1e-6, 1e-5, 1e-4, 1e-3, 5e-3)  # standard deviation, m and rad
TICKS = (1e-3, 2e-3, 5e-3, 20e-3)  # s
STREAM_TICK = 2e-3  # s


@dataclass
class Measured:
    """Figures so far, as lines of tables, and the reasons for missing libraries."""

    jumps: list[list[str]] = field(default_factory=list)
    smooth: list[list[str]] = field(default_factory=list)
    stream: list[list[str]] = field(default_factory=list)
    missing: dict[str, None] = field(default_factory=dict)


def main() -> None:
    """Measures all arms and writes the results, again after each arm: the run is long."""
    arguments = parse_arguments()
    warnings.filterwarnings("ignore")  # of libraries, about solvers and deprecated calls
    arguments.out.mkdir(parents=True, exist_ok=True)
    measured = Measured()
    with tempfile.TemporaryDirectory() as scratch:
        for chain in arms.chosen(arguments, Path(scratch)):
            for jerk in JERKS:
                for dt in arguments.ticks:
                    print(f"{chain.name}, {1e3 * dt:g} ms, jerk {limit_name(jerk)}", flush=True)
                    setting = Setting(dt, VELOCITY, ACCELERATION, jerk)
                    measure_jumps(chain, setting, arguments, measured)
                    measure_smooth(chain, setting, measured)
                measure_stream(chain, Setting(STREAM_TICK, VELOCITY, ACCELERATION, jerk), measured)
            write(measured, arguments.out)
    print(f"wrote the tables, noisy_targets.md and noisy_targets.png to {arguments.out}")


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arms.add_arguments(parser, arms=("franka_panda", "ur5e", "iiwa14"))
    parser.add_argument("--ticks", nargs="+", type=float, default=TICKS, help="tick lengths (s)")
    parser.add_argument("--noises", nargs="+", type=float, default=NOISES, help="standard deviations (m and rad)")
    parser.add_argument("--jumps", type=int, default=3, help="jumps an arm (default: 3)")
    parser.add_argument("--seconds", type=float, default=3.0, help="time for a jump and the rest after it (default: 3)")
    parser.add_argument("--out", type=Path, default=Path("noisy"), help="where the results go (default: noisy)")
    return parser.parse_args()


JUMP_COLUMNS = [
    *("robot", "tick_ms", "jerk_limit", "noise_sd_m", "library", "settling_s", "slowest_settling_s"),
    *("off_the_line_mm", "rest_acceleration_rms", "rest_jerk_rms", "acceleration_over_limit", "jerk_over_limit"),
    *("tick_median_us", "tick_p99_us", "tick_median_in_a_row_us"),
]


def measure_jumps(chain: Chain, setting: Setting, arguments: argparse.Namespace, measured: Measured) -> None:
    """Measures all libraries at the same jumps, for each level of noise."""
    movers = available(JUMPING, chain, setting, measured)
    ticks = round(arguments.seconds / setting.dt)
    for noise in arguments.noises:
        runs: dict[str, list[list[float]]] = {mover.name: [] for mover in movers}
        for number, (start, goal) in enumerate(jumps(chain, arguments.jumps)):
            random = np.random.default_rng([SEED, number])
            targets = motion.noisy(np.tile(goal, (ticks, 1, 1)), noise, random)
            commanded = motion.drive(movers, start, targets)
            in_a_row = motion.drive(movers, start, targets[: ticks // 3], in_a_row=50)
            for name, mine in commanded.items():
                runs[name].append([*judge_jump(chain, mine, goal, setting, noise), np.median(in_a_row[name].times)])
        for name, figures in runs.items():
            settling, *rest = np.array(figures).T
            row = [motion.median(settling), settling.max(), *(float(np.median(each)) for each in rest)]
            keys = [chain.name, f"{1e3 * setting.dt:g}", limit_name(setting.jerk), f"{noise:g}", name]
            measured.jumps.append([*keys, *map(cell, row)])


def judge_jump(
    chain: Chain, commanded: motion.Commanded, goal: np.ndarray, setting: Setting, noise: float
) -> list[float]:
    """Figures of one jump except the time in a row; the last third of the time counts as rest."""
    points, dt = motion.tips(chain, commanded.q), setting.dt
    at_rest = commanded.q[-len(commanded.q) // 3 :]
    return [
        motion.settling_time(np.linalg.norm(points - goal[:3, 3], axis=1), dt, noise),
        1e3 * motion.off_the_line(points, points[0], goal[:3, 3]),
        motion.rms_rate(at_rest, 2, dt),
        motion.rms_rate(at_rest, 3, dt),
        *over_limits(commanded.q, setting),
        float(np.median(commanded.times)),
        float(np.quantile(commanded.times, 0.99)),
    ]


def over_limits(q: np.ndarray, setting: Setting) -> tuple[float, float]:
    """Largest acceleration and jerk relative to their limits, NaN without a limit; the arm starts at rest."""
    q = np.vstack([q[:1], q[:1], q])
    acceleration = motion.excess(q, 2, setting.dt, setting.acceleration)
    return acceleration, np.nan if setting.jerk is None else motion.excess(q, 3, setting.dt, setting.jerk)


SMOOTH_COLUMNS = ["robot", "tick_ms", "jerk_limit", "library", "lag_ms", "error_rms_mm", "largest_error_mm"]


def measure_smooth(chain: Chain, setting: Setting, measured: Measured) -> None:
    """Measures the lag of all libraries behind a smooth path that begins at rest."""
    start, path = smooth_path(chain, setting.dt)
    for name, commanded in motion.drive(available(JUMPING, chain, setting, measured), start, path[1:]).items():
        points = motion.tips(chain, commanded.q)
        error = np.linalg.norm(points - path[:, :3, 3], axis=1)
        row = [
            1e3 * motion.lag(points, path[:, :3, 3], setting.dt),
            1e3 * np.sqrt(np.mean(error**2)),
            1e3 * error.max(),
        ]
        keys = [chain.name, f"{1e3 * setting.dt:g}", limit_name(setting.jerk), name]
        measured.smooth.append([*keys, *map(cell, row)])


STREAM_COLUMNS = [
    *("robot", "jerk_limit", "library", "lag_ms", "error_rms_mm", "error_without_lag_rms_mm"),
    *("acceleration_rms", "jerk_rms", "acceleration_over_limit", "jerk_over_limit"),
]


def measure_stream(chain: Chain, setting: Setting, measured: Measured) -> None:
    """Measures lag, error, acceleration and jerk of all libraries on the same slow, late and noisy stream."""
    start, path = smooth_path(chain, setting.dt)
    arrivals = stream(path, setting.dt)
    for mover in available(STREAMING, chain, setting, measured):
        mover.begin(start)
        mover.listen(path[0], 0.0)
        mover.begin(start)
        q = np.array([start, *(mover.listen(*arrivals.get(i, (None, None))) for i in range(1, len(path)))])
        points = motion.tips(chain, q)
        late = motion.lag(points, path[:, :3, 3], setting.dt)
        shifted = motion.delayed(path[:, :3, 3], late / setting.dt)
        row = [
            1e3 * late,
            1e3 * rms(points - path[:, :3, 3]),
            1e3 * rms(points - shifted),
            motion.rms_rate(q, 2, setting.dt),
            motion.rms_rate(q, 3, setting.dt),
            *over_limits(q, setting),
        ]
        measured.stream.append([chain.name, limit_name(setting.jerk), mover.name, *map(cell, row)])


def rms(differences: np.ndarray) -> float:
    """Root mean square of the lengths of the rows."""
    return float(np.sqrt(np.mean((differences**2).sum(axis=1))))


def available(movers: list[type[Mover]], chain: Chain, setting: Setting, measured: Measured) -> list[Mover]:
    """Selects the libraries that are installed and accept this arm and these limits; notes the others."""
    found, missing = load(movers, chain, setting)
    measured.missing |= dict.fromkeys(f"- {name}, {chain.name}: {reason}" for name, reason in missing.items())
    return found


def limit_name(jerk: float | None) -> str:
    """Formats the limit for the tables."""
    return "none" if jerk is None else f"{jerk:g}"


def cell(value: float) -> str:
    """Formats the figure for the tables; a dash if it is not finite."""
    return f"{value:.4g}" if np.isfinite(value) else "-"


def write(measured: Measured, out: Path) -> None:
    """Writes the tables, the report and the picture."""
    write_table(out / "jumps.csv", JUMP_COLUMNS, measured.jumps)
    write_table(out / "smooth.csv", SMOOTH_COLUMNS, measured.smooth)
    write_table(out / "stream.csv", STREAM_COLUMNS, measured.stream)
    (out / "noisy_targets.md").write_text(markdown(measured), encoding="utf-8")
    over_noise = over_noise_lines(rows(JUMP_COLUMNS, measured.jumps))
    write_table(out / "live_targets_noise.csv", OVER_NOISE_COLUMNS, over_noise)
    write_table(out / "live_targets.csv", SUMMARY_COLUMNS, summarised(measured))
    streamed = stream_summary_lines(rows(STREAM_COLUMNS, measured.stream))
    write_table(out / "live_targets_stream.csv", STREAM_SUMMARY_COLUMNS, streamed)
    plot_over_noise(over_noise, out / "noisy_targets.png")


def summarised(measured: Measured) -> list[list[str]]:
    """Returns the lines of the short table."""
    return summary_lines(rows(JUMP_COLUMNS, measured.jumps), rows(SMOOTH_COLUMNS, measured.smooth))


def markdown(measured: Measured) -> str:
    """Returns the whole report."""
    every = dict.fromkeys((*JUMPING, *STREAMING))
    late = f"{1e3 * STREAM_LATENCY:g} to {1e3 * (STREAM_LATENCY + STREAM_JITTER):g} ms late"
    sections = [
        f"# Live targets\n\nLimits of every joint: {VELOCITY:g} rad/s, {ACCELERATION:g} rad/s², jerk as said. Noise is "
        "normal, on each coordinate in m and about each axis in rad. A dash: not settled, or not limited. Settled: "
        "within 2 mm, or 3 standard deviations of the noise, of the goal without noise, from then on. At rest: the "
        "last third. Rates are finite differences of the commanded joint angles, rms over joints and ticks.\n",
        plain_section(
            "Libraries and settings", ["library", "settings"], [[each.name, each.settings] for each in every]
        ),
        plain_section("Medians over arms and ticks", SUMMARY_COLUMNS, summarised(measured)),
        plain_section(f"Jumps of {JUMP:g} m", JUMP_COLUMNS, measured.jumps),
        plain_section(f"A smooth path, {RADIUS:g} m and {PERIOD:g} s a turn", SMOOTH_COLUMNS, measured.smooth),
        plain_section(
            f"The same path as a stream of {STREAM_RATE:g} Hz: noise {1e3 * STREAM_NOISE:g} mm and mrad, {late}, "
            f"ticks of {1e3 * STREAM_TICK:g} ms",
            STREAM_COLUMNS,
            measured.stream,
        ),
        "Not measured:\n",
        *measured.missing,
    ]
    return "\n".join(sections) + "\n"


if __name__ == "__main__":
    main()
