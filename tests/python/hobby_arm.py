"""A hobby arm of five joints and a gripper, with the measures of those that LeRobot drives, as a URDF."""


def _joint(name: str, links: str, xyz: str, axis: str, limits: str) -> str:
    parent, child = links.split()
    lower, upper = limits.split()
    return (
        f"<link name='{child}'/><joint name='{name}' type='revolute'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='{xyz}'/><axis xyz='{axis}'/><limit lower='{lower}' upper='{upper}' velocity='10' effort='10'/>"
        "</joint>"
    )


HOBBY_ARM = (
    "<robot name='hobby'><link name='base'/>"
    + _joint("shoulder_pan", "base shoulder", "0.039 0 0.062", "0 0 1", "-1.92 1.92")
    + _joint("shoulder_lift", "shoulder upper", "0.030 0 0.054", "0 1 0", "-1.75 1.75")
    + _joint("elbow_flex", "upper fore", "0.028 0 0.113", "0 1 0", "-1.69 1.69")
    + _joint("wrist_flex", "fore wrist", "0.135 0 0.005", "0 1 0", "-1.66 1.66")
    + _joint("wrist_roll", "wrist hand", "0.061 0 0", "1 0 0", "-2.74 2.84")
    + _joint("gripper", "hand jaw", "0.02 0.02 0", "0 0 1", "-0.17 1.75")
    + "<link name='gripper_frame_link'/><joint name='tip' type='fixed'><parent link='hand'/>"
    "<child link='gripper_frame_link'/><origin xyz='0.098 0 0'/></joint></robot>"
)
MOTORS = ["shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll", "gripper"]
