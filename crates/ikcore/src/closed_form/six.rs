//! Six joints: selects the method once, and returns all branches for a pose.

use std::f64::consts::{PI, TAU};
use std::fmt;

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::axis_chain::{AxisChain, AxisKind, JointAxis};
use crate::closed_form::branches::{Branches, Candidates, Doubt};
use crate::closed_form::configurations::{ArmConfigurations, Drives};
use crate::closed_form::general::General;
use crate::closed_form::spherical_wrist::SphericalWrist;
use crate::closed_form::structure::{EXACT, NEARLY, are_sharp, three_meet, three_parallel};
use crate::closed_form::three_parallel::ThreeParallel;
use crate::closed_form::verify::{Verifier, verified, write_values};
use crate::math::Frame;
use crate::math::arithmetic::{Baseline, by_instructions};

/// Structure of a six-joint chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Structure {
    /// Axes `first` to `first` + 2, counted from 1, meet in one point.
    ThreeMeet {
        /// First of the three axes.
        first: usize,
        /// True if the axes meet only approximately.
        nearly: bool,
    },
    /// Axes `first` to `first` + 2, counted from 1, are parallel.
    ThreeParallel {
        /// First of the three axes.
        first: usize,
        /// True if the axes are parallel only approximately.
        nearly: bool,
    },
    /// General geometry: up to sixteen solutions.
    General,
    /// Some joints are prismatic, and no method fits.
    Unsolved,
}

impl Structure {
    /// Whether the structure is exact: all candidates are solutions up to rounding, and a pose has no others. The general method
    /// proves no such thing: it counts zeros of a polynomial, and rounding may hide some.
    pub fn is_exact(self) -> bool {
        matches!(self, Self::ThreeMeet { nearly: false, .. } | Self::ThreeParallel { nearly: false, .. })
    }

    /// Whether the structure holds only approximately, so that its method gives starting points.
    pub fn is_nearly(self) -> bool {
        matches!(self, Self::ThreeMeet { nearly: true, .. } | Self::ThreeParallel { nearly: true, .. })
    }
}

impl fmt::Display for Structure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let nearly = |nearly: &bool| if *nearly { "nearly " } else { "" };
        let proven = |nearly: &bool| if *nearly { "at most 16 solutions" } else { "at most 8 solutions" };
        match self {
            Self::ThreeMeet { first: 4, nearly: n } => write!(f, "{}spherical wrist; {}", nearly(n), proven(n)),
            Self::ThreeMeet { first: 1, nearly: n } => write!(f, "{}spherical shoulder; {}", nearly(n), proven(n)),
            Self::ThreeMeet { first, nearly: n } => {
                write!(f, "axes {first} to {} {}meet; {}", first + 2, nearly(n), proven(n))
            }
            Self::ThreeParallel { first, nearly: n } => {
                write!(f, "axes {first} to {} {}parallel; {}", first + 2, nearly(n), proven(n))
            }
            Self::General => write!(f, "general; at most 16 solutions"),
            Self::Unsolved => write!(f, "no closed form"),
        }
    }
}

/// Closed form of a six-joint chain.
#[derive(Debug, Clone)]
pub struct ClosedForm {
    chain: AxisChain<6>,
    structure: Structure,
    method: Method,
    verifier: Verifier<6>,
    back: Frame,
    size: f64,
    /// General method, used in addition where the structure holds only approximately: that structure loses solutions near
    /// folds of the elbow.
    further: Option<Box<[General; 2]>>,
}

#[derive(Debug, Clone)]
#[allow(clippy::large_enum_variant)]
enum Method {
    Spherical(SphericalWrist),
    Parallel(ThreeParallel),
    /// Opens the loop after joint `at` for every pose, and looks for the structure there.
    Opened {
        at: usize,
        tolerance: f64,
    },
    /// Both directions of the general method, the better one first.
    General(Box<[General; 2]>),
    None,
}

impl ClosedForm {
    /// Selects the method from the geometry of the chain.
    pub fn new(chain: &AxisChain<6>) -> Self {
        let mut form = Self::structured(chain);
        if form.structure.is_nearly() && chain.joints.iter().all(|joint| joint.motion == AxisKind::Turns) {
            let ways = general_ways(&chain.joints, form.size);
            form.further = Some(form.ordered(ways));
        }
        form
    }

    /// Selects the method by structure alone: faster, but incomplete where the structure holds only approximately.
    pub fn structured(chain: &AxisChain<6>) -> Self {
        let size = chain.size();
        let (structure, method) = decide(&chain.joints, size);
        let worth_polishing = if structure.is_nearly() { 30.0 * NEARLY * size.max(1.0) } else { 1e-3 };
        let verifier = Verifier::new(chain, worth_polishing);
        let back = chain.tip.inverse();
        let mut form = Self { chain: *chain, structure, method, verifier, back, size, further: None };
        if !matches!(structure, Structure::General | Structure::Unsolved) && !form.finds_samples() {
            // Degenerate chains, for example with coincident axes, defeat the method of a structure: test it first.
            let turning = chain.joints.iter().all(|joint| joint.motion == AxisKind::Turns);
            (form.structure, form.method) =
                if turning { general(&chain.joints, size) } else { (Structure::Unsolved, Method::None) };
        }
        form.method = match std::mem::replace(&mut form.method, Method::None) {
            Method::General(ways) => Method::General(form.ordered(ways)),
            method => method,
        };
        form
    }

    /// Whether the method reproduces a set of evenly spread configurations.
    fn finds_samples(&self) -> bool {
        samples().all(|q| {
            let found = self.solve(&self.chain.tip_at(&q));
            let near = |set: &[f64; 6]| set.iter().zip(&q).all(|(a, b)| (Angle::by(a - b).cos - 1.0).abs() < 1e-6);
            found.iter().any(near) || found.singular && !found.is_empty()
        })
    }

    /// Sorts the two directions of the general method, the better one first.
    fn ordered(&self, mut ways: Box<[General; 2]>) -> Box<[General; 2]> {
        let [first, second] = [0, 1].map(|way| self.trouble(&ways[way]));
        if second < first {
            ways.swap(0, 1);
        }
        ways
    }

    /// Counts the sample poses for which one direction of the general method is inconclusive.
    fn trouble(&self, way: &General) -> usize {
        let mut trouble = 0;
        for q in samples() {
            let target = self.chain.tip_at(&q);
            let mut found = Branches::none();
            let count = way.solve(&target.then::<Baseline>(&self.back), |candidate| {
                self.verifier.add(&target, &candidate, &mut found);
            });
            let proven = count.sound && found.len() >= count.zeros;
            trouble += count.shared + 4 * usize::from(!proven);
        }
        trouble
    }

    /// Returns the structure that the method relies on.
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// Returns all joint angles, in (-pi, pi], that bring the tip to `target`.
    #[inline]
    pub fn solve(&self, target: &Frame) -> Branches<6> {
        self.solve_displacement(&target.then::<Baseline>(&self.back), target)
    }

    /// Returns all joint angles for a known displacement `goal` of the tip from the zero configuration to `target`.
    #[inline]
    pub fn solve_displacement(&self, goal: &Frame, target: &Frame) -> Branches<6> {
        if let Method::General(ways) = &self.method {
            return self.solve_general(ways, goal, target, Branches::none());
        }
        let mut candidates = Candidates::new();
        self.add_candidates(goal, &[AngleRange::ANY; 6], &mut candidates);
        let mut found = verified(&self.verifier, target, &candidates);
        if !self.structure.is_exact() {
            found.doubt = Doubt::Anywhere;
        }
        match &self.further {
            Some(ways) => self.solve_general(ways, goal, target, found),
            None => found,
        }
    }

    /// Adds candidates that displace the tip by `goal`, as far as `ranges` may hold them. Adds none for the general method,
    /// whose candidates exist only verified.
    #[inline]
    pub fn add_candidates(&self, goal: &Frame, ranges: &[AngleRange; 6], candidates: &mut Candidates) {
        match &self.method {
            Method::Spherical(method) => spherical_candidates(method, goal, ranges, candidates),
            Method::Parallel(method) => parallel_candidates(method, goal, candidates),
            Method::Opened { at, tolerance } => self.solve_opened(goal, *at, *tolerance, candidates),
            Method::General(_) | Method::None => {}
        }
    }

    /// Finds joint values that bring the tip to `target`, to be confirmed by forward kinematics, or near it if the structure
    /// holds only approximately; none for the general method.
    #[inline]
    pub fn likely(&self, target: &Frame, drives: &Drives, found: &mut ArmConfigurations) {
        let mut candidates = Candidates::new();
        self.add_candidates(&target.then::<Baseline>(&self.back), &[AngleRange::ANY; 6], &mut candidates);
        found.replace(drives, candidates.count, |columns| write_values(&self.verifier, &candidates, columns));
        found.is_all = self.structure.is_exact() && candidates.doubt == Doubt::None && !candidates.singular;
    }

    /// Solves in one direction, and in the other too if the first may have missed a solution. A count with nearly coincident
    /// zeros is no proof.
    fn solve_general(&self, ways: &[General; 2], goal: &Frame, target: &Frame, mut found: Branches<6>) -> Branches<6> {
        for way in ways {
            let count = way.solve(goal, |candidate| self.verifier.add(target, &candidate, &mut found));
            // Zeros bound the number of branches: equal counts mean that none is missing.
            let is_all = count.sound && found.len() >= count.zeros;
            found.doubt = if is_all { Doubt::Nearby } else { Doubt::Anywhere };
            if is_all {
                return found;
            }
        }
        self.search_further(ways, goal, target, &mut found);
        found
    }

    /// Searches by Newton's method for branches that the zeros missed.
    #[cold]
    fn search_further(&self, ways: &[General; 2], goal: &Frame, target: &Frame, found: &mut Branches<6>) {
        for way in ways {
            way.spread(goal, |candidate| self.verifier.add(target, &candidate, found));
        }
    }

    /// Solves a structure found elsewhere in the loop that chain and pose close: opens the loop after `at` joints.
    fn solve_opened(&self, goal: &Frame, at: usize, tolerance: f64, candidates: &mut Candidates) {
        let joints = AxisChain::rotated(&self.chain.joints, goal, at);
        let mut turned = Candidates::new();
        // Axes that are not neighbours in the arm may meet or be parallel at this pose, exactly or nearly.
        if !are_sharp(&joints, self.size) {
            turned.doubt = Doubt::Anywhere;
        }
        match self.structure {
            Structure::ThreeMeet { .. } => match three_meet(&joints[3..], self.size, 4.0 * tolerance) {
                Some(centre) => {
                    let method = SphericalWrist::new(&joints, &centre, self.size, tolerance);
                    method.solve(goal, &[AngleRange::ANY; 6], &mut turned);
                }
                None => turned.doubt.add(Doubt::Anywhere),
            },
            _ => ThreeParallel::new(&joints, self.size, tolerance).solve::<Baseline>(goal, &mut turned),
        }
        candidates.singular |= turned.singular;
        candidates.doubt.add(turned.doubt);
        for place in 0..turned.count {
            // Joint `at` is the first of the opened loop.
            candidates.push_six(&std::array::from_fn(|k| {
                let k = (k + 6 - at) % 6;
                Angle { cos: turned.cos[k][place], sin: turned.sin[k][place] }
            }));
        }
    }
}

by_instructions! {
    fn spherical_candidates(
        method: &SphericalWrist,
        goal: &Frame,
        ranges: &[AngleRange; 6],
        candidates: &mut Candidates,
    ) {
        method.solve(goal, ranges, candidates);
    }
}

by_instructions! {
    fn parallel_candidates(method: &ThreeParallel, goal: &Frame, candidates: &mut Candidates) {
        method.solve::<A>(goal, candidates);
    }
}

fn decide(joints: &[JointAxis; 6], size: f64) -> (Structure, Method) {
    if joints.iter().any(|joint| joint.motion == AxisKind::Slides) {
        return decide_sliding(joints, size);
    }
    for tolerance in [EXACT, NEARLY] {
        let nearly = tolerance == NEARLY;
        for first in [4, 1, 2, 3] {
            let Some(centre) = three_meet(&joints[first - 1..first + 2], size, tolerance) else { continue };
            let method = match first {
                4 => Method::Spherical(SphericalWrist::new(joints, &centre, size, tolerance)),
                1 => Method::Spherical(SphericalWrist::shoulder(joints, &centre, size, tolerance)),
                // Loop opened after the three axes, which makes them the last.
                _ => Method::Opened { at: (first + 2) % 6, tolerance },
            };
            return (Structure::ThreeMeet { first, nearly }, method);
        }
        for first in [2, 3, 1, 4] {
            if !three_parallel(&joints[first - 1..first + 2], size, tolerance) {
                continue;
            }
            let method = match first {
                2 => Method::Parallel(ThreeParallel::new(joints, size, tolerance)),
                // Loop opened one joint before the three axes, which makes them the second to fourth.
                _ => Method::Opened { at: (first + 4) % 6, tolerance },
            };
            return (Structure::ThreeParallel { first, nearly }, method);
        }
    }
    general(joints, size)
}

fn general(joints: &[JointAxis; 6], size: f64) -> (Structure, Method) {
    (Structure::General, Method::General(general_ways(joints, size)))
}

fn general_ways(joints: &[JointAxis; 6], size: f64) -> Box<[General; 2]> {
    Box::new([General::new(joints, size), General::reversed(joints, size)])
}

/// Returns a few evenly spread configurations: multiples of irrational numbers, as turns.
pub fn samples() -> impl Iterator<Item = [f64; 6]> {
    let roots = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0_f64].map(f64::sqrt);
    (1..=8).map(move |sample| roots.map(|root| TAU * (f64::from(sample) * root).fract() - PI))
}

/// Selects the method for arms with prismatic joints, which need a spherical wrist.
fn decide_sliding(joints: &[JointAxis; 6], size: f64) -> (Structure, Method) {
    let wrist = &joints[3..];
    if wrist.iter().all(|joint| joint.motion == AxisKind::Turns) {
        for tolerance in [EXACT, NEARLY] {
            let method = three_meet(wrist, size, tolerance)
                .and_then(|centre| SphericalWrist::sliding(joints, &centre, size, tolerance));
            if let Some(method) = method {
                let structure = Structure::ThreeMeet { first: 4, nearly: tolerance == NEARLY };
                return (structure, Method::Spherical(method));
            }
        }
    }
    (Structure::Unsolved, Method::None)
}
