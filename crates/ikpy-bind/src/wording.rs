//! Messages of the core in the words of Python: the settings that they name are spelt as keywords and calls.

use ikcore::message::{Message, Setting};

/// Returns a message in the words of Python.
pub fn said(message: &Message) -> String {
    message.worded(spelt)
}

/// Returns the spelling of a setting in Python.
pub fn spelt(setting: &Setting) -> String {
    let words = match setting {
        Setting::Limit(kind) => return format!("limits=Limits({}=...)", kind.replace(' ', "_")),
        Setting::Method(name) => return format!("method=\"{name}\""),
        Setting::Tolerance(value) => return format!("tolerance={value}"),
        Setting::First(part) => return format!("task=tasks.Pose(first=\"{part}\")"),
        Setting::Prefer(which) => return format!("prefer=\"{which}\""),
        Setting::WithoutRobot(kind) => return format!("{kind}.without_robot(robot, q)"),
        Setting::Budget => "budget in stop=Stop(...)",
        Setting::EnoughValue => "Stop(value_below=...)",
        Setting::MethodWithSolver => "method=TPBSO(solver=...)",
        Setting::Tip => "tip=",
        Setting::CarryingLink => "link=",
        Setting::OneTask => "task= for all tips",
        Setting::TaskOfEachTip => "task= of several tips is a dict, such as {tip: tasks.Position()}",
        Setting::JointWeights => "joint_weights",
        Setting::AllTurns => "turns=True",
        Setting::RaiseInvalid => "use on_invalid=\"raise\"",
        Setting::Session => "Tracker",
        Setting::Clock => "tracker.time",
        Setting::Ease => "ease=True",
        Setting::Recover => "recover=True",
        Setting::FreeStart => "free_start=True",
        Setting::StartVelocity => "start_qd",
        Setting::StartConfiguration => "start_q",
        Setting::IgnoreExtra => "ignore_extra=True",
        Setting::Breaks => "breaks=True, which lets the tool leave the path there and go on",
        Setting::StartSlack => "start_slack",
        Setting::Wrap => "robot.wrap(q) takes whole turns off and brings it inside",
        Setting::Clip => "robot.clip(q) moves it to the limit, which changes the pose",
        Setting::Retime => "plan.retime(limits)",
        Setting::Margin => "margin=",
        Setting::Surroundings => "obstacles= (a list, which may be empty) or self_collision=True",
        Setting::Region => "region=(corner, corner)",
        Setting::MapTask { pointing: true } => "task=tasks.Pointing() or tasks.Position()",
        Setting::MapTask { pointing: false } => "task=tasks.Position()",
        Setting::Primitives => "collision=\"primitives\"",
        Setting::Fitted => "collision=\"fit\"",
        Setting::GiveCapsules => {
            "give it capsules with with_capsules(radius=...) along its links or with_capsules([(link, a, b, radius), ...])"
        }
        Setting::CapsulesAlone => "robot.with_capsules(robot.capsules)",
        Setting::MoreCapsules => "robot.with_capsules(robot.capsules + [(link, a, b, radius), ...])",
        Setting::Attach => "scene.attach_to(robot)",
        Setting::CapsulesAlongLinks => "with_capsules(radius=...)",
        Setting::Inertias => "them by robot.with_inertias({link: Inertia(link, mass, center, matrix)})",
        Setting::RadiansFromDegrees => "np.radians converts degrees",
        Setting::AnglesInDegrees => "degrees=True takes degrees",
        _ => return setting.to_string(),
    };
    words.into()
}
