//! Values that look like another unit: degrees where radians are due, millimetres where metres are due.
//!
//! A doubt is no error: the value is used as given, and an interface shows the [`UnitDoubt`]. The thresholds are beyond what
//! robots are and do, such as joints of several turns, long rails and targets out of reach:
//!
//! | value | looks like degrees or millimetres if |
//! |---|---|
//! | angle of a joint with limits | more than [`MANY_TURNS`] (3.5 turns) outside its range |
//! | angles of joints without limits | [typed in degrees](typed_in_degrees) |
//! | roll, pitch and yaw | roll or pitch beyond [`MANY_TURNS`], or typed in degrees |
//! | rotation vector | longer than eight turns, or typed in degrees |
//! | position limits of revolute joints | all beyond 15 rad and one beyond 30, or typed in degrees; not multiples of pi, and not +-50, 100, 200, 500 or 1000 |
//! | position limits of a MuJoCo model | those of two or more joints are all within 2 pi degrees: radians read as degrees |
//! | velocity limits of revolute joints | all of two or more beyond 60 rad/s; not one round number for all |
//! | twists and offsets of a Denavit-Hartenberg table | beyond two turns |
//! | position of a joint that slides | 22 m and 20 ranges outside its range, and inside it as millimetres |
//! | position of a target, a tool or an obstacle | 30 m and 30 reaches out of reach, and within reach as millimetres |
//! | size of a body that moves | 10 m and 20 reaches |
//! | reach of a robot, without its slides | 300 m |

mod angles;
mod doubt;
mod joints;
mod lengths;
mod limits;

pub use angles::{MANY_TURNS, of_dh_angles, of_rotation_vector, of_rpy, of_rpy_in_file, typed_in_degrees};
pub use doubt::{Unit, UnitDoubt};
pub use joints::of_configurations;
pub use lengths::{of_center_of_mass, of_obstacles, of_offset, of_position, of_sizes};
pub use limits::{of_converted_limits, of_limits, of_limits_of_call, of_tip_speed};
