//! Scan of the fourth joint: columns that follow the branches, and the least values along each.

use smallvec::SmallVec;

use crate::closed_form::angle::Angle;

/// Largest number of joints.
pub const MOST: usize = 5;

/// Largest number of seeds.
pub(crate) const SEEDS: usize = 16;

/// Solutions for each value of the scan and each turn that the fifth joint begins with.
pub const BRANCHES: usize = 4;

/// Sum of three cosines below which two samples do not follow each other while others are more alike.
const LEAST_ALIKE: f64 = 2.5;

/// Sum of three cosines of a sample and an empty column.
const UNLIKE: f64 = -4.0;

/// Configuration at or near the goal's position.
#[derive(Debug, Clone, Copy)]
pub struct ScanSample {
    /// 1 - cos of the angle to the target orientation; infinite without a solution.
    pub value: f64,
    /// Angles of the joints.
    pub turns: [Angle; MOST],
}

/// Least value along a column of the scan.
#[derive(Debug, Clone, Copy)]
pub struct ScanMinimum {
    /// The sample with the least value.
    pub sample: ScanSample,
    /// Value of the fourth joint there (rad).
    pub fourth: f64,
    /// Values of the samples before and after; infinite where the column begins or ends.
    pub beside: [f64; 2],
}

/// Least values of a scan.
pub type Minima = SmallVec<[ScanMinimum; SEEDS]>;

/// Column of the scan, which follows one branch.
#[derive(Debug, Clone, Copy)]
struct Column {
    before: f64,
    here: ScanSample,
    next: ScanSample,
}

/// Scan in progress.
pub struct Scan {
    columns: SmallVec<[Column; 2 * BRANCHES]>,
    /// Value of the fourth joint of the row before the one under way.
    fourth: f64,
    /// Solutions of the row under way, with the numbers of their turns.
    now: SmallVec<[(usize, ScanSample); 2 * BRANCHES]>,
    found: Minima,
}

impl ScanSample {
    /// No sample.
    pub const NONE: Self = Self { value: f64::INFINITY, turns: [Angle::NONE; MOST] };
}

impl Scan {
    /// Scan with this many turns that the fifth joint begins with.
    pub fn new(turns: usize) -> Self {
        let column = Column { before: f64::INFINITY, here: ScanSample::NONE, next: ScanSample::NONE };
        let columns = SmallVec::from_elem(column, turns * BRANCHES);
        Self { columns, fourth: 0.0, now: SmallVec::new(), found: Minima::new() }
    }

    /// Adds a solution of the row under way, of the turn `number`.
    pub fn add(&mut self, number: usize, sample: ScanSample) {
        if self.now.len() < self.columns.len() {
            self.now.push((number, sample));
        }
    }

    /// Writes the solutions of the row under way into the columns whose last solutions they continue: the most alike first, then the
    /// others into free columns of their turn.
    fn continue_columns(&mut self) {
        for rest in [LEAST_ALIKE, f64::NEG_INFINITY] {
            while let Some((place, column)) = self.most_alike(rest) {
                let (_, sample) = self.now.swap_remove(place);
                self.columns[column].next = sample;
            }
        }
        self.now.clear();
    }

    /// The solution and the free column of its turn that are most alike, if more than `least`.
    fn most_alike(&self, least: f64) -> Option<(usize, usize)> {
        let mut found = None;
        let mut most = least;
        for (place, (number, sample)) in self.now.iter().enumerate() {
            for index in number * BRANCHES..(number + 1) * BRANCHES {
                let column = &self.columns[index];
                if column.next.value.is_finite() {
                    continue;
                }
                let alike = if column.here.value.is_finite() { likeness(sample, &column.here) } else { UNLIKE };
                if alike > most {
                    (most, found) = (alike, Some((place, index)));
                }
            }
        }
        found
    }

    /// Ends the row at the value `fourth` of the fourth joint.
    pub fn end_row(&mut self, fourth: f64) {
        self.continue_columns();
        self.keep_least();
        self.fourth = fourth;
        for column in &mut self.columns {
            column.before = column.here.value;
            column.here = std::mem::replace(&mut column.next, ScanSample::NONE);
        }
    }

    /// Adds the end of a branch that a limit cuts off: a branch between two values of the scan has no column.
    pub fn add_end(&mut self, sample: ScanSample) {
        let fourth = sample.turns[MOST - 2].angle();
        insert(&mut self.found, ScanMinimum { sample, fourth, beside: [f64::INFINITY; 2] });
    }

    /// Ends the last column. Returns the least values along all columns and the ends of branches, the least of all first.
    pub fn finish(mut self) -> Minima {
        self.keep_least();
        self.found
    }

    /// Keeps the columns that are least at the row before the one under way.
    fn keep_least(&mut self) {
        for Column { before, here, next } in &self.columns {
            let value = here.value;
            if !value.is_finite() {
                continue;
            }
            if value <= *before && value < next.value {
                let (fourth, beside) = (self.fourth, [*before, next.value]);
                insert(&mut self.found, ScanMinimum { sample: *here, fourth, beside });
            }
        }
    }
}

/// Inserts `minimum` in order; the worst is lost where there is no room.
fn insert(found: &mut Minima, minimum: ScanMinimum) {
    let value = minimum.sample.value;
    let place = found.iter().position(|other| value < other.sample.value).unwrap_or(found.len());
    if place < SEEDS {
        found.truncate(SEEDS - 1);
        found.insert(place, minimum);
    }
}

impl ScanMinimum {
    /// Value of the fourth joint at the vertex of the parabola through the three values, which are `spacing` (rad) apart; `None` where
    /// the column begins or ends.
    pub fn vertex(&self, spacing: f64) -> Option<f64> {
        let [before, after] = self.beside.map(|value| value - self.sample.value);
        let bend = before + after;
        (bend.is_finite() && bend > 0.0).then(|| self.fourth + 0.5 * spacing * (before - after) / bend)
    }
}

/// Sum of the cosines of the angles between the first three joints of two samples.
pub fn likeness(a: &ScanSample, b: &ScanSample) -> f64 {
    (0..3).map(|k| a.turns[k].cos * b.turns[k].cos + a.turns[k].sin * b.turns[k].sin).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ScanSample whose first joint is at `angle` (rad).
    fn sample(value: f64, angle: f64) -> ScanSample {
        let mut turns = [Angle::NONE; MOST];
        turns[0] = Angle::by(angle);
        ScanSample { value, turns }
    }

    /// Least values of rows of samples, given as value and angle.
    fn scanned(rows: &[&[(f64, f64)]]) -> Minima {
        let mut scan = Scan::new(1);
        for (row, samples) in rows.iter().enumerate() {
            samples.iter().for_each(|(value, angle)| scan.add(0, sample(*value, *angle)));
            scan.end_row(row as f64);
        }
        scan.finish()
    }

    #[test]
    fn columns_follow_the_branches_in_any_order() {
        let found = scanned(&[
            &[(0.5, 0.0), (0.9, 1.5)],
            &[(0.7, 1.6), (0.4, 0.1)],
            &[(0.6, 0.2), (0.5, 1.7)],
            &[(0.8, 1.8), (0.9, 0.3)],
        ]);
        let found: Vec<_> = found.iter().map(|minimum| (minimum.sample.value, minimum.fourth)).collect();
        assert_eq!(found, [(0.4, 1.0), (0.5, 2.0)]);
    }

    #[test]
    fn ends_of_branches_are_kept_beside_columns() {
        let mut scan = Scan::new(1);
        for (value, angle) in [(0.5, 0.0), (0.4, 0.1)] {
            scan.add(0, sample(value, angle));
            scan.end_row(angle);
        }
        // Both are as near to the end of the column as the end of its own branch would be.
        for (value, angle) in [(0.39, 0.12), (0.45, 0.15)] {
            scan.add_end(sample(value, angle));
        }
        let found: Vec<_> = scan.finish().iter().map(|least| least.sample.value).collect();
        assert_eq!(found, [0.39, 0.4, 0.45]);
    }

    #[test]
    fn the_vertex_of_a_parabola_is_its_minimum() {
        let parabola = |x: f64| 0.3 + 2.0 * (x - 1.04) * (x - 1.04);
        let found = scanned(&[&[(parabola(0.0), 0.0)], &[(parabola(1.0), 0.0)], &[(parabola(2.0), 0.0)]]);
        let place = found[0].vertex(1.0).expect("it has both neighbours");
        assert!((place - 1.04).abs() < 1e-12, "{place}");
    }
}
