//! Scan of the fourth joint: columns that follow the branches, and the least values along each.

use smallvec::SmallVec;

use crate::closed_form::angle::Angle;

/// Largest number of joints.
pub const MOST: usize = 5;

/// Largest number of seeds.
pub(crate) const SEEDS: usize = 8;

/// Solutions for each value of the scan and each turn that the fifth joint begins with.
pub const BRANCHES: usize = 4;

/// Sum of three cosines below which two samples do not follow each other while others are more alike.
const LEAST_ALIKE: f64 = 2.5;

/// The same of the last sample of a column and the end of its branch.
const LEAST_ALIKE_NEAR: f64 = 2.85;

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
    /// Whether the fourth joint is at the end of its values.
    pub is_at_end: bool,
    /// Whether it is an end of a branch that no value of the scan lies on.
    pub is_between: bool,
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
    rows: usize,
    /// Solutions of the row under way, with the numbers of their turns.
    now: SmallVec<[(usize, ScanSample); 2 * BRANCHES]>,
    found: Minima,
    /// Where columns begin and end.
    ends: SmallVec<[ScanSample; 4 * BRANCHES]>,
    /// Ends of branches that limits cut off.
    cut: SmallVec<[ScanSample; 4 * BRANCHES]>,
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
        Self {
            columns,
            fourth: 0.0,
            rows: 0,
            now: SmallVec::new(),
            found: Minima::new(),
            ends: SmallVec::new(),
            cut: SmallVec::new(),
        }
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
        self.keep_least(self.rows == 1);
        (self.fourth, self.rows) = (fourth, self.rows + 1);
        for column in &mut self.columns {
            column.before = column.here.value;
            column.here = std::mem::replace(&mut column.next, ScanSample::NONE);
        }
    }

    /// Ends the last column.
    pub fn end(&mut self) {
        self.keep_least(true);
    }

    /// Adds the end of a branch that a limit cuts off.
    pub fn add_end(&mut self, sample: ScanSample) {
        self.cut.push(sample);
    }

    /// Least values along all columns, the least of all first, and the ends of branches without a column: those that no column goes
    /// to within `spacing` (rad) of the fourth joint. A column goes to the end that is most like its last sample.
    pub fn finish(mut self, spacing: f64) -> Minima {
        let near = spacing.cos() - 1e-9;
        for end in &self.ends {
            let mut most = LEAST_ALIKE_NEAR + near;
            let mut own = None;
            for (place, cut) in self.cut.iter().enumerate() {
                let [fourth, other] = [end, cut].map(|sample| sample.turns[MOST - 2]);
                let apart = fourth.cos * other.cos + fourth.sin * other.sin;
                let alike = likeness(end, cut) + apart;
                if apart >= near && alike > most {
                    (most, own) = (alike, Some(place));
                }
            }
            if let Some(place) = own {
                self.cut.swap_remove(place);
            }
        }
        for sample in self.cut {
            let (fourth, beside) = (sample.turns[MOST - 2].angle(), [f64::INFINITY; 2]);
            insert(&mut self.found, ScanMinimum { sample, fourth, beside, is_at_end: false, is_between: true });
        }
        self.found
    }

    /// Keeps the columns that are least at the row before the one under way.
    fn keep_least(&mut self, is_at_end: bool) {
        for Column { before, here, next } in &self.columns {
            let value = here.value;
            if !value.is_finite() {
                continue;
            }
            let beside = [*before, next.value];
            if beside.iter().any(|value| !value.is_finite()) {
                self.ends.push(*here);
            }
            if value <= *before && value < next.value {
                let fourth = self.fourth;
                insert(&mut self.found, ScanMinimum { sample: *here, fourth, beside, is_at_end, is_between: false });
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
    /// Vertex of the parabola through the three values, which are `spacing` (rad) apart: the value of the fourth joint and the least
    /// value there; `None` where the column begins or ends.
    pub fn vertex(&self, spacing: f64) -> Option<[f64; 2]> {
        let [before, after] = self.beside.map(|value| value - self.sample.value);
        let bend = before + after;
        (bend.is_finite() && bend > 0.0).then(|| {
            let slope = before - after;
            [self.fourth + 0.5 * spacing * slope / bend, self.sample.value - 0.125 * slope * slope / bend]
        })
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
        scan.end();
        scan.finish(1.0)
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
    fn each_column_goes_to_one_end_and_other_ends_are_kept() {
        let mut scan = Scan::new(1);
        for (value, angle) in [(0.5, 0.0), (0.4, 0.1)] {
            scan.add(0, sample(value, angle));
            scan.end_row(angle);
        }
        scan.end();
        // The column goes to the nearest of these; the other two are the ends of a branch without a column, and of one elsewhere.
        for (value, angle) in [(0.39, 0.12), (0.2, 0.15), (0.3, 2.0)] {
            scan.add_end(sample(value, angle));
        }
        scan.add_end(sample(0.52, -0.05));
        let found: Vec<_> = scan.finish(1.0).iter().map(|least| (least.sample.value, least.is_between)).collect();
        assert_eq!(found, [(0.2, true), (0.3, true), (0.4, false)]);
    }

    #[test]
    fn the_vertex_of_a_parabola_is_its_minimum() {
        let parabola = |x: f64| 0.3 + 2.0 * (x - 1.04) * (x - 1.04);
        let found = scanned(&[&[(parabola(0.0), 0.0)], &[(parabola(1.0), 0.0)], &[(parabola(2.0), 0.0)]]);
        let [place, least] = found[0].vertex(1.0).expect("it has both neighbours");
        assert!((place - 1.04).abs() < 1e-12 && (least - 0.3).abs() < 1e-12, "{place} {least}");
    }
}
