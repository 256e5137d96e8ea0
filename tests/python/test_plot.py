"""Figures: contents and labels."""

import io
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import beetle_ik as bik
from beetle_ik.figures import plan_figure
from beetle_ik.figures.shapes import inside
from beetle_ik.figures.surface import simplified


def labels(figure: Figure) -> list[str]:
    return [axes.get_ylabel() for axes in figure.get_axes()]


def legend(axes: Axes) -> list[str]:
    return [text.get_text() for text in axes.get_legend().get_texts()]


def test_a_tracked_path_is_drawn_with_labels(tracked: bik.TrackResult) -> None:
    figure = tracked.plot()
    space, error, positions, evaluations, *velocities = figure.get_axes()
    assert [space.get_xlabel(), space.get_ylabel(), space.get_zlabel()] == ["x [m]", "y [m]", "z [m]"]
    assert legend(space) == ["target", "tip", "start"]
    assert (error.get_ylabel(), error.get_yscale()) == ("position error [m]", "log")
    assert error.get_lines()[1].get_ydata()[0] == tracked.position_tolerance
    assert positions.get_ylabel() == "joint position [rad]"
    assert legend(positions) == tracked.robot.joint_names
    assert (evaluations.get_ylabel(), evaluations.get_xlabel()) == ("evaluations per step", "time [s]")
    assert [axes.get_title() for axes in velocities] == tracked.robot.joint_names
    assert figure.get_suptitle() == "planar5, 30 steps of 0.2 s"
    figure.savefig(io.BytesIO())


def test_the_shade_begins_at_the_velocity_limit(tracked: bik.TrackResult) -> None:
    for j, axes in enumerate(tracked.plot().get_axes()[4:]):
        above, below = (shade.get_paths()[0].vertices[:, 1] for shade in axes.collections)
        assert above.min() == pytest.approx(np.nanmin(tracked.velocity_limit[:, j]))
        assert below.max() == pytest.approx(-np.nanmin(tracked.velocity_limit[:, j]))


def test_space_has_one_scale(tracked: bik.TrackResult) -> None:
    space = tracked.plot().get_axes()[0]
    widths = [np.ptp(limits) for limits in (space.get_xlim(), space.get_ylim(), space.get_zlim())]
    assert widths == pytest.approx([widths[0]] * 3)


def test_a_trajectory_of_straight_lines_has_no_acceleration(tracked: bik.TrackResult) -> None:
    assert labels(tracked.trajectory.plot()) == ["position [rad, m]", "velocity [rad/s, m/s]"]


def test_accelerations_of_a_curved_trajectory_are_drawn() -> None:
    q = np.array([[0.0, 1.0], [1.0, 0.0]])
    figure = bik.Trajectory.from_samples([0.0, 1.0], q, qd=np.zeros((2, 2)), joint_names=["a", "b"]).plot()
    assert labels(figure)[2] == "acceleration [rad/s², m/s²]"
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["a", "b"]


def test_a_robot_is_drawn_up_to_its_tip() -> None:
    robot = bik.Robot.planar([1.0, 1.0])
    (axes,) = bik.plot.robot(robot, [0.0, 0.0]).get_axes()
    assert axes.get_title() == f"{robot.name}, 2 joints"
    assert len(axes.collections) == 1  # of its links
    np.testing.assert_allclose(axes.get_lines()[0].get_data_3d(), [[2.0], [0.0], [0.0]], atol=1e-12)


def test_a_tool_is_drawn_up_to_the_tip() -> None:
    robot = bik.Robot.planar([1.0, 1.0]).with_tool(bik.pose([0.3, 0.0, 0.0]))
    (axes,) = bik.plot.robot(robot, [0.0, 0.0], meshes=False).get_axes()
    links, tool, tip = axes.get_lines()
    assert (links.get_label(), tool.get_label(), tip.get_label()) == ("links", "tool", "tip")
    assert links.get_data_3d()[0].max() == pytest.approx(2.0)
    np.testing.assert_allclose(tool.get_data_3d()[0], [2.0, 2.3], atol=1e-12)
    np.testing.assert_allclose(tip.get_data_3d()[0], [2.3], atol=1e-12)


def test_a_plan_draws_the_tool() -> None:
    robot = bik.Robot.planar([1.0, 1.0]).with_tool(bik.pose([0.3, 0.0, 0.0]))
    limits = bik.Limits(velocity=1.0, acceleration=1.0)
    plan = bik.plan_point_to_point(robot, start_q=[0.0, 0.0], end_q=[0.5, 0.5], limits=limits)
    arm = plan.plot().get_axes()[0].get_lines()[0]
    assert arm.get_xdata().max() == pytest.approx(2.3)


def test_velocities_far_below_their_limits_fill_their_panels() -> None:
    robot = bik.Robot.planar([1.0, 1.0], velocity=[100.0, 0.2])
    path = bik.paths.polyline([(1.2, 0.4, 0.0), (1.2, 0.45, 0.0)], duration=1.0)
    result = bik.track(robot, path, dt=0.1)
    first, second = result.plot().get_axes()[4:]
    fastest = np.abs(result.qd[1:]).max()
    assert first.get_ylim()[1] == pytest.approx(1.15 * fastest)
    assert [text.get_text() for text in first.texts] == ["limit 100"]
    assert not second.texts or second.texts[0].get_text() == "limit 0.2"


def sphere_mesh(count: int) -> np.ndarray:
    """Returns triangles (t, 3, 3) of a unit sphere, about `count`."""
    steps = int(np.sqrt(count / 2))
    polar, turn = np.linspace(0, np.pi, steps + 1), np.linspace(0, 2 * np.pi, steps + 1)
    rings = ((np.sin(polar), np.cos(turn)), (np.sin(polar), np.sin(turn)), (np.cos(polar), turn**0))
    corner = np.stack([np.outer(*ring) for ring in rings], axis=-1)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    return np.concatenate([np.stack(face, axis=2).reshape(-1, 3, 3) for face in ((a, b, c), (a, c, d))])


def test_huge_meshes_are_drawn_coarser() -> None:
    triangles = sphere_mesh(80_000)
    coarse = simplified(triangles, 5000)
    assert 1000 < len(coarse) <= 5000
    np.testing.assert_allclose(np.linalg.norm(coarse.reshape(-1, 3), axis=1), 1.0, atol=0.1)
    np.testing.assert_array_equal(simplified(triangles, len(triangles)), triangles)


def test_meshes_are_drawn_in_one_collection(tmp_path: Path) -> None:
    for link in ("a", "b"):
        vertices = sphere_mesh(3000).reshape(-1, 3) * 0.1
        lines = [f"v {x} {y} {z}" for x, y, z in vertices]
        lines += [f"f {i} {i + 1} {i + 2}" for i in range(1, len(vertices), 3)]
        (tmp_path / f"{link}.obj").write_text("\n".join(lines))
    links = "".join(
        f"<link name='{link}'><collision><geometry><mesh filename='{link}.obj'/></geometry></collision></link>"
        for link in ("a", "b")
    )
    joint = "<joint name='j' type='continuous'><parent link='a'/><child link='b'/><origin xyz='0 0 0.5'/></joint>"
    (tmp_path / "arm.urdf").write_text(f"<robot name='arm'>{links}{joint}</robot>")
    robot = bik.Robot.from_urdf(tmp_path / "arm.urdf", collision="hulls")
    (axes,) = bik.plot.robot(robot, [0.0], bodies=False).get_axes()
    assert len(axes.collections) == 1
    (tip,) = axes.get_lines()
    assert tip.get_label() == "tip"
    assert axes.get_zlim()[1] > 0.6  # the mesh beyond the tip is inside
    (axes,) = bik.plot.robot(robot, [0.0]).get_axes()
    assert len(axes.collections) == 1 + len(robot.bodies)
    (axes,) = bik.plot.robot(robot, [0.0], bodies=False, meshes=False).get_axes()
    assert len(axes.collections) == 0
    assert len(axes.get_lines()) == 2


def test_a_floor_leaves_the_arm_its_size() -> None:
    floor = bik.obstacles.Box((0, 0, -0.05), (20, 20, 0.1))
    out_of_sight = bik.obstacles.Sphere((50, 0, 0), 1.0)
    (axes,) = bik.plot.robot(bik.Robot.named("panda"), np.zeros(7), obstacles=[floor, out_of_sight]).get_axes()
    assert np.ptp([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()], axis=1).max() < 2.5
    assert len(axes.collections) == 2  # arm and floor


def test_polygons_are_cut_to_a_box() -> None:
    low, high = np.array([-1.0, -1.0, -1.0]), np.array([1.0, 1.0, 1.0])
    triangle = np.array([[-9.0, -9.0, 0.5], [9.0, -9.0, 0.5], [0.0, 9.0, 0.5]])
    corners = {tuple(corner) for corner in inside(triangle, low, high).round(12)}
    assert corners == {(x, y, 0.5) for x in (-1.0, 1.0) for y in (-1.0, 1.0)}
    np.testing.assert_array_equal(inside(triangle / 20, low, high), triangle / 20)
    assert inside(triangle + np.array([0.0, 0.0, 1.0]), low, high).shape == (0, 3)
    half = inside(np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]]), low, high)
    assert sorted(map(tuple, half)) == [(0, 0, 0), (0, 0, 1), (1, 0, 0), (1, 0, 1), (1, 0, 1)]


def test_a_long_message_is_a_title_of_several_lines() -> None:
    arm = bik.Robot.named("panda").with_capsules(radius=0.06)
    home = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8]
    post = bik.obstacles.Capsule((0.45, 0, 0), (0.45, 0, 0.5), 0.04)
    limits = bik.Limits(acceleration=5.0)
    plan = bik.plan_point_to_point(arm, start_q=home, end=[0.45, 0, 0.3], limits=limits, obstacles=[post])
    lines = plan.plot().get_suptitle().splitlines()
    assert " ".join(lines) == f"{arm.name}: {plan.message}"
    assert max(map(len, lines)) <= 120


def test_a_tracked_pose_shows_its_rotation_error() -> None:
    robot = bik.Robot.named("iiwa14")
    start = [0.3, 0.5, 0.2, -1.2, 0.1, 0.8, 0.1]
    pose = robot.fk(start)
    path = bik.paths.circle(pose[:3, 3], diameter=0.1, duration=1.0).with_orientation(pose[:3, :3])
    result = bik.track(robot, path, dt=0.1)
    rotation = result.plot().get_axes()[2]
    assert (rotation.get_ylabel(), rotation.get_yscale()) == ("rotation error [rad]", "log")
    np.testing.assert_array_equal(rotation.get_lines()[0].get_ydata(), result.rotation_error)


def test_many_joints_keep_the_layout() -> None:
    robot = bik.Robot.planar([0.2] * 24, velocity=5.0)
    result = bik.track(robot, bik.paths.circle((2.0, 1.0, 0.0), diameter=0.4, duration=0.4), dt=0.2)
    for figure in (result.plot(), result.trajectory.plot()):
        figure.get_layout_engine().execute(figure)
        for axes in figure.get_axes():
            box = axes.get_window_extent()
            assert min(box.width, box.height) > 60 * figure.dpi / 72


def test_pyplot_knows_the_figure(tracked: bik.TrackResult) -> None:
    assert plt.figure(tracked.plot().number) is plt.gcf()
    assert len(plt.get_fignums()) == 1


def test_figures_are_not_shown(tracked: bik.TrackResult, monkeypatch: pytest.MonkeyPatch) -> None:
    def show(*_: object, **__: object) -> None:
        pytest.fail("a figure was shown")

    monkeypatch.setattr(plt, "show", show)
    tracked.plot()
    tracked.trajectory.plot()
    bik.plot.robot(tracked.robot, tracked.q[0])


def test_without_matplotlib_the_extra_is_named(tracked: bik.TrackResult, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(bik.BeetleIkError, match=r"^a figure needs matplotlib: pip install 'beetle-ik\[plot\]'$"):
        tracked.plot()


def test_a_tracked_path_is_animated(tracked: bik.TrackResult, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan_figure, "_FRAMES_A_SECOND", 1)
    monkeypatch.setattr(plan_figure, "_PAUSE", 0)
    bik.plot.animation(tracked).save(tmp_path / "track.gif", writer="pillow")
    assert (tmp_path / "track.gif").read_bytes().startswith(b"GIF")
    with pytest.raises(bik.InvalidInputError, match=r"^result must be a Plan or a TrackResult, got 3$"):
        bik.plot.animation(3)  # type: ignore[arg-type]


def test_a_plan_shows_the_speed_of_its_tip_and_the_limits() -> None:
    robot, start = bik.Robot.named("panda"), np.array([0.0, -0.5, 0.0, -2.0, 0.0, 1.5, 0.8])
    limits = bik.Limits(acceleration=5.0, tip_speed=0.3, tip_turn_speed=9.0)
    plan = bik.plan_point_to_point(robot, start_q=start, end_q=start + 0.4, limits=limits)
    axes = {panel.get_ylabel(): panel for panel in plan.plot().axes}
    drawn, *bounds = axes["tip speed [m/s]"].lines
    time, speed = np.asarray(drawn.get_xdata()), np.asarray(drawn.get_ydata())
    places = robot.fk(plan.trajectory.at(time)[0])[:, :3, 3]
    np.testing.assert_allclose(speed, np.linalg.norm(np.gradient(places, time, axis=0), axis=1), atol=0.02)
    assert [bound.get_ydata()[0] for bound in bounds] == [0.3]
    assert len(axes["tip turn speed [rad/s]"].lines) == 1  # its limit is far above
