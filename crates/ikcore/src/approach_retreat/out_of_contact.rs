//! The way out of a contact: from a configuration that is nearer to something than the margin to one that keeps it.

use crate::error::Result;
use crate::math::vector::largest_difference;
use crate::obstacle::{ClearSpace, Edge, MotionCertificate, NearRows, RequiredDistance};
use crate::timing::{ConstantLimits, scaled};
use crate::trajectory::Trajectory;

/// Distance beyond the margin that the way out reaches (m).
const BEYOND: f64 = 2e-3;
/// Longest step of a joint (rad, m).
const LONGEST: f64 = 0.05;
/// Shortest step of the descent (rad, m); where it would need a shorter one, it is stuck.
const SHORTEST: f64 = 1e-6;
/// Maximum number of steps of the descent.
const STEPS: usize = 400;
/// Allowed loss of distance on the way out (m), since a motion outwards must be certified too.
pub(super) const ALLOWED_LOSS: f64 = 2e-5;
/// Largest motion of a joint (rad, m) on the parts of a line that are certified one by one.
const PART: f64 = 0.01;

/// The motion out of the contact at `from` (n,): straight lines, each from rest to rest, on which no two bodies come nearer to each
/// other, by more than [`ALLOWED_LOSS`], than they are at its beginning or than the margin; `None` if none was found. The shortest way:
/// down the gradient of the distances.
pub(super) fn way_out(space: &ClearSpace<'_>, limits: &ConstantLimits, from: &[f64]) -> Result<Option<Trajectory>> {
    let Some(descent) = descent(space, limits, from) else { return Ok(None) };
    let mut near = NearRows::new(space.scene());
    near.find(space.scene(), from, space.margin());
    let kept = RequiredDistance {
        at_rest: near.rows(),
        tolerance_band: ALLOWED_LOSS,
        ..RequiredDistance::constant(space.margin())
    };
    let mut motion: Option<Trajectory> = None;
    let mut at = 0;
    // Each line goes as far along the descent as it is certified to come no nearer.
    while at + 1 < descent.len() {
        let Some(next) =
            (at + 1..descent.len()).rev().find(|next| comes_no_nearer(space, &kept, [&descent[at], &descent[*next]]))
        else {
            return Ok(None);
        };
        let rest = vec![0.0; 2 * from.len()];
        let ends = [&descent[at][..], &descent[next]].concat();
        let line = Trajectory::from_samples(limits.joint_names(), &[0.0, 1.0], &ends, Some(&rest), Some(&rest))?;
        let line = scaled(&line, limits)?;
        motion = Some(motion.map_or(Ok(line.clone()), |motion| motion.then(&line, 0.0))?);
        at = next;
    }
    Ok(motion)
}

/// Whether all bodies keep these distances on the straight line.
fn comes_no_nearer(space: &ClearSpace<'_>, kept: &RequiredDistance<'_>, [from, to]: [&[f64]; 2]) -> bool {
    let longest = largest_difference(from, to);
    let parts = (longest / PART).ceil().max(1.0) as usize;
    let mut check = MotionCertificate::new(space.scene());
    let at = |i: usize| -> Vec<f64> {
        from.iter().zip(to).map(|(from, to)| from + (to - from) * i as f64 / parts as f64).collect()
    };
    (0..parts).all(|i| check.is_clear(space.scene(), &Edge { from: &at(i), to: &at(i + 1) }, 1.0, kept))
}

/// Descends the gradient of the shortfall; the last configuration keeps the margin and a little more.
fn descent(space: &ClearSpace<'_>, limits: &ConstantLimits, from: &[f64]) -> Option<Vec<Vec<f64>>> {
    let up_to = space.margin() + BEYOND;
    let n = from.len();
    let (mut way, mut q, mut step) = (vec![from.to_vec()], from.to_vec(), LONGEST);
    let mut gradient = vec![0.0; n];
    let mut cost = space.nearness(&q, up_to, 1.0, &mut gradient);
    for _ in 0..STEPS {
        if space.holds(&q) && cost == 0.0 {
            return Some(way);
        }
        let largest = gradient.iter().fold(f64::MIN_POSITIVE, |largest, entry| largest.max(entry.abs()));
        let (next, next_cost, next_gradient) = loop {
            if step < SHORTEST {
                // Near enough: the margin is kept, though not all of the reserve beyond it.
                return space.holds(&q).then_some(way);
            }
            let mut next = q.clone();
            for j in 0..n {
                next[j] = (q[j] - step * gradient[j] / largest).clamp(limits.lower[j], limits.upper[j]);
            }
            let mut there = vec![0.0; n];
            let lower = space.nearness(&next, up_to, 1.0, &mut there);
            if lower < cost {
                break (next, lower, there);
            }
            step *= 0.5;
        };
        (q, cost, gradient) = (next, next_cost, next_gradient);
        way.push(q.clone());
        step = (2.0 * step).min(LONGEST);
    }
    space.holds(&q).then_some(way)
}
