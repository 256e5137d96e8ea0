//! How noisy a sensor is, as far as repeated measurements tell.

/// Steps are believed from this many noise levels on.
pub const ABOVE_NOISE: f64 = 3.0;

/// How far apart two measurements of the same command lie (m): the median of the last three that could tell, so that an
/// outlier counts for nothing.
#[derive(Debug, Default)]
pub struct Noise {
    repeats: [f64; 3],
    noted: usize,
    level: f64,
}

impl Noise {
    /// Two measurements of one command were `repeat` apart (m).
    pub fn note(&mut self, repeat: f64) {
        self.repeats[self.noted % 3] = repeat;
        self.noted += 1;
        let [a, b, c] = self.repeats;
        self.level = median(a, b, c) * std::f64::consts::FRAC_1_SQRT_2;
    }

    /// The noise of one measurement (m); zero until there is evidence.
    pub fn level(&self) -> f64 {
        self.level
    }

    /// How much of a surprise to learn from a step that moves the tip by `motion` (m).
    pub fn share(&self, motion: f64) -> f64 {
        let noise = ABOVE_NOISE * self.level();
        if noise == 0.0 { 1.0 } else { motion * motion / (motion * motion + noise * noise) }
    }
}

/// The middle one of three.
pub fn median(a: f64, b: f64, c: f64) -> f64 {
    a.max(b).min(a.min(b).max(c))
}
