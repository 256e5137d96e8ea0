//! Masses and torques.

use ikcore::dynamics::Inertia;
use ikcore::robot::Motions;

use super::*;

fn motions<'a>(q: &'a [f64], qd: Option<&'a [f64]>) -> Motions<'a> {
    Motions { q, qd, qdd: None, wrenches: None }
}

pub fn masses_and_torques() -> Vec<Row> {
    let (panda, bare) = (robot("panda"), robot("ur5e"));
    let point = |mass: f64| Inertia::point(mass, [0.0; 3]);
    let massless = Robot::planar(&[0.5, 0.4]).unwrap();
    let on_axis = massless.with_inertias([("link_2", Inertia::point(1.0, [0.0; 3]))]).unwrap();
    let strong = Limits::of(&on_axis)
        .replace(Field::Velocity, vec![Profile::Constant(1.0)])
        .and_then(|limits| limits.replace(Field::Acceleration, vec![Profile::Constant(1.0)]))
        .and_then(|limits| limits.with_torque_limit(vec![1.0]))
        .unwrap();
    let options = TrackOptions { limits: Some(strong), ..TrackOptions::default() };
    let mut tracked = Session::new(&on_axis, &[0.0; 2], 0.1, &options).unwrap();
    promises! {
        "Session::set_robot" Contradiction: tracked.set_robot(&bare), "robot 'ur5e' differs from robot 'planar2' in more than masses, payloads and gravity, which alone may change while it is tracked: begin anew with the other robot";
        "Session::set_robot" NoDynamics: tracked.set_robot(&massless), "robot 'planar2' has no dynamics: no link has a mass: give its links inertias";
        "Robot::dynamics" NoDynamics: bare.dynamics().map(|_| ()), "robot 'ur5e' has no dynamics: no link has a mass: give its links inertias";
        "Robot::with_inertias" UnknownLink: panda.with_inertias([("hnd", point(1.0))]), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange";
        "Robot::with_inertias" ImpossibleInertia: panda.with_inertias([("flange", point(-1.0))]), "inertia of link 'flange': the mass is -1 kg: it cannot be negative";
        "Robot::with_payload" UnknownLink: panda.with_payload(Some("hnd"), point(1.0)), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange";
        "Robot::with_payload" ImpossibleInertia: panda.with_payload(None, point(-1.0)), "payload: the mass is -1 kg: it cannot be negative";
        "Robot::with_payload" SeveralTips: arms().with_payload(None, point(1.0)), "with_payload takes robots with one tip; this one has left_tool and right_tool: give the one that carries the payload as the link";
        "Robot::with_gravity" NotFinite: panda.with_gravity([0.0, 0.0, NAN]), "gravity must be finite, but entry 2 is NaN";
        "Inertia::require_possible" ImpossibleInertia: point(NAN).require_possible("hand"), "hand: mass, centre and inertia matrix must be finite, got NaN";
        "Robot::torques_all" NoDynamics: bare.torques_all(&motions(&[0.0; 6], None)), "robot 'ur5e' has no dynamics: no link has a mass: give its links inertias";
        "Robot::torques_all" OutOfRange: panda.torques_all(&motions(&[0.0; 7], Some(&[1e160; 7]))), "torque of joint 'panda_joint1' of robot 'panda' must be a number that floats can hold: what causes it is too large, got NaN";
        "Robot::torques_all" WrongLength: panda.torques_all(&motions(&[0.0; 7], Some(&[0.0; 14]))), "joint velocities of robot 'panda': expected 1 rows, as many as there are joint angles, got 2";
        "Robot::torques_all" NotFinite: panda.torques_all(&motions(&[0.0; 7], Some(&[NAN; 7]))), "joint velocities must be finite, but joint 'panda_joint1' of configuration 0 is NaN";
        "Subject::center_of_mass" NoDynamics: Subject::center_of_mass(&arms()), "robot 'pair' has no dynamics: no link has a mass: give its links inertias";
        "Subject::center_of_mass" Contradiction: Subject::center_of_mass(&panda), "the centre of mass is a task beside those of several tips; robot 'panda' has one";
        "Robot::accelerations_all" SingularMassMatrix: on_axis.accelerations_all(&[0.0, 1.0], &[0.0; 2], &[1.0; 2]), "configuration 0: the mass matrix of robot 'planar2' is singular: joint 'joint_2' and those before it can move without moving mass";
    }
}
