"""Simulated arms in MuJoCo, for testing controllers and motions. It needs the extra `sim`.

`MujocoPlant` has position servos, gravity and a sensor at the tip; only its kinematics comes from the robot:

    from beetle_ik.sim import MujocoPlant

    plant = MujocoPlant.from_urdf("iiwa14.urdf", noise=1e-4)
    controller = bik.BroydenBAS(max_evaluations_per_step=1)
    result = bik.track_model_free(plant, path, start, dt=plant.dt, controller=controller)

`TorquePlant` has the masses, payloads and friction of the robot, and motors that take torques:

    from beetle_ik.sim import TorquePlant

    followed = TorquePlant(robot.with_payload(3.0)).follow(plan, model=robot)
    followed.error.max()  # m: the plan does not know the payload

Modules: `servo_plant`, `torque_plant`, and `chain`, which both are made from.
"""

from .servo_plant import MujocoPlant
from .torque_plant import Followed, TorquePlant

__all__ = ["Followed", "MujocoPlant", "TorquePlant"]
