"""Joint angles of a planar arm from a picture of it.

A contour of the arm is found, by a threshold or by an active contour, and the joint angles are fitted to it: every
point of the contour should be half a link's width from the nearest link. The active contour of scikit-image has the
energy of "Trajectory tracking of redundant manipulator based on PSO algorithm optimization", eq. (19) to (21), with the
squares put back that eq. (20) lacks: alpha is its l1, beta its l2, and the strength of edges its E_con.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInputError, Robot
from .._needs import library
from .camera import Camera, check_planar, distance_to_links
from .render import evenly, outline

_SMOOTHING = 2.0  # pixels, standard deviation
_SMALLEST = 8  # pixels: a picture with a shorter side shows nothing
_FLAT = 1e-9  # brightness: a picture that varies by less shows nothing
_CONTRAST = 0.2  # least difference of the two brightnesses over their spread together, for anything to be seen
_POINTS = 300  # of the contour
_RELIABLE_RMS = 0.8  # pixels
_RELIABLE_OVERLAP = 0.93
_MARGIN = 6.0  # pixels that the active contour begins outside the guess


class Sight(StrEnum):
    """What became of a search for an arm."""

    FOUND = "found"
    UNRELIABLE = "unreliable"
    CUT_OFF = "cut off"
    NOTHING_SEEN = "nothing seen"


_ADVICE = {
    Sight.FOUND: "found",
    Sight.UNRELIABLE: "the fit does not explain the picture: give a better guess, or check camera and robot",
    Sight.CUT_OFF: "the arm reaches over the edge of the picture: move the camera back",
    Sight.NOTHING_SEEN: "there is nothing in the picture that stands out from it",
}


@dataclass(frozen=True, kw_only=True)
class ArmLocation:
    """Where an arm was found."""

    q: NDArray[np.float64]
    """The joint angles (n,) (rad); to be trusted only on `success`."""
    status: Sight
    contour: NDArray[np.float64]
    """The contour that was seen (k, 2): column and row (pixels); empty where nothing was."""
    rms: float
    """Root mean square distance of the contour from the fitted arm's outline (pixels)."""
    overlap: float
    """Of what is arm in the picture or in the fit, the share that is both."""
    evaluations: int
    """Postures that were held against the contour."""
    elapsed: float
    """Time taken (s)."""

    @property
    def success(self) -> bool:
        """Whether the arm was found reliably."""
        return self.status is Sight.FOUND

    @property
    def message(self) -> str:
        """What happened, and what to try."""
        seen = "" if np.isnan(self.rms) else f", {self.rms:.2f} pixels rms, overlap {self.overlap:.3f}"
        return f"{_ADVICE[self.status]}{seen}"


def locate_arm(
    image: ArrayLike,
    robot: Robot,
    guess: ArrayLike,
    *,
    camera: Camera | None = None,
    method: Literal["threshold", "snake"] = "threshold",
) -> ArmLocation:
    """Find the joint angles of a planar arm, brighter or darker than what is behind it.

    Args:
        image: (rows, columns) grey, or (rows, columns, 3 or 4) RGB or RGBA; integers or floats.
        robot: a planar arm.
        guess: (n,) (rad), where the search begins; up to about 0.1 rad off a joint.
        camera: None: 80 pixels a metre, the base at pixel (128, 128), links 0.2 m wide.
        method: the contour by a "threshold", or by a "snake", an active contour that begins around the guess.

    Returns:
        An `ArmLocation`. A picture without an arm, or one that the fit does not explain, is a status, not an error.

    Raises:
        InvalidInputError: a robot that is not planar, an image or a guess of a wrong shape.
        BeetleIkError: scikit-image is not installed.
    """
    library("skimage", "scikit-image", "locate_arm", extra="vision")
    began = time.perf_counter()
    check_planar(robot)
    camera = camera or Camera()
    grey = _grey(image)
    start = _checked_guess(guess, robot)
    if method not in ("threshold", "snake"):
        raise InvalidInputError(f"method must be one of 'threshold', 'snake', got '{method}'")
    mask, level, smooth = _arm_mask(grey)
    nothing = np.empty((0, 2))

    def located(status: Sight, q: NDArray[np.float64], contour: NDArray[np.float64], **numbers: Any) -> ArmLocation:
        shown = {"rms": np.nan, "overlap": np.nan, "evaluations": 0, **numbers}
        elapsed = time.perf_counter() - began
        return ArmLocation(q=_frozen(q), status=status, contour=_frozen(contour), elapsed=elapsed, **shown)

    if mask is None:
        return located(Sight.NOTHING_SEEN, start, nothing)
    contour = _longest_contour(smooth, level) if method == "threshold" else _snake(smooth, robot, start, camera)
    q, evaluations = _fit(contour, robot, start, camera)
    residual = distance_to_links(contour, camera.joint_points(robot, q)) - camera.half_width
    rms = float(np.sqrt(np.mean(residual**2)))
    overlap = _overlap(mask, camera.joint_points(robot, q), camera)
    numbers = {"rms": rms, "overlap": overlap, "evaluations": evaluations}
    if mask[0].any() or mask[-1].any() or mask[:, 0].any() or mask[:, -1].any():
        return located(Sight.CUT_OFF, q, contour, **numbers)
    reliable = rms <= _RELIABLE_RMS and overlap >= _RELIABLE_OVERLAP
    return located(Sight.FOUND if reliable else Sight.UNRELIABLE, q, contour, **numbers)


def _grey(image: ArrayLike) -> NDArray[np.float64]:
    """The image as brightness between 0 and about 1."""
    picture = np.asarray(image)
    coloured = picture.ndim == 3 and picture.shape[2] in (3, 4)
    if not (picture.ndim == 2 or coloured) or picture.dtype.kind not in "buif":
        raise InvalidInputError(
            f"image: expected shape (rows, columns), or (rows, columns, 3 or 4), of numbers, got {picture.shape} of "
            f"{picture.dtype}"
        )
    scale = np.iinfo(picture.dtype).max if picture.dtype.kind in "ui" else 1.0
    bright = picture.astype(float) / scale
    grey = bright[..., :3] @ [0.2125, 0.7154, 0.0721] if coloured else bright
    if not np.isfinite(grey).all():
        raise InvalidInputError("image must be finite, but holds NaN or infinity")
    return np.asarray(grey)


def _checked_guess(guess: ArrayLike, robot: Robot) -> NDArray[np.float64]:
    start = np.array(guess, dtype=float)
    robot.fk(start)  # raises for a wrong length and for NaN
    return start


def _arm_mask(grey: NDArray[np.float64]) -> tuple[NDArray[np.bool_] | None, float, NDArray[np.float64]]:
    """What is arm, the largest piece that stands out; the brightness at its edge; the smooth picture, arm bright."""
    from skimage.filters import gaussian, threshold_otsu
    from skimage.measure import label

    if min(grey.shape) < _SMALLEST:
        return None, 0.0, grey
    smooth = gaussian(grey, _SMOOTHING)
    if np.ptp(smooth) < _FLAT:
        return None, 0.0, grey
    level = float(threshold_otsu(smooth))
    bright = smooth > level
    # The frame of the picture is what is behind the arm.
    if np.mean(np.concatenate((bright[0], bright[-1], bright[:, 0], bright[:, -1]))) > 0.5:
        smooth, level, bright = -smooth, -level, ~bright
    apart = smooth[bright].mean() - smooth[~bright].mean()
    rest = smooth[~bright].std()
    pieces = label(bright)
    sizes = np.bincount(pieces.ravel())[1:]
    # Noise alone falls into many pieces, and its two sides are not far apart.
    if apart < _CONTRAST * np.ptp(grey) or rest > 0.5 * apart or sizes.max() < 0.5 * bright.sum():
        return None, level, smooth
    level = float(0.5 * (np.median(smooth[bright]) + np.median(smooth[~bright])))
    return pieces == 1 + int(sizes.argmax()), level, smooth


def _longest_contour(smooth: NDArray[np.float64], level: float) -> NDArray[np.float64]:
    from skimage.measure import find_contours

    return evenly(max(find_contours(smooth, level), key=len)[:, ::-1], _POINTS)


def _snake(
    smooth: NDArray[np.float64], robot: Robot, start: NDArray[np.float64], camera: Camera
) -> NDArray[np.float64]:
    """An active contour from around the guess onto the edge."""
    from skimage.segmentation import active_contour

    begin = outline(robot, start, camera=camera, margin=_MARGIN, points=_POINTS)[:, ::-1]
    found = active_contour(smooth, begin, alpha=0.01, beta=0.05, w_line=0.0, w_edge=1.0, gamma=0.05, max_num_iter=1000)
    return np.asarray(found)[:, ::-1]


def _fit(
    contour: NDArray[np.float64], robot: Robot, start: NDArray[np.float64], camera: Camera
) -> tuple[NDArray[np.float64], int]:
    """The angles at which the contour is half a link's width from the links; stray points count little."""
    from scipy.optimize import least_squares

    def residual(q: NDArray[np.float64]) -> NDArray[np.float64]:
        return distance_to_links(contour, camera.joint_points(robot, q)) - camera.half_width

    fit = least_squares(residual, start, loss="soft_l1", f_scale=1.0, max_nfev=100)
    return fit.x, int(fit.nfev)


def _overlap(mask: NDArray[np.bool_], joints: NDArray[np.float64], camera: Camera) -> float:
    rows, columns = np.indices(mask.shape)
    pixels = np.stack((columns.ravel(), rows.ravel()), axis=1).astype(float)
    fitted = (distance_to_links(pixels, joints) <= camera.half_width).reshape(mask.shape)
    return float((mask & fitted).sum() / max((mask | fitted).sum(), 1))


def _frozen(values: NDArray[np.float64]) -> NDArray[np.float64]:
    array = np.array(values, dtype=float)
    array.setflags(write=False)
    return array
