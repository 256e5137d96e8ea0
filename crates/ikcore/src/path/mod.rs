//! stub
#![allow(missing_docs)]
use crate::math::Pose;
pub struct Reference {
    pub d: f64,
    pub p: Vec<[f64; 3]>,
}
impl Reference {
    pub fn dt(&self) -> f64 {
        self.d
    }
    pub fn len(&self) -> usize {
        self.p.len()
    }
    pub fn time(&self, i: usize) -> f64 {
        i as f64 * self.d
    }
    pub fn position(&self, i: usize) -> [f64; 3] {
        self.p[i]
    }
    pub fn pose(&self, _i: usize) -> Option<Pose> {
        None
    }
}
