"""Finding a planar arm in a picture."""

import sys
from collections.abc import Callable

import numpy as np
import pytest

import beetle_ik as bik
from beetle_ik import vision

pytest.importorskip("skimage")
ARM = bik.Robot.planar([0.5, 0.45, 0.4])
Q = np.array([0.9, -0.7, -0.6])
OFF = np.array([0.1, -0.1, 0.1])


def picture(q: np.ndarray = Q, seed: int = 0) -> np.ndarray:
    return vision.render(ARM, q, noise=0.08, seed=seed)


def overlap(contour: np.ndarray, truth: np.ndarray) -> float:
    """Intersection over union of the inside of a contour and the true arm."""
    from skimage.draw import polygon2mask

    inside = polygon2mask(truth.shape, contour[:, ::-1])
    return (inside & truth).sum() / (inside | truth).sum()


@pytest.mark.parametrize("method", ["threshold", "snake"])
def test_the_pose_of_the_note_is_found(method: str) -> None:
    found = vision.locate_arm(picture(), ARM, Q + OFF, method=method)
    assert found.success
    assert np.abs(found.q - Q).max() < 0.01
    assert overlap(found.contour, vision.render(ARM, Q) > 0.5) >= 0.97
    assert not found.q.flags.writeable
    assert found.message.startswith("found, 0.1")


def test_random_poses_are_found_and_wrong_guesses_are_no_lies() -> None:
    rng = np.random.default_rng(0)
    near = 0
    for seed in range(10):
        q = np.array([rng.uniform(-np.pi, np.pi), *rng.uniform(-2.0, 2.0, 2)])
        found = vision.locate_arm(picture(q, seed), ARM, q + rng.uniform(-0.1, 0.1, 3))
        near += found.success and np.abs(found.q - q).max() < 0.01
        astray = vision.locate_arm(picture(q, seed), ARM, q + rng.choice([-1.0, 1.0], 3))
        off = np.abs((astray.q - q + np.pi) % (2 * np.pi) - np.pi).max()
        assert off < 0.02 or not astray.success
    assert near >= 9


def test_every_kind_of_picture_is_understood() -> None:
    clean = np.clip(picture(), 0.0, 1.0)
    as_bytes = (255 * clean).astype(np.uint8)
    rgb = np.repeat(as_bytes[..., None], 3, axis=2)
    rgba = np.concatenate((rgb, np.full((*clean.shape, 1), 255, np.uint8)), axis=2)
    for image in (clean, clean.astype(np.float32), as_bytes, rgb, rgba, 1.0 - clean):
        found = vision.locate_arm(image, ARM, Q + OFF)
        assert found.success, found.message
        assert np.abs(found.q - Q).max() < 0.01


@pytest.mark.parametrize(
    "image",
    [
        np.empty((0, 0)),
        np.zeros((256, 256)),
        np.full((64, 64), 255, np.uint8),
        np.random.default_rng(0).random((256, 256)),
    ],
    ids=["empty", "black", "white", "noise"],
)
def test_a_picture_of_nothing_says_so(image: np.ndarray) -> None:
    found = vision.locate_arm(image, ARM, Q)
    assert (found.success, found.status) == (False, vision.Sight.NOTHING_SEEN)
    assert found.message == "no arm stands out from the background: increase the contrast, or check the image"
    assert found.contour.shape == (0, 2)


def test_an_arm_over_the_edge_is_told() -> None:
    camera = vision.Camera(origin=(200.0, 128.0))
    image = vision.render(ARM, [0.0, 0.2, 0.1], camera=camera)
    found = vision.locate_arm(image, ARM, [0.0, 0.2, 0.1], camera=camera)
    assert found.status is vision.Sight.CUT_OFF
    assert found.message.startswith("the arm extends beyond the edge of the image: move the camera back")


def test_another_arm_is_not_taken_for_this_one() -> None:
    found = vision.locate_arm(picture(), bik.Robot.planar([0.3, 0.3, 0.3]), Q)
    assert found.status is vision.Sight.UNRELIABLE


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: vision.locate_arm(np.zeros(5), ARM, Q), r"image: expected shape \(rows, columns\)"),
        (lambda: vision.locate_arm(np.full((9, 9), np.nan), ARM, Q), "image must be finite"),
        (lambda: vision.locate_arm(picture(), ARM, Q[:2]), "expected 3 joints, got 2"),
        (
            lambda: vision.locate_arm(picture(), bik.Robot.named("ur5e"), np.zeros(6)),
            "robot 'ur5e' is not a planar arm",
        ),
        (
            lambda: vision.locate_arm(picture(), ARM, Q, method="eye"),
            "method must be one of 'threshold', 'snake', got 'eye'",
        ),
        (lambda: vision.Camera(link_width=0.0), "link_width must be positive and finite, got 0.0"),
    ],
)
def test_wrong_input_is_named(call: object, message: str) -> None:
    with pytest.raises(bik.InvalidInputError, match=message):
        call()


def test_the_extra_is_named_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    import importlib.util

    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    monkeypatch.setitem(sys.modules, "skimage", None)
    with pytest.raises(bik.BeetleIkError, match=r"locate_arm needs scikit-image.*pip install 'beetle-ik\[vision\]'"):
        vision.locate_arm(picture(), ARM, Q)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: bik.vision.Camera(pixels_per_metre="wide"),
            "pixels_per_metre must be positive and finite, got 'wide'",
        ),
        (lambda: bik.vision.Camera(origin=3.0), "origin must be column and row, got 3.0"),
        (lambda: bik.vision.Camera(origin="here"), "origin must be numbers, got 'here'"),
        (lambda: bik.vision.render("arm", [0.0]), "robot must be a Robot, such as Robot.named('arm'), got 'arm'"),
        (lambda: bik.vision.render(ARM, [0.0] * 3, camera=3), "camera must be a Camera, got 3"),
        (lambda: bik.vision.render(ARM, [0.0] * 3, shape=(3, "a")), "shape must be numbers, got (3, 'a')"),
        (lambda: bik.vision.render(ARM, [0.0] * 3, noise="much"), "noise must be numbers, got 'much'"),
        (lambda: bik.vision.render(ARM, [0.0] * 3, seed=-1), "seed must be a whole number, zero or more, got -1"),
        (lambda: bik.vision.locate_arm(object, ARM, [0.0] * 3), "image: expected shape"),
        (
            lambda: bik.vision.locate_arm([[1], [1, 2]], ARM, [0.0] * 3),
            "image must be an array of numbers, got [[1], [1, 2]]",
        ),
        (lambda: bik.vision.locate_arm(np.zeros((9, 9)), ARM, "guess"), "guess must be numbers, got 'guess'"),
    ],
)
def test_wrong_types_are_named(call: Callable[[], object], message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        call()
    assert str(caught.value).startswith(message)
