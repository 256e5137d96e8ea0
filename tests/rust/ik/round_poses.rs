//! Poses of round configurations: zeros, right angles, joints at their limits or locked, nearly structured arms. They have a
//! solution, so they are never reported as out of reach, and `solve_all` never reports an empty set as complete.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::common::arms::{arm, calibrated_ur10};
use crate::common::{cases, pose_at, robot};
use ikcore::ik::{AllOptions, SolveOptions, solve, solve_all};
use ikcore::math::Frame;
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Target;

const ARMS: [&str; 9] = ["ur5e", "ur10", "ur3e", "kr210", "panda", "fr3", "iiwa14", "iiwa7", "gen3"];
const WIDEST: f64 = 6.3;

fn chance(rng: &mut LazyRng, fraction: f64) -> bool {
    rng.uniform_in(0.0, 1.0) < fraction
}

/// Angle of a quarter, half or whole turn, or zero; sometimes off by 1e-16 to 1e-2.
fn round_angle(rng: &mut LazyRng) -> f64 {
    let off = if chance(rng, 0.5) { 0.0 } else { 10.0_f64.powf(rng.uniform_in(-16.0, -2.0)) };
    FRAC_PI_2 * rng.uniform_in(-2.5, 2.5).round() + off
}

/// Arm with narrower limits, some of them near round angles, and some joints locked.
fn narrowed(full: &Robot, rng: &mut LazyRng) -> Robot {
    let locks = chance(rng, 0.3);
    full.with_limits(|_, joint| {
        let (lower, upper) = (joint.lower.max(-WIDEST), joint.upper.min(WIDEST));
        let centre = if chance(rng, 0.5) { round_angle(rng) } else { rng.uniform_in(lower, upper) };
        let centre = centre.clamp(lower, upper);
        let width = (upper - lower) * rng.uniform_in(0.01, 1.0);
        let below = if chance(rng, 0.2) { rng.uniform_in(0.0, 2.0).floor() } else { rng.uniform_in(0.0, 1.0) };
        (joint.lower, joint.upper) = ((centre - below * width).max(lower), (centre + (1.0 - below) * width).min(upper));
        if locks && chance(rng, 0.3) {
            (joint.lower, joint.upper) = (centre, centre);
        }
    })
    .unwrap()
}

/// Configuration of round angles, joints at limits and arbitrary others.
fn round_configuration(robot: &Robot, rng: &mut LazyRng) -> Vec<f64> {
    let joint = |joint: &ikcore::robot::Joint| match rng.uniform_in(0.0, 4.0) as usize {
        0 => round_angle(rng).clamp(joint.lower, joint.upper),
        1 => [joint.lower, joint.upper][usize::from(chance(rng, 0.5))],
        _ => rng.uniform_in(joint.lower, joint.upper),
    };
    robot.joints().iter().map(joint).collect()
}

#[track_caller]
fn assert_not_excluded(robot: &Robot, q: &[f64]) {
    let target = pose_at(robot, q);
    let solution = solve(robot, &target, &SolveOptions::default(), &mut Unattended).unwrap();
    assert_ne!(solution.status, Status::OutOfReach, "{}: {q:?}: {}", robot.name(), solution.message());
    let all = solve_all(robot, &target, &AllOptions::default(), &mut Unattended).unwrap();
    assert!(!(all.complete && all.solutions.is_empty()), "{}: {q:?}: {}", robot.name(), all.message());
}

#[test]
fn round_poses_of_arms_are_not_called_out_of_reach() {
    let mut rng = rng::stream(17, 0);
    for full in ARMS.map(robot) {
        for _ in 0..cases(24) {
            let robot = narrowed(&full, &mut rng);
            for _ in 0..8 {
                assert_not_excluded(&robot, &round_configuration(&robot, &mut rng));
            }
        }
    }
}

#[test]
fn a_pose_with_joint_2_or_6_at_zero_is_met_by_a_family() {
    let (full, mut rng) = (robot("iiwa14"), rng::stream(17, 1));
    for zero in [1, 5] {
        for _ in 0..200 {
            let robot = full
                .with_limits(|number, joint| {
                    let width = (joint.upper - joint.lower) * rng.uniform_in(0.05, 0.3);
                    let lower = match number == zero {
                        true => -width * rng.uniform_in(0.2, 0.8),
                        false => rng.uniform_in(joint.lower, joint.upper - width),
                    };
                    (joint.lower, joint.upper) = (lower, lower + width);
                })
                .unwrap();
            let inside =
                |joint: &ikcore::robot::Joint| joint.lower + (joint.upper - joint.lower) * rng.uniform_in(0.05, 0.95);
            let mut q: Vec<f64> = robot.joints().iter().map(inside).collect();
            q[zero] = 0.0;
            let solution = solve(&robot, &pose_at(&robot, &q), &SolveOptions::default(), &mut Unattended).unwrap();
            assert_eq!(solution.status, Status::Solved, "{q:?}: {}", solution.message());
        }
    }
}

#[test]
fn nearly_structured_arms_claim_nothing_of_their_own_poses() {
    let mut rng = rng::stream(17, 2);
    for off in [0.0, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2] {
        let h = FRAC_PI_2;
        let rows = [[0.0, h, 0.1625], [-0.425, 0.0, 0.0], [-0.3922, 0.0, 0.0], [0.0, h, 0.1333]];
        let skew = arm("skew wrist", [rows[0], rows[1], rows[2], rows[3], [off, -h, 0.0997], [0.0, 0.0, 0.0996]]);
        let five =
            arm("five", [[0.033, h, 0.147], [0.155, off, 0.0], [0.135, 0.0, 0.0], [0.0, h, 0.0], [0.0, 0.0, 0.2175]]);
        for full in [skew, five, calibrated_ur10(off)] {
            let robot = full.with_limits(|_, joint| (joint.lower, joint.upper) = (-WIDEST, WIDEST)).unwrap();
            for _ in 0..60 {
                let mut q = round_configuration(&robot, &mut rng);
                q[4] = if chance(&mut rng, 0.5) { rng.uniform_in(-0.02, 0.02) } else { q[4] };
                assert_not_excluded(&robot, &q);
            }
        }
    }
}

#[test]
fn a_miss_within_the_tolerances_is_solved() {
    let mut rng = rng::stream(17, 3);
    for full in ["ur5e", "kr210"].map(robot) {
        for _ in 0..300 {
            let q = round_configuration(&full, &mut rng);
            let Target::Pose(pose) = pose_at(&full, &q) else { panic!("a pose") };
            let off: [f64; 3] = std::array::from_fn(|_| rng.uniform_in(-2e-7, 2e-7));
            let origin = std::array::from_fn(|k| pose.origin[k] + off[k]);
            let target = Target::Pose(Frame { origin, ..pose });
            let solution = solve(&full, &target, &SolveOptions::default(), &mut Unattended).unwrap();
            assert_ne!(solution.status, Status::OutOfReach, "{}: {q:?}: {}", full.name(), solution.message());
        }
    }
}

#[test]
fn solutions_at_limits_a_turn_away_are_in_the_set() {
    let full = robot("ur5e");
    let mut rng = rng::stream(17, 4);
    for _ in 0..300 {
        let (first, second) = (rng.uniform_in(0.0, 6.0) as usize, rng.uniform_in(0.0, 6.0) as usize);
        let robot = full
            .with_limits(|_, joint| {
                let lower = rng.uniform_in(-2.0 * PI, PI);
                (joint.lower, joint.upper) = (lower, lower + rng.uniform_in(0.1, PI));
            })
            .unwrap();
        let mut q: Vec<f64> = robot.joints().iter().map(|joint| rng.uniform_in(joint.lower, joint.upper)).collect();
        q[first] = robot.joints()[first].upper;
        q[second] = robot.joints()[second].lower;
        let all = solve_all(&robot, &pose_at(&robot, &q), &AllOptions::default(), &mut Unattended).unwrap();
        let near = all.solutions.iter().any(|one| one.q.iter().zip(&q).all(|(a, b)| (a - b).abs() < 1e-5));
        assert!(near, "{q:?}: {}", all.message());
    }
}

/// Arms whose closed loop, opened where three axes intersect or are parallel, has other axes that coincide at the pose, or
/// nearly.
#[test]
#[allow(clippy::approx_constant, reason = "angles as they were found, 3.14 rad among them")]
fn poses_that_align_axes_of_the_loop_are_not_called_out_of_reach() {
    let (a, b) = (FRAC_PI_2, PI);
    let cases = [
        (
            arm(
                "four aligned",
                [
                    [0.1500901849722468, b, -0.17152524951743708],
                    [0.45431804996888436, b, 0.47577621369901435],
                    [0.0, -a, 0.0],
                    [0.03864475950960555, 0.8351621416523312, 0.0],
                    [0.0, -a, 0.0],
                    [0.04764608353175803, 1.5038800452359746, 0.0],
                ],
            ),
            [
                -2.188727478264407,
                -0.7836055400298116,
                -1.2876181062043575,
                a - 5.5e-10,
                a - 3.9e-11,
                -0.07816878373314795,
            ],
        ),
        (
            arm(
                "idle fifth",
                [
                    [0.0, a, -0.4229171830507149],
                    [0.02570254573995412, -1.6171343088581642, 0.46528466165225535],
                    [-0.38122364925769714, a, -0.07131809861495586],
                    [0.10769469082121064, b, -0.26096705821704635],
                    [-0.3455038226575534, b, -0.4083607074288499],
                    [0.0, a, -0.1872417885542902],
                ],
            ),
            [1.9839358977994896, -a, a, 0.0, -0.07065512357661685, 3.14],
        ),
        (
            arm(
                "nearly coincident",
                [
                    [1.4143533134314881e-05, 0.0, 0.1296235268372663],
                    [-0.46361504264893283, -a, 0.0],
                    [0.0, 1.4967038082591433, 0.2608977492231588],
                    [0.0, 3.141576498686241, 3.1821824010443564e-05],
                    [0.10579363603476943, -a, 0.0],
                    [6.279350808025231e-11, -1.5707963268546967, -0.0887307778102345],
                ],
            ),
            [-3.14, -0.6755472191514436, a, -0.6146919032096272, -3.14, 3.14],
        ),
        (
            arm(
                "almost a UR",
                [
                    [0.0, a, 0.1625],
                    [-0.425, 0.0, 0.0],
                    [-0.3922, 0.0, 0.0],
                    [0.0, a, 0.1333],
                    [1.234491456395058e-10, -a, 0.0997],
                    [0.0, 0.0, 0.0996],
                ],
            ),
            [b, -6.2316340858018835, b, -3.261187594602702, -2.036598635541712, -a],
        ),
    ];
    for (robot, q) in cases {
        assert_not_excluded(&robot, &q);
    }
}
