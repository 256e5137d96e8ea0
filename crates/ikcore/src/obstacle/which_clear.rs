//! Clear ones of many configurations. Most are found clear in single precision, eight in the registers; the others are tested one by
//! one.

use super::eight_scene::{EightScene, Near, Visitor};
use super::scene::Scene;
use crate::bodies::BodyPair;
use crate::error::{Error, Result};
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::f32x8::F32x8;

/// All eight lanes.
const ALL: u32 = 0xff;

impl Scene<'_> {
    /// [`is_clear`](Self::is_clear) at each of the configurations stored one after another, eight at a time.
    ///
    /// # Errors
    /// As [`nearest`](Self::nearest), or [`Error::OutOfRange`] for a negative margin.
    pub fn which_are_clear(&self, qs: &[f64], margin: f64) -> Result<Vec<bool>> {
        if !(margin >= 0.0 && margin.is_finite()) {
            return Err(Error::out_of_range("margin", "zero or more and finite", margin));
        }
        let n = self.robot().dof();
        qs.chunks(n).try_for_each(|q| self.robot().check("joint angles", q))?;
        if !self.fixed_are_clear(margin) {
            return Ok(vec![false; qs.len() / n]);
        }
        if self.others.obstacles.index().is_some() {
            return Ok(qs.chunks(n).map(|q| self.is_clear(q, margin)).collect());
        }
        let mut eight = EightScene::new(self);
        let mut clear = Vec::with_capacity(qs.len() / n);
        for some in qs.chunks(8 * n) {
            let near = near_lanes(&mut eight, some, margin);
            let is_clear = |(lane, q): (usize, &[f64])| near & (1 << lane) == 0 || self.is_clear(q, margin);
            clear.extend(some.chunks(n).enumerate().map(is_clear));
        }
        Ok(clear)
    }
}

/// The configurations in which something may be too near, one bit each.
struct NearLanes(u32);

impl Visitor for NearLanes {
    #[inline(always)]
    fn goes_on<A: Arithmetic>(&mut self, _: &mut Near<'_, '_>, _: BodyPair, lanes: u32) -> bool {
        self.0 |= lanes;
        self.0 != ALL
    }
}

by_instructions! {
    fn near_lanes(eight: &mut EightScene<'_>, qs: &[f64], margin: f64) -> u32 {
        let n = eight.scene.robot().dof();
        let last = qs.len() / n - 1;
        // Lanes without a configuration repeat the last one.
        eight.pose_at::<A>(|joint| F32x8(std::array::from_fn(|lane| qs[lane.min(last) * n + joint] as f32)));
        let enough = margin + eight.rounding(qs.iter().fold(0.0, |most, q| q.abs().max(most)));
        let mut near = NearLanes(0);
        eight.each_near::<A>(enough, &[], &mut near);
        near.0
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::math::Pose;
    use crate::rng;
    use crate::robot::Robot;
    use crate::shape::Shape;

    #[test]
    fn what_is_seen_to_be_clear_is_so_wherever_the_robot_stands() {
        let mut rng = rng::stream(1, 0);
        let panda = Robot::named("panda").unwrap().with_capsules_along_links(0.07).unwrap();
        let (mut clear, mut near) = (0, 0);
        for case in 0..240 {
            let far = [0.0, 10.0_f64.powf(rng.uniform_in(0.0, 12.0))][case % 2];
            let place = Vector3::from_fn(|_, _| far * rng.uniform_in(-1.0, 1.0));
            let robot = panda.with_base(Pose::translation(place.x, place.y, place.z)).unwrap();
            let size = 10.0_f64.powf(rng.uniform_in(-12.0, 12.0));
            let beside: [f64; 3] = (place + Vector3::new(0.5 + size, 0.3, 0.4)).into();
            let obstacles = match case % 6 {
                0 | 1 => vec![],
                2 | 3 => vec![Shape::sphere(beside, size).unwrap()],
                _ => vec![Shape::half_space([0.0, 0.0, 1.0], place.z - 0.1).unwrap()],
            };
            let scene = Scene::new(&robot, &obstacles).unwrap();
            let qs = robot.random_configurations(40, &mut rng).unwrap();
            let margin = rng.uniform_in(0.0, 0.02);
            let found = scene.which_are_clear(&qs, margin).unwrap();
            for (q, found) in qs.chunks(robot.dof()).zip(found) {
                assert!(!found || scene.clearance(q).unwrap() >= margin - 1e-9 - 1e-11 * far, "{far:e} {size:e}");
                *(if found { &mut clear } else { &mut near }) += 1;
            }
        }
        assert!(clear > 1000 && near > 1000, "{clear} {near}");
    }
}
