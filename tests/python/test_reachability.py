"""Reachability maps: against solves, their inverse, files, figures, and placements of the base."""

from pathlib import Path

import numpy as np
import pytest

import beetle_ik as bik

UR5E = bik.Robot.named("ur5e")
PANDA = bik.Robot.named("panda")
COARSE = {"voxel": 0.2, "directions": 12, "rolls": 3}
MAP = bik.reachability(UR5E, **COARSE)


def drawn(found: bik.ReachabilityMap, count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Poses of voxels that are reached, and whether each pose is."""
    rng = np.random.default_rng(seed)
    voxels = np.argwhere(found.index > 0)
    picked = voxels[rng.integers(len(voxels), size=count)].tolist()
    numbers = rng.integers(found.orientations, size=count)
    poses = np.array([found.poses((x, y, z))[k] for (x, y, z), k in zip(picked, numbers, strict=True)])
    return poses, np.array([found.reached((x, y, z))[k] for (x, y, z), k in zip(picked, numbers, strict=True)])


@pytest.mark.parametrize("robot", [UR5E, PANDA, bik.Robot.named("iiwa14")], ids=lambda robot: robot.name)
def test_a_map_agrees_with_a_search_of_a_large_budget(robot: bik.Robot) -> None:
    found = bik.reachability(robot, **COARSE)
    poses, reached = drawn(found, 300)
    assert (found.query(poses) == reached).all()
    searched = bik.solve_batch(robot, poses, solver=bik.MultiStart(bik.LevenbergMarquardt()), seed=1).success
    assert not (reached & ~searched).any()
    assert (searched & ~reached).sum() <= 2


def test_the_index_is_the_share_of_orientations() -> None:
    x, y, z = np.argwhere(MAP.index > 0)[7].tolist()
    assert MAP.index[x, y, z] == np.float32(MAP.reached((x, y, z)).mean())
    assert MAP.orientations == 36
    assert MAP.index.shape == MAP.shape == MAP.bits.shape[:3]
    centre = MAP.origin + MAP.voxel * (np.array([x, y, z]) + 0.5)
    np.testing.assert_allclose(MAP.poses((x, y, z))[:, :3, 3], np.tile(centre, (36, 1)), atol=1e-12)
    assert MAP.axis is not None
    np.testing.assert_array_equal(MAP.axis, [0, 0])


def test_orientations_turn_with_the_azimuth_of_the_voxel() -> None:
    nx, ny, nz = MAP.shape
    assert nx == ny, "as far in all directions"
    here, there = MAP.poses((2, 5, 3)), MAP.poses((nx - 1 - 5, 2, 3))  # a quarter of a turn on
    quarter = bik.pose([0, 0, 0], rpy=[0, 0, np.pi / 2])
    np.testing.assert_allclose(quarter @ here, there, atol=1e-12)
    assert nz > 3


def test_a_query_takes_the_voxel_and_the_nearest_orientation() -> None:
    poses, reached = drawn(MAP, 50)
    nudged = poses @ bik.pose([0.02, -0.02, 0.02], rpy=[0.05, -0.05, 0.05])
    assert (MAP.query(nudged) == reached).all()
    assert MAP.query(poses[0]) is bool(reached[0])
    assert MAP.query(bik.pose([9, 9, 9])) is False


def test_the_inverse_agrees_with_the_map() -> None:
    inverse = MAP.inverse()
    poses, reached = drawn(MAP, 100)
    target = bik.pose([0.3, -2.0, 0.4], rpy=[0.3, -0.2, 1.0])
    bases = target @ np.linalg.inv(poses)
    assert (inverse.query(bases, target) == reached).all()
    assert (inverse.query(np.linalg.inv(poses)) == reached).all()
    down = bik.pose([1.0, 2.0, 0.3], rpy=[np.pi, 0, 0])
    share = inverse.on_floor(np.linspace(0, 2, 11), np.linspace(1, 3, 11), target=down)
    assert share.max() == 1.0
    finer = inverse.on_floor(np.linspace(0, 2, 11), np.linspace(1, 3, 11), target=down, yaws=48)
    assert np.abs(finer - share).mean() < 0.05
    assert share[0, 0] == 0.0


def test_a_map_is_stored_and_restored(tmp_path: Path) -> None:
    file = tmp_path / "map.npz"
    found = bik.reachability(UR5E, **COARSE, quality=True)
    found.to_npz(file)
    again = bik.ReachabilityMap.load(file, robot=UR5E)
    assert again == found
    assert again != MAP
    assert again.robot == UR5E
    assert file.stat().st_size < found.bits.nbytes + 2 * found.index.nbytes


def test_files_that_are_no_map_of_the_robot_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "map.npz"
    MAP.to_npz(file)
    with pytest.raises(bik.InvalidInputError) as raised:
        bik.ReachabilityMap.load(file, robot=PANDA)
    assert str(raised.value) == f"{file}: the map is of robot 'ur5e', not of 'panda'"
    longer = UR5E.with_tool(bik.pose([0, 0, 0.1]))
    with pytest.raises(bik.InvalidInputError) as raised:
        bik.ReachabilityMap.load(file, robot=longer)
    changed = "the map is of another robot 'ur5e': joints, limits, base, tool or bodies differ"
    assert str(raised.value) == f"{file}: {changed}"
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 0xFF
    file.write_bytes(content)
    with pytest.raises(bik.InvalidInputError, match=r"map\.npz: damaged"):
        bik.ReachabilityMap.load(file)
    np.savez(file, x=1)
    with pytest.raises(bik.InvalidInputError) as raised:
        bik.ReachabilityMap.load(file)
    assert str(raised.value) == f"{file}: not a reachability map"
    np.savez(file, reachability_map=np.array(0))
    with pytest.raises(bik.InvalidInputError) as raised:
        bik.ReachabilityMap.load(file)
    assert "a map of format 0" in str(raised.value)


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_threads_do_not_change_a_bit(threads: int) -> None:
    again = bik.reachability(UR5E, **COARSE, threads=threads)
    assert again == MAP


def test_progress_ends_at_all_voxels() -> None:
    told: list[tuple[int, int]] = []
    bik.reachability(UR5E, **COARSE, progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1] > 0
    assert [done for done, _ in told] == sorted(done for done, _ in told)


def test_a_region_is_extended_to_whole_voxels() -> None:
    found = bik.reachability(UR5E, **COARSE, region=[(0.75, 0.3, 0.1), (0.25, -0.1, 0.5)])
    np.testing.assert_allclose(found.origin, [0.2, -0.2, 0.0], atol=1e-12)
    assert found.shape == (3, 3, 3)
    offset = np.round((found.origin - MAP.origin) / 0.2).astype(int)
    part = MAP.index[tuple(slice(k, k + 3) for k in offset)]
    np.testing.assert_array_equal(found.index, part)


def test_obstacles_take_away_what_they_are_in_the_way_of() -> None:
    arm = UR5E.with_capsules(radius=0.05)
    box = bik.obstacles.Box((0.5, 0.0, 0.25), size=(0.3, 0.3, 0.5))
    options = {"voxel": 0.25, "directions": 4, "rolls": 1, "quality": True}
    free = bik.reachability(arm, **options, self_collision=True)
    beside = bik.reachability(arm, **options, obstacles=[box])
    assert not (beside.bits & ~free.bits).any()
    assert beside.index.sum() < free.index.sum()
    assert beside.clearance is not None
    assert np.nanmin(beside.clearance) >= 1e-3
    poses, reached = drawn(beside, 60)
    solved = bik.solve_batch(arm, poses, obstacles=[box]).success
    assert not (reached & ~solved).any()
    assert (solved & ~reached).sum() <= 6, "pushes of blocked solutions are left out"


def test_arms_of_other_kinds_have_maps() -> None:
    planar = bik.reachability(bik.Robot.planar([0.5, 0.4, 0.3]), voxel=0.1, rolls=8)
    assert planar.shape[2] == 1
    assert planar.orientations == 8
    assert planar.index.max() == 1.0
    positions = bik.reachability(bik.Robot.named("kr210"), voxel=0.5, task=bik.tasks.Position())
    assert positions.orientations == 1
    rail = bik.Robot.named("ur5").with_mobile_base("planar", lower=[-1, -1, -3], upper=[1, 1, 3])
    region = [(1.0, 1.0, 0.2), (1.4, 1.4, 0.4)]
    on_wheels = bik.reachability(rail, voxel=0.2, directions=3, rolls=1, region=region)
    assert on_wheels.axis is None
    assert on_wheels.index.mean() > 0.9, "a base that drives reaches farther than its arm"


def test_what_has_no_map_is_refused() -> None:
    several = bik.Robot.from_urdf(TWO_TIPS, tip=["left", "right"])
    with pytest.raises(bik.InvalidInputError) as raised:
        bik.reachability(several)
    assert str(raised.value).startswith("reachability takes robots with one tip; this one has left and right")
    with pytest.raises(bik.InvalidInputError, match=r"moves in 2 directions.*give task=tasks\.Position\(\)"):
        bik.reachability(bik.Robot.planar([1, 1]))


TWO_TIPS = """<robot name="r"><link name="base"/><link name="left"/><link name="right"/>
<joint name="a" type="continuous"><parent link="base"/><child link="left"/></joint>
<joint name="b" type="continuous"><parent link="base"/><child link="right"/></joint></robot>"""


def test_the_best_base_reaches_all_targets() -> None:
    targets = np.array([bik.pose([x, y, 0.4], rpy=[np.pi, 0, 0]) for x in (0.3, 0.9, 1.5) for y in (-0.3, 0.3)])
    placed = bik.best_base(UR5E, targets, region=[(-1, -1, 0), (1.5, 1, 0)], map=MAP)
    assert placed.success
    assert placed.message.startswith("6 of 6 targets reached from (")
    stands = UR5E.with_base(placed.pose)
    assert (bik.solve_batch(stands, targets).success == placed.reached).all()
    assert placed.margin % MAP.voxel == pytest.approx(0.0, abs=1e-12)
    away = bik.best_base(UR5E, targets, region=[(5, 5, 0), (5.5, 5.5, 0)], map=MAP)
    assert not away.reached.any()
    assert away.margin == 0.0
    with pytest.raises(bik.InvalidInputError) as raised:
        bik.best_base(PANDA, targets, region=[(0, 0, 0), (1, 1, 0)], map=MAP)
    assert str(raised.value) == "map is of robot 'ur5e', not of 'panda'"


@pytest.mark.parametrize("kind", ["slices", "cloud"])
def test_figures_show_the_share(kind: str) -> None:
    figure = MAP.plot(kind)  # type: ignore[arg-type]
    assert figure.get_suptitle() == "ur5e: share of 36 orientations reached"
    assert len(figure.axes) == (4 if kind == "slices" else 2)
    floor = MAP.inverse().plot(bik.pose([0.4, 0, 0.4]))
    assert floor.axes[0].get_xlabel() == "x of the base [m]"
    with pytest.raises(bik.InvalidInputError) as raised:
        MAP.plot("pie")  # type: ignore[arg-type]
    assert str(raised.value) == "kind must be one of 'slices', 'cloud', got 'pie'"


def test_repr_says_what_is_reached() -> None:
    assert repr(MAP).startswith("<ReachabilityMap of 'ur5e': 12x12x12 voxels of 0.2 m, ")
    assert repr(MAP.inverse()).startswith("<InverseReachabilityMap of <ReachabilityMap of 'ur5e'")


def test_an_inverse_map_is_drawn_for_one_target() -> None:
    inverse = bik.reachability(bik.Robot.named("ur5e"), voxel=0.4, directions=4, rolls=1).inverse()
    with pytest.raises(bik.InvalidInputError, match=r"^target: expected shape \(4, 4\), got \(0, 4, 4\)$"):
        inverse.plot(np.zeros((0, 4, 4)))


def test_a_region_of_places_must_be_finite() -> None:
    region = [[0.0, 0.0, 0.0], [1.0, np.nan, 0.0]]
    with pytest.raises(bik.InvalidInputError) as raised:
        bik.best_base(bik.Robot.named("ur5e"), [np.eye(4)], region=region)
    assert str(raised.value) == "region must be finite, got [[0.0, 0.0, 0.0], [1.0, nan, 0.0]]"
