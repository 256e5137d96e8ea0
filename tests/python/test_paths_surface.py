"""Lines over surfaces: planes, spheres, cylinders and boxes, whose points and normals are known."""
# ruff: noqa: E501 -- a row is a line

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mistakes import Invalid, assert_told

import beetle_ik as bik

trimesh = pytest.importorskip("trimesh")

api: Any = bik
TABLE = bik.obstacles.Box((0.5, 0.0, 0.1), (0.4, 0.4, 0.2))
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], dtype=float)
SHEET = (CORNERS, np.array([(0, 1, 2), (0, 2, 3)]))
BALL = trimesh.creation.icosphere(subdivisions=5, radius=0.2)
PIPE = trimesh.creation.cylinder(radius=0.1, height=0.5, sections=512)
LINE = [(0.4, 0.0, 0.2), (0.6, 0.0, 0.2)]


def normals(seam: bik.paths.Seam) -> np.ndarray:
    """Outward normals (m, 3)."""
    return -seam.poses[:, :3, 2]


def places(seam: bik.paths.Seam) -> np.ndarray:
    return seam.poses[:, :3, 3]


def assert_frames(seam: bik.paths.Seam) -> None:
    turns = seam.poses[:, :3, :3]
    np.testing.assert_allclose(turns @ turns.transpose(0, 2, 1), np.tile(np.eye(3), (len(seam), 1, 1)), atol=1e-12)
    assert (np.linalg.det(turns) > 0.0).all()
    np.testing.assert_array_equal(seam.poses[:, 3], np.tile([0.0, 0.0, 0.0, 1.0], (len(seam), 1)))
    np.testing.assert_allclose(
        np.diff(seam.distance), np.linalg.norm(np.diff(places(seam), axis=0), axis=1), atol=1e-12
    )


def test_a_line_on_a_table_is_the_line_with_the_tool_down() -> None:
    seam = bik.paths.on_surface(TABLE, LINE, standoff=0.01, step=0.01)
    assert_frames(seam)
    assert len(seam) == 21
    np.testing.assert_allclose(places(seam), np.linspace((0.4, 0.0, 0.21), (0.6, 0.0, 0.21), 21), atol=1e-12)
    np.testing.assert_allclose(seam.poses[:, :3, :3], np.tile(np.diag([1.0, -1.0, -1.0]), (21, 1, 1)), atol=1e-12)


def test_points_off_the_surface_are_moved_to_the_nearest() -> None:
    seam = bik.paths.on_surface(TABLE, np.add(LINE, (0.0, 0.05, 0.03)))
    np.testing.assert_allclose(places(seam)[:, 1:], np.tile([0.05, 0.2], (len(seam), 1)), atol=1e-12)


def test_a_circle_on_a_sphere_keeps_distance_and_normal() -> None:
    around = np.linspace(0.0, 2 * np.pi, 360, endpoint=False)
    circle = 0.15 * np.column_stack([np.cos(around), np.sin(around), np.full(360, np.sqrt(0.2**2 - 0.15**2) / 0.15)])
    seam = bik.paths.on_surface(BALL, circle, closed=True, standoff=0.05)
    assert_frames(seam)
    outward = places(seam) / np.linalg.norm(places(seam), axis=1, keepdims=True)
    sag = 0.2 * (
        1.0 - BALL.triangles.mean(axis=1).__pow__(2).sum(axis=1).min() ** 0.5 / 0.2
    )  # of the coarsest triangle
    distance = np.linalg.norm(places(seam), axis=1)
    assert distance.max() <= 0.25 + 1e-9
    assert distance.min() >= 0.25 - sag - 1e-6
    assert np.degrees(np.arccos(np.einsum("ki,ki->k", normals(seam), outward))).max() < 0.1
    # The x axis runs along the circle, to half a step.
    along = np.column_stack([-outward[:, 1], outward[:, 0], np.zeros(len(seam))])
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    assert np.einsum("ki,ki->k", along, seam.poses[:, :3, 0]).min() > 0.999


def test_a_closed_line_ends_in_its_first_pose() -> None:
    seam = bik.paths.on_surface(TABLE, [*LINE, (0.6, 0.1, 0.2)], closed=True)
    assert seam.closed
    np.testing.assert_array_equal(seam.poses[0], seam.poses[-1])
    assert seam.length == pytest.approx(0.2 + 0.1 + np.hypot(0.2, 0.1), abs=1e-9)


def test_normals_are_interpolated_over_a_cylinder() -> None:
    angle = np.linspace(0.0, np.pi, 50)
    arc = 0.1 * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(50)])
    coarse = trimesh.creation.cylinder(radius=0.1, height=0.5, sections=16)  # faces turn by 22.5 degrees
    seam = bik.paths.on_surface(coarse, arc, step=0.001)
    turn = np.arccos(np.clip(np.einsum("ki,ki->k", normals(seam)[1:], normals(seam)[:-1]), -1.0, 1.0))
    assert turn.max() < 0.03
    assert len(seam.edges) == 0
    radial = places(seam) / np.linalg.norm(places(seam), axis=1, keepdims=True)
    assert np.degrees(np.arccos(np.clip(np.einsum("ki,ki->k", normals(seam), radial), -1, 1))).max() < 1.0


def test_the_tool_turns_gradually_over_a_sharp_edge() -> None:
    over = [(0.5, 0.0, 0.2), (0.7, 0.0, 0.2), (0.7, 0.0, 0.05)]
    seam = bik.paths.on_surface(TABLE, over, step=0.002, rounding=0.02)
    assert_frames(seam)
    np.testing.assert_allclose(seam.edges, [0.2], atol=0.002)
    far = np.abs(seam.distance - 0.2) > 0.0201
    flat = np.where(seam.distance[:, None] < 0.2, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    np.testing.assert_allclose(normals(seam)[far], flat[far], atol=1e-9)
    angles = np.arctan2(normals(seam)[:, 0], normals(seam)[:, 2])
    assert (np.diff(angles) > -1e-9).all()
    assert np.diff(angles).max() < 0.2
    # The tip stays on the two faces.
    assert np.abs(np.minimum(0.2 - places(seam)[:, 2], 0.7 - places(seam)[:, 0])).max() < 1e-12


def test_rounding_zero_turns_the_tool_at_once() -> None:
    over = [(0.5, 0.0, 0.2), (0.7, 0.0, 0.2), (0.7, 0.0, 0.05)]
    seam = bik.paths.on_surface(TABLE, over, step=0.002, rounding=0.0)
    turns = np.einsum("ki,ki->k", normals(seam)[1:], normals(seam)[:-1])
    assert (turns < 0.5).sum() == 1


@pytest.mark.parametrize(
    ("lead", "first", "last"),
    [
        ("normal", (0.4, 0.0, 0.25), (0.6, 0.0, 0.22)),
        ("tangent", (0.35, 0.0, 0.2), (0.62, 0.0, 0.2)),
    ],
)
def test_leads_are_straight_and_turn_nothing(lead: Any, first: tuple[float, ...], last: tuple[float, ...]) -> None:
    seam = bik.paths.on_surface(TABLE, LINE, lead_in=0.05, lead_out=0.02, lead=lead)
    np.testing.assert_allclose(places(seam)[[0, -1]], [first, last], atol=1e-12)
    np.testing.assert_array_equal(seam.poses[0, :3, :3], seam.poses[1, :3, :3])
    assert seam.contact.tolist() == [False, *[True] * (len(seam) - 2), False]
    assert seam.length == pytest.approx(0.27, abs=1e-12)


def test_a_seam_has_constant_speed_along_its_length() -> None:
    seam = bik.paths.on_surface(BALL, [(0.0, -0.1, 0.2), (0.05, 0.0, 0.2), (0.0, 0.1, 0.2)], standoff=0.02)
    path = seam.path(speed=0.05)
    assert path.duration == pytest.approx(seam.length / 0.05)
    speeds = np.linalg.norm(path.velocity(np.linspace(0.01, path.duration - 0.01, 500)), axis=1)
    np.testing.assert_allclose(speeds, 0.05, rtol=1e-6)


def test_calls_take_a_seam_as_poses() -> None:
    robot = bik.Robot.named("ur5e")
    seam = bik.paths.on_surface(TABLE, LINE, step=0.02)
    limits = bik.Limits(acceleration=5.0)
    plan = bik.plan_along_path(robot, seam, task=bik.tasks.Pointing(), limits=limits)
    assert plan.success
    other = bik.plan_along_path(robot, seam.poses, task=bik.tasks.Pointing(), limits=limits)
    np.testing.assert_array_equal(plan.trajectory.coefficients, other.trajectory.coefficients)


def moved(surface: Any) -> tuple[np.ndarray, np.ndarray]:
    return np.asarray(surface.vertices), np.asarray(surface.faces)


@pytest.mark.parametrize("spoil", ["inside out", "mixed", "soup", "repeated", "lines"])
def test_meshes_of_files_are_put_in_order(spoil: str) -> None:
    vertices, faces = moved(BALL)
    if spoil == "inside out":
        faces = faces[:, ::-1]
    elif spoil == "mixed":
        faces = np.where(np.random.default_rng(0).random(len(faces))[:, None] < 0.5, faces[:, ::-1], faces)
    elif spoil == "soup":
        vertices, faces = vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)
    elif spoil == "repeated":
        vertices, faces = (
            np.concatenate([vertices, vertices]),
            np.where(np.arange(len(faces))[:, None] % 2, faces, faces + len(vertices)),
        )
    else:
        faces = np.concatenate([faces, [[0, 0, 1], [5, 6, 5], [7, 7, 7]]])
    line = [(0.0, -0.1, 0.2), (0.0, 0.1, 0.2)]
    np.testing.assert_allclose(
        bik.paths.on_surface((vertices, faces), line).poses, bik.paths.on_surface(BALL, line).poses, atol=1e-9
    )


def test_an_open_sheet_keeps_the_winding_of_most_faces() -> None:
    vertices, faces = trimesh.creation.icosphere(subdivisions=3).vertices, None
    grid = np.stack(np.meshgrid(np.linspace(0, 1, 11), np.linspace(0, 1, 11)), axis=-1).reshape(-1, 2)
    vertices = np.column_stack([grid, np.zeros(len(grid))])
    low = (np.arange(10)[:, None] * 11 + np.arange(10)).ravel()
    faces = np.concatenate([np.stack([low, low + 1, low + 12], 1), np.stack([low, low + 12, low + 11], 1)])
    faces[::5] = faces[::5, ::-1]
    line = [(0.1, 0.5, 0.0), (0.9, 0.5, 0.0)]
    np.testing.assert_allclose(normals(bik.paths.on_surface((vertices, faces), line))[:, 2], 1.0)
    np.testing.assert_allclose(normals(bik.paths.on_surface((vertices, faces), line, flip=True))[:, 2], -1.0)


@pytest.mark.parametrize("size", [1e-6, 1e-3, 10.0])
def test_small_and_large_meshes_are_alike(size: float) -> None:
    line = [(0.2, 0.3, 0.0), (0.9, 0.4, 0.0)]
    seam, one = (bik.paths.on_surface((s * CORNERS, SHEET[1]), np.multiply(s, line)) for s in (size, 1.0))
    np.testing.assert_allclose(places(seam), size * places(one), atol=1e-14 * size)


def test_no_call_hides_another() -> None:
    bik.paths.raster(SHEET, spacing=0.2, direction=(1, 0, 0))
    bik.paths.join(bik.paths.raster(SHEET, spacing=0.2, direction=(1, 0, 0)))
    assert all(callable(getattr(bik.paths, name)) for name in bik.paths.__all__)


def test_points_on_edges_and_corners_and_twice_are_taken() -> None:
    line = [(0, 0, 0), (0, 0, 0), (0.5, 0.5, 0), (1, 1, 0), (1, 1, 0), (1, 0, 0)]
    seam = bik.paths.on_surface(SHEET, line, rounding=0.01)
    assert_frames(seam)
    np.testing.assert_allclose(normals(seam), np.tile([0.0, 0.0, 1.0], (len(seam), 1)), atol=1e-12)
    assert seam.length == pytest.approx(np.sqrt(2.0) + 1.0)


def test_a_line_that_turns_back_has_frames_everywhere() -> None:
    seam = bik.paths.on_surface(SHEET, [(0.2, 0.5, 0), (0.8, 0.5, 0), (0.2, 0.5, 0)])
    assert_frames(seam)
    assert seam.length == pytest.approx(1.2)


def test_files_of_meshes_are_read(tmp_path: Path) -> None:
    BALL.export(tmp_path / "ball.stl")
    line = [(0.0, -0.1, 0.2), (0.0, 0.1, 0.2)]
    read = bik.paths.on_surface(tmp_path / "ball.stl", line)
    np.testing.assert_allclose(read.poses, bik.paths.on_surface(BALL, line).poses, atol=1e-6)


def test_a_mesh_in_millimetres_is_suspected() -> None:
    with pytest.warns(bik.UnitsWarning) as told:
        bik.paths.on_surface((1000.0 * CORNERS, SHEET[1]), [(0, 0, 0), (100, 100, 0)])
    assert str(told[0].message) == (
        "surface is 1414 m from corner to corner: if its file is in millimetres, scale it by 0.001"
    )
    assert told[0].filename == __file__


def test_a_file_without_trimesh_says_what_to_install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "trimesh", None)
    install = "trimesh: pip install 'beetle-ik[surfaces]'"
    options = {"spacing": 0.1, "direction": (1, 0, 0)}
    missing = bik.BeetleIkError
    assert_told(
        lambda: api.paths.raster(tmp_path / "a.stl", **options), missing, f"a surface from a file needs {install}"
    )
    assert_told(lambda: api.paths.on_surface(TABLE, LINE), missing, f"a line on a surface needs {install}")
    assert len(bik.paths.raster(SHEET, **options)) == 10


# --- raster ---------------------------------------------------------------------------------------


def test_rows_cover_a_sheet_at_equal_distances_there_and_back() -> None:
    passes = bik.paths.raster(SHEET, spacing=0.1, direction=(1, 0, 0), standoff=0.02)
    assert len(passes) == 10
    for i, row in enumerate(passes):
        assert_frames(row)
        np.testing.assert_allclose(places(row)[:, 1:], np.tile([0.05 + 0.1 * i, 0.02], (len(row), 1)), atol=1e-8)
        ends = (0.05, 0.95) if i % 2 == 0 else (0.95, 0.05)
        np.testing.assert_allclose(places(row)[[0, -1], 0], ends, atol=1e-12)
        np.testing.assert_allclose(row.poses[:, 0, 0], 1.0 if i % 2 == 0 else -1.0)


def test_rows_are_as_far_apart_along_a_sphere_as_asked() -> None:
    passes = bik.paths.raster(BALL, spacing=0.02, direction=(1, 0, 0), side=(0, 0, 1))
    at = [np.arcsin(np.clip(row.poses[len(row) // 2, 1, 3] / 0.2, -1.0, 1.0)) for row in passes]
    apart = 0.2 * np.diff(at)
    assert np.ptp(apart) < 4e-4
    assert 0.019 < apart.mean() <= 0.02 + 1e-6
    for row in passes:
        radii = np.linalg.norm(places(row), axis=1)
        assert (radii > 0.2 - 1e-4).all()
        assert (radii < 0.2 + 1e-9).all()
        assert (normals(row)[:, 2] > -0.05).all()


def test_rows_over_a_pipe_go_round_it_where_all_is_covered() -> None:
    rings = bik.paths.raster(PIPE, spacing=0.1, direction=(1, 0, 0), side=(0, 1, 0), steepest=np.pi)
    assert all(ring.closed for ring in rings)
    assert {round(ring.length, 3) for ring in rings} == {0.628}
    half = bik.paths.raster(PIPE, spacing=0.1, direction=(1, 0, 0), side=(0, 1, 0), inset=0.0)
    assert not any(row.closed for row in half)
    assert half[0].length == pytest.approx(np.pi * 0.1, rel=1e-2)


def test_a_row_is_whole_where_triangles_meet_within_an_edge() -> None:
    vertices = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0.5, 0), (2, 0, 0), (2, 1, 0)]
    faces = [(0, 1, 2), (0, 2, 3), (1, 5, 4), (4, 5, 6), (4, 6, 2)]
    passes = bik.paths.raster((vertices, faces), spacing=0.2, direction=(1, 0, 0))
    assert [round(row.length, 6) for row in passes] == [1.8] * 5


def test_a_closed_part_is_covered_from_above() -> None:
    one, other = (
        bik.paths.raster(BALL, spacing=0.1, direction=(1, 0, 0), **side) for side in ({}, {"side": (0, 0, 1)})
    )
    assert one == other


def test_a_hole_divides_a_row() -> None:
    plate = trimesh.creation.annulus(r_min=0.1, r_max=0.3, height=0.02, sections=256)
    passes = bik.paths.raster(plate, spacing=0.05, direction=(1, 0, 0), side=(0, 0, 1), inset=0.01)
    middle = [row for row in passes if abs(row.poses[0, 1, 3]) < 0.05]
    assert len(middle) % 2 == 0
    for row in passes:
        radii = np.hypot(*places(row)[:, :2].T)
        assert radii.min() > 0.1
        assert radii.max() < 0.3


def test_passes_are_joined_in_order_with_a_lift() -> None:
    passes = bik.paths.raster(SHEET, spacing=0.2, direction=(1, 0, 0))
    joined = bik.paths.join(passes, lift=0.05)
    assert_frames(joined)
    assert joined.contact.sum() == sum(map(len, passes))
    np.testing.assert_allclose(places(joined)[~joined.contact][:, 2], 0.05, atol=1e-12)
    assert joined.length == pytest.approx(5 * 0.8 + 4 * (0.05 + 0.2 + 0.05), abs=1e-6)
    flat = bik.paths.join(passes)
    assert flat.length == pytest.approx(5 * 0.8 + 4 * 0.2, abs=1e-6)
    assert flat.contact.all()


@pytest.mark.parametrize("flip", [False, True])
def test_a_joined_line_stays_on_the_surface(flip: bool) -> None:
    x, y = np.meshgrid(np.linspace(-0.12, 0.12, 60), np.linspace(-0.12, 0.12, 60))
    vertices = np.column_stack([c.ravel() for c in (x, y, np.sqrt(0.25**2 - x**2 - y**2))])
    corner = (np.arange(59)[:, None] * 60 + np.arange(59)).ravel()
    dome = (vertices, (corner[:, None] + np.array([[[0, 1, 61]], [[0, 61, 60]]])).reshape(-1, 3))
    passes = bik.paths.raster(dome, spacing=0.02, direction=(0, 1, 0), standoff=0.03, flip=flip)
    joined = bik.paths.join(passes, surface=dome)
    assert_frames(joined)
    way = joined.poses[~joined.contact]
    np.testing.assert_allclose(np.linalg.norm(way[:, :3, 3], axis=1), 0.22 if flip else 0.28, atol=5e-5)
    outward = way[:, :3, 3] / np.linalg.norm(way[:, :3, 3], axis=1, keepdims=True)
    assert np.abs(np.einsum("ki,ki->k", -way[:, :3, 2], outward) - (-1.0 if flip else 1.0)).max() < 1e-4
    turns = joined.poses[:-1, :3, :3].transpose(0, 2, 1) @ joined.poses[1:, :3, :3]
    assert np.degrees(np.arccos(np.clip((np.trace(turns, axis1=1, axis2=2) - 1.0) / 2.0, -1.0, 1.0))).max() < 20.0


def test_a_spacing_wider_than_the_part_makes_one_row() -> None:
    (row,) = bik.paths.raster(SHEET, spacing=5.0, direction=(1, 0, 0))
    np.testing.assert_allclose(places(row)[:, 1], 0.5, atol=1e-9)
    assert row.length == pytest.approx(0.1)


def test_a_plane_through_vertices_cuts_once() -> None:
    grid = np.stack(np.meshgrid(np.linspace(0, 1, 11), np.linspace(0, 1, 11)), axis=-1).reshape(-1, 2)
    vertices = np.column_stack([grid, np.zeros(len(grid))])
    low = (np.arange(10)[:, None] * 11 + np.arange(10)).ravel()
    faces = np.concatenate([np.stack([low, low + 1, low + 12], 1), np.stack([low, low + 12, low + 11], 1)])
    passes = bik.paths.raster((vertices, faces), spacing=0.1, direction=(1, 0, 0), inset=0.1)
    assert len(passes) == 9
    for row in passes:
        assert row.length == pytest.approx(0.8)
        assert (np.diff(row.distance) > 0.0).all()


# --- wrong input ----------------------------------------------------------------------------------

SHEETS = (np.concatenate([CORNERS, np.add(CORNERS, (2.0, 0.0, 0.0))]), np.concatenate([SHEET[1], SHEET[1] + 4]))
APART = bik.paths.raster(SHEETS, spacing=2.0, direction=(1, 0, 0), inset=0.1)
AROUND = np.linspace(0, 2 * np.pi, 13)[:-1]
RING = np.column_stack([np.cos(AROUND), np.sin(AROUND), 0 * AROUND])
TUBE = (
    np.concatenate([RING, np.add(RING, (0, 0, 1))]),
    [f for i in range(12) for j in [(i + 1) % 12] for f in ((i, j, 12 + j), (i, 12 + j, 12 + i))],
)
ALONG = {"spacing": 0.1, "direction": (1, 0, 0)}
STRIP = np.array([(np.cos(a) * (1 + w * np.cos(a / 2)), np.sin(a) * (1 + w * np.cos(a / 2)), w * np.sin(a / 2))
                  for a in np.linspace(0, 2 * np.pi, 25)[:-1] for w in (-0.2, 0.2)])  # fmt: skip
MOEBIUS = [face for i in range(24) for a, b, c, d in [(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3)]
           for face in ((a, b, c), (b, d, c))]  # fmt: skip
MOEBIUS = [tuple({48: 1, 49: 0}.get(v, v) for v in face) for face in MOEBIUS]


@pytest.mark.parametrize(("call", "message"), [
    (lambda: api.paths.on_surface(3, LINE), "surface must be a file, a mesh of trimesh, a bik.obstacles.Mesh or (vertices, faces), got 3"),
    (lambda: api.paths.on_surface("none.stl", LINE), "surface: no file 'none.stl'"),
    (lambda: api.paths.on_surface(bik.obstacles.Sphere((0, 0, 0), 1.0), LINE), "surface: the triangles of a Sphere are only for drawing; make a finer mesh, for example with trimesh.creation, or give a Box, a ConvexMesh or a Mesh"),
    (lambda: api.paths.on_surface((CORNERS, [(0, 1, 4)]), LINE), "surface: faces[0] is [0, 1, 4], but there are 4 vertices"),
    (lambda: api.paths.on_surface((CORNERS, [(0.0, 1.0, 2.0)]), LINE), "surface: faces must be whole numbers, indices of vertices, got float64"),
    (lambda: api.paths.on_surface((CORNERS, [(0, 1)]), LINE), "surface: faces: expected shape (t, 3), got (1, 2)"),
    (lambda: api.paths.on_surface((CORNERS, [(0, 0, 1)]), LINE), "surface has no triangle of any area"),
    (lambda: api.paths.on_surface((np.nan * CORNERS, SHEET[1]), LINE), "surface: vertices[0] must be finite, got [nan, nan, nan]"),
    (lambda: api.paths.on_surface((STRIP, MOEBIUS), [(1, 0, 0), (0, 1, 0)]), "surface has one side only, like a Moebius strip: cut it, so that it has an outside"),
    (lambda: api.paths.on_surface(TABLE, [(0.4, 0, np.nan), (0, 0, 0)]), "points[0] must be finite, got [0.4, 0.0, nan]"),
    (lambda: api.paths.on_surface(TABLE, [(0.4, 0, 0.2)]), "points: at least 2 are needed, got 1"),
    (lambda: api.paths.on_surface(TABLE, [(0.4, 0, 0.2)] * 3), "points are all projected to one point of the surface: a line needs two"),
    (lambda: api.paths.on_surface(TABLE, [*LINE, (0.5, 0.0, 1.2)]), "points[2] is 1 m from the surface, farther than within=0.06: give a larger within=, or move it nearer"),
    (lambda: api.paths.on_surface(BALL, [(0, 0, -0.2), (0, 1e-9, 0.2)]), None),
    (lambda: api.paths.on_surface(TABLE, LINE, step=0.0), "step must be positive and finite, got 0"),
    (lambda: api.paths.on_surface(TABLE, LINE, step=1e-9), "step: 1e-09 m would make 2e+08 poses; at most 1,000,000 are made"),
    (lambda: api.paths.on_surface(TABLE, LINE, standoff=-0.1), "standoff must be zero or more, and finite, got -0.1"),
    (lambda: api.paths.on_surface(TABLE, LINE, crease=4.0), "crease must be between 0 and 3.14159, got 4"),
    (lambda: api.paths.on_surface(TABLE, LINE, lead="along"), "lead must be 'normal' or 'tangent', got 'along'"),
    (lambda: api.paths.on_surface(TABLE, LINE, closed=1), "closed must be True or False, got 1"),
    (lambda: api.paths.raster(TABLE, spacing=0.1, direction=(0, 0, 1)), "direction is along side= [0.0, 0.0, 1.0], from which the tool comes: rows run across it"),
    (lambda: api.paths.raster(TUBE, **ALONG), "side= is needed: the normals of the surface point to all sides"),
    (lambda: api.paths.raster(SHEET, spacing=0.1, direction=(0, 0, 2)), "direction is along side= [0.0, 0.0, 1.0], from which the tool comes: rows run across it"),
    (lambda: api.paths.raster(SHEET, spacing=0.1, direction=(0, 0, 0)), "direction must not be zero, got [0.0, 0.0, 0.0]"),
    (lambda: api.paths.raster(SHEET, spacing=0.0, direction=(1, 0, 0)), "spacing must be positive and finite, got 0"),
    (lambda: api.paths.raster(SHEET, spacing=1e-6, direction=(1, 0, 0)), "spacing: 1e-06 m would make 1e+06 rows over 1 m; at most 10,000 are made"),
    (lambda: api.paths.raster(SHEET, **ALONG, side=(0, 0, -1)), "no face of the surface looks towards side= [0.0, 0.0, -1.0]: choose another, or flip=True for an open surface that winds the other way"),
    (lambda: api.paths.raster(SHEET, **ALONG, side=(0, np.nan, -1)), "side must be finite, got [0.0, nan, -1.0]"),
    (lambda: api.paths.join([]), "seams: at least one is needed, got none"),
    (lambda: api.paths.join(bik.paths.raster(SHEET, **ALONG), lift=0.1, surface=SHEET), "lift and surface: give one of them, a tool that lifts off or one that stays on it"),
    (lambda: api.paths.join(APART, surface=SHEETS), "between seams[0] and seams[1]: the projection of the line jumps by 1 m behind points[0]: give more points, nearer to the surface; or give lift="),
    (lambda: api.paths.join([1]), "seams[0] must be a Seam, got 1"),
])  # fmt: skip
def test_wrong_input_is_told(call: Any, message: str | None) -> None:
    if message is None:
        with pytest.raises(Invalid, match="the projection of the line jumps by"):
            call()
    else:
        assert_told(call, Invalid, message)
