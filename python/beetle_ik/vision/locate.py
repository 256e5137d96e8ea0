"""Joint angles of a planar arm from an image.

The contour of the arm is found by a threshold or by an active contour. The joint angles are fitted to it: each point of
the contour should be half a link width from the nearest link. The active contour of scikit-image minimises the energy
of "Trajectory tracking of redundant manipulator based on PSO algorithm optimization", eq. (19) to (21), with the
squares that eq. (20) lacks: alpha is its l1, beta its l2, and the edge strength its E_con.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInputError, Robot
from ..calls.arguments import require_one_tip
from ..calls.wording import worded_call
from ..installed.needs import library
from .camera import Camera, check_planar, checked, distance_to_links, numbers
from .render import evenly, outline

_SMOOTHING = 2.0  # pixels, standard deviation
_SMALLEST = 8  # pixels: least side of an image
_FLAT = 1e-9  # least variation of the brightness
_CONTRAST = 0.2  # least difference between arm and background, as a fraction of the range of brightness
_POINTS = 300  # points of the contour
_RELIABLE_RMS = 0.8  # pixels
_RELIABLE_OVERLAP = 0.93
_MARGIN = 6.0  # pixels between the guess and the initial active contour


class Sight(StrEnum):
    """Status of a search for an arm."""

    FOUND = "found"
    UNRELIABLE = "unreliable"
    CUT_OFF = "cut off"
    NOTHING_SEEN = "nothing seen"


_ADVICE = {
    Sight.FOUND: "found",
    Sight.UNRELIABLE: "the fit does not match the image: give a better guess, or check camera and robot",
    Sight.CUT_OFF: "the arm extends beyond the edge of the image: move the camera back",
    Sight.NOTHING_SEEN: "no arm stands out from the background: increase the contrast, or check the image",
}


@dataclass(frozen=True, kw_only=True)
class ArmLocation:
    """The result of `locate_arm`."""

    q: NDArray[np.float64]
    """Joint angles (n,) (rad); reliable only on `success`."""
    status: Sight
    contour: NDArray[np.float64]
    """The contour in the image (k, 2): column and row (pixels); empty if none was found."""
    rms: float
    """Root mean square distance between the contour and the outline of the fitted arm (pixels)."""
    overlap: float
    """Intersection over union of the arm in the image and the fitted arm."""
    evaluations: int
    """Postures compared with the contour."""
    elapsed: float
    """Time taken (s)."""

    @property
    def success(self) -> bool:
        """Whether the arm was found reliably."""
        return self.status is Sight.FOUND

    @property
    def message(self) -> str:
        """Outcome and advice, as a sentence."""
        seen = "" if np.isnan(self.rms) else f", {self.rms:.2f} pixels rms, overlap {self.overlap:.3f}"
        return f"{_ADVICE[self.status]}{seen}"


@worded_call
def locate_arm(
    image: ArrayLike,
    robot: Robot,
    guess: ArrayLike,
    *,
    camera: Camera | None = None,
    method: Literal["threshold", "snake"] = "threshold",
) -> ArmLocation:
    """Finds the joint angles of a planar arm that is brighter or darker than the background.

    Args:
        image: (rows, columns) grey, or (rows, columns, 3 or 4) RGB or RGBA; integers or floats.
        robot: a planar arm.
        guess: (n,) (rad), start of the search; each joint up to about 0.1 rad off.
        camera: None: 80 pixels per metre, the base at pixel (128, 128), links 0.2 m wide.
        method: method for the contour: "threshold", or "snake", an active contour that starts around the guess.

    Returns:
        An `ArmLocation`. An image without an arm, or a fit that does not match it, is a status, not an error.

    Raises:
        InvalidInputError: a robot that is not planar, an image or a guess of the wrong shape.
        BeetleIkError: scikit-image is not installed.
    """
    library("skimage", "scikit-image", "locate_arm", extra="vision")
    began = time.perf_counter()
    check_planar(robot)
    camera = checked(camera)
    grey = _grey(image)
    start = _checked_guess(guess, robot)
    if method not in ("threshold", "snake"):
        raise InvalidInputError(f"method must be one of 'threshold', 'snake', got {method!r:.60}")
    mask, level, smooth = _arm_mask(grey)
    nothing = np.empty((0, 2))

    def located(status: Sight, q: NDArray[np.float64], contour: NDArray[np.float64], **measured: Any) -> ArmLocation:
        shown = {"rms": np.nan, "overlap": np.nan, "evaluations": 0, **measured}
        elapsed = time.perf_counter() - began
        return ArmLocation(q=_frozen(q), status=status, contour=_frozen(contour), elapsed=elapsed, **shown)

    if mask is None:
        return located(Sight.NOTHING_SEEN, start, nothing)
    contour = _longest_contour(smooth, level) if method == "threshold" else _snake(smooth, robot, start, camera)
    q, evaluations = _fit(contour, robot, start, camera)
    residual = distance_to_links(contour, camera.joint_points(robot, q)) - camera.half_width
    rms = float(np.sqrt(np.mean(residual**2)))
    overlap = _overlap(mask, camera.joint_points(robot, q), camera)
    measured = {"rms": rms, "overlap": overlap, "evaluations": evaluations}
    if mask[0].any() or mask[-1].any() or mask[:, 0].any() or mask[:, -1].any():
        return located(Sight.CUT_OFF, q, contour, **measured)
    reliable = rms <= _RELIABLE_RMS and overlap >= _RELIABLE_OVERLAP
    return located(Sight.FOUND if reliable else Sight.UNRELIABLE, q, contour, **measured)


def _grey(image: ArrayLike) -> NDArray[np.float64]:
    """Returns the brightness of the image, between 0 and about 1."""
    try:
        picture = np.asarray(image)
    except (TypeError, ValueError):
        raise InvalidInputError(f"image must be an array of numbers, got {image!r:.60}") from None
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
    require_one_tip("locate", robot)
    start = numbers("guess", guess)
    robot.fk(start)  # raises for a wrong length and for NaN
    return start


def _arm_mask(grey: NDArray[np.float64]) -> tuple[NDArray[np.bool_] | None, float, NDArray[np.float64]]:
    """Returns the mask of the largest object, the brightness at its edge, and the smoothed image with a bright arm."""
    from skimage.filters import gaussian, threshold_otsu
    from skimage.measure import label

    if min(grey.shape) < _SMALLEST:
        return None, 0.0, grey
    smooth = gaussian(grey, _SMOOTHING)
    if np.ptp(smooth) < _FLAT:
        return None, 0.0, grey
    level = float(threshold_otsu(smooth))
    bright = smooth > level
    # Chooses the side: the border of the image is background.
    if np.mean(np.concatenate((bright[0], bright[-1], bright[:, 0], bright[:, -1]))) > 0.5:
        smooth, level, bright = -smooth, -level, ~bright
    apart = smooth[bright].mean() - smooth[~bright].mean()
    rest = smooth[~bright].std()
    pieces = label(bright)
    sizes = np.bincount(pieces.ravel())[1:]
    # Refuses noise, which breaks into many small objects with little contrast.
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
    """Moves an active contour from around the guess onto the edge of the arm."""
    from skimage.segmentation import active_contour

    begin = outline(robot, start, camera=camera, margin=_MARGIN, points=_POINTS)[:, ::-1]
    found = active_contour(smooth, begin, alpha=0.01, beta=0.05, w_line=0.0, w_edge=1.0, gamma=0.05, max_num_iter=1000)
    return np.asarray(found)[:, ::-1]


def _fit(
    contour: NDArray[np.float64], robot: Robot, start: NDArray[np.float64], camera: Camera
) -> tuple[NDArray[np.float64], int]:
    """Fits the joint angles, so that the contour is half a link width from the links; robust against outliers."""
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
