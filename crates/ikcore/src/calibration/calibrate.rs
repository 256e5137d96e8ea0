//! The call: from measurements to the arm as it is built.

use nalgebra::DMatrix;

use super::arm_model::{ArmModel, CameraFrames, FreeEnds};
use super::doubts::{check_configurations, check_lengths, still_joints};
use super::estimate::Estimate;
use super::identifiability::{Identifiability, identifiability};
use super::landmark::Landmark;
use super::measured::{CameraPlace, Measured};
use super::normal_equations::{NormalEquations, Weighing};
use super::parameters::{FitParameter, FittedParts, Part, Place, usual};
use super::placement::{outside_start, placed_ends};
use super::residual::Comparison;
use super::result::{Calibration, Findings, FittedParameter, RmsError, RowErrors};
use super::robust_fit::{NoiseModel, RobustFit, fitted};
use super::statistics::{Influence, covariance, influences};
use super::suggestion::{SuggestionOptions, suggested};
use crate::error::{Error, Result};
use crate::math::Pose;
use crate::rng::stream;
use crate::robot::Robot;

/// Options of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationOptions {
    /// Parts to fit. With a camera, base and tool mean the poses of camera and board.
    pub fit: Vec<Part>,
    /// Standard deviations of the noise of each measurement: lengths (m or pixels), angles (rad). Estimated from the residuals if not
    /// given.
    pub sigma: Option<Vec<[f64; 2]>>,
    /// Whether measurements that do not belong with the others are found and left out.
    pub robust: bool,
    /// Further configurations to suggest.
    pub suggestion: SuggestionOptions,
}

impl Default for CalibrationOptions {
    fn default() -> Self {
        Self { fit: Part::ALL.to_vec(), sigma: None, robust: true, suggestion: SuggestionOptions::default() }
    }
}

/// Initial estimate of the noise (m, rad).
const FIRST_NOISE: [f64; 2] = [1e-3, 1e-3];
/// Initial estimate of the noise in pixels.
const FIRST_PIXELS: f64 = 1.0;
/// Extra random measurements for the test of identifiability, beyond the number that the parameters need.
const ELSEWHERE: usize = 10;
/// Seed of these random measurements.
const SEED: u64 = 46;

/// Fits the geometry of a robot to measurements at `qs` (m, n) (rad, m), by weighted least squares.
///
/// # Errors
/// [`Error::InvalidMeasurement`] for measurements that cannot be right: too few, all alike, in millimetres or degrees, from a mirrored
/// frame; [`Error::WrongLength`], [`Error::NotFinite`] and [`Error::OutOfRange`] for impossible numbers; [`Error::SeveralTips`];
/// [`Error::Contradiction`] if nothing is to be fitted, and for joints that follow others by polynomials.
pub fn calibrate(robot: &Robot, qs: &[f64], measured: &Measured, options: &CalibrationOptions) -> Result<Calibration> {
    robot.require_one_tip("calibration")?;
    robot.require_linear_couplings("calibration")?;
    let parts = FittedParts::new(&options.fit)?;
    measured.check(robot, qs)?;
    options.suggestion.check(robot)?;
    check_sigma(measured, options.sigma.as_deref())?;
    check_configurations(robot, measured, qs)?;
    check_lengths(robot, measured, qs)?;
    let start = Setup::new(robot, qs, measured, &parts)?;
    let noise = NoiseModel { given: options.sigma.clone(), robust: options.robust };
    start.calibrated(robot, qs, &noise, &options.suggestion)
}

/// Model of the arm, begun near the optimum.
struct Setup<'a> {
    measured: &'a Measured,
    qs: &'a [f64],
    dof: usize,
    model: ArmModel,
    /// Robot whose base and tool are placed.
    placed: Robot,
}

impl<'a> Setup<'a> {
    fn new(robot: &Robot, qs: &'a [f64], measured: &'a Measured, parts: &FittedParts) -> Result<Self> {
        let free = free_ends(measured);
        let outside = outside_start(robot, qs, measured)?;
        let fits = [parts.has(Part::Base) && free.base > 0, parts.has(Part::Tool) && free.tool > 0];
        let placed = match &outside {
            Some(_) => robot.clone(),
            None => placed_ends(robot, qs, measured, fits)?,
        };
        let model = model_of(&placed, parts, free, outside, measured);
        if model.parameters.is_empty() {
            let problem = "nothing of what is to be fitted has an effect on these measurements: add link transforms or joint offsets";
            return Err(Error::Contradiction { problem: problem.into() });
        }
        Ok(Self { measured, qs, dof: robot.dof(), model, placed })
    }

    fn comparison(&self) -> Comparison<'_> {
        Comparison { model: &self.model, measured: self.measured, qs: self.qs, dof: self.dof }
    }

    fn nominal(&self) -> Estimate {
        let landmark = self.measured.landmark();
        Estimate { corrections: self.model.corrections(), offsets: vec![0.0; self.dof], landmark }
    }

    fn calibrated(
        &self,
        robot: &Robot,
        qs: &[f64],
        noise: &NoiseModel,
        suggestion: &SuggestionOptions,
    ) -> Result<Calibration> {
        let comparison = self.comparison();
        let all: Vec<f64> = self.model.parameters.iter().map(|parameter| parameter.usual).collect();
        let placements = self.model.parameters.iter().map(|parameter| self.model.is_placement(parameter));
        let ends: Vec<f64> = placements.zip(&all).map(|(of_end, usual)| if of_end { *usual } else { 0.0 }).collect();
        let first = match self.measured {
            Measured::Pixels { .. } => [FIRST_PIXELS, 1.0],
            _ => FIRST_NOISE,
        };
        // Base and tool first: few parameters, which no gross error bends.
        let placed = if ends.iter().any(|scale| *scale > 0.0) {
            fitted(&comparison, self.nominal(), noise, first, &ends)?
        } else {
            let unfitted = NoiseModel { given: noise.given.clone(), robust: false };
            fitted(&comparison, self.nominal(), &unfitted, first, &ends)?
        };
        let fit = if ends == all {
            placed.clone()
        } else {
            fitted(&comparison, placed.descent.estimate.clone(), noise, placed.scale, &all)?
        };
        self.require_enough(&comparison, &fit, &all)?;
        self.result(robot, qs, [&placed, &fit], &all, noise, suggestion)
    }

    /// Checks that there are as many equations as unknowns that matter.
    fn require_enough(&self, comparison: &Comparison<'_>, fit: &RobustFit, scales: &[f64]) -> Result<()> {
        let count = self.measured.count();
        let equations: usize = (0..count).map(|index| self.measured.rows(index)).sum();
        if equations >= scales.len() {
            return Ok(());
        }
        let possible = self.identifiability(comparison, fit, scales)?.possible;
        if equations >= possible {
            return Ok(());
        }
        let needed = (possible * count).div_ceil(equations);
        let problem = format!(
            "{count} measurements give {equations} equations for {possible} unknowns: measure {needed} configurations or more, twice as many if you can, or fit fewer parts"
        );
        Err(Error::InvalidMeasurement { problem: problem.into() })
    }

    fn identifiability(&self, comparison: &Comparison<'_>, fit: &RobustFit, scales: &[f64]) -> Result<Identifiability> {
        let configurations = self.measured.configurations();
        let each = (0..self.measured.count()).map(|index| self.measured.rows(index)).max().unwrap_or(1).max(1);
        let count = scales.len().div_ceil(each) + ELSEWHERE;
        let qs = self.placed.random_configurations(count * configurations, &mut stream(SEED, 0))?;
        let kind = self.measured.like(count);
        let weighing = Weighing { sigma: vec![fit.weighing.sigma[0]; count], weights: vec![1.0; count] };
        let anywhere = Comparison { model: &self.model, measured: &kind, qs: &qs, dof: self.dof };
        identifiability(comparison, (&anywhere, &weighing), &fit.descent.estimate, &fit.weighing, scales)
    }

    fn result(
        &self,
        robot: &Robot,
        qs: &[f64],
        [placed, fit]: [&RobustFit; 2],
        scales: &[f64],
        noise: &NoiseModel,
        suggestion: &SuggestionOptions,
    ) -> Result<Calibration> {
        let comparison = self.comparison();
        let estimate = &fit.descent.estimate;
        let system = NormalEquations::at(&comparison, estimate, &fit.weighing, scales)?;
        let covariance = covariance(&system).unwrap_or_else(|| DMatrix::identity(scales.len(), scales.len()));
        let after = influences(&comparison, estimate, &fit.weighing, scales, &covariance)?;
        let at = |estimate: &Estimate| influences(&comparison, estimate, &fit.weighing, scales, &covariance);
        let nominal =
            if self.model.outside(estimate).is_some() { &placed.descent.estimate } else { &self.given(robot) };
        let before = at(nominal)?;
        let used: Vec<usize> = (0..after.len()).filter(|index| fit.weighing.weights[*index] > 0.0).collect();
        let rms = |found: &[Influence], squares: fn(&Influence) -> [f64; 2]| self.rms(&used, found, squares);
        let errors = before.iter().zip(&after).map(|(before, after)| {
            let of = |one: &Influence| self.rms(&[0], std::slice::from_ref(one), |one| one.squares);
            RowErrors { before: of(before), after: of(after) }
        });
        let calibrated = self.model.robot(&self.placed, estimate)?;
        let (camera, board) = self.camera_and_board(estimate);
        let findings = Findings {
            camera,
            board,
            centre: match &estimate.landmark {
                Landmark::Centre(centre) => Some((*centre).into()),
                _ => None,
            },
            plane: match &estimate.landmark {
                Landmark::Plane { normal, height } => Some((normal.into_inner().into(), *height)),
                _ => None,
            },
            parameters: self.fitted_parameters(robot, &calibrated, estimate, &covariance),
            covariance: DMatrix::from_fn(scales.len(), scales.len(), |i, j| covariance[(i, j)] * scales[i] * scales[j]),
            before: rms(&before, |one| one.squares),
            placed: rms(&at(&placed.descent.estimate)?, |one| one.squares),
            after: rms(&after, |one| one.squares),
            held_out: rms(&after, |one| one.held_out),
            errors: errors.collect(),
            outliers: fit.outliers.clone(),
            noise: self.noise_of(fit, noise),
            excess: if noise.given.is_some() {
                fit.scale[0].max(if self.measured.has_rotations() { fit.scale[1] } else { 0.0 })
            } else {
                1.0
            },
            identifiability: self.identifiability(&comparison, fit, scales)?,
            still_joints: still_joints(robot, qs),
            iterations: placed.descent.iterations + fit.descent.iterations,
            converged: fit.descent.converged,
            in_pixels: matches!(self.measured, Measured::Pixels { .. }),
            suggested: suggested(
                &calibrated,
                &comparison,
                estimate,
                fit.weighing.sigma[0],
                scales,
                &covariance,
                suggestion,
            )?,
        };
        Ok(Calibration { robot: calibrated, findings })
    }

    /// The estimate of the robot as it was given.
    fn given(&self, robot: &Robot) -> Estimate {
        self.model.with_ends(&self.nominal(), [Some(*robot.base()), Some(*robot.tool())])
    }

    fn rms(&self, used: &[usize], found: &[Influence], squares: fn(&Influence) -> [f64; 2]) -> RmsError {
        let mean = |group: usize| {
            let sum: f64 = used.iter().map(|index| squares(&found[*index])[group]).sum();
            // Image points are counted one by one, other measurements as a whole.
            let count: usize = match self.measured {
                Measured::Pixels { .. } => used.iter().map(|index| found[*index].counts[0] / 2).sum(),
                _ => used.len(),
            };
            (sum / count as f64).sqrt()
        };
        RmsError { length: mean(0), rotation: if self.measured.has_rotations() { mean(1) } else { f64::NAN } }
    }

    fn noise_of(&self, fit: &RobustFit, noise: &NoiseModel) -> RmsError {
        let [length, rotation] = noise.given.as_ref().map_or(fit.scale, |given| given[0]);
        RmsError { length, rotation: if self.measured.has_rotations() { rotation } else { f64::NAN } }
    }

    /// Values relative to the robot as it was given.
    fn fitted_parameters(
        &self,
        robot: &Robot,
        calibrated: &Robot,
        estimate: &Estimate,
        covariance: &DMatrix<f64>,
    ) -> Vec<FittedParameter> {
        let relative = if self.model.outside(estimate).is_some() {
            estimate.clone()
        } else {
            let since = |given: &Pose, placed: &Pose, found: &Pose| Some(placed * (given.inverse() * found));
            let ends = [
                since(robot.base(), self.placed.base(), calibrated.base()),
                since(robot.tool(), self.placed.tool(), calibrated.tool()),
            ];
            self.model.with_ends(estimate, ends)
        };
        let values = relative.values(&self.model.parameters, &self.measured.landmark());
        let parameters = self.model.parameters.iter().zip(values).enumerate();
        parameters
            .map(|(k, (parameter, value))| FittedParameter {
                name: parameter.name.clone(),
                value,
                deviation: covariance[(k, k)].max(0.0).sqrt() * parameter.usual,
                is_angle: parameter.is_angle,
            })
            .collect()
    }

    /// Poses of camera and board in the frames of base and tip.
    fn camera_and_board(&self, estimate: &Estimate) -> (Option<Pose>, Option<Pose>) {
        let Some([before, after]) = self.model.outside(estimate) else { return (None, None) };
        let beside = Some(before.inverse());
        match self.measured.camera() {
            Some(CameraPlace::Hand) => (Some(after), beside),
            _ => (beside, Some(after)),
        }
    }
}

/// Directions of base and tool that have an effect on the measurements.
fn free_ends(measured: &Measured) -> FreeEnds {
    let base = match measured {
        // A centre or a plane takes the place of the base, and distances of pairs do not depend on it.
        Measured::BallBar { .. } | Measured::Heights { .. } | Measured::Pairs(_) => 0,
        _ => 6,
    };
    FreeEnds { base, tool: if measured.is_of_a_point() { 3 } else { 6 } }
}

fn model_of(
    robot: &Robot,
    parts: &FittedParts,
    free: FreeEnds,
    outside: Option<CameraFrames>,
    measured: &Measured,
) -> ArmModel {
    let mut model = ArmModel::new(robot, parts, free, outside);
    if parts.has(Part::Base) {
        let landmark = measured.landmark();
        let entries = landmark.parameters().iter().enumerate();
        model.parameters.extend(entries.map(|(entry, (name, is_angle))| FitParameter {
            name: (*name).into(),
            is_angle: *is_angle,
            usual: usual::PLACEMENT,
            place: Place::Landmark(entry),
        }));
    }
    model
}

/// Standard deviations (m, rad) whose inverse squares are numbers.
const SIGMAS: std::ops::RangeInclusive<f64> = 1e-100..=1e100;

/// Checks the noise that was given.
fn check_sigma(measured: &Measured, sigma: Option<&[[f64; 2]]>) -> Result<()> {
    let Some(sigma) = sigma else { return Ok(()) };
    if sigma.len() != measured.count() {
        let expected = format!("{}, one for each measurement", measured.count());
        return Err(Error::WrongLength { what: "standard deviations".into(), expected, got: sigma.len() });
    }
    let all = sigma.as_flattened().iter();
    let what = "standard deviation of a measurement";
    if let Some(value) = all.clone().find(|value| !(**value > 0.0 && value.is_finite())) {
        return Err(Error::out_of_range(what, "positive and finite", *value));
    }
    all.clone().find(|value| !SIGMAS.contains(value)).map_or(Ok(()), |value| {
        let expected = format!("from {:e} to {:e} (m, rad)", SIGMAS.start(), SIGMAS.end());
        Err(Error::out_of_range(what, &expected, *value))
    })
}
