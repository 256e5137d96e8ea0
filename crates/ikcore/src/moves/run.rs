//! Motion from one stop to the next: joint moves and tip paths, joined by rounded corners.

use super::joint_corner::JointCorner;
use super::move_task::TURN_ACCURACY;
use super::moving_tip::MovingTip;
use super::tool_path::ToolPath;
use crate::error::Result;
use crate::math::cubic_spline::SplineEnds;
use crate::math::vector::distance;
use crate::objective::Point;
use crate::timing::{ConstantLimits, JointPath};

/// Initial number of intervals of a corner.
const INTERVALS: usize = 24;
/// Maximum number of intervals of a corner.
const MOST_INTERVALS: usize = 96;

/// Intervals of a straight line in joint space.
const LINE_INTERVALS: usize = 6;

/// Largest distance of the tip from its path (m) beside a corner.
const ACCURACY: f64 = 5e-6;
/// The same relative to the length between knots where a speed is asked for, so that the speed of the tip is that of the parameter.
const SLOPE_ACCURACY: f64 = 1e-4;
/// Minimum of that distance (m).
const NOTHING: f64 = 1e-9;

/// A part of a run.
#[derive(Debug, Clone)]
pub(super) struct RunPart<'a> {
    /// Index of its move, of the first for a path of the tip.
    pub index: usize,
    /// The tips that it leads.
    pub tips: &'a [MovingTip<'a>],
    /// The path of the tip; `None` for a joint move.
    pub tool_path: Option<&'a ToolPath>,
    /// The joint path.
    pub path: JointPath,
}

/// Interval of a run that one of its parts covers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    /// Parameter of the run at which it begins.
    pub begin: f64,
    /// Parameters of the part between which it is followed.
    pub from: f64,
    pub to: f64,
}

impl Window {
    /// Parameter of the run where it ends.
    pub fn end(&self) -> f64 {
        self.begin + self.to - self.from
    }
}

/// A run: one joint path through all its parts.
#[derive(Debug)]
pub(super) struct Run<'a> {
    pub parts: Vec<RunPart<'a>>,
    pub windows: Vec<Window>,
    pub path: JointPath,
}

impl<'a> Run<'a> {
    /// The run of one part.
    pub fn of(part: RunPart<'a>) -> Self {
        let path = part.path.clone();
        let [from, to] = [path.breaks()[0], path.breaks()[path.pieces()]];
        Self { parts: vec![part], windows: vec![Window { begin: from, from, to }], path }
    }

    /// The run of several parts, whose corners are rounded within `radii` (m); `None` where that is not found. `all` are the tips of the robot.
    ///
    /// # Errors
    /// None in practice: the parts differ.
    pub fn rounded(
        all: &[MovingTip<'_>],
        limits: &ConstantLimits,
        parts: &[RunPart<'a>],
        radii: &[f64],
    ) -> Result<Option<Self>> {
        let middle = |path: &JointPath| 0.5 * (path.breaks()[0] + path.breaks()[path.pieces()]);
        let mut corners = vec![];
        for (i, radius) in radii.iter().enumerate() {
            let paths = [&parts[i].path, &parts[i + 1].path];
            // A joint move to a configuration leads all tips; the radius is about the one that the other move leads.
            let tips = if parts[i].tips.len() < parts[i + 1].tips.len() { parts[i].tips } else { parts[i + 1].tips };
            let first = if i > 0 { middle(paths[0]) } else { paths[0].breaks()[0] };
            let last = if i + 1 < radii.len() { middle(paths[1]) } else { paths[1].breaks()[paths[1].pieces()] };
            let Some(corner) = JointCorner::between(tips, limits, paths, [first, last], *radius) else {
                return Ok(None);
            };
            corners.push(corner);
        }
        let mut intervals = INTERVALS;
        while intervals <= MOST_INTERVALS {
            let mut run = Self::through(parts, &corners, intervals)?;
            run.path = run.path.inside(&limits.lower, &limits.upper);
            if run.is_accurate(all) {
                return Ok(Some(run));
            }
            intervals *= 2;
        }
        Ok(None)
    }

    /// The spline through the knots of all parts, and `intervals` of each corner.
    fn through(parts: &[RunPart<'a>], corners: &[JointCorner], intervals: usize) -> Result<Self> {
        let names = parts[0].path.joints().to_vec();
        let (mut knots, mut rows, mut speeds, mut windows) = (vec![], vec![], vec![], vec![]);
        let mut q = Point::from_elem(0.0, names.len());
        let mut at = 0.0;
        for (i, part) in parts.iter().enumerate() {
            let path = &part.path;
            let [start, end] = [path.breaks()[0], path.breaks()[path.pieces()]];
            let from = if i > 0 { corners[i - 1].entered } else { start };
            let to = corners.get(i).map_or(end, |corner| corner.left);
            let window = Window { begin: at, from, to };
            let mut before = from;
            // Finer knots beside a corner keep the spline from ringing there; most runs need none.
            let beside = |corner: Option<&JointCorner>| {
                corner
                    .filter(|_| intervals > INTERVALS)
                    .map_or(f64::INFINITY, |corner| corner.length / intervals as f64)
            };
            let spacings = [beside(i.checked_sub(1).and_then(|before| corners.get(before))), beside(corners.get(i))];
            for s in knots_of(part, [from, to], spacings) {
                path.position(s, &mut q);
                if s > from {
                    speeds.push(path.largest_speed(path.locate(0.5 * (before + s)).0));
                }
                before = s;
                if i == 0 || s > from {
                    knots.push(at + s - from);
                    rows.extend_from_slice(&q);
                }
            }
            at = window.end();
            windows.push(window);
            if let Some(corner) = corners.get(i) {
                for k in 1..=intervals {
                    let fraction = k as f64 / intervals as f64;
                    corner.position(fraction, &mut q);
                    knots.push(at + fraction * corner.length);
                    rows.extend_from_slice(&q);
                    speeds.push(f64::INFINITY);
                }
                at += corner.length;
            }
        }
        let path = JointPath::spline(names, &rows, Some(&knots), SplineEnds::NotAKnot)?;
        Ok(Self { parts: parts.to_vec(), windows, path: path.with_speeds(speeds) })
    }

    /// Whether the tip stays on its paths between knots, and others where they are.
    fn is_accurate(&self, all: &[MovingTip<'_>]) -> bool {
        let mut q = Point::from_elem(0.0, self.path.joints().len());
        let mut due_q = q.clone();
        self.parts.iter().zip(&self.windows).all(|(part, window)| {
            let (Some(tool_path), [tip, ..]) = (part.tool_path, part.tips) else { return true };
            self.path.breaks().windows(2).all(|ends| {
                let s = 0.5 * (ends[0] + ends[1]);
                if s < window.begin || s > window.end() {
                    return true;
                }
                self.path.position(s, &mut q);
                let at = window.from + s - window.begin;
                let mut others = all.iter().filter(|other| other.number != tip.number);
                let stays = |other: &MovingTip<'_>| {
                    part.path.position(at, &mut due_q);
                    distance(&other.position(&q), &other.position(&due_q)) <= ACCURACY
                };
                if !others.all(stays) {
                    return false;
                }
                let has_speed = tool_path.pieces[tool_path.piece_at(at)].speed.is_some();
                let by_slope = if has_speed { SLOPE_ACCURACY * (ends[1] - ends[0]) } else { ACCURACY };
                let most = by_slope.clamp(NOTHING, ACCURACY);
                let due = tool_path.pose(at);
                if tip.task.is_whole() {
                    return distance(&tip.position(&q), &due.origin) <= most;
                }
                let [distance, angle] = tip.task.target(&due).off(&tip.frame(&q));
                distance <= most && angle <= TURN_ACCURACY
            })
        })
    }
}

/// Parameters of a part at which a run takes it over, from `from` to `to`. Those of a path of the tip become as dense towards its ends as
/// `spacings`.
fn knots_of(part: &RunPart<'_>, [from, to]: [f64; 2], [first, last]: [f64; 2]) -> Vec<f64> {
    let mut knots = vec![from];
    if to <= from {
        // Its corners take all of it.
        return knots;
    }
    if part.tool_path.is_some() {
        let spare = 1e-3 * (to - from) / part.path.pieces() as f64;
        knots.extend(part.path.breaks().iter().copied().filter(|s| *s > from + spare && *s < to - spare));
        let [after_first, before_last] = [knots.get(1).unwrap_or(&to), knots.last().unwrap_or(&from)];
        let [into, out] = [0.5 * (after_first - from), 0.5 * (to - before_last)];
        let dense: Vec<f64> =
            doubling(first, into).map(|s| from + s).chain(doubling(last, out).map(|s| to - s)).collect();
        knots.extend(dense);
        knots.sort_by(f64::total_cmp);
        knots.dedup_by(|next, before| *next - *before < spare);
    } else {
        knots.extend((1..LINE_INTERVALS).map(|i| from + (to - from) * i as f64 / LINE_INTERVALS as f64));
    }
    knots.push(to);
    knots
}

/// Distances whose differences double, from `first` up to `most`.
fn doubling(first: f64, most: f64) -> impl Iterator<Item = f64> {
    (1..).map(move |k| first * (2.0_f64.powi(k) - 1.0)).take_while(move |s| *s < most)
}
