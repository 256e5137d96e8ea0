"""The simulated arm. Skipped where MuJoCo is not installed."""

import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from iiwa_circle import CIRCLE, IIWA, ON_CIRCLE

import beetle_ik as bik
from beetle_ik.sim import MujocoPlant

SLIDER = """
<robot name="slider">
  <link name="base"/>
  <link name="rail"><visual><geometry><mesh filename="package://nowhere/rail.stl"/></geometry></visual></link>
  <link name="tip"/>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="rail"/><origin xyz="0 0 0.5"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <joint name="swing" type="revolute"><parent link="rail"/><child link="tip"/><origin xyz="0 0 0.3" rpy="0 0.4 0"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <link name="end"/>
  <joint name="flange" type="fixed"><parent link="tip"/><child link="end"/><origin xyz="0.2 0 0.1"/></joint>
</robot>
"""


def test_without_mujoco_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(bik.BeetleIkError) as raised:
        MujocoPlant(IIWA)
    assert str(raised.value) == "simulation needs mujoco: pip install 'beetle-ik[sim]'"


@pytest.fixture
def mujoco() -> None:
    pytest.importorskip("mujoco", reason="MuJoCo is not installed (extra 'sim')")


@pytest.mark.usefixtures("mujoco")
def test_servos_of_the_simulated_robot_yield_under_gravity() -> None:
    plant = MujocoPlant(IIWA, gravity=0.0)
    plant.reset(ON_CIRCLE)
    np.testing.assert_allclose(plant.q, ON_CIRCLE, atol=1e-6)
    np.testing.assert_allclose(plant.tip, IIWA.fk(ON_CIRCLE)[:3, 3], atol=1e-6)
    heavy = MujocoPlant(IIWA)
    heavy.reset(ON_CIRCLE)
    sag = IIWA.fk(ON_CIRCLE)[2, 3] - heavy.tip[2]
    assert 1e-4 < sag < 1e-2


@pytest.mark.usefixtures("mujoco")
def test_a_robot_needs_no_meshes_or_masses() -> None:
    plant = MujocoPlant.from_urdf(SLIDER, gravity=0.0)
    plant.reset([0.3, -0.5])
    np.testing.assert_allclose(plant.tip, plant.robot.fk([0.3, -0.5])[:3, 3], atol=1e-6)
    shared = Path(__file__).parents[3] / "shared" / "robots" / "panda.urdf"
    if not shared.exists():
        pytest.skip("no robot descriptions beside the repository")
    MujocoPlant.from_urdf(shared, tip="panda_link8")


@pytest.mark.usefixtures("mujoco")
def test_broyden_bas_follows_to_a_millimetre_without_a_model() -> None:
    built = IIWA.with_errors(length=0.02, angle=np.radians(2.0), seed=1)
    plant = MujocoPlant(built, noise=5e-5)
    resolved = bik.track(IIWA, CIRCLE, ON_CIRCLE, dt=0.2)
    plant.reset(ON_CIRCLE)
    misses = []
    for q, target in zip(resolved.q[1:40], resolved.reference[1:40], strict=True):
        plant.move(q)
        misses.append(np.linalg.norm(plant.tip - target))
    assert min(misses) > 5e-3
    plant.reset(ON_CIRCLE)
    tips = []

    def move(q: np.ndarray[Any, Any]) -> Any:
        measured = plant.move(q)
        tips.append(plant.tip)
        return measured

    result = bik.track_model_free(
        move, CIRCLE, ON_CIRCLE, dt=plant.dt, controller=bik.BroydenBAS(max_evaluations_per_step=1)
    )
    error = np.linalg.norm(np.array(tips) - result.reference, axis=1)[30:]
    assert error.max() < 1e-3, error.max()


@pytest.mark.usefixtures("mujoco")
@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: MujocoPlant(IIWA, dt=0.0), "dt must be positive and finite, got 0.0"),
        (lambda: MujocoPlant(IIWA, noise=-1.0), "noise must be zero or more and finite, got -1.0"),
        (lambda: MujocoPlant(IIWA).move([0.0]), "q of the plant: expected shape (7,), got (1,)"),
    ],
)
def test_wrong_input_is_named(make: Any, message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as raised:
        make()
    assert str(raised.value) == message


@pytest.mark.usefixtures("mujoco")
@pytest.mark.skipif(os.environ.get("MUJOCO_GL") != "egl", reason="pictures need EGL")
def test_a_picture_is_drawn_without_a_screen() -> None:
    plant = MujocoPlant(IIWA)
    bare = plant.picture(width=160, height=120)
    drawn = plant.picture(width=160, height=120, target=[[0.0, 0.4, 1.0]])
    assert bare.shape == (120, 160, 3)
    assert (bare != drawn).any()


@pytest.mark.usefixtures("mujoco")
def test_the_simulated_sensor_measures_poses_by_an_option() -> None:
    plant = MujocoPlant(IIWA, gravity=0.0, rotation_noise=0.0)
    plant.reset(ON_CIRCLE)
    np.testing.assert_allclose(plant.move(ON_CIRCLE), IIWA.fk(ON_CIRCLE), atol=1e-6)
    heavy = MujocoPlant(IIWA, dt=0.05, rotation_noise=0.0)
    heavy.reset(ON_CIRCLE)
    path = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=20.0).with_orientation(IIWA.fk(ON_CIRCLE)[:3, :3])
    controller = bik.BroydenBAS(max_evaluations_per_step=1)
    result = bik.track_model_free(heavy, path, ON_CIRCLE, dt=heavy.dt, controller=controller)
    assert result.position_error[200:].max() < 2e-4
    assert result.rotation_error[200:].max() < 4e-4
    with pytest.raises(bik.InvalidInputError) as raised:
        MujocoPlant(IIWA, rotation_noise=-1.0)
    assert str(raised.value) == "rotation_noise must be zero or more and finite, got -1.0"
