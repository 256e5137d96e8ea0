"""Small drawings as SVG, without another library: arms, obstacles and curves for notebooks, in light and dark."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .._core import Grid, Mesh, PointCloud
from .style import BLUE, GREEN, ORANGE, SKY, VERMILION

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .._core import Obstacle

    Points = NDArray[np.float64]

_WIDTH, _HEIGHT, _MARGIN = 230.0, 160.0, 8.0  # pixels
_COLORS = (BLUE, VERMILION, GREEN, ORANGE, SKY, "#CC79A7", "currentColor")
_MOST_POINTS = 160  # points of a curve
_MOST_FACES = 200  # faces of a non-convex obstacle
_VIEWS = {"from the side (x, z)": (0, 2), "from above (x, y)": (0, 1)}
_BEYOND = 1.0  # margin around an arm, as a fraction of its extent


def curves(x: Points, rows: Points, title: str) -> str:
    """Draws the columns of `rows` (m, n) over `x` (m,), between their least and largest value."""
    chosen = np.linspace(0, len(x) - 1, min(len(x), _MOST_POINTS)).astype(int)
    x, rows = x[chosen], rows[chosen]
    low, high = _range(rows)
    across = _MARGIN + (x - x[0]) / max(x[-1] - x[0], 1e-12) * (_WIDTH - 2 * _MARGIN)
    up = _HEIGHT - _MARGIN - (rows - low) / (high - low) * (_HEIGHT - 2 * _MARGIN)
    drawn = [_line(np.column_stack((across, column)), _COLORS[i % len(_COLORS)]) for i, column in enumerate(up.T)]
    return _svg(f"{title}, {low:.3g} to {high:.3g}", drawn)


def views(arms: Sequence[Points], ways: Sequence[Points] = (), obstacles: Sequence[Obstacle] = ()) -> str:
    """Draws arms (k, 3), paths of tips (k, 3) and obstacles from the side and from above."""
    shapes = [shape.triangles for shape in obstacles]
    lines = np.vstack([*arms, *ways] if arms or ways else [triangles.reshape(-1, 3) for triangles in shapes])
    corners = _corners(lines, shapes)
    drawn = []
    for title, axes in _VIEWS.items():
        polygons = [polygon for obstacle in obstacles for polygon in _polygons(obstacle, axes)]
        flat = ([line[:, axes] for line in group] for group in (arms, ways))
        drawn.append(_view(title, corners[:, axes], polygons, *flat))
    return "".join(drawn)


def heat(values: Points, title: str) -> str:
    """Draws a grid (rows, columns) of fractions from 0 to 1, the first row at the bottom."""
    step = max(1, -(-max(values.shape) // 60))
    values = values[::step, ::step]
    cell = min((_WIDTH - 2 * _MARGIN) / values.shape[1], (_HEIGHT - 2 * _MARGIN) / values.shape[0])
    cells = [
        f'<rect x="{_MARGIN + column * cell:.1f}" y="{_HEIGHT - _MARGIN - (row + 1) * cell:.1f}" width="{cell:.1f}" '
        f'height="{cell:.1f}" fill="{BLUE}" fill-opacity="{values[row, column]:.2f}"/>'
        for row, column in np.argwhere(values > 0)
    ]
    return _svg(title, cells)


def _range(values: ArrayLike) -> tuple[float, float]:
    low, high = float(np.min(values)), float(np.max(values))
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _corners(points: Points, faces: Sequence[Points]) -> Points:
    """Returns the corners (2, 3) of the drawn region, without distant faces: a whole floor would dwarf the arm."""
    low, high = points.min(axis=0), points.max(axis=0)
    beyond = _BEYOND * float((high - low).max())
    for part in faces:
        low = np.minimum(low, np.maximum(part.min(axis=(0, 1)), points.min(axis=0) - beyond))
        high = np.maximum(high, np.minimum(part.max(axis=(0, 1)), points.max(axis=0) + beyond))
    return np.array((low, high))


def _polygons(obstacle: Obstacle, axes: tuple[int, int]) -> list[Points]:
    """Returns the outline (k, 2) of a convex obstacle, or some faces of another."""
    triangles = obstacle.triangles[:, :, axes]
    if isinstance(obstacle, Mesh | PointCloud | Grid):
        return list(triangles[:: max(1, len(triangles) // _MOST_FACES)])
    return [_hull(triangles.reshape(-1, 2))]


def _hull(points: Points) -> Points:
    """Returns the corners of the convex hull of points (k, 2), by Andrew's monotone chain."""
    ordered = np.unique(points.round(9), axis=0)
    halves = []
    for line in (ordered, ordered[::-1]):
        half: list[Points] = []
        for point in line:
            while len(half) > 1 and _turn(half[-2], half[-1], point) <= 0:
                half.pop()
            half.append(point)
        halves += half[:-1]
    return np.array(halves)


def _turn(a: Points, b: Points, c: Points) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _view(
    title: str, corners: Points, polygons: Sequence[Points], arms: Sequence[Points], ways: Sequence[Points]
) -> str:
    low, high = corners
    scale = float(np.min((_WIDTH - 2 * _MARGIN, _HEIGHT - 2 * _MARGIN) / np.maximum(high - low, 1e-9)))
    middle = (low + high) / 2

    def placed(points: Points) -> Points:
        return np.asarray((points - middle) * (scale, -scale) + (_WIDTH / 2, _HEIGHT / 2))

    outlines = (f'<polygon points="{_listed(placed(polygon))}"/>' for polygon in polygons)
    drawn = [f'<g fill="{ORANGE}" fill-opacity="0.35" stroke="{ORANGE}" stroke-opacity="0.6">{"".join(outlines)}</g>']
    drawn += [_line(placed(arm), "currentColor", width=2.5, opacity=(i + 1) / len(arms)) for i, arm in enumerate(arms)]
    drawn += [_line(placed(way), VERMILION) for way in ways]
    return _svg(title, drawn)


def _line(points: Points, color: str, *, width: float = 1.5, opacity: float = 1.0) -> str:
    style = f'fill="none" stroke="{color}" stroke-width="{width}" stroke-opacity="{opacity:.2f}"'
    return f'<polyline points="{_listed(points)}" {style} stroke-linejoin="round"/>'


def _listed(points: Points) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)


def _svg(title: str, parts: Iterable[str]) -> str:
    frame = f'<rect width="{_WIDTH}" height="{_HEIGHT}" fill="none" stroke="currentColor" stroke-opacity="0.2"/>'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{_WIDTH}" height="{_HEIGHT}" role="img"'
    figure = f'{head} aria-label="{title}">{frame}{"".join(parts)}</svg>'
    caption = f"<figcaption><small>{title}</small></figcaption>"
    return f'<figure style="display:inline-block;margin:4px">{figure}{caption}</figure>'
