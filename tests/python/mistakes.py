"""Tables of wrong calls, the exceptions they raise, and the exact messages."""

from collections.abc import Callable

import pytest

import beetle_ik as bik

Invalid, Limit, Urdf, Unknown = bik.InvalidInputError, bik.LimitError, bik.UrdfError, bik.UnknownNameError
# What can be done about a position outside its limits.
RADIANS = "move it inside; angles are in radians, and np.radians converts degrees"
TURNED = "robot.wrap(q) takes whole turns off and brings it inside"
INSIDE = "robot.clip(q) moves it to the limit, which changes the pose"
SLACK = f"{INSIDE}; start_slack takes a start farther out"
Case = tuple[Callable[[], object], type[Exception], str]


def with_entry(index: int, value: float) -> list[float]:
    """Seven joint angles of zero, but for one."""
    angles = [0.0] * 7
    angles[index] = value
    return angles


def told(cases: list[Case]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(("call", "error", "message"), cases, ids=[case[2][:60] for case in cases])


def assert_told(call: Callable[[], object], error: type[Exception], message: str) -> None:
    with pytest.raises(Exception) as caught:  # noqa: PT011  the class is compared exactly
        call()
    assert (type(caught.value), str(caught.value)) == (error, message)
