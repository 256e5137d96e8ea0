//! Between solver and objective: counts, clips, checks, and keeps the best.

mod best;
mod budgeted;
mod derivatives;
mod halt;

pub use best::Best;
pub use budgeted::Evaluator;
pub use halt::Halt;
