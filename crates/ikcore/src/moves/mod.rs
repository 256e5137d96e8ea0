//! Programs of moves: joint moves, lines and arcs of the tip, waits, and blends between them.
//!
//! | file | what |
//! |---|---|
//! | `program` | [`Move`]s as data, and their checks |
//! | `around` | collisions and constraints on the way |
//! | `leg`, `corner`, `tool_path` | lines and arcs by their length, rounded corners, the path from stop to stop |
//! | `move_task` | task of the moves at their poses |
//! | `moving_tip` | tips, their tasks, and the joints that move them |
//! | `outline` | a program as stages from rest to rest |
//! | `follower` | joint positions along a path, by Newton's method and splines |
//! | `move_configurations` | configurations in which the tip meets a pose |
//! | `ladder_block`, `rung` | blocks of a program, and configurations at their starts |
//! | `ladder`, `climber` | configurations for the whole program, and words for where there are none |
//! | `run`, `joint_corner` | one joint path from stop to stop, corners beside joint moves rounded |
//! | `timing` | the fastest motion at the requested speed |
//! | `report` | what slows a move, and when |
//! | `assembly` | the motion of all steps |
//! | `program_planner` | the plan for one task |
//! | `moves_options`, `plan_moves` | [`plan_moves()`], the call: tasks that ask for more compete |

mod around;
mod assembly;
mod climber;
mod corner;
mod follower;
mod joint_corner;
mod ladder;
mod ladder_block;
mod leg;
mod move_configurations;
mod move_task;
mod moves_options;
mod moving_tip;
mod outline;
mod plan_moves;
mod program;
mod program_planner;
mod report;
mod run;
mod rung;
mod timing;
mod tool_path;

pub use moves_options::MovesOptions;
pub use plan_moves::plan_moves;
pub use program::{JointGoal, Move, MoveKind};
