"""Tables 2 and 3, Figures 6 and 7: the best posture of three equal links, for the tip or for the whole arm."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ... import Robot
from ...papers import CircleSwarm, PlanarPosture, planar_posture
from ...report import (
    BLUE,
    GREEN,
    VERMILION,
    Block,
    Cell,
    Column,
    Figure,
    Part,
    Section,
    Table,
    drawing,
    line,
)
from ..experiment import Context
from .posture_claims import (
    SECTION,
    SMALL,
    PosturesAt,
    area_is_balance,
    balanced,
    best_so_far,
    constriction,
    found_best,
    least_sine,
    own_search,
    printed_optima,
    second_joint_small,
    straight_arm_singular,
    text_and_tables,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TITLE = SECTION
_Measure: TypeAlias = Literal["tip", "overall"]
_MEASURES: tuple[_Measure, ...] = ("tip", "overall")  # measures of Tables 2 and 3
_FLOOR = 1e-7  # lower end of a logarithmic scale
TARGET = (0.5, 0.5, 0.0)  # E, section 3.1
LENGTH = 0.5  # m; the paper gives none
ARM = Robot.planar([LENGTH] * 3)
QUADRANT = ((0.0, 0.0), (np.inf, np.inf))
_PLACES = ("anywhere", "first quadrant")
# Lengths: the paper gives none. 1.4 m is its swing radius (Table 1); 1.3455 m gives its SM3 of 6.9278.
LENGTHS = {f"{length:g} m": length for length in (0.3, 0.467, 0.5, 1.0, 1.3455)}
PRINTED: dict[_Measure, list[float]] = {
    "tip": [6.912, 6.9138, 6.9139, 6.9171, 6.9179, 6.9208, 6.9255, 6.9278, 6.9278, 6.9278],  # Table 2
    "overall": [10.782, 10.7986, 10.7977, 10.7978, 10.7992, 10.7996, 10.7998, 10.8001, 10.8003, 10.8003],  # Table 3
}
SYMBOLS = {"tip": "SM₃", "overall": "SM"}
# Optima by a scan of 4e6 points of the self-motion with links of 0.3, 0.5 and 1 m: SM₃ and SM anywhere and in the
# quadrant.
SCANNED: dict[float, dict[_Measure, tuple[float, float]]] = {
    0.3: {"tip": (0.727905, 0.727905), "overall": (0.947446, 0.915893)},
    0.5: {"tip": (1.720667, 1.493501), "overall": (2.488703, 1.900676)},
    1.0: {"tip": (4.403020, 2.720699), "overall": (7.503629, 5.584065)},
}

_TEXT = """
Three equal links hold their tip at E = (0.5, 0.5). One degree of freedom is left. The paper searches it for the posture
in which unit joint speeds move the tip over the largest ellipse, SM₃, or in which the ellipses of all links together
are largest, SM. Its particles are joint points on circles, projected back onto them in every generation.

Compare the course of printed and measured values, not their size: the link length is not given (0.5 m here), and no
length fits both. c₁ = c₂ = 2.05 stand for the printed φ > 3, at which eq. (18) has no real root.
"""
_TEXT_LENGTH = """
The paper says of the tip's best posture that its joint angle q₂ is “very small”, and of the whole arm's that its angles
are “very balanced”. The first is true only for links that barely reach E; the second depends on the link length and on
the meaning of balance. An arm with q₂ = 0 is not singular either, unless q₃ is zero too: only the tip of link 2 loses a
direction.
"""


def index(posture: PlanarPosture, measure: _Measure) -> float:
    """Returns SM₃ = pi w, or SM."""
    return _scale(measure) * posture.index


def _scale(measure: _Measure) -> float:
    """Returns the factor from the library's index to the paper's."""
    return float(np.pi) if measure == "tip" else 1.0


def postures(context: Context) -> Part:
    """Finds the best postures by the swarm, for the tip and for the whole arm, over the length of the links."""
    seeds = context.seeds(50)
    best = {
        measure: max(
            (planar_posture(ARM, TARGET, measure=measure, swarm=CircleSwarm(), seed=seed) for seed in seeds),
            key=lambda posture: posture.index,
        )
        for measure in context.each("pso-tracking: Tables 2 and 3", _MEASURES)
    }
    optima, largest = _optima()
    lengths = {name: postures_at(length) for name, length in LENGTHS.items()}
    printed = {place: _at_printed_tip(region) for place, region in zip(_PLACES, (None, QUADRANT), strict=True)}
    at_printed = {f"{length:.4g} m": postures_at(length) for length, _ in printed.values()}
    blocks: list[Block] = [
        _TEXT,
        *(_table(measure, posture, len(seeds)) for measure, posture in best.items()),
        _gaps(seeds),
        _figure("figure_6", "Figure 6: the best posture for the tip", best["tip"], "tip"),
        _figure("figure_7", "Figure 7: the best posture for the whole arm", best["overall"], "overall"),
        _TEXT_LENGTH,
        _over_length(context),
        optima,
    ]
    return Section(TITLE, blocks), [
        found_best(_swarm_gaps(seeds), len(seeds)),
        printed_optima(printed, PRINTED["overall"][-1]),
        text_and_tables({"SM₃": (6.816, PRINTED["tip"][-1]), "SM": (10.6883, PRINTED["overall"][-1])}),
        best_so_far({SYMBOLS[measure]: printed for measure, printed in PRINTED.items()}),
        second_joint_small(at_printed, lengths),
        straight_arm_singular(_least_singular_value()),
        balanced(lengths),
        area_is_balance({name: _balance_of_largest(length) for name, length in LENGTHS.items()}),
        constriction([3.25, 3.5, 3.75, 4.1]),
        own_search(largest),
    ]


def postures_at(length: float) -> PosturesAt:
    """Returns the best postures of three links of `length` (m), by the library's own search."""
    arm = Robot.planar([length] * 3)
    angles: dict[_Measure, tuple[float, ...]] = {
        measure: _wrapped(planar_posture(arm, TARGET, measure=measure).q) for measure in _MEASURES
    }
    inside = _wrapped(planar_posture(arm, TARGET, region=QUADRANT).q)
    return PosturesAt(tip=angles["tip"], overall=angles["overall"], tip_in_quadrant=inside)


def _wrapped(q: NDArray[np.float64]) -> tuple[float, ...]:
    """Wraps angles to (-pi, pi] (rad)."""
    return tuple(float(angle) for angle in np.pi - (np.pi - np.asarray(q)) % (2.0 * np.pi))


def _swarm_gaps(seeds: range) -> dict[str, float]:
    """Returns the gap between the best of the runs and the optimum, by reading."""
    gaps = {}
    for length, scanned in SCANNED.items():
        arm = Robot.planar([length] * 3)
        for measure, optima in scanned.items():
            for place, region, optimum in zip(_PLACES, (None, QUADRANT), optima, strict=True):
                runs = (
                    planar_posture(arm, TARGET, measure=measure, region=region, swarm=CircleSwarm(), seed=seed)
                    for seed in seeds
                )
                gaps[f"{SYMBOLS[measure]}, links of {length:g} m, {place}"] = max(
                    0.0, 1.0 - max(index(run, measure) for run in runs) / optimum
                )
    return gaps


def _at_printed_tip(region: tuple[tuple[float, float], tuple[float, float]] | None) -> tuple[float, float]:
    """Returns the length of the links (m) that gives the printed SM3, and SM at this length."""
    low, high = 0.3, 4.0  # SM3 grows with the length
    for _ in range(30):
        length = 0.5 * (low + high)
        found = index(planar_posture(Robot.planar([length] * 3), TARGET, region=region), "tip")
        low, high = (length, high) if found < PRINTED["tip"][-1] else (low, length)
    return length, index(
        planar_posture(Robot.planar([length] * 3), TARGET, measure="overall", region=region), "overall"
    )


def _least_singular_value() -> float:
    """Returns the least singular value of the tip's Jacobian (m), links 1 and 2 in a line, link 3 at right angles."""
    jacobian = ARM.jacobian(np.array([0.3, 0.0, 0.5 * np.pi]))[:2]
    return float(np.linalg.svd(jacobian, compute_uv=False).min())


def _balance_of_largest(length: float) -> tuple[float, float]:
    """Returns the axis ratio (shortest over longest) of the tip's ellipse at its largest area, and the best ratio."""
    arm = Robot.planar([length] * 3)
    axes = np.array([arm.velocity_ellipsoid(q).lengths[:2] for q in _self_motion(length)])
    ratios = axes.min(axis=1) / axes.max(axis=1)
    return float(ratios[axes.prod(axis=1).argmax()]), float(ratios.max())


def _self_motion(length: float, samples: int = 360) -> list[NDArray[np.float64]]:
    """Returns postures (3,) (rad) that hold the tip at the target, for both elbows."""
    goal = np.array(TARGET[:2])
    found = []
    for first in np.linspace(-np.pi, np.pi, samples, endpoint=False):
        to_goal = goal - length * np.array([np.cos(first), np.sin(first)])
        half = np.linalg.norm(to_goal) / (2.0 * length)
        if half > 1.0:
            continue
        for elbow in (-1.0, 1.0):
            second = np.arctan2(to_goal[1], to_goal[0]) - elbow * np.arccos(half)
            found.append(np.array([first, second - first, 2.0 * elbow * np.arccos(half)]))
    return found


def _over_length(context: Context) -> Figure:
    lengths = np.linspace(0.24, 1.4, context.pick(full=117, short=30))
    at = [postures_at(float(length)) for length in lengths]
    with drawing(height=3.6) as figure:
        second, balance = figure.subplots(1, 2)
        second.plot(lengths, [np.degrees(abs(p.tip[1])) for p in at], label="anywhere", **line(0))
        second.plot(lengths, [np.degrees(abs(p.tip_in_quadrant[1])) for p in at], label="first quadrant", **line(1))
        second.axhline(SMALL, color="black", linestyle=":", linewidth=1.0, label=f"{SMALL:g}°: small")
        second.set(ylabel="|q₂| where SM₃ is largest [°]")
        for i, (label, q) in enumerate((("for the tip", "tip"), ("for the whole arm", "overall"))):
            balance.plot(lengths, [least_sine(getattr(p, q)) for p in at], label=label, **line(i))
        balance.set(ylabel="smallest |sin q| of q₂, q₃")
        for axes in (second, balance):
            axes.axvline(LENGTH, color="black", linewidth=0.6)
            axes.set(xlabel="length of each link [m]")
            axes.legend(fontsize="small")
    return Figure(
        name="over_length",
        title="What the paper says of q₂ and of balance, over the length that it does not give",
        drawing=figure,
        caption="Left: where the tip's ellipse is largest, q₂ is small only while the links barely reach E. Right: "
        "what “balanced” may mean; below 0.4 m the tip's posture has more of it, above the whole arm's, by little. "
        "The thin line is 0.5 m.",
    )


def _table(measure: _Measure, best: PlanarPosture, runs: int) -> Table:
    printed, scale, optimum = PRINTED[measure], _scale(measure), SCANNED[LENGTH][measure][0]
    number_printed = 2 + _MEASURES.index(measure)
    rows: list[list[Cell]] = [
        [
            generation + 1,
            (printed[generation], float(scale * value)),
            (
                _rounded(100 * (1 - printed[generation] / printed[-1])),
                max(0.0, float(100 * (1 - scale * value / optimum))),
            ),
        ]
        for generation, value in enumerate(best.history)
    ]
    return Table(
        name=f"table_{number_printed}",
        title=f"Table {number_printed}: {SYMBOLS[measure]} by generation, the best of {runs} runs",
        columns=[
            Column(name="generation"),
            Column(name=SYMBOLS[measure], compared=True, digits=5),
            Column(name="below the optimum", unit="%", compared=True),
        ],
        rows=rows,
        caption="The printed course is measured against its own last value, ours against the optimum of a dense scan.",
    )


def _rounded(value: float) -> float:
    """Rounds to the digits that differences of printed values have."""
    return float(f"{value:.2g}")


def _gaps(seeds: range) -> Table:
    swarms = {
        "5 × 10, r in [0, 1]": CircleSwarm(),
        "5 × 10, r in [-1, 1], as printed": CircleSwarm(signed=True),
        "20 × 50, r in [0, 1]": CircleSwarm(population=20, generations=50),
    }
    rows: list[list[Cell]] = []
    for name, swarm in swarms.items():
        for column, (place, region) in enumerate(zip(_PLACES, (None, QUADRANT), strict=True)):
            gaps = [
                1.0
                - index(planar_posture(ARM, TARGET, region=region, swarm=swarm, seed=seed), "tip")
                / SCANNED[LENGTH]["tip"][column]
                for seed in seeds
            ]
            percent = [float(100 * max(value, 0.0)) for value in (min(gaps), float(np.median(gaps)), max(gaps))]
            rows.append([name, place, *percent])
    return Table(
        name="swarms",
        title=f"How far the swarm stays below the best SM₃, over {len(seeds)} seeds",
        columns=[
            Column(name="particles × generations"),
            Column(name="joint points"),
            *(Column(name=name, unit="%") for name in ("best", "median", "worst")),
        ],
        rows=rows,
        caption="In the first quadrant the optimum lies on the edge, C = (l, 0), which particles seldom meet.",
    )


def _optima() -> tuple[Table, float]:
    rows: list[list[Cell]] = []
    largest = 0.0
    for length, optima in SCANNED.items():
        arm = Robot.planar([length] * 3)
        for measure, scanned in optima.items():
            for place, region, optimum in zip(_PLACES, (None, QUADRANT), scanned, strict=True):
                own = index(planar_posture(arm, TARGET, measure=measure, region=region), measure)
                largest = max(largest, abs(1 - own / optimum))
                rows.append([length, SYMBOLS[measure], place, optimum, own])
    return Table(
        name="optima",
        title="The library's own search beside a scan of 4 million postures",
        columns=[
            Column(name="links", unit="m"),
            Column(name="index"),
            Column(name="joint points"),
            Column(name="scan", digits=7),
            Column(name="own search", digits=7),
        ],
        rows=rows,
    ), largest


def _figure(name: str, title: str, posture: PlanarPosture, measure: _Measure) -> Figure:
    with drawing(height=4.4) as figure:
        arm, course = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
        draw_arm(arm, ARM, posture.q)
        generations = np.arange(1, 11)
        printed = np.array(PRINTED[measure])
        ours = _scale(measure) * posture.history / SCANNED[LENGTH][measure][0]
        for i, (label, share) in enumerate((("ours", ours), ("printed", printed / printed[-1]))):
            course.semilogy(generations, 100 * np.maximum(1 - share, _FLOOR), label=label, marker=".", **line(i))
        course.set(xlabel="generation", ylabel=f"{SYMBOLS[measure]} below its optimum [%]")
        course.legend()
    angles = ", ".join(f"{angle:.0f}°" for angle in np.degrees(posture.q))
    return Figure(
        name=name,
        title=title,
        drawing=figure,
        caption=f"Joint angles {angles}. The ellipses show how the tips of link 2 and link 3 move at unit joint "
        "speeds, a quarter of true size; gaps below 1e-5 % are drawn as that.",
    )


def draw_arm(axes: Axes, robot: Robot, q: NDArray[np.float64], *, scale: float = 0.25) -> None:
    """Draws a planar arm with the velocity ellipses of its links' tips, `scale` metres per m/s."""
    joints = robot.link_poses(q)[1:, :2, 3]
    for i, color in zip(range(2, len(joints)), (GREEN, VERMILION), strict=False):
        part = Robot.planar(np.linalg.norm(np.diff(joints[: i + 1], axis=0), axis=1))
        ellipsoid = part.velocity_ellipsoid(q[:i])
        turn = np.linspace(0.0, 2 * np.pi, 200)
        circle = np.stack((np.cos(turn), np.sin(turn)), axis=1) * ellipsoid.lengths
        outline = joints[i] + scale * circle @ ellipsoid.axes[:, :2]
        axes.plot(*outline.T, color=color, linewidth=1.1, label=f"velocities of the tip of link {i}")
        axes.fill(*outline.T, color=color, alpha=0.12, linewidth=0)
    axes.plot(*joints.T, color=BLUE, linewidth=4, marker="o", markersize=7, label="arm")
    for name, point in zip("ACBE", joints, strict=False):
        # Labels go outward from the middle of the arm, where no link is.
        outward = point - joints.mean(axis=0)
        away = 14.0 * outward / np.linalg.norm(outward)
        axes.annotate(name, point, textcoords="offset points", xytext=tuple(away), ha="center", va="center")
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.margins(0.2)
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend(loc="best", fontsize="small")
