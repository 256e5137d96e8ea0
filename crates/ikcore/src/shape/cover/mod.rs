//! Covers of meshes: few spheres and capsules that contain a mesh and its interior.
//!
//! Planes cut the mesh into parts, and each part gets the smallest capsule found for it. Since a capsule is convex, it
//! contains a part, triangles and interior, if it contains the corners of the part and the corners on its cuts.

mod fit;
mod parts;
mod tightness;

use serde::{Deserialize, Serialize};

use super::checked_shape::Shape;
use super::mesh::Mesh;
use crate::error::Result;
pub(super) use fit::smallest_capsule;
use fit::{FittedCapsule, rough_volume};
use parts::CoveredPart;

/// Spheres and capsules that contain a mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cover {
    /// Spheres and capsules of the cover.
    pub shapes: Vec<Shape>,
    /// Volume of the cover relative to the mesh, to about 1 %; NaN for a mesh that is not closed.
    pub volume_ratio: f64,
    /// Upper bound on the distance of any point of the cover from the mesh (m). Exceeds the true maximum by at most 5 %, 0.2
    /// mm, or a 4,000th of the meridian of its largest capsule.
    pub largest_distance: f64,
}

/// Fraction of the volume that one more capsule must save.
const LEAST_GAIN: f64 = 0.02;

impl Mesh {
    /// Covers the mesh by at most `most` >= 1 spheres and capsules. The piece whose cut saves most volume is cut in two until
    /// there are `most` pieces; the cover of least volume on the way is returned.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for coordinates that are too large for a volume.
    pub fn cover(&self, most: usize) -> Result<Cover> {
        let (volume, shapes) = self.covering(most)?;
        let volume_ratio = if self.is_closed() { volume / self.volume().abs() } else { f64::NAN };
        let largest_distance = tightness::largest_distance(self, &shapes);
        Ok(Cover { shapes, volume_ratio, largest_distance })
    }

    /// Returns the shapes of [`cover`](Self::cover), and their volume (m^3).
    fn covering(&self, most: usize) -> Result<(f64, Vec<Shape>)> {
        let mut pieces = vec![Piece::of(CoveredPart::of(self))];
        // Cache of the best cut of each piece.
        let mut cuts = vec![pieces[0].best_cut()];
        let mut best = (f64::INFINITY, vec![]);
        loop {
            let shapes = pieces.iter().map(|piece| piece.capsule.shape()).collect::<Result<Vec<Shape>>>()?;
            let volume = tightness::volume(&shapes);
            if best.1.is_empty() || volume < (1.0 - LEAST_GAIN) * best.0 {
                best = (volume, shapes);
            }
            let gain = |i: &usize| cuts[*i].as_ref().map_or(f64::NEG_INFINITY, |cut| cut.gain);
            let next = (0..pieces.len()).max_by(|i, j| gain(i).total_cmp(&gain(j)));
            let Some((next, cut)) = next.and_then(|next| Some((next, cuts[next].take()?))) else { break };
            if pieces.len() >= most {
                break;
            }
            let [first, second] = cut.halves;
            pieces[next] = first;
            cuts[next] = pieces[next].best_cut();
            cuts.push(second.best_cut());
            pieces.push(second);
        }
        Ok(best)
    }
}

/// Part of the mesh, and the capsule that contains it.
struct Piece {
    part: CoveredPart,
    capsule: FittedCapsule,
}

/// Cut of a piece in two, and the volume that it saves (m^3).
struct Cut {
    halves: [Piece; 2],
    gain: f64,
}

impl Piece {
    fn of(part: CoveredPart) -> Self {
        Self { capsule: smallest_capsule(&part.corners()), part }
    }

    /// Returns the cut that saves most volume according to roughly fitted capsules.
    fn best_cut(&self) -> Option<Cut> {
        let planes = self.part.candidate_planes();
        let cuts =
            planes.iter().map(|plane| self.part.cut(plane)).filter(|halves| !halves.iter().any(CoveredPart::is_empty));
        let rough = |halves: &[CoveredPart; 2]| halves.iter().map(|half| rough_volume(&half.corners())).sum::<f64>();
        let best = cuts.map(|halves| (rough(&halves), halves)).min_by(|one, other| one.0.total_cmp(&other.0));
        let halves = best?.1.map(Self::of);
        let gain = self.capsule.volume() - halves.iter().map(|half| half.capsule.volume()).sum::<f64>();
        Some(Cut { halves, gain })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::rng::{self, LazyRng};
    use crate::shape::test_shapes::{as_mesh, mesh_of};

    /// Returns an L of two overlapping boxes, and a ring of boxes.
    fn bodies(rng: &mut LazyRng) -> Vec<Shape> {
        let cuboid = |center: [f64; 3], size: [f64; 3]| Shape::cuboid(center, size, None).unwrap().triangles();
        let l = [cuboid([0.0, 0.0, 0.25], [0.1, 0.1, 0.5]), cuboid([0.15, 0.0, 0.5], [0.4, 0.1, 0.1])].concat();
        let ring = (0..8).flat_map(|i| {
            let (sine, cosine) = (f64::from(i) * std::f64::consts::FRAC_PI_4).sin_cos();
            let turn = *nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), sine.atan2(cosine)).matrix();
            Shape::cuboid([0.3 * cosine, 0.3 * sine, 0.0], [0.06, 0.3, 0.06], Some(turn)).unwrap().triangles()
        });
        let ball = Shape::sphere([0.1, 0.2, 0.3], 0.2).unwrap().triangles();
        let soup = (0..40).map(|_| [(); 3].map(|()| std::array::from_fn(|_| rng.uniform_in(-1.0, 1.0))));
        vec![mesh_of(&l), mesh_of(&ring.collect::<Vec<_>>()), mesh_of(&ball), mesh_of(&soup.collect::<Vec<_>>())]
    }

    #[test]
    fn nothing_of_a_mesh_sticks_out_of_its_cover() {
        let mut rng = rng::stream(1, 0);
        for body in bodies(&mut rng) {
            for most in [1, 2, 6] {
                let (_, cover) = as_mesh(&body).covering(most).unwrap();
                assert!((1..=most).contains(&cover.len()));
                for i in 0..as_mesh(&body).faces().len() {
                    let [a, b, c] = as_mesh(&body).triangle(i);
                    for _ in 0..20 {
                        let (mut s, mut t) = (rng.uniform(), rng.uniform());
                        if s + t > 1.0 {
                            (s, t) = (1.0 - s, 1.0 - t);
                        }
                        assert!(is_held(&cover, &(a + s * (b - a) + t * (c - a))));
                    }
                }
                // Points inside the mesh must be covered too.
                for _ in 0..2000 {
                    let point = Vector3::from_fn(|_, _| rng.uniform_in(-0.6, 0.6));
                    assert!(!as_mesh(&body).encloses(&point) || is_held(&cover, &point), "{point}");
                }
            }
        }
    }

    fn is_held(cover: &[Shape], point: &Vector3<f64>) -> bool {
        cover.iter().any(|shape| shape.geometry().tangent(point).value <= 0.0)
    }

    #[test]
    fn no_point_of_a_cover_is_farther_than_stated() {
        let mut rng = rng::stream(2, 0);
        for body in bodies(&mut rng) {
            let cover = as_mesh(&body).cover(4).unwrap();
            let mut farthest = 0.0_f64;
            for _ in 0..20_000 {
                let ball = body.bounding_ball();
                let point = Vector3::from_fn(|k, _| ball.center[k] + 1.2 * rng.uniform_in(-ball.radius, ball.radius));
                if is_held(&cover.shapes, &point) {
                    farthest = farthest.max(as_mesh(&body).tangent(&point).value);
                }
            }
            assert!(farthest <= cover.largest_distance, "{farthest} {}", cover.largest_distance);
            assert!(farthest > 0.5 * cover.largest_distance, "{farthest} {}", cover.largest_distance);
        }
    }

    #[test]
    fn a_needle_of_extreme_length_has_a_cover() {
        let needle = |length: f64| mesh_of(&[[[0.0; 3], [length, 0.0, 0.0], [0.0, 1e-3, 1e-4]]]);
        // Termination is all that is required here.
        let _ = as_mesh(&needle(1e300)).cover(4);
        let cover = as_mesh(&needle(1e30)).cover(4).unwrap();
        assert!(cover.largest_distance >= 4e-4 && cover.largest_distance.is_finite(), "{}", cover.largest_distance);
    }

    #[test]
    fn more_capsules_fit_closer() {
        let mut rng = rng::stream(3, 0);
        let body = &bodies(&mut rng)[0];
        let [one, two, six] = [1, 2, 6].map(|most| as_mesh(body).cover(most).unwrap());
        assert!(two.volume_ratio < 0.7 * one.volume_ratio && six.volume_ratio < two.volume_ratio);
        assert!(six.largest_distance < one.largest_distance);
        let ball = as_mesh(&bodies(&mut rng)[2]).cover(6).unwrap();
        assert_eq!(ball.shapes.len(), 1);
        assert!((1.0..1.1).contains(&ball.volume_ratio), "{}", ball.volume_ratio);
        assert_eq!(as_mesh(body).cover(6).unwrap(), six);
    }
}
