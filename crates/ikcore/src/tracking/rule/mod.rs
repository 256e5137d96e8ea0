//! Tick rules, which move a modelled arm by one tick inside a given box.
//!
//! | file | what |
//! |---|---|
//! | `tick_rule` | [`TickRule`]: choice of rule, and the running rule |
//! | `tick` | input and result of a rule |
//! | `mid_step` | the model-based rule, the default |
//! | `soft_step` | its step by the joints that cost least, whose weights do not make ticks overshoot |
//! | `goal_pursuit` | the model-based rule under acceleration and jerk limits |
//! | `approach` | proportional approach to a target that one tick cannot reach |
//! | `tip_step` | the model-based rule for several tips |
//! | `weighted_pseudo_inverse` | resolved-rate control |
//! | `any_solver` | any solver, started at the accepted configuration |

mod any_solver;
mod approach;
mod goal_pursuit;
mod joint_move;
mod mid_step;
mod soft_step;
mod tick;
mod tick_rule;
mod tip_step;
mod weighted_pseudo_inverse;

pub(super) use tick::{Tick, TickResult};
pub(super) use tick_rule::RunningRule;
pub use tick_rule::TickRule;
pub use weighted_pseudo_inverse::{Integrator, WeightedPseudoInverse};
