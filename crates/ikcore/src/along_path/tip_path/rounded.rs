//! Paths with rounded corners.

use nalgebra::UnitQuaternion;

use super::tip_curve::{PathPlace, TipPath};

/// Rows that replace a corner.
const ROWS: usize = 32;

/// Fraction of the allowed distance that a rounded corner uses.
const USED: f64 = 0.95;

/// Corrections of the width of a corner; its distance from the path is nearly proportional to it.
const CORRECTIONS: usize = 6;

/// Step for the direction at the end of a rounded corner, relative to its width.
const STEP: f64 = 1e-4;

impl TipPath {
    /// Returns the same curve with each corner rounded, so that it is off by `most` (m, rad) at most. A corner takes up to half of the way
    /// to the next one. `None` without corners.
    ///
    /// Position and orientation are quintics that go on smoothly, up to the second derivative along straight segments.
    pub(crate) fn rounded(&self, most: f64) -> Option<Self> {
        let mut centers: Vec<f64> = self.corners().collect();
        centers.first()?;
        centers.insert(0, 0.0);
        centers.push(1.0);
        let room = |i: usize| {
            let [before, after] = [centers[i] - centers[i - 1], centers[i + 1] - centers[i]];
            // Ends of the path are not rounded.
            let [first, last] = [i == 1, i + 2 == centers.len()];
            let share = |way: f64, whole: bool| if whole { way } else { 0.5 * way };
            share(before, first).min(share(after, last))
        };
        let corners: Vec<Corner> =
            (1..centers.len() - 1).map(|i| Corner::new(self, centers[i], room(i), most)).collect();
        Some(self.with(&corners))
    }

    fn with(&self, corners: &[Corner]) -> Self {
        let is_replaced = |at: f64| corners.iter().any(|corner| (at - corner.center).abs() <= corner.width);
        let kept = self.fractions.iter().copied().filter(|at| !is_replaced(*at));
        let inside = corners.iter().flat_map(|corner| (0..=ROWS).map(|i| corner.at(i)));
        let mut fractions: Vec<f64> = kept.chain(inside).collect();
        fractions.sort_by(f64::total_cmp);
        fractions.dedup();
        self.resampled(fractions, |at| {
            let corner = corners.iter().find(|corner| (at - corner.center).abs() <= corner.width);
            corner.map(|corner| corner.place(self, at))
        })
    }
}

/// A rounded corner: a quintic from `width` before its center to `width` after it.
struct Corner {
    center: f64,
    width: f64,
}

impl Corner {
    fn new(path: &TipPath, center: f64, room: f64, most: f64) -> Self {
        let mut corner = Self { center, width: room };
        for _ in 0..CORRECTIONS {
            let off = corner.off(path);
            if off <= most {
                break;
            }
            corner.width *= USED * most / off;
        }
        corner
    }

    fn at(&self, row: usize) -> f64 {
        self.center + self.width * (2.0 * row as f64 / ROWS as f64 - 1.0)
    }

    /// The largest distance (m) or angle (rad) from the path.
    fn off(&self, path: &TipPath) -> f64 {
        let at_row = |row: usize| {
            let at = self.at(row);
            let (position, rotation) = self.place(path, at);
            let distance = path.distance(position, self.center - self.width, self.center + self.width);
            let angle = rotation.zip(path.rotation(at)).map_or(0.0, |(rounded, due)| rounded.angle_to(&due));
            distance.max(angle)
        };
        (0..=ROWS).map(at_row).fold(0.0, f64::max)
    }

    fn place(&self, path: &TipPath, at: f64) -> PathPlace {
        let ends = [self.center - self.width, self.center + self.width];
        let step = STEP * self.width;
        let part = (at - ends[0]) / (2.0 * self.width);
        let quintic = |place: &dyn Fn(f64) -> [f64; 3]| {
            let [begin, end] = ends.map(place);
            let slope = |from: f64, to: f64| {
                let [from, to] = [place(from), place(to)];
                std::array::from_fn(|k| (to[k] - from[k]) / step * (2.0 * self.width))
            };
            let slopes: [[f64; 3]; 2] = [slope(ends[0], ends[0] + step), slope(ends[1] - step, ends[1])];
            std::array::from_fn(|k| straightening([begin[k], end[k]], slopes.map(|slope| slope[k]), part))
        };
        let position = quintic(&|at| path.position(at));
        let rotation = path.rotation(self.center).map(|middle| {
            let vector =
                |at: f64| path.rotation(at).map_or([0.0; 3], |it| (it * middle.inverse()).scaled_axis().into());
            UnitQuaternion::from_scaled_axis(quintic(&vector).into()) * middle
        });
        (position, rotation)
    }
}

/// The quintic between two values with these slopes and without curvature at the ends, at a part of the way.
fn straightening([from, to]: [f64; 2], [begin, end]: [f64; 2], part: f64) -> f64 {
    let cube = part.powi(3);
    let passed = cube * (10.0 - part * (15.0 - 6.0 * part));
    let at_begin = part - cube * (6.0 - part * (8.0 - 3.0 * part));
    let at_end = cube * (-4.0 + part * (7.0 - 3.0 * part));
    from + passed * (to - from) + at_begin * begin + at_end * end
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::Waypoints;

    fn square() -> TipPath {
        let points = vec![[0.0; 3], [0.4, 0.0, 0.0], [0.4, 0.4, 0.0], [0.0, 0.4, 0.0]];
        TipPath::through(&Waypoints::new(points, None).unwrap()).unwrap()
    }

    #[test]
    fn rounded_corners_use_the_distance_they_may() {
        for most in [1e-4, 1e-3, 0.01, 0.03] {
            let rounded = square().rounded(most).unwrap();
            let off = |i: usize| square().distance(rounded.position(i as f64 / 3000.0), 0.0, 1.0);
            let largest = (0..=3000).map(off).fold(0.0, f64::max);
            assert!(0.8 * most < largest && largest <= most, "{largest} of {most}");
            assert_eq!(rounded.corners().count(), 0);
        }
    }

    #[test]
    fn a_corner_takes_at_most_half_of_the_way_to_the_next() {
        let rounded = square().rounded(10.0).unwrap();
        for fraction in [0.0, 0.5, 1.0] {
            assert!(square().distance(rounded.position(fraction), 0.0, 1.0) < 1e-12, "{fraction}");
        }
    }

    #[test]
    fn the_direction_changes_little_from_row_to_row() {
        let rounded = square().rounded(0.01).unwrap();
        let rows = rounded.positions();
        let turned = rows.windows(3).map(|at| super::super::segment_geometry::turn(at[0], at[1], at[2]));
        assert!(turned.fold(0.0, f64::max) < 0.2);
    }
}
