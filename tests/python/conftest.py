"""Fixtures common to all tests."""

import signal
from collections.abc import Iterator

import matplotlib as mpl
import pytest

import beetle_ik as bik

mpl.use("Agg")


@pytest.fixture(autouse=True)
def _close_figures() -> Iterator[None]:
    import matplotlib.pyplot as plt

    yield
    plt.close("all")


@pytest.fixture
def ctrl_c_raises() -> Iterator[None]:
    """Python's own handler of Ctrl-C. A process that inherits an ignored SIGINT, as under nohup, starts without it."""
    inherited = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, inherited)


@pytest.fixture(scope="session")
def tracked() -> bik.TrackResult:
    """The five-link arm of the BAS paper on a short stretch of its circle."""
    limits = bik.Limits(velocity=bik.Sinusoid(mean=0.2, amplitude=0.004, angular_frequency=1.0))
    circle = bik.paths.circle((4.0, 1.0, 0.0), diameter=1.4, duration=6.0)
    return bik.track(bik.Robot.planar([1.0] * 5), circle, dt=0.2, limits=limits, position_tolerance=4e-5)
