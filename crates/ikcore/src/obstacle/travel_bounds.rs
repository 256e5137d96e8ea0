//! Bounds on the motion of bodies by the joints, for all configurations in their ranges.

use crate::kinematics::chain::Transmission;
use crate::math::Frame;
use crate::robot::Robot;

/// Bounds (m per rad, m per m) on how far each joint moves the points of a body, relative to a frame that carries it.
#[derive(Debug, Clone)]
pub(super) struct TravelBounds(Vec<f64>);

/// A ball in the frame of this number.
#[derive(Debug, Clone, Copy)]
pub(super) struct CarriedBall {
    pub frame: usize,
    pub center: [f64; 3],
    pub radius: f64,
}

/// The moving elements of a robot, and how far each slides at most (m) while its joint is in its sampling range.
pub(super) struct MovingElements {
    stages: Vec<(usize, Frame, Transmission)>,
    slides: Vec<f64>,
}

impl MovingElements {
    /// The moving elements of `robot`.
    pub fn of(robot: &Robot) -> Self {
        let stages: Vec<_> = robot.moving_elements().collect();
        let slide = |(_, _, motion): &(usize, Frame, Transmission)| {
            let (lower, upper) = robot.joints()[motion.joint].sampling_range();
            let at = |q: f64| {
                if motion.slide_scale == 0.0 {
                    motion.slide_offset
                } else {
                    motion.slide_scale * q + motion.slide_offset
                }
            };
            at(lower).abs().max(at(upper).abs())
        };
        let mut slides: Vec<f64> = stages.iter().map(slide).collect();
        for curve in robot.curves().iter() {
            let (lower, upper) = robot.joints()[stages[curve.stage].2.joint].sampling_range();
            slides[curve.stage] = curve.longest_slide(lower, upper);
        }
        Self { stages, slides }
    }

    /// The values of joint `j` for which the bounds hold: all, unless it slides.
    pub fn range(&self, robot: &Robot, j: usize) -> (f64, f64) {
        let slides = self.stages.iter().any(|(_, _, motion)| motion.joint == j && motion.slide_scale != 0.0);
        if slides { robot.joints()[j].sampling_range() } else { (f64::NEG_INFINITY, f64::INFINITY) }
    }

    /// The largest distance of the points of `ball` from the origin (m).
    pub fn reach(&self, ball: &CarriedBall) -> f64 {
        let length = |[x, y, z]: [f64; 3]| x.hypot(y).hypot(z);
        let (mut at, mut far) = (ball.frame, length(ball.center) + ball.radius);
        while at > 0 {
            let (parent, Frame { origin, .. }, _) = &self.stages[at - 1];
            far += length(*origin) + self.slides[at - 1];
            at = *parent;
        }
        far
    }

    /// Adds to `travel_bounds` how far the joints move `ball` relative to frame number `below`, which carries it.
    pub fn add(&self, ball: &CarriedBall, below: usize, levers: &mut TravelBounds) {
        let CarriedBall { frame: mut at, center: [x, y, z], radius } = *ball;
        // The largest distance of the ball's points from the axis of the element, and from its origin.
        let (mut beside, mut far) = (x.hypot(y) + radius, x.hypot(y).hypot(z) + radius);
        while at > below {
            let ((parent, Frame { origin: [x, y, z], .. }, motion), slide) =
                (&self.stages[at - 1], self.slides[at - 1]);
            let lever = if motion.is_of_vector() { far } else { beside };
            levers.0[motion.joint] += motion.turn_scale.abs() * lever + motion.slide_scale.abs();
            (beside, far) = (x.hypot(*y) + slide + far, x.hypot(*y).hypot(*z) + slide + far);
            at = *parent;
        }
    }
}

impl TravelBounds {
    /// Zero bounds of something that none of `joints` joints moves.
    pub fn none(joints: usize) -> Self {
        Self(vec![0.0; joints])
    }

    /// Largest motion (m) of a point while the joints move by up to `reach` (rad, m).
    #[inline]
    pub fn travel(&self, reach: &[f64]) -> f64 {
        self.0.iter().zip(reach).map(|(lever, reach)| lever * reach).sum()
    }

    /// Largest motion (m) while all joints move by 1 (rad, m).
    pub fn sum(&self) -> f64 {
        self.0.iter().sum()
    }
}
