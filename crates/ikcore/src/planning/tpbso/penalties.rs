//! Weights of the penalties in eq. (15) and (25), in the scale of the cost: the paper gives none.

/// lambda_1 of eq. (15), and the weight that eq. (25) needs too: an extreme that breaks its limit counts this much for
/// every time that it reaches the limit. Any weight from 1 on keeps a search from trading a limit for cost.
pub(super) const BROKEN_LIMIT: f64 = 10.0;

/// lambda_2 of eq. (15).
pub(super) const NO_CONFIGURATION: f64 = 1e3;
