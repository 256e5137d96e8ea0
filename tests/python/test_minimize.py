"""Minimisation of Python functions by every derivative-free solver."""

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from interrupts import interrupted
from mistakes import Case, Invalid, assert_told, told

import beetle_ik as bik

SOLVERS = [
    bik.papers.BAS(variant="chain"),
    bik.papers.BeeColony(),
    bik.papers.BeetleSwarm(),
    bik.DifferentialEvolution(),
    bik.DifferentialEvolution(update="immediate"),
    bik.papers.Firefly(),
    bik.papers.Genetic(),
    bik.papers.Genetic(mutation_rate=0.5),
    bik.papers.PSO(),
    bik.papers.PSO(form="inertia"),
    bik.papers.QPSO(),
    bik.MultiStart(bik.papers.PSO()),
]
LOWER, UPPER = [-1.0, -1.0, 0.0], [2.0, 3.0, 1.0]
BOTTOM = np.array([0.5, -0.25, 0.75])


def bowl(x: np.ndarray) -> float:
    return float(np.sum((x - BOTTOM) ** 2))


def bowls(xs: np.ndarray) -> np.ndarray:
    return np.sum((xs - BOTTOM) ** 2, axis=1)


def minimize(function: Callable[[np.ndarray], Any] = bowl, **options: Any) -> bik.Minimum:
    arguments: dict[str, Any] = {
        "solver": bik.papers.PSO(population=10),
        "stop": bik.Stop(max_evaluations=200),
        **options,
    }
    return bik.minimize(function, arguments.pop("lower", LOWER), arguments.pop("upper", UPPER), **arguments)


@pytest.mark.parametrize("solver", SOLVERS, ids=repr)
def test_every_solver_finds_the_bottom(solver: Any) -> None:
    found = minimize(solver=solver, stop=bik.Stop(value_below=1e-5))
    assert found.success, found.message
    assert found.status == bik.Status.SOLVED
    assert found.value == bowl(found.x) < 1e-5
    assert np.all((found.x >= LOWER) & (found.x <= UPPER))


@pytest.mark.parametrize("solver", SOLVERS, ids=repr)
def test_generations_at_once_give_the_same_bits(solver: Any) -> None:
    one, many = minimize(solver=solver, seed=3), minimize(bowls, solver=solver, seed=3, vectorized=True)
    np.testing.assert_allclose(one.x, many.x, rtol=1e-12)
    assert one.evaluations == many.evaluations == 200


def test_generations_come_whole() -> None:
    sizes: list[tuple[int, ...]] = []

    def watched(xs: np.ndarray) -> np.ndarray:
        sizes.append(xs.shape)
        return bowls(xs)

    minimize(watched, vectorized=True, stop=bik.Stop(max_evaluations=30))
    assert sizes == [(1, 3), (9, 3), (10, 3), (10, 3)]


def test_differential_evolution_is_the_default() -> None:
    def valley(x: np.ndarray) -> float:
        return float((1 - x[0]) ** 2 + 100 * (x[1] - x[0] ** 2) ** 2)

    found = bik.minimize(valley, [-2, -2], [2, 2])
    given = bik.minimize(valley, [-2, -2], [2, 2], solver=bik.DifferentialEvolution())
    assert found.value == given.value < 1e-8


def test_history_is_the_best_value_against_evaluations() -> None:
    values: list[float] = []

    def watched(x: np.ndarray) -> float:
        values.append(bowl(x))
        return values[-1]

    found = minimize(watched)
    best = np.minimum.accumulate(values)
    at, least = found.history.T
    assert (at[0], at[-1], least[-1]) == (1, found.evaluations, found.value)
    np.testing.assert_array_equal(least, best[at.astype(int) - 1])
    assert np.all(np.diff(least[:-1]) < 0)
    assert not found.history.flags.writeable
    assert not found.x.flags.writeable


def test_the_seed_repeats_and_the_start_comes_first() -> None:
    seen: list[list[float]] = []
    found = minimize(lambda x: seen.append(x.tolist()) or bowl(x), start=[0.1, 0.2, 0.3])
    assert seen[0] == [0.1, 0.2, 0.3]
    assert minimize(start=[0.1, 0.2, 0.3]).x.tolist() == found.x.tolist()
    assert minimize(start=[0.1, 0.2, 0.3], seed=1).x.tolist() != found.x.tolist()


def test_a_start_that_is_good_enough_costs_one_evaluation() -> None:
    found = minimize(start=BOTTOM, stop=bik.Stop(value_below=1e-9))
    assert (found.success, found.evaluations, found.iterations) == (True, 1, 0)


def test_negative_values_are_minimised_too() -> None:
    for solver in SOLVERS[1:]:
        found = minimize(lambda x: bowl(x) - 5.0, solver=solver, stop=bik.Stop(max_evaluations=4000))
        assert found.value < -4.99, solver


def test_the_message_says_how_the_search_ended() -> None:
    spent = minimize()
    assert not spent.success
    assert spent.message == (
        f"best value {spent.value:.6e} after 200 evaluations, when all were spent: raise the budget in stop=Stop(...), "
        "or say by Stop(value_below=...) what is low enough"
    ).replace("e-0", "e-")
    assert repr(spent) == f"<Minimum BUDGET_SPENT: {spent.message}>"
    stalled = minimize(lambda _: 1.0, solver=bik.papers.PSO(population=10, stall_generations=2))
    assert stalled.status == bik.Status.STALLED
    assert stalled.message.endswith("no further progress: try another start or seed, or MultiStart")


def test_values_that_are_not_finite_are_the_worst() -> None:
    nowhere = minimize(lambda _: float("nan"))
    assert nowhere.value == np.inf
    assert nowhere.message == "the function had no finite value in 200 evaluations: try another box or start"
    half = minimize(lambda x: bowl(x) if x[0] > 0 else -np.inf, stop=bik.Stop(value_below=1e-6))
    assert half.success


@pytest.mark.parametrize("value", [1, np.float32(2.0), np.int64(3), np.array(4.0), True])
def test_any_type_of_number_is_a_value(value: Any) -> None:
    assert minimize(lambda _: value).value == float(value)


class BoomError(Exception):
    pass


@pytest.mark.parametrize("vectorized", [False, True])
def test_an_exception_of_the_function_carries_the_best_point(vectorized: bool) -> None:
    left = 5 if vectorized else 55

    def failing(x: np.ndarray) -> Any:
        nonlocal left
        left -= 1
        if left == 0:
            raise BoomError("sensor unplugged")
        return bowls(x) if vectorized else bowl(x)

    with pytest.raises(BoomError, match=r"^sensor unplugged\n") as caught:
        minimize(failing, vectorized=vectorized)
    best = caught.value.best  # type: ignore[attr-defined]
    assert left == 0
    assert best.value == bowl(best.x)
    assert best.status == bik.Status.INTERRUPTED
    assert caught.value.__notes__ == [f"minimize: {best.message}; kept as `best` of this exception"]


def test_progress_is_told_to_the_end_and_changes_nothing() -> None:
    told_of: list[tuple[int, int]] = []
    stop = bik.Stop(max_evaluations=900)
    followed = bik.minimize(
        bowl,
        LOWER,
        UPPER,
        solver=bik.papers.PSO(),
        stop=stop,
        progress=lambda done, total: told_of.append((done, total)),
    )
    assert told_of[-1] == (900, 900)
    assert told_of == sorted(told_of)
    np.testing.assert_array_equal(followed.x, bik.minimize(bowl, LOWER, UPPER, solver=bik.papers.PSO(), stop=stop).x)


ENDLESS: dict[str, Any] = {
    "solver": bik.papers.PSO(stall_generations=None),
    "stop": bik.Stop(max_evaluations=10**12, max_iterations=10**12),
}


def test_an_exception_of_progress_carries_the_best_point() -> None:
    def progress(done: int, total: int) -> None:
        raise ValueError(f"enough after {done} of {total}")

    with pytest.raises(ValueError, match=r"^enough after [0-9]+ of 1000000000000\n") as caught:
        minimize(progress=progress, **ENDLESS)
    best = caught.value.best  # type: ignore[attr-defined]
    assert best.status == bik.Status.INTERRUPTED
    assert best.value == bowl(best.x)


@pytest.mark.skipif(sys.platform == "win32", reason="no timer sends signals on Windows")
def test_ctrl_c_carries_the_best_point() -> None:
    with pytest.raises(KeyboardInterrupt) as caught, interrupted():
        minimize(**ENDLESS)
    assert caught.value.best.evaluations > 1  # type: ignore[attr-defined]


NAMES = "BAS, BeeColony, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, PSO, QPSO or MultiStart of one of them"
PSO_40 = bik.papers.PSO()
MISTAKES: list[Case] = [
    (lambda: minimize(upper=[2.0, -2.0, 1.0]), Invalid, "lower[1] must be at most upper[1] = -2, got -1"),
    (lambda: minimize(upper=[2.0, np.inf, 1.0]), Invalid, "upper must be finite, but entry 1 is inf"),
    (lambda: minimize(lower=[np.nan, 0.0, 0.0]), Invalid, "lower must be finite, but entry 0 is NaN"),
    (lambda: minimize(upper=[1.0]), Invalid, "upper: expected 3 entries as in lower, got 1"),
    (lambda: minimize(lower=[], upper=[]), Invalid, "lower: expected at least 1 entry, got 0"),
    (lambda: minimize(start=[0.0, 9.0, 0.5]), Invalid, "start[1] must be within [-1, 3], got 9"),
    (lambda: minimize(start=[0.0]), Invalid, "start: expected 3 entries as in lower, got 1"),
    (lambda: minimize(solver=bik.papers.PSO(population=1)), Invalid, "population must be between 2 and 1000000, got 1"),
    (lambda: bik.DifferentialEvolution(population=3), Invalid, "population must be between 4 and 1000000, got 3"),
    (
        lambda: minimize(solver=PSO_40, stop=bik.Stop(max_evaluations=30)),
        Invalid,
        "population must be at most max_evaluations = 30, got 40",
    ),
    (lambda: minimize(stop=bik.Stop(max_evaluations=0)), Invalid, "max_evaluations must be at least 1, got 0"),
    (lambda: bik.Stop(value_below=float("nan")), Invalid, "value_below must be a number, got NaN"),
    (lambda: minimize(lambda _: None), Invalid, "function must return a real number, got None"),
    (lambda: minimize(lambda x: x[:2] * 0), Invalid, "function must return a real number, got array([0., 0.])"),
    (lambda: minimize(lambda _: np.ones(1)), Invalid, "function must return a real number, got array([1.])"),
    (lambda: minimize(lambda _: 1 + 2j), Invalid, "function must return a real number, got (1+2j)"),
    (lambda: minimize(lambda _: np.complex64(1j)), Invalid, "function must return a real number, got np.complex64(1j)"),
    (lambda: minimize(lambda _: "1.0"), Invalid, "function must return a real number, got '1.0'"),
    (
        lambda: minimize(lambda xs: xs[:, :1], vectorized=True),
        Invalid,
        "vectorized function must return shape (1,), got (1, 1)",
    ),
    (
        lambda: minimize(lambda _: None, vectorized=True),
        Invalid,
        "the function's values must be an array of numbers, got None",
    ),
    (lambda: minimize("bowl"), Invalid, "function must be a callable of x, got 'bowl'"),
    (
        lambda: minimize(solver=bik.LevenbergMarquardt()),
        Invalid,
        f"minimize has no derivatives: solver must be {NAMES}, got LevenbergMarquardt(initial_damping=0.05)",
    ),
    (
        lambda: bik.papers.PSO(form="swarm"),  # type: ignore[arg-type]
        Invalid,
        "form must be one of 'constriction', 'inertia', got 'swarm'",
    ),
    (lambda: bik.papers.PSO(inertia=0.5), Invalid, "inertia must be left out with form 'constriction', got 0.5"),
    (lambda: bik.papers.PSO(c1=1.0), Invalid, "c1 + c2 must be above 4 with form 'constriction', got 3.05"),
    (lambda: bik.papers.PSO(form="inertia", inertia=1.0), Invalid, "inertia must be at least 0 and below 1, got 1"),
    (lambda: bik.papers.QPSO(expansion=0.0), Invalid, "expansion must be positive and finite, got 0"),
    (lambda: bik.papers.Firefly(absorption=-1.0), Invalid, "absorption must be zero or more and finite, got -1"),
    (
        lambda: bik.papers.Firefly(randomness_decay=1.5),
        Invalid,
        "randomness_decay must be above 0 and at most 1, got 1.5",
    ),
    (lambda: bik.papers.Genetic(elite_share=1.0), Invalid, "elite_share must be at least 0 and below 1, got 1"),
    (
        lambda: bik.papers.Genetic(tournament=51),
        Invalid,
        "tournament must be between 1 and the population of 50, got 51",
    ),
    (lambda: bik.papers.Genetic(mutation_rate=0.0), Invalid, "mutation_rate must be above 0 and at most 1, got 0"),
    (lambda: bik.papers.BeeColony(limit=0), Invalid, "limit must be at least 1, got 0"),
    (lambda: bik.papers.BeetleSwarm(velocity_share=2.0), Invalid, "velocity_share must be between 0 and 1, got 2"),
    (
        lambda: bik.papers.BeetleSwarm(direction="up"),  # type: ignore[arg-type]
        Invalid,
        "direction must be one of 'printed', 'downhill', got 'up'",
    ),
    (lambda: bik.DifferentialEvolution(weight=3.0), Invalid, "weight must be above 0 and at most 2, got 3"),
    (
        lambda: bik.DifferentialEvolution(update="later"),  # type: ignore[arg-type]
        Invalid,
        "update must be one of 'generation', 'immediate', got 'later'",
    ),
    (lambda: bik.papers.QPSO(stall_generations=0), Invalid, "stall_generations must be at least 1, got 0"),
    (lambda: bik.papers.QPSO(max_generations=-1), Invalid, "max_generations must be zero or more, got -1"),
]


@told(MISTAKES)
def test_mistakes_are_told(call: Callable[[], object], error: type[Exception], message: str) -> None:
    assert_told(call, error, message)
