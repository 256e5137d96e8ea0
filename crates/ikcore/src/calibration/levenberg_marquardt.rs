//! Levenberg-Marquardt on the normal equations of a calibration.

use super::estimate::Estimate;
use super::normal_equations::{NormalEquations, Weighing, cost};
use super::residual::Comparison;
use crate::error::Result;

/// Longest step that counts as none, in units of the prior.
const SMALL_STEP: f64 = 1e-10;
/// Relative decrease of the cost that ends the descent.
const SMALL_DECREASE: f64 = 1e-9;
/// Relative increase of the cost that is rounding.
const ROUNDING: f64 = 1e-12;
/// Damping at the start; the start is good, so that Gauss-Newton usually works.
const FIRST_DAMPING: f64 = 1e-6;
/// Damping beyond which no step helps.
const LAST_DAMPING: f64 = 1e8;

/// End of a descent.
#[derive(Debug, Clone)]
pub(super) struct Descent {
    pub estimate: Estimate,
    pub iterations: usize,
    pub converged: bool,
}

/// Descends from `start` by at most `most` steps. Scale 0 holds a parameter.
pub(super) fn descend(
    comparison: &Comparison<'_>,
    start: Estimate,
    weighing: &Weighing,
    scales: &[f64],
    most: usize,
) -> Result<Descent> {
    let mut here = start;
    let mut damping = FIRST_DAMPING;
    for iterations in 0..most {
        let system = NormalEquations::at(comparison, &here, weighing, scales)?;
        let Some((next, cost, step)) = accepted_step(comparison, &here, &system, weighing, scales, &mut damping)?
        else {
            return Ok(Descent { estimate: here, iterations, converged: true });
        };
        here = next;
        if step < SMALL_STEP || system.cost - cost <= SMALL_DECREASE * system.cost {
            return Ok(Descent { estimate: here, iterations: iterations + 1, converged: true });
        }
    }
    Ok(Descent { estimate: here, iterations: most, converged: false })
}

/// Finds a damping whose step lowers the cost: the estimate there, its cost and the largest entry of the step.
fn accepted_step(
    comparison: &Comparison<'_>,
    here: &Estimate,
    system: &NormalEquations,
    weighing: &Weighing,
    scales: &[f64],
    damping: &mut f64,
) -> Result<Option<(Estimate, f64, f64)>> {
    while *damping <= LAST_DAMPING {
        if let Some(factor) = system.decomposed(*damping) {
            let step = factor.solve(&-&system.gradient);
            let moved: Vec<f64> = step.iter().zip(scales).map(|(z, scale)| z * scale).collect();
            let next = here.stepped(&comparison.model.parameters, &moved);
            let found = cost(comparison, &next, weighing, scales)?;
            if found <= system.cost * (1.0 + ROUNDING) {
                *damping = (*damping * 0.1).max(1e-12);
                return Ok(Some((next, found, step.amax())));
            }
        }
        *damping *= 10.0;
    }
    Ok(None)
}
