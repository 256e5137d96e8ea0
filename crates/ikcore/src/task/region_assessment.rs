//! Assessment of a tip in a region.
//!
//! The search aims at the point of the region that is nearest to the target, a margin inside the faces, so that a
//! search that ends within its tolerance ends inside the region. For a coordinate that the task leaves free, the
//! residual is its distance from the region, which is zero inside. Where tolerances along the axes of the target reach into
//! the region although that point is beyond them, it aims at the nearest point within both; a search for what lies beyond the
//! tolerances aims at the point within both that is nearest to the tip.

use super::assessment::Assessment;
use super::criterion::Criterion;
use super::region::{Outside, Region};
use super::target::Target;
use crate::math::vector::dot;
use crate::math::{Frame, MAX_DOF};
use crate::objective::TaskBlock;

impl Criterion {
    /// Describes the faces that keep the tip from `target`, if every point of the region is beyond the tolerance.
    pub(crate) fn blocked_by_region(&self, target: &Target) -> Option<String> {
        let (region, wanted) = (self.region.as_ref()?, target.position()?);
        if self.position_within_both(region, target).is_some() {
            return None;
        }
        let axes = target.frame().map_or(Frame::IDENTITY.axes, |frame| frame.axes);
        let nearest = Frame { axes, origin: region.nearest(&wanted, 0.0) };
        let error = target.assess_tip_anywhere(&nearest, self);
        (!error.score.solved).then(|| format!("its region keeps {}", region.violated_faces(&wanted)))
    }
}

/// What a search in a region lowers.
struct RegionLead {
    /// Target that the residual is relative to.
    aim: Target,
    /// Criterion of the residual.
    criterion: Criterion,
    /// Whether positions in the region are within the tolerances of the target, other than the one nearest to it.
    is_within_both: bool,
}

impl Target {
    /// Assesses `tip`, which must be in `region`.
    pub(super) fn assess_tip_within(&self, region: &Region, tip: &Frame, criterion: &Criterion) -> Assessment {
        let excess = free_excess(region, &tip.origin, criterion, self);
        let lead = self.lead(region, tip, criterion);
        let led = lead.aim.assess_tip_anywhere(tip, &lead.criterion);
        self.assess_led(region, tip, criterion, &lead, led.score.value + dot(&excess, &excess))
    }

    /// Assesses like [`assess_tip_within`](Self::assess_tip_within), and writes residual and Jacobian.
    pub(super) fn linearize_tip_within(
        &self,
        region: &Region,
        tip: &Frame,
        dof: usize,
        criterion: &Criterion,
        out: &mut TaskBlock,
    ) -> Assessment {
        let mut linear = [[0.0; 3]; MAX_DOF];
        for (linear, [x, y, z, ..]) in linear.iter_mut().zip(&out.columns[..dof]) {
            *linear = [*x, *y, *z];
        }
        let lead = self.lead(region, tip, criterion);
        let led = lead.aim.linearize_tip_anywhere(tip, dof, &lead.criterion, out);
        let excess = free_excess(region, &tip.origin, criterion, self);
        for k in (0..3).filter(|k| excess[*k] != 0.0) {
            out.residual[k] = excess[k];
            out.columns[..dof].iter_mut().zip(&linear).for_each(|(column, linear)| column[k] = linear[k]);
        }
        self.assess_led(region, tip, criterion, &lead, led.score.value + dot(&excess, &excess))
    }

    /// What leads `tip` into the region.
    fn lead(&self, region: &Region, tip: &Frame, criterion: &Criterion) -> RegionLead {
        let both = criterion.position_within_both(region, self);
        let near_tip = if criterion.beyond { criterion.nearest_within_both(region, self, &tip.origin) } else { None };
        let aim = criterion.aim_within(region, self, near_tip.or(both));
        let criterion = if near_tip.is_some() { criterion.exact_in_position() } else { *criterion };
        RegionLead { aim, criterion, is_within_both: both.is_some() }
    }

    /// Assesses a tip whose squared distance from the aim is `value`. The errors are relative to the target itself; the tip
    /// counts as solved inside the region, within the tolerances of the target or as near to it as the region allows.
    fn assess_led(
        &self,
        region: &Region,
        tip: &Frame,
        criterion: &Criterion,
        lead: &RegionLead,
        value: f64,
    ) -> Assessment {
        let inside = region.contains(&tip.origin);
        let within = self.with_position(|wanted| region.nearest(wanted, 0.0));
        let mut assessment = self.assess_tip_anywhere(tip, criterion);
        assessment.score.value = match criterion.outside {
            Outside::Infinite if !inside => f64::INFINITY,
            _ => value,
        };
        let is_nearest = || !lead.is_within_both && within.assess_tip_anywhere(tip, criterion).score.solved;
        assessment.score.solved = inside && (assessment.score.solved || is_nearest());
        assessment
    }
}

/// Excess of each free coordinate of the tip over the region (m).
fn free_excess(region: &Region, tip: &[f64; 3], criterion: &Criterion, target: &Target) -> [f64; 3] {
    let inside = region.nearest(tip, criterion.margin());
    let free = criterion.free(target);
    std::array::from_fn(|k| if free[k] { tip[k] - inside[k] } else { 0.0 })
}
