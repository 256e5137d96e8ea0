//! Configurations side by side give the same bits as one by one.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should say so")]

use ikcore::rng;
use ikcore::robot::Robot;

#[test]
fn tip_positions_have_the_bits_of_tip_position() {
    for name in ["iiwa14", "ur5e", "planar5", "hydraulic3"] {
        let robot = Robot::named(name).unwrap();
        // Every way in which a count splits into fours, a pair and a single one.
        for count in 0..=11 {
            let qs = robot.random_configurations(count, &mut rng::stream(3, count as u64));
            let mut side_by_side = vec![];
            robot.tip_positions(&qs, |tip| side_by_side.push(tip.map(f64::to_bits)));
            let one_by_one: Vec<_> =
                qs.chunks_exact(robot.dof()).map(|q| robot.tip_position(q).map(f64::to_bits)).collect();
            assert_eq!(side_by_side, one_by_one, "{name}, {count} configurations");
        }
    }
}
