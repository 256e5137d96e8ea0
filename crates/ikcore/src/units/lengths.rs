//! Lengths that look like millimetres.

use nalgebra::Vector3;

use super::doubt::UnitDoubt;
use crate::kinematics::Reach;
use crate::math::vector3::{norm, sub};
use crate::robot::{BodySource, Robot};
use crate::shape::{BoundingBall, Shape};
use crate::wording::number;

/// Distance out of reach that looks like millimetres (m), and as a multiple of the reach.
const FAR: f64 = 30.0;

/// Distance (m) beyond which a number is nobody's millimetres.
const FARTHEST: f64 = 1e6;

/// Multiple of the reach within which a position lies if it is in millimetres.
const AS_MILLIMETRES: f64 = 3.0;

/// Radius of an obstacle (m) that may hold a robot: a floor, or a wall.
const WIDE: f64 = 50.0;

/// Radius of a body that looks like millimetres (m), and as a multiple of the reach.
const LARGE_BODY: [f64; 2] = [10.0, 20.0];

/// Reach of links (m) that looks like millimetres.
const LONG_LINKS: f64 = 300.0;

/// Doubts the position of a target of one tip, or of the second of two `tips` in the frame of the first (m). `what` names it.
/// The usual path is one comparison per coordinate.
pub fn of_position(robot: &Robot, what: &str, tips: &[usize], position: &[f64; 3]) -> Option<UnitDoubt> {
    // Nearer ones are plausible for any arm.
    if !position.iter().any(|x| x.abs() > FAR) || tips.len() > 2 {
        return None;
    }
    far_position(what, &ReachBall::of(robot, tips), position)
}

/// Doubts the position of a target of the centre of mass (m). `what` names it.
pub fn of_center_of_mass(robot: &Robot, what: &str, position: &[f64; 3]) -> Option<UnitDoubt> {
    if position.iter().any(|x| x.abs() > FAR) { far_position(what, &ReachBall::of_all(robot), position) } else { None }
}

#[cold]
fn far_position(what: &str, ball: &ReachBall, position: &[f64; 3]) -> Option<UnitDoubt> {
    let largest = (0..3).max_by(|i, j| position[*i].abs().total_cmp(&position[*j].abs()))?;
    let thing = || format!("{what}: {}", ["x", "y", "z"][largest]);
    let doubted = ball.is_far(ball.distance(position)) && ball.holds_as_millimetres(position, 0.0);
    doubted.then(|| UnitDoubt::millimetres(thing(), position[largest], ball.in_words()))
}

/// Doubts the `offset` of a tool or a payload, the argument `what`, from a link of a robot (m).
pub fn of_offset(robot: &Robot, what: &str, offset: &[f64; 3]) -> Option<UnitDoubt> {
    let ball = ReachBall { center: [0.0; 3], ..ReachBall::of(robot, &[0]) };
    far_position(what, &ball, offset)
}

/// Doubts obstacles: all of them that are no floor or wall are far away, and one is within reach as millimetres.
pub fn of_obstacles<'a>(robot: &Robot, obstacles: impl IntoIterator<Item = &'a Shape>) -> Option<UnitDoubt> {
    let ball = ReachBall::of_all(robot);
    let mut found = None;
    for (number, shape) in obstacles.into_iter().enumerate() {
        let BoundingBall { center, radius } = shape.bounding_ball();
        let from_ball = ball.distance(&center) - radius;
        if !ball.is_far(from_ball) && radius <= WIDE {
            return None;
        }
        if found.is_none() && radius.is_finite() {
            let distance = if ball.is_far(from_ball) { from_ball } else { ball.distance_of(shape) };
            if ball.is_far(distance) && distance < FARTHEST && ball.holds_as_millimetres(&center, radius) {
                found = Some((number, shape.name(), distance + ball.radius));
            }
        }
    }
    found.map(|(number, kind, distance)| {
        UnitDoubt::millimetres(format!("distance of obstacle {number} ({kind})"), distance, ball.in_words())
    })
}

/// Doubts the size of links and bodies of a robot.
pub fn of_sizes(robot: &Robot) -> Option<UnitDoubt> {
    let links = ReachBall::of_links(robot);
    if links.radius > LONG_LINKS && links.radius < 1e3 * LONG_LINKS {
        let thing = format!("reach of robot '{}'", robot.name());
        return Some(UnitDoubt::millimetres(thing, links.radius, "the sum of its links".into()));
    }
    let ball = ReachBall::of_all(robot);
    let base = robot.link_names().next().unwrap_or_default();
    let large = robot.bodies().iter().filter(|body| body.link != base).find_map(|body| {
        let radius = body.shape.bounding_ball().radius;
        (radius > LARGE_BODY[0].max(LARGE_BODY[1] * ball.radius) && radius < FARTHEST).then_some((body, radius))
    })?;
    let (body, radius) = large;
    let thing = format!("radius of a body of link '{}' ({})", body.link, body.source);
    let doubt = UnitDoubt::millimetres(thing, radius, ball.in_words());
    match body.source {
        BodySource::Mesh(_) => Some(UnitDoubt { remedy: "a mesh in millimetres has the scale 0.001".into(), ..doubt }),
        _ => Some(doubt),
    }
}

/// Returns the reach of the stretched links, without slides (m).
pub(super) fn reach_of_links(robot: &Robot) -> f64 {
    ReachBall::of_links(robot).radius
}

/// Ball that an arm reaches.
struct ReachBall {
    center: [f64; 3],
    radius: f64,
}

impl ReachBall {
    fn of(robot: &Robot, tips: &[usize]) -> Self {
        let [lower, upper]: [Vec<f64>; 2] =
            [robot.joints().iter().map(|j| j.lower).collect(), robot.joints().iter().map(|j| j.upper).collect()];
        let reach = |tip: &usize| robot.reach_of(*tip, &lower, &upper);
        match tips {
            [tip] => reach(tip).into(),
            _ => {
                let reaches: Vec<Reach> = tips.iter().map(reach).collect();
                let apart = norm(&sub(&reaches[0].center, &reaches[reaches.len() - 1].center));
                Self { center: [0.0; 3], radius: apart + reaches.iter().map(|reach| reach.radius).sum::<f64>() }
            }
        }
    }

    /// Ball about the first tip's that holds those of all tips.
    fn of_all(robot: &Robot) -> Self {
        let mut all = Self::of(robot, &[0]);
        for tip in 1..robot.tip_count() {
            let next = Self::of(robot, &[tip]);
            all.radius = all.radius.max(norm(&sub(&next.center, &all.center)) + next.radius);
        }
        all
    }

    /// Ball of the stretched links, without slides.
    fn of_links(robot: &Robot) -> Self {
        let still = vec![0.0; robot.dof()];
        robot.reach_of(0, &still, &still).into()
    }

    /// Distance of a point from the ball (m); negative inside.
    fn distance(&self, point: &[f64; 3]) -> f64 {
        norm(&sub(point, &self.center)) - self.radius
    }

    /// Lower bound on the distance of a shape from the ball (m), exact up to the distance that is far.
    fn distance_of(&self, shape: &Shape) -> f64 {
        let center = Vector3::from(self.center);
        shape.distance_to_segment(&[center, center], self.radius + 2.0 * FAR * self.radius.max(1.0)) - self.radius
    }

    /// Whether a distance (m) is implausible for this reach.
    fn is_far(&self, distance: f64) -> bool {
        distance > FAR * self.radius.max(1.0)
    }

    /// Whether a position with a ball of this `radius` about it (mm) is near.
    fn holds_as_millimetres(&self, position: &[f64; 3], radius: f64) -> bool {
        let metres = position.map(|x| 1e-3 * x);
        norm(&sub(&metres, &self.center)) <= AS_MILLIMETRES * self.radius + 1e-3 * radius
    }

    fn in_words(&self) -> String {
        format!("the arm reaches {} m", number(self.radius))
    }
}

impl From<Reach> for ReachBall {
    fn from(Reach { center, radius, .. }: Reach) -> Self {
        Self { center, radius }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::pose;

    fn panda() -> Robot {
        Robot::named("panda").unwrap()
    }

    #[test]
    fn targets_in_millimetres_are_doubted_those_out_of_reach_not() {
        let robot = panda();
        let doubt = of_position(&robot, "target", &[0], &[412.0, -80.0, 300.0]).unwrap();
        assert_eq!((doubt.thing.as_str(), doubt.value), ("target: x", 412.0));
        for honest in [[4.0, 0.0, 0.5], [28.0, 0.0, 0.0], [1e6, 0.0, 0.0], [f64::NAN; 3], [0.4, 0.1, 0.3]] {
            assert_eq!(of_position(&robot, "target", &[0], &honest), None, "{honest:?}");
        }
        // A robot that stands far from the origin.
        let placed = robot.with_base(pose::translation(500.0, 0.0, 0.0)).unwrap();
        assert_eq!(of_position(&placed, "target", &[0], &[500.4, 0.0, 0.3]), None);
    }

    #[test]
    fn obstacles_in_millimetres_are_doubted() {
        let robot = panda();
        let table = Shape::cuboid([500.0, 0.0, 200.0], [600.0, 400.0, 20.0], None).unwrap();
        let ball = Shape::sphere([400.0, 0.0, 300.0], 50.0).unwrap();
        let floor = Shape::half_space([0.0, 0.0, 1.0], 0.0).unwrap();
        let cloud = Shape::point_cloud(vec![[500.0, 0.0, 100.0], [480.0, 30.0, 110.0]], 5.0).unwrap();
        for scene in [vec![&table], vec![&floor, &ball], vec![&cloud], vec![&table, &ball]] {
            assert!(of_obstacles(&robot, scene.clone()).is_some(), "{scene:?}");
        }
    }

    #[test]
    fn scenes_of_a_site_are_not_doubted() {
        let robot = panda();
        let floor = Shape::cuboid([0.0, 0.0, -0.1], [100.0, 100.0, 0.2], None).unwrap();
        let space = Shape::half_space([0.0, 0.0, 1.0], -800.0).unwrap();
        let table = Shape::cuboid([0.5, 0.0, 0.2], [0.6, 0.4, 0.02], None).unwrap();
        let tower = Shape::cuboid([200.0, 0.0, 20.0], [20.0, 20.0, 40.0], None).unwrap();
        let wall = Shape::cuboid([25.0, 0.0, 0.0], [1.0, 100.0, 10.0], None).unwrap();
        for scene in [vec![&floor], vec![&space], vec![&table, &tower], vec![&tower, &table], vec![&wall], vec![]] {
            assert_eq!(of_obstacles(&robot, scene.clone()), None, "{scene:?}");
        }
    }

    #[test]
    fn bodies_and_links_in_millimetres_are_doubted() {
        let robot = panda();
        assert_eq!(of_sizes(&robot.with_capsules_along_links(0.06).unwrap()), None);
        assert!(of_sizes(&robot.with_capsules_along_links(60.0).unwrap()).is_some());
        assert!(of_sizes(&Robot::planar(&[425.0, 392.0]).unwrap()).is_some());
        assert_eq!(of_sizes(&Robot::planar(&[10.0; 12]).unwrap()), None);
        assert!(of_offset(&robot, "tool", &[0.0, 0.0, 103.0]).is_some());
        assert_eq!(of_offset(&robot, "tool", &[0.0, 0.0, 20.0]), None);
    }
}
