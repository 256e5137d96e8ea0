//! Arms of three to five revolute joints whose first three carry the tip to a position: seeds for the nearest orientation there.
//!
//! A position takes three joints; the others are parameters. Where the second to fourth axis are parallel (`plane_joints`), as in
//! most small arms, the orientation depends on the sum of their turns and on the fifth joint alone (`turn_pair`): all optima follow
//! without a scan for a tip on the fifth axis, and with a scan of the fifth joint for another.
//!
//! Of other arms the fourth joint is scanned (`scan`), and for each of its values the first three follow in closed form, on all
//! branches (`solutions`). A branch that limits cut off so short that it lies between two values is found from its end, where one of
//! the first three joints is at a limit and the others follow (`given_turn`). The fifth joint turns the hand: its best value for the
//! orientation (`goal`) is known in closed form where the tip is on its axis. A tip near the axis is scanned as its nearest point
//! there, which is where the target's orientation would have it; elsewhere the scan begins with a few turns of the fifth joint.
//! Both alternate once. The seeds are the least angles along the scan, each moved to the vertex of the parabola through it and its
//! neighbours.

mod given_turn;
mod goal;
mod of_position;
mod plane_joints;
mod position_seeds;
mod scan;
mod solutions;
mod turn_pair;

pub(crate) use of_position::PositionArm;
pub(crate) use position_seeds::Seed;
pub(crate) use scan::SEEDS;
