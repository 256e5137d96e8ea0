//! Test arms with seven joints: rows (a, alpha, d, theta) of standard Denavit-Hartenberg tables.

use std::f64::consts::{FRAC_PI_2 as Q, PI};

use crate::rng;

pub const PANDA: [[f64; 4]; 7] = [
    [0.0, -Q, 0.333, 0.0],
    [0.0, Q, 0.0, 0.0],
    [0.0825, Q, 0.316, 0.0],
    [-0.0825, -Q, 0.0, 0.0],
    [0.0, Q, 0.384, 0.0],
    [0.088, Q, 0.0, 0.0],
    [0.0, 0.0, 0.107, 0.0],
];
pub const IIWA14: [[f64; 4]; 7] = [
    [0.0, -Q, 0.36, 0.0],
    [0.0, Q, 0.0, 0.0],
    [0.0, Q, 0.42, 0.0],
    [0.0, -Q, 0.0, 0.0],
    [0.0, -Q, 0.4, 0.0],
    [0.0, Q, 0.0, 0.0],
    [0.0, 0.0, 0.126, 0.0],
];
pub const GEN3: [[f64; 4]; 7] = [
    [0.0, Q, -0.2848, 0.0],
    [0.0, Q, -0.0118, PI],
    [0.0, Q, -0.4208, PI],
    [0.0, Q, -0.0128, PI],
    [0.0, Q, -0.3143, PI],
    [0.0, Q, 0.0, PI],
    [0.0, PI, -0.1674, PI],
];
pub const XARM7: [[f64; 4]; 7] = [
    [0.0, -Q, 0.267, 0.0],
    [0.0, Q, 0.0, 0.0],
    [0.0525, Q, 0.293, 0.0],
    [0.0775, Q, 0.0, 0.0],
    [0.0, Q, 0.3425, 0.0],
    [0.076, -Q, 0.0, 0.0],
    [0.0, 0.0, 0.097, 0.0],
];
pub const SAWYER: [[f64; 4]; 7] = [
    [0.081, -Q, 0.317, 0.0],
    [0.0, Q, 0.1925, Q],
    [0.0, -Q, 0.4, 0.0],
    [0.0, Q, -0.1685, 0.0],
    [0.0, -Q, 0.4, 0.0],
    [0.0, Q, 0.1366, 0.0],
    [0.0, 0.0, 0.13375, 0.0],
];
pub const BAXTER: [[f64; 4]; 7] = [
    [0.069, -Q, 0.27035, 0.0],
    [0.0, Q, 0.0, Q],
    [0.069, -Q, 0.36435, 0.0],
    [0.0, Q, 0.0, 0.0],
    [0.01, -Q, 0.37429, 0.0],
    [0.0, Q, 0.0, 0.0],
    [0.0, 0.0, 0.229525, 0.0],
];

/// Returns the arm of the public URDF, in which axes 1 and 2, and 3 and 4, miss each other by 0.436 mm.
pub fn iiwa14_of_urdf() -> [[f64; 4]; 7] {
    let mut rows = IIWA14;
    (rows[0][0], rows[2][0]) = (-0.00043624, 0.00043624);
    rows
}

pub fn random_angles(count: usize) -> Vec<[f64; 7]> {
    let mut rng = rng::stream(21, 0);
    (0..count).map(|_| std::array::from_fn(|_| rng.uniform_in(-PI, PI))).collect()
}
