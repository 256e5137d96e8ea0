//! Programs of moves: joint moves, lines and arcs of the tip, waits, and blends between them.
//!
//! | file | what |
//! |---|---|
//! | `program` | [`Move`]s as data, and their checks |
//! | `leg`, `corner`, `tool_path` | lines and arcs by their length, rounded corners, the path from stop to stop |
//! | `outline` | a program as steps from rest to rest |
//! | `follower` | joint positions along a path, by Newton's method and splines |
//! | `ladder` | configurations for the whole program |
//! | `timing` | the fastest motion at the speed asked for |
//! | `report` | what slows a move, and when |
//! | `assembly` | the motion of all steps |
//! | `plan_moves` | [`plan_moves()`], the call |

mod assembly;
mod corner;
mod follower;
mod ladder;
mod leg;
mod outline;
mod plan_moves;
mod program;
mod report;
mod timing;
mod tool_path;

pub use plan_moves::{MovesOptions, plan_moves};
pub use program::{JointGoal, Move, MoveKind};
