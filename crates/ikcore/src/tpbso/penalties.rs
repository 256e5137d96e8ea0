//! Weights of the penalties in eq. (15) and (25), relative to the scale of the cost; the paper gives none.

/// lambda_1 of eq. (15), also needed in eq. (25): multiplies the ratio of an extreme to the limit it violates. Any
/// weight from 1 on keeps a search from trading a limit for cost.
pub(super) const BROKEN_LIMIT: f64 = 10.0;

/// lambda_2 of eq. (15).
pub(super) const NO_CONFIGURATION: f64 = 1e3;
