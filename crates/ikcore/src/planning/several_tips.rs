//! Point to point for robots with several tips: targets of the tips become configurations, between which the planner joins.

use crate::constraint::Keep;
use crate::error::{Error, Result};
use crate::ik::{AllOptions, Solution, SolveOptions, solve_all_tips, solve_tips};
use crate::obstacle::ClearSpace;
use crate::plan::{END_RESERVE, EndName, Endpoint, PointToPointOptions, no_usable_end};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::{NamedTask, Subject, Target};
use crate::timing::ConstantLimits;

/// Configurations of an end that are tried, beside the one that a descent from the start leads to.
const TRIED: usize = 6;

/// Configurations of the ends of a motion of several tips.
pub(super) struct TipEnds {
    pub start: Endpoint,
    pub ends: Vec<Endpoint>,
    /// The number of the end that each of `ends` is a configuration of.
    pub origins: Vec<usize>,
    pub evaluations: usize,
}

/// Finds configurations of the ends. Targets of the start are solved first; each end is taken at the solution that a descent from the
/// start leads to, and at a few others.
///
/// # Errors
/// As [`plan_point_to_point`](super::plan_point_to_point()).
pub(super) fn tip_ends(
    robot: &Robot,
    start: &Endpoint,
    ends: &[Endpoint],
    space: Option<&ClearSpace<'_>>,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<TipEnds> {
    let mut search = EndSearch::new(robot, space, options)?;
    let start = search.start(start, monitor)?;
    let (mut found, mut origins, mut problems) = (vec![], vec![], vec![]);
    for (i, end) in ends.iter().enumerate() {
        match search.configurations(EndName::of(i, ends.len()), end, &start, monitor) {
            Ok(configurations) => {
                origins.extend(configurations.iter().map(|_| i));
                found.extend(configurations.into_iter().map(Endpoint::Configuration));
            }
            Err(problem @ Error::Unreachable { .. }) => problems.push(problem),
            Err(wrong) => return Err(wrong),
        }
    }
    if found.is_empty() {
        return Err(no_usable_end(ends.len(), problems));
    }
    let start = Endpoint::Configuration(start);
    Ok(TipEnds { start, ends: found, origins, evaluations: search.evaluations })
}

/// Solves for configurations of the ends.
struct EndSearch<'a> {
    robot: &'a Robot,
    options: SolveOptions,
    keeps: &'a [Keep],
    evaluations: usize,
}

impl<'a> EndSearch<'a> {
    fn new(robot: &'a Robot, space: Option<&ClearSpace<'_>>, options: &'a PointToPointOptions) -> Result<Self> {
        let limits = ConstantLimits::for_robot(robot, options.limits.as_ref(), "plan_point_to_point")?;
        let keeps = &options.keeps;
        let options = SolveOptions {
            limits: Some(limits.position_limits(robot)?),
            surroundings: space.map(|space| space.narrowed(END_RESERVE).surroundings()).unwrap_or_default(),
            seed: options.seed,
            ..SolveOptions::default()
        };
        Ok(Self { robot, options, keeps, evaluations: 0 })
    }

    /// The configuration of the start.
    fn start(&mut self, start: &Endpoint, monitor: &mut dyn Monitor) -> Result<Vec<f64>> {
        match start {
            Endpoint::Configuration(q) => Ok(q.clone()),
            Endpoint::Targets { tips, targets } => {
                let solution = self.solve(self.options_of(tips), targets, monitor)?;
                reached(EndName::Start, &solution).map(|()| solution.q.to_vec())
            }
        }
    }

    /// Configurations of an end: the one that a descent from `start` leads to, then others.
    fn configurations(
        &mut self,
        name: EndName,
        end: &Endpoint,
        start: &[f64],
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<Vec<f64>>> {
        let (tips, targets) = match end {
            Endpoint::Configuration(q) => return Ok(vec![q.clone()]),
            Endpoint::Targets { tips, targets } => (tips, targets),
        };
        let first =
            self.solve(SolveOptions { start: Some(start.to_vec()), ..self.options_of(tips) }, targets, monitor)?;
        reached(name, &first)?;
        if first.status == Status::LevelGivenUp {
            return Ok(vec![first.q.to_vec()]);
        }
        let tips = &of_one_level(tips);
        let each = SolveOptions { whole_only: true, ..self.options_of(tips) };
        let all = AllOptions { each, limit: Some(TRIED), ..AllOptions::default() };
        let targets: Vec<Target> = targets.iter().chain(self.also_kept(tips).map(Keep::target)).copied().collect();
        let others = solve_all_tips(self.robot, &targets, &all, monitor)?;
        self.evaluations += others.evaluations;
        Ok(std::iter::once(first.q.to_vec()).chain(others.solutions.iter().map(|other| other.q.to_vec())).collect())
    }

    fn options_of(&self, tips: &[NamedTask]) -> SolveOptions {
        let also = self.also_kept(tips).map(|keep| *keep.task());
        SolveOptions { tips: tips.iter().copied().chain(also).collect(), ..self.options.clone() }
    }

    /// Constraints of tips and pairs without a target among `tips`: they hold at the ends too.
    fn also_kept(&self, tips: &[NamedTask]) -> impl Iterator<Item = &'a Keep> {
        let named: Vec<Subject> = tips.iter().map(|task| task.subject).collect();
        let is_named = move |subject: Subject| {
            named.contains(&subject)
                || matches!(subject, Subject::Pair { from, of } if named.contains(&Subject::Pair { from: of, of: from }))
        };
        self.keeps.iter().filter(move |keep| !is_named(keep.task().subject))
    }

    fn solve(&mut self, options: SolveOptions, targets: &[Target], monitor: &mut dyn Monitor) -> Result<Solution> {
        let given = &options.tips[..targets.len()];
        let targets: Vec<Target> =
            targets.iter().copied().chain(self.also_kept(given).map(|keep| *keep.target())).collect();
        let solution = solve_tips(self.robot, &targets, &options, monitor)?;
        self.evaluations += solution.evaluations;
        Ok(solution)
    }
}

/// The tasks without their levels, for solutions that meet all targets.
fn of_one_level(tips: &[NamedTask]) -> Vec<NamedTask> {
    let flat = |named: &NamedTask| NamedTask { task: named.task.map(|task| task.at_level(0)), ..*named };
    tips.iter().map(flat).collect()
}

/// Err unless the targets of an end were reached, those of higher levels as far as the lower ones allow.
fn reached(name: EndName, solution: &Solution) -> Result<()> {
    match solution.status {
        Status::Solved | Status::LevelGivenUp => Ok(()),
        Status::Interrupted => Err(Error::Interrupted),
        _ => Err(Error::Unreachable { what: name.of_target(), problem: solution.message() }),
    }
}
