//! Limits of the speed, acceleration and turn speed of tips, and their certificate over a motion.
//!
//! Over an interval a [`TipJet`](super::tip_jet::TipJet) bounds all three.

use std::sync::Arc;

use super::joint_span::JointSpan;
use super::largest_factor::{IntervalFactor, TIGHT, largest_factor};
use super::tip_jet::{TipElements, TipJet, why_no_jets};
use crate::error::{Error, Result};
use crate::limits::{ROUNDING, TipField, TipLimits};
use crate::math::vector3::norm;
use crate::message::{Message, message};
use crate::robot::Robot;
use crate::trajectory::{Coefficients, Trajectory};

/// Robot and limits of its tips.
#[derive(Debug, Clone)]
pub(crate) struct TipRates {
    robot: Arc<Robot>,
    tips: Vec<LimitedTip>,
    /// As given.
    limits: TipLimits,
}

/// A tip and its limits, infinite where it has none.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LimitedTip {
    pub elements: TipElements,
    name: String,
    /// By [`TipField`].
    limits: [f64; 3],
}

/// A rate beyond its limit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TipExcess {
    /// The quantity, for example "speed of tip 'tool0'".
    pub what: String,
    pub value: f64,
    pub bound: f64,
    pub unit: &'static str,
}

impl PartialEq for TipRates {
    fn eq(&self, other: &Self) -> bool {
        self.tips == other.tips
    }
}

impl TipRates {
    /// The limits of the tips of `robot`; `None` without finite ones. `method` names the call in errors.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`] where a rotation vector or a joint that follows another by a polynomial carries a tip.
    pub fn new(robot: &Robot, limits: &TipLimits, method: impl Into<Message>) -> Result<Option<Self>> {
        let mut tips = vec![];
        for (tip, name) in robot.tips().enumerate() {
            let of_tip = TipField::ALL.map(|field| limits.at(field, tip));
            let Some(first) = TipField::ALL.into_iter().find(|field| limits.at(*field, tip).is_finite()) else {
                continue;
            };
            let Some(elements) = TipElements::of(robot, tip) else {
                let remedy = message![why_no_jets(robot), "leave out ", first.setting()];
                return Err(Error::UnsupportedLimit { field: first.to_string(), method: method.into(), remedy });
            };
            tips.push(LimitedTip { elements, name: name.to_owned(), limits: of_tip });
        }
        Ok((!tips.is_empty()).then(|| Self { robot: Arc::new(robot.clone()), tips, limits: limits.clone() }))
    }

    /// Drops the limits of speeds that tips can never exceed at joint velocities and positions of these sizes, one per joint. `None` if none
    /// is left.
    pub fn without_idle(mut self, [velocity, position]: [&[f64]; 2]) -> Option<Self> {
        let mut at = JointSpan::new(&self.robot);
        at.set(&self.robot, std::iter::empty(), [0.0, 1.0]);
        for tip in &mut self.tips {
            let [speed, turn] = tip.elements.fastest(&self.robot, at.frames(), [velocity, position]);
            for (field, fastest) in [(TipField::Speed, speed), (TipField::TurnSpeed, turn)] {
                if fastest * (1.0 + TIGHT) + TIGHT < tip.limit(field) {
                    tip.limits[field as usize] = f64::INFINITY;
                }
            }
        }
        self.tips.retain(|tip| tip.limits.iter().any(|limit| limit.is_finite()));
        (!self.tips.is_empty()).then_some(self)
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The limits, as given.
    pub fn limits(&self) -> &TipLimits {
        &self.limits
    }

    /// The tips that have limits.
    pub fn tips(&self) -> &[LimitedTip] {
        &self.tips
    }

    /// Whether any tip has an acceleration limit.
    pub fn limit_acceleration(&self) -> bool {
        self.tips.iter().any(|tip| tip.limit(TipField::Acceleration).is_finite())
    }

    /// Factor by which `motion` must be slowed down to keep the limits, or a bound of it up to `enough`. A larger one is at most
    /// [`TIGHT`] too large.
    pub fn slowdown(&self, motion: &Trajectory, enough: f64) -> f64 {
        self.largest(motion, &[TipField::Speed, TipField::Acceleration, TipField::TurnSpeed], None, enough)
    }

    /// Factor by which the motion over an interval of twice `half` (s) must be slowed down to keep limits of these kinds, at most.
    pub fn factor(&self, at: &JointSpan, half: f64, fields: &[TipField]) -> f64 {
        let of_tip = |tip: &LimitedTip| {
            let jet = at.jet(&self.robot, &tip.elements);
            fields.iter().map(|field| tip.factor(&jet, half, *field)[1]).fold(0.0, f64::max)
        };
        self.tips.iter().map(of_tip).fold(0.0, f64::max)
    }

    /// Largest rate (1/s) at which speed and turn speed, as fractions of their limits, can grow for joints of these largest velocities and
    /// accelerations, in a motion of this duration (s) that begins at the middle of `at`.
    pub fn growth(&self, at: &JointSpan, rates: impl Fn(usize) -> [f64; 2], duration: f64) -> f64 {
        let of_tip = |tip: &LimitedTip| {
            let [speed, turn_speed] = tip.elements.growth(&self.robot, at.frames(), &rates, duration);
            (speed / tip.limit(TipField::Speed)).max(turn_speed / tip.limit(TipField::TurnSpeed))
        };
        self.tips.iter().map(of_tip).fold(0.0, f64::max)
    }

    /// Rates of `motion` beyond their limits.
    pub fn excesses(&self, motion: &Trajectory) -> Vec<TipExcess> {
        let enough = 1.0 + ROUNDING;
        if self.slowdown(motion, enough) <= enough {
            return vec![];
        }
        let each = (0..self.tips.len()).flat_map(|tip| TipField::ALL.map(|field| (tip, field)));
        let excess = |(tip, field): (usize, TipField)| {
            let LimitedTip { name, limits, .. } = &self.tips[tip];
            let (factor, bound) = (self.largest(motion, &[field], Some(tip), enough), limits[field as usize]);
            let value = bound * if field == TipField::Acceleration { factor * factor } else { factor };
            (factor > enough).then(|| TipExcess { what: field.of_tip(name), value, bound, unit: field.unit() })
        };
        each.filter_map(excess).collect()
    }

    /// The parts of the limits of each tip that joints on these polynomials use at `t` (s).
    pub fn shares(&self, polynomials: &[Coefficients], t: f64) -> impl Iterator<Item = (usize, TipField, f64)> {
        let mut at = JointSpan::new(&self.robot);
        at.set(&self.robot, polynomials.iter().copied(), [t, 1.0]);
        let of_tip = |(i, tip): (usize, &LimitedTip)| {
            let jet = at.jet(&self.robot, &tip.elements);
            TipField::ALL.map(|field| {
                let [slowdown, _] = tip.factor(&jet, 1.0, field);
                (i, field, if field == TipField::Acceleration { slowdown * slowdown } else { slowdown })
            })
        };
        self.tips.iter().enumerate().flat_map(of_tip).collect::<Vec<_>>().into_iter()
    }

    /// Name of a limited tip.
    pub fn name(&self, tip: usize) -> &str {
        &self.tips[tip].name
    }

    fn largest(&self, motion: &Trajectory, fields: &[TipField], only: Option<usize>, enough: f64) -> f64 {
        let of = only.map_or(&self.tips[..], |tip| &self.tips[tip..=tip]);
        let at = JointSpan::new(&self.robot);
        largest_factor(motion, enough, &mut TipFactor { robot: &self.robot, at, of, fields })
    }
}

/// The factor by which tips must be slowed down over an interval.
struct TipFactor<'a> {
    robot: &'a Robot,
    at: JointSpan,
    of: &'a [LimitedTip],
    fields: &'a [TipField],
}

impl IntervalFactor for TipFactor<'_> {
    const ACCURACY: f64 = TIGHT;

    fn over(&mut self, polynomials: &[Coefficients], [middle, half]: [f64; 2]) -> [f64; 2] {
        self.at.set(self.robot, polynomials.iter().copied(), [middle, half]);
        let [mut seen, mut bound] = [0.0_f64; 2];
        for tip in self.of {
            let jet = self.at.jet(self.robot, &tip.elements);
            for field in self.fields {
                let [in_middle, at_most] = tip.factor(&jet, half, *field);
                (seen, bound) = (seen.max(in_middle), bound.max(at_most));
            }
        }
        [seen, bound]
    }
}

impl LimitedTip {
    /// The limit of one kind.
    pub fn limit(&self, field: TipField) -> f64 {
        self.limits[field as usize]
    }

    /// Factor by which the motion of `jet`, over an interval of twice `half` (s), must be slowed down in its middle, and a bound of it.
    fn factor(&self, jet: &TipJet, half: f64, field: TipField) -> [f64; 2] {
        let limit = self.limit(field);
        if limit == f64::INFINITY {
            return [0.0; 2];
        }
        match field {
            TipField::Speed => [norm(&jet.velocity.middle()), jet.velocity.bound()].map(|rate| rate / half / limit),
            TipField::TurnSpeed => [norm(&jet.turn.middle()), jet.turn.bound()].map(|rate| rate / half / limit),
            TipField::Acceleration => {
                let change = jet.velocity.derivative();
                [norm(&change.middle()), change.bound()].map(|rate| (rate / limit).sqrt() / half)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::math::Columns;
    use crate::rng::{self, LazyRng};

    const SLIDING: &str = r#"<robot name="sliding"><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
        <joint name="turn" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0.1 0.2 0.3" rpy="0.3 0 0.2"/><axis xyz="0.6 0 0.8"/></joint>
        <joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="0.4 0 0.1" rpy="0 0.5 0"/><axis xyz="0 1 0"/>
            <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
        <joint name="follow" type="revolute"><parent link="c"/><child link="d"/><origin xyz="0 0.3 0.1"/><axis xyz="1 0 0"/><mimic joint="turn" multiplier="-2"/>
            <limit lower="-9" upper="9" velocity="9" effort="1"/></joint>
        <joint name="last" type="prismatic"><parent link="d"/><child link="e"/><origin xyz="0.2 0 0.5" rpy="0.1 0.2 0.3"/><axis xyz="0 0 1"/>
            <limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"#;

    fn robots() -> [Robot; 2] {
        [Robot::named("panda").unwrap(), Robot::from_urdf(SLIDING, None, None).unwrap()]
    }

    fn limited(robot: &Robot, [speed, acceleration, turn]: [f64; 3]) -> TipRates {
        let mut limits = TipLimits::default();
        for (field, limit) in TipField::ALL.into_iter().zip([speed, acceleration, turn]) {
            limits.replace(field, vec![limit]).unwrap();
        }
        TipRates::new(robot, &limits, "this test").unwrap().unwrap()
    }

    /// A motion of two segments with random polynomials, with velocities up to `scale` at its knots.
    fn motion(robot: &Robot, scale: f64, rng: &mut LazyRng) -> Trajectory {
        let n = robot.dof();
        let mut draw = |size: f64| -> Vec<f64> { (0..3 * n).map(|_| rng.uniform_in(-size, size)).collect() };
        let (q, qd, qdd) = (draw(1.0), draw(scale), draw(3.0 * scale));
        let names = robot.joints().iter().map(|joint| joint.name.clone()).collect();
        Trajectory::from_samples(names, &[0.0, 0.7, 2.0], &q, Some(&qd), Some(&qdd)).unwrap()
    }

    /// Velocity of the tip (m/s) and its turn rate (rad/s) by the Jacobian.
    fn rates(robot: &Robot, motion: &Trajectory, t: f64) -> [Vector3<f64>; 2] {
        let n = robot.dof();
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; n]);
        motion.at(t, &mut q, &mut qd, &mut qdd).unwrap();
        let mut columns = Columns::default();
        robot.tip_and_jacobian_of(0, &q, &mut columns);
        [0, 3].map(|first| {
            Vector3::from_fn(|axis, _| columns.iter().zip(&qd).map(|(column, qd)| column[first + axis] * qd).sum())
        })
    }

    #[test]
    fn slowdown_bounds_the_rates_at_samples_and_is_tight() {
        let mut rng = rng::stream(3, 0);
        for robot in robots() {
            for round in 0..12 {
                let motion = motion(&robot, [0.0, 0.5, 2.0][round % 3], &mut rng);
                for (field, order) in [(0, 1), (1, 2), (2, 1)] {
                    let mut limits = [f64::INFINITY; 3];
                    limits[field] = 0.3;
                    let factor = limited(&robot, limits).slowdown(&motion, 0.0).powi(order);
                    let step = 1e-5;
                    let sample = |i: usize| {
                        let t = motion.duration() * (i as f64 + 0.5) / 2000.0;
                        let [velocity, turn] = rates(&robot, &motion, t);
                        let later = rates(&robot, &motion, t + step)[0];
                        let earlier = rates(&robot, &motion, t - step)[0];
                        [velocity.norm(), (later - earlier).norm() / (2.0 * step), turn.norm()][field] / 0.3
                    };
                    let largest = (0..2000).map(sample).fold(0.0, f64::max);
                    assert!(largest <= factor * (1.0 + 1e-6), "{largest} {factor} {field}");
                    assert!(factor <= largest * 1.01 + 1e-6, "{largest} {factor} {field}");
                }
            }
        }
    }

    #[test]
    fn a_circle_at_constant_speed_is_known_exactly() {
        let robot = Robot::planar(&[0.5]).unwrap();
        let names = vec![robot.joints()[0].name.clone()];
        let motion = Trajectory::from_samples(names, &[0.0, 10.0], &[0.0, 20.0], None, None).unwrap();
        let factor = limited(&robot, [1.0, f64::INFINITY, f64::INFINITY]).slowdown(&motion, 0.0);
        assert!((factor - 1.0).abs() < 2e-6, "{factor}");
        let factor = limited(&robot, [f64::INFINITY, 2.0, f64::INFINITY]).slowdown(&motion, 0.0);
        assert!((factor - 1.0).abs() < 2e-6, "{factor}");
    }

    #[test]
    fn limits_that_joints_cannot_exceed_are_idle() {
        let robot = Robot::planar(&[0.5, 0.5]).unwrap();
        let idle =
            |limit: f64| limited(&robot, [limit, f64::INFINITY, f64::INFINITY]).without_idle([&[1.0; 2], &[4.0; 2]]);
        assert!(idle(1.51).is_none() && idle(1.49).is_some());
    }

    #[test]
    fn an_excess_names_the_tip_and_its_rate() {
        let robot = Robot::planar(&[0.5]).unwrap();
        let names = vec![robot.joints()[0].name.clone()];
        let motion = Trajectory::from_samples(names, &[0.0, 10.0], &[0.0, 20.0], None, None).unwrap();
        let found = limited(&robot, [0.5, f64::INFINITY, 2.5]).excesses(&motion);
        assert_eq!(found.len(), 1);
        let tip = robot.tips().next().unwrap();
        assert_eq!(
            (found[0].what.as_str(), found[0].unit, found[0].bound),
            (&*format!("speed of tip '{tip}'"), "m/s", 0.5)
        );
        assert!((found[0].value - 1.0).abs() < 2e-6, "{found:?}");
    }
}
