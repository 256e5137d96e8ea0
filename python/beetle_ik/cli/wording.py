"""Messages in the words of the command line: its options in place of the keywords of Python."""

import re

_OPTIONS = {
    **{f"limits=Limits({kind}=...)": f"--{kind}-limit" for kind in ("velocity", "acceleration", "jerk")},
    "limits=Limits(tip_speed=...)": "--tip-speed",
    **{f'method="{name}"': f"--method {name}" for name in ("minmax", "timed", "tpbso")},
    "np.radians converts degrees": "90deg is 90 degrees",
    "degrees=True takes degrees": "90deg is 90 degrees",
    "budget in stop=Stop(...)": "budget (--max-evaluations)",
    "breaks=True": "--breaks",
    "ease=True": "--ease",
    "free_start=True": "--free-start",
    "keep is held": "--tilt is held",
    "tilt must be": "--tilt must be",
    "the length of axis": "the length of --up",
    "margin=": "--margin",
    "give tolerance=": "give --tolerance ",
    "joint_weights": "--joint-weights",
    "obstacles= (a list, which may be empty) or self_collision=True": "--scene",
    "scene.attach_to(robot)": "a robot that carries it (Scene.attach_to in Python)",
    **{f"{kind}.without_robot(robot, q)": f"{kind}.without_robot in Python" for kind in ("PointCloud", "Grid")},
    "one of them as tip=": "one of them as --tip",
    "give the one that carries the payload as link=": "load the robot with one of them as --tip",
    'task=tasks.Pose(first="position")': "--first position",
    "robot.wrap(q) takes whole turns off and brings it inside": "whole turns taken off bring it inside",
    "robot.clip(q) moves it to the limit, which changes the pose": "moving it to the limit changes the pose",
    "; start_slack takes a start farther out": "",
    "plan.retime(limits)": "`beetle-ik plan retime`",
    "with with_capsules(radius=...) along its links or with_capsules([(link, a, b, radius), ...])": "by --link-radius",
}


def in_options(text: object) -> str:
    """Returns a message of the library with options where it names keywords that have one."""
    message = re.sub(r"(?<![-\w])(start|end)_q\b", r"--\1-q", str(text))
    for keyword, option in _OPTIONS.items():
        message = message.replace(keyword, option)
    return message
