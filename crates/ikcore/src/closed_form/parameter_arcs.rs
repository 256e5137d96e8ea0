//! Arcs of an angle on which a sinusoid stays within bounds.

use std::f64::consts::{PI, TAU};

use crate::closed_form::subproblem::CLAMP;
use crate::math::turns::without_turns;

/// Gap between the end of an arc and a limit (rad) that still counts as touching: near a peak of the wave, a pose change
/// within a caller's tolerances moves the end by as much.
const SLACK: f64 = 5e-3;

/// Sinusoid base + swing cos(q - peak).
#[derive(Debug, Clone, Copy)]
pub struct Wave {
    base: f64,
    swing: f64,
    peak: f64,
}

impl Wave {
    /// Returns base + a cos q + b sin q.
    pub fn new(base: f64, a: f64, b: f64) -> Self {
        Self { base, swing: (a * a + b * b).sqrt(), peak: b.atan2(a) }
    }

    /// Fits a function of one angle without higher harmonics, by four samples.
    pub fn of(value: impl Fn(f64) -> f64) -> Self {
        let (east, north, west, south) = (value(0.0), value(0.5 * PI), value(PI), value(-0.5 * PI));
        Self::new(0.25 * (east + north + west + south), 0.5 * (east - west), 0.5 * (north - south))
    }

    fn at(&self, q: f64) -> f64 {
        self.base + self.swing * (q - self.peak).cos()
    }

    /// Returns the angle and the value of the peak, and of the trough.
    pub fn extremes(&self) -> [(f64, f64); 2] {
        [(self.peak, self.base + self.swing), (self.peak + PI, self.base - self.swing)]
    }

    /// Returns the smallest and the largest value between two angles.
    pub fn range(&self, [lower, upper]: [f64; 2]) -> [f64; 2] {
        if upper - lower >= TAU {
            return [self.base - self.swing, self.base + self.swing];
        }
        // Whether some angle + 2 pi k lies in between.
        let passes = |angle: f64| angle + TAU * ((lower - angle) / TAU).ceil() <= upper;
        let ends = [self.at(lower), self.at(upper)];
        let least = if passes(self.peak + PI) { self.base - self.swing } else { ends[0].min(ends[1]) };
        let most = if passes(self.peak) { self.base + self.swing } else { ends[0].max(ends[1]) };
        [least, most]
    }

    /// Returns the angles, in (-pi, pi], at which the wave has a value: two, or its peak or trough if the wave misses the
    /// value narrowly.
    pub fn angles_at(&self, value: f64) -> impl Iterator<Item = f64> {
        let Self { base, swing, peak } = *self;
        let slack = CLAMP * (base.abs() + swing);
        let is_met = swing > 0.0 && (value - base).abs() <= swing + slack;
        let off = ((value - base) / swing).clamp(-1.0, 1.0).acos();
        [peak - off, peak + off].into_iter().filter(move |_| is_met).map(without_turns)
    }

    /// Returns the arcs on which the wave lies between two bounds. Bounds missed narrowly, or by `slack`, give an arc of zero
    /// length, which a solve at that value confirms or rejects.
    pub fn arcs_between(&self, [least, most]: [f64; 2], slack: f64) -> ParameterArcs {
        let Self { base, swing, peak } = *self;
        let slack = slack + CLAMP * (base.abs() + swing);
        if least > base + swing + slack || most < base - swing - slack {
            return ParameterArcs::NONE;
        }
        if swing <= slack {
            return ParameterArcs::CIRCLE;
        }
        // Two arcs, one on each side of the peak; they join where a bound is not met.
        let angle = |bound: f64| ((bound - base) / swing).clamp(-1.0, 1.0).acos();
        let (near, far) = (angle(most), angle(least));
        let mut arcs = ParameterArcs::NONE;
        match (near <= 0.0, far >= PI) {
            (true, true) => return ParameterArcs::CIRCLE,
            (true, false) => arcs.push_wrapped(peak - far, peak + far),
            (false, true) => arcs.push_wrapped(peak + near, peak + TAU - near),
            (false, false) => {
                arcs.push_wrapped(peak - far, peak - near);
                arcs.push_wrapped(peak + near, peak + far);
            }
        }
        arcs
    }
}

/// At most six arcs of a parameter (rad, m), as pairs of start and end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParameterArcs {
    arcs: [[f64; 2]; 6],
    count: usize,
}

impl ParameterArcs {
    /// Empty set.
    pub const NONE: Self = Self { arcs: [[0.0; 2]; 6], count: 0 };

    /// Full circle from -pi to pi.
    pub const CIRCLE: Self = Self { arcs: [[-PI, PI], [0.0; 2], [0.0; 2], [0.0; 2], [0.0; 2], [0.0; 2]], count: 1 };

    /// Returns a single arc.
    pub fn one(arc: [f64; 2]) -> Self {
        let mut arcs = Self::NONE;
        arcs.push(arc);
        arcs
    }

    fn push(&mut self, arc: [f64; 2]) {
        if self.count < self.arcs.len() && arc[0] <= arc[1] {
            self.arcs[self.count] = arc;
            self.count += 1;
        }
    }

    /// Adds an arc with its start wrapped into [-pi, pi). Rounding may leave an arc of zero length with its end before its
    /// start.
    fn push_wrapped(&mut self, start: f64, end: f64) {
        let turns = ((start + PI) / TAU).floor() * TAU;
        self.push([start - turns, end.max(start) - turns]);
    }

    /// Intersects arcs of an angle with limits, modulo 2 pi.
    pub fn within(&self, [lower, upper]: [f64; 2]) -> Self {
        if upper - lower >= TAU {
            return *self;
        }
        let mut within = Self::NONE;
        for [start, end] in self.iter() {
            let (first, last) =
                (((lower - SLACK - end) / TAU).ceil() as i32, ((upper + SLACK - start) / TAU).floor() as i32);
            for turns in first..=last {
                let turn = TAU * f64::from(turns);
                within.push([start + turn, end + turn].map(|angle| angle.clamp(lower, upper)));
            }
        }
        within
    }

    /// Whether the two sets have an angle in common, modulo 2 pi.
    pub fn meet(&self, others: &Self) -> bool {
        let both = |[a, b]: &[f64; 2], [c, d]: &[f64; 2]| {
            [-TAU, 0.0, TAU].iter().any(|turn| c + turn <= b + SLACK && a - SLACK <= d + turn)
        };
        self.iter().any(|arc| others.iter().any(|other| both(arc, other)))
    }

    /// Returns values at equal distances along the arcs: `count` or a few more, and at least one on each arc.
    pub fn spread(&self, count: usize) -> impl Iterator<Item = f64> {
        let step = self.length() / count as f64;
        self.iter().flat_map(move |[start, end]| {
            let length = end - start;
            let values = if step > 0.0 { (length / step).round().max(1.0) } else { 1.0 };
            (0..values as usize).map(move |k| start + length * (k as f64 + 0.5) / values)
        })
    }

    /// Returns `count` well-separated values: the midpoints of the arcs, then van der Corput's sequence along the arcs.
    pub fn scattered(&self, count: usize) -> impl Iterator<Item = f64> {
        let length = self.length();
        let middles = self.iter().map(|[start, end]| 0.5 * (start + end));
        let along = move |number: usize| {
            let reversed = (number as u64).reverse_bits() as f64 / 2.0_f64.powi(64);
            self.at(reversed * length)
        };
        let further = if length > 0.0 { 2..count } else { 2..2 };
        middles.chain(further.map(along))
    }

    /// Returns the value at a distance along the arcs.
    fn at(&self, mut distance: f64) -> f64 {
        let mut value = 0.0;
        for [start, end] in self.iter() {
            value = (start + distance).min(*end);
            if start + distance <= *end {
                break;
            }
            distance -= end - start;
        }
        value
    }

    /// Returns the total length of the arcs.
    pub fn length(&self) -> f64 {
        self.iter().map(|[start, end]| end - start).sum()
    }
}

impl std::ops::Deref for ParameterArcs {
    type Target = [[f64; 2]];

    fn deref(&self) -> &[[f64; 2]] {
        &self.arcs[..self.count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_hold_exactly_the_values_between() {
        let wave = Wave::of(|q: f64| 0.7 + 0.4 * (q - 2.9).cos());
        for bounds in [[0.5, 0.8], [0.0, 0.6], [0.9, 5.0], [0.0, 5.0]] {
            let arcs = wave.arcs_between(bounds, 0.0);
            for k in -312..313 {
                let q = f64::from(k) * 0.01;
                let inside = arcs.within([-3.13, 3.13]).iter().any(|[a, b]| *a <= q && q <= *b);
                let value = wave.at(q);
                assert_eq!(inside, bounds[0] <= value && value <= bounds[1], "{bounds:?} {q} {arcs:?}");
            }
        }
    }

    #[test]
    fn angles_at_a_value_have_it() {
        let wave = Wave::of(|q: f64| 0.7 + 0.4 * (q - 2.9).cos());
        for value in [0.3, 0.5, 0.9, 1.1] {
            let angles: Vec<f64> = wave.angles_at(value).collect();
            assert!(angles.len() == 2 && angles.iter().all(|q| q.abs() <= PI && (wave.at(*q) - value).abs() < 1e-12));
        }
        assert_eq!([0.2, 1.2].map(|value| wave.angles_at(value).count()), [0, 0]);
    }

    #[test]
    fn limits_a_turn_away_leave_the_same_values() {
        let arcs = Wave::of(|q: f64| (q - 2.9).cos()).arcs_between([0.1, 0.9], 0.0);
        let (here, there) = (arcs.within([-1.0, 4.0]), arcs.within([-1.0 + 3.0 * TAU, 4.0 + 3.0 * TAU]));
        assert!(here.length() > 0.5 && (here.length() - there.length()).abs() < 1e-12, "{here:?} {there:?}");
    }

    #[test]
    fn arcs_meet_across_the_end_of_a_turn() {
        let arc = |start: f64, end: f64| {
            let mut arcs = ParameterArcs::NONE;
            arcs.push_wrapped(start, end);
            arcs
        };
        assert!(arc(3.0, 3.5).meet(&arc(-3.0, -2.9)) && arc(-3.0, -2.9).meet(&arc(3.0, 3.5)));
        assert!(!arc(3.0, 3.2).meet(&arc(-3.0, -2.9)) && !arc(0.0, 1.0).meet(&arc(1.1, 2.0)));
        assert!(ParameterArcs::CIRCLE.meet(&arc(6.0, 6.1)) && !ParameterArcs::CIRCLE.meet(&ParameterArcs::NONE));
    }

    #[test]
    fn an_arc_shrunk_to_a_point_stays() {
        let wave = Wave::of(|q: f64| 0.7 + 0.4 * (q - 1.0).cos());
        let arcs = wave.arcs_between([1.1, 2.0], 0.0);
        assert!(arcs.len() == 1 && arcs.length() < 1e-7 && (arcs[0][0] - 1.0).abs() < 1e-7);
        assert_eq!(wave.arcs_between([1.2, 2.0], 0.0).len(), 0);
    }

    #[test]
    fn an_arc_shrunk_to_a_trough_stays_whatever_rounding_does() {
        for k in 0..1000 {
            let wave = Wave { base: 0.7, swing: 0.4, peak: 0.0063 * f64::from(k) - 3.1 };
            let arcs = wave.arcs_between([0.3, 0.3], 0.0);
            assert!(!arcs.is_empty() && arcs.length() < 1e-6, "{k} {arcs:?}");
        }
    }

    #[test]
    fn ranges_over_part_of_the_circle() {
        let wave = Wave::of(|q: f64| (q - 0.5).cos());
        let [least, most] = wave.range([0.0, 1.0]);
        assert!((most - 1.0).abs() < 1e-15 && (least - 0.5_f64.cos()).abs() < 1e-15);
        let [least, most] = wave.range([-3.0, 3.5]);
        assert!((most - 1.0).abs() < 1e-15 && (least + 1.0).abs() < 1e-12);
    }
}
