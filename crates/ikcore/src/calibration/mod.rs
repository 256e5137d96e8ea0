//! Calibration: the arm as it is built, from measurements.
//!
//! | file | what |
//! |---|---|
//! | `measured`, `camera`, `landmark` | measurements |
//! | `parameters`, `estimate` | what may differ from the model, and by how much |
//! | `arm_model` | the arm as a function of joint angles and parameters, with derivatives |
//! | `residual` | predicted minus measured |
//! | `doubts` | measurements that cannot be right |
//! | `start`, `placement`, `board_pose` | closed forms for base, tool and camera |
//! | `normal_equations`, `levenberg_marquardt` | weighted least squares |
//! | `robust_fit` | noise and outliers |
//! | `statistics`, `identifiability` | certainty of the result |
//! | `suggestion` | further configurations that would tell most |
//! | `calibrate`, `result` | the call and its result |

mod arm_model;
mod board_pose;
mod calibrate;
mod camera;
mod doubts;
mod estimate;
mod identifiability;
mod landmark;
mod levenberg_marquardt;
mod measured;
mod normal_equations;
mod parameters;
mod placement;
mod residual;
mod result;
mod robust_fit;
mod start;
mod statistics;
mod suggestion;

pub use calibrate::{CalibrationOptions, calibrate};
pub use camera::PinholeCamera;
pub use identifiability::Identifiability;
pub use measured::{CameraPlace, Measured};
pub use parameters::Part;
pub use result::{Calibration, Findings, FittedParameter, RmsError, RowErrors};
pub use suggestion::SuggestionOptions;
