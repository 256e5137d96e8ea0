"""Streams that lose packets, judged by the path that the targets were taken from."""

import numpy as np
import pytest

import beetle_ik as bik

START = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
DT, RATE, SECONDS = 0.01, 30.0, 12.0


def path(t: float) -> np.ndarray:
    """Position relative to the start."""
    return np.array([0.05 * np.sin(1.1 * t), 0.1 * np.sin(0.9 * t), 0.05 * np.sin(1.7 * t)])


def follow(limits: bik.Limits, noise: float, burst: int, loss: float) -> tuple[float, float]:
    """Returns the largest distance of the tip from the path, and of the path from its last packet (m)."""
    robot, random = bik.Robot.named("panda"), np.random.default_rng(3)
    home, tracker = robot.fk(START), bik.Tracker(robot, START, dt=DT, limits=limits)
    worst, longest, due, lost, sent = 0.0, 0.0, 0.0, 0, 0.0
    for tick in range(1, round(SECONDS / DT) + 1):
        t, packet = tick * DT, None
        if t >= due:
            due += 1.0 / RATE
            shift, draw = noise * random.normal(size=3), random.random()
            lost = burst if lost <= 0 and draw < loss / burst and t > 0.5 else lost - 1
            if lost <= 0:
                packet, sent = home.copy(), t
                packet[:3, 3] += path(t) + shift
        step = tracker.step(packet)
        if t > 1.0:
            worst = max(worst, float(np.linalg.norm(robot.fk(step.q)[:3, 3] - home[:3, 3] - path(t))))
            longest = max(longest, float(np.linalg.norm(path(sent) - path(t))))
    return worst, longest


@pytest.mark.parametrize("jerk", [None, 50.0])
@pytest.mark.parametrize("noise", [0.0, 0.001, 0.003])
@pytest.mark.parametrize(("burst", "loss"), [(1, 0.1), (1, 0.5), (3, 0.1), (10, 0.3)])
def test_lost_packets_cost_no_more_than_the_way_in_the_gap(
    jerk: float | None, noise: float, burst: int, loss: float
) -> None:
    limits = bik.Limits(velocity=1.5, acceleration=5.0, jerk=jerk)
    without, _ = follow(limits, noise, 1, 0.0)
    worst, longest = follow(limits, noise, burst, loss)
    assert longest > 0.005
    assert worst <= 1.1 * (without + longest) + 1e-4, (worst, without, longest)
