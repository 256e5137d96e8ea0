"""Repetitive motion: joint drift and accumulated error after ten rounds of a circle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import beetle_ik as bik

from ...report import Check, Claim, Column, Figure, Part, Section, Table, drawing, line, number
from ..experiment import Context
from . import dual_network
from .dual_network import DualNetwork
from .other_methods import COARSE, FEEDBACK
from .settings import ADAPTIVE, DT, IIWA, NO_LIMITS, ON_CIRCLE, PUBLISHED, Array, circle

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "Repetitive motion"
_ROUNDS = 10
_ROUND, _ROUND_SHORT = 10.0, 5.0  # s
_DRIFTED = 0.1  # rad
_GROWN = 1.5
_CLOSED = 1e-6  # rad
_OPEN = "pseudo-inverse, open loop"
_FED_BACK = f"pseudo-inverse, feedback {FEEDBACK:g}/s"
_SECANTS = "BroydenBAS"

_TEXT = """
When the tool of a redundant arm closes a circle, the joints need not return to their start, and the drift of each round
adds up. The paper rightly says so of the pseudo-inverse. It does not say that ZNNBAS drifts too: on average its steps
point down the gradient of the error, as those of the pseudo-inverse do, so its joints drift as far, and randomly in
addition.

Two methods return to their start. The dual network does so if its criterion includes a term that pulls towards the
first posture. `BroydenBAS` does so by construction: it steps along the rows of its estimated Jacobian, and a secant
update adds to the rows only what is already in their span. As long as it makes no new test motions, its joints stay in
a space of three dimensions, in which a tool position has, locally, one configuration.
"""


@dataclass(frozen=True)
class Rounds:
    """Drift and error of a method, round by round (k,)."""

    drift: Array
    """Largest joint difference from the first configuration (rad)."""
    error: Array
    """Largest distance of the tool from the path (m); for ZNNBAS at theta."""


def repetition(context: Context) -> Part:
    """Runs ten rounds by each method."""
    count, duration = context.pick(full=(_ROUNDS, _ROUND), short=(3, _ROUND_SHORT))
    one = circle(duration)
    path = bik.paths.from_function(lambda t: one.position(t % duration), count * duration)
    rounds = {name: _by_round(q, path, count) for name, q in _runs(path, context).items()}
    section = Section(
        TITLE,
        [
            _TEXT,
            Figure(
                name="repetition",
                title="How far the joints are from where they began, after each round",
                drawing=_draw(rounds),
                caption=f"A circle of 0.2 m in {duration:g} s a round. Ticks of 10 ms with a model, of "
                "1 ms without. The pseudo-inverse, `track` as it is and the network of least velocity coincide.",
            ),
            _table(rounds),
        ],
    )
    return section, [
        not_repeatable(float(rounds[_OPEN].drift[-1]), count),
        adds_up(rounds[_OPEN].error, rounds[_FED_BACK].error),
        closes(float(rounds[_SECANTS].drift[-1]), count),
    ]


def not_repeatable(drift: float, rounds: int) -> Claim:
    """Judges the joint drift of the pseudo-inverse after `rounds` rounds (rad)."""
    return Claim.judged(
        "The pseudo-inverse does not produce repeatable results.",
        source="Section 1, on reference 23",
        rule=f"After {rounds} rounds of a circle a joint is over {number(_DRIFTED, 1)} rad from where it began.",
        measured=f"{number(drift)} rad",
        holds=drift > _DRIFTED,
        reading="The circle of Cheng et al., from a configuration of ours.",
        section=TITLE,
    )


def adds_up(open_loop: Array, fed_back: Array) -> Claim:
    """Judges the largest tool errors of the rounds (m), in open loop and with feedback."""
    growth = float(open_loop[-1] / open_loop[0])
    return Claim.judged(
        "Methods that know the model operate in open loop, so that position errors accumulate.",
        source="Section 1",
        rule=f"The largest error of the last round is over {_GROWN:g} times that of the first.",
        measured=f"open loop: {number(1e3 * open_loop[0])} to {number(1e3 * open_loop[-1])} mm; with the position fed "
        f"back: {number(1e3 * fed_back[0])} to {number(1e3 * fed_back[-1])} mm",
        holds=growth > _GROWN,
        reading="In open loop, as the paper has it. One term of feedback, which both methods take, ends it.",
        section=TITLE,
    )


def closes(drift: float, rounds: int) -> Check:
    """Checks the joint drift of BroydenBAS after `rounds` rounds (rad)."""
    return Check(
        statement="`BroydenBAS` repeats its joint motion without a criterion for it.",
        rule=f"After {rounds} rounds no joint is {number(_CLOSED, 1)} rad from where it began.",
        measured=f"{number(drift)} rad",
        holds=drift < _CLOSED,
        section=TITLE,
    )


def _runs(path: bik.Path, context: Context) -> dict[str, Array]:
    """Returns the joints (k, n) by method."""
    ones = np.ones(IIWA.dof)

    def modelled(**options: object) -> Array:
        return np.asarray(bik.track(IIWA, path, ON_CIRCLE, dt=COARSE, limits=NO_LIMITS, **options).q)  # type: ignore[arg-type]

    def network(drift_free: float) -> Array:
        options = DualNetwork(feedback=FEEDBACK, drift_free=drift_free)
        return dual_network.track(IIWA, path, ON_CIRCLE, dt=COARSE, network=options).q

    def model_free(controller: bik.papers.ZNNBAS | bik.BroydenBAS) -> Array:
        plant = bik.KinematicPlant(IIWA)
        result = bik.track_model_free(plant, path, ON_CIRCLE, dt=DT, controller=controller, seed=context.seed)
        return np.asarray(result.q)

    methods = {
        _OPEN: lambda: modelled(solver=bik.WeightedPseudoInverse(gain=0.0, weights=ones)),
        _FED_BACK: lambda: modelled(solver=bik.WeightedPseudoInverse(gain=FEEDBACK, weights=ones)),
        "`track`, as it is": lambda: modelled(),
        "`track`, goal `Posture`": lambda: modelled(goals=[bik.goals.Posture(ON_CIRCLE)]),
        "dual network, least velocity": lambda: network(0.0),
        "dual network, drift-free": lambda: network(5.0),
        "ZNNBAS, printed constants": lambda: model_free(PUBLISHED),
        "ZNNBAS, eq. (16), k = 100": lambda: model_free(ADAPTIVE),
        _SECANTS: lambda: model_free(bik.BroydenBAS(max_evaluations_per_step=1)),
    }
    return {name: methods[name]() for name in context.each("khan2022: repetitive motion", list(methods))}


def _by_round(q: Array, path: bik.Path, count: int) -> Rounds:
    ticks = (len(q) - 1) // count
    reference = path.position(path.duration / (len(q) - 1) * np.arange(len(q)))
    errors = np.linalg.norm(IIWA.fk(q)[:, :3, 3] - reference, axis=1)
    ends = ticks * np.arange(1, count + 1)
    return Rounds(
        np.abs(q[ends] - q[0]).max(axis=1), np.array([errors[end - ticks + 1 : end + 1].max() for end in ends])
    )


def _table(rounds: dict[str, Rounds]) -> Table:
    return Table(
        name="rounds",
        title=f"After one round and after {len(next(iter(rounds.values())).drift)}",
        columns=[
            Column(name="method"),
            Column(name="joints off, first round", unit="rad", digits=4),
            Column(name="joints off, last round", unit="rad", digits=4),
            Column(name="tool off, first round", unit="mm", digits=4),
            Column(name="tool off, last round", unit="mm", digits=4),
        ],
        rows=[
            [name, float(r.drift[0]), float(r.drift[-1]), 1e3 * float(r.error[0]), 1e3 * float(r.error[-1])]
            for name, r in rounds.items()
        ],
        caption="Largest joint difference from the start, and largest tool error of the round; of ZNNBAS at θ.",
    )


def _draw(rounds: dict[str, Rounds]) -> Drawing:
    markers = "os^vD<>PX"
    with drawing(4.2) as figure:
        axes = figure.subplots()
        for i, (name, found) in enumerate(rounds.items()):
            axes.semilogy(np.arange(1, len(found.drift) + 1), found.drift, label=name.replace("`", ""),
                          marker=markers[i], markersize=4.0, **line(i))  # fmt: skip
        axes.set(xlabel="rounds", ylabel="largest joint difference [rad]")
        axes.set_xticks(np.arange(1, len(found.drift) + 1))
        axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize="small")
    return figure
