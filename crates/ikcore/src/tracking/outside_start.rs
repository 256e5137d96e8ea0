//! Start of a tracked arm outside its position limits, from where it is led inside.

use crate::limits::JointOutside;

/// Joints that began outside their limits.
#[derive(Debug)]
pub(super) struct OutsideStart {
    pub joints: Vec<JointOutside>,
}

impl OutsideStart {
    /// The start of an arm with these joints outside; `None` without any.
    pub fn new(joints: Vec<JointOutside>) -> Option<Box<Self>> {
        (!joints.is_empty()).then(|| Box::new(Self { joints }))
    }

    /// Whether all joints of `q` are inside the position limits of a tick.
    pub fn has_returned([floor, ceiling]: [&[f64]; 2], q: &[f64]) -> bool {
        q.iter().zip(floor.iter().zip(ceiling)).all(|(q, (floor, ceiling))| floor <= q && q <= ceiling)
    }
}
