//! The only place where random generators are born: repeatable from (seed, stream), and lazily, since most targets
//! are solved without a draw.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A generator that is built at its first draw. Equal (seed, stream) give equal draws on every platform.
#[derive(Debug, Clone)]
pub struct LazyRng {
    seed: u64,
    stream: u64,
    generator: Option<ChaCha8Rng>,
}

/// The generator of item `index` of a job with this `seed`; items are independent of each other.
pub fn stream(seed: u64, index: u64) -> LazyRng {
    LazyRng { seed, stream: index, generator: None }
}

impl LazyRng {
    /// Uniform in [0, 1): the upper 53 bits of a draw, so that no library update can change the numbers.
    pub fn uniform(&mut self) -> f64 {
        const SCALE: f64 = 1.0 / (1_u64 << 53) as f64;
        let generator = self.generator.get_or_insert_with(|| {
            let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
            generator.set_stream(self.stream);
            generator
        });
        (generator.next_u64() >> 11) as f64 * SCALE
    }

    /// Uniform in [lower, upper); both finite.
    pub fn uniform_in(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * self.uniform()
    }

    /// A vector of unit length: entries uniform in [-1, 1), then normalised.
    pub fn direction(&mut self, b: &mut [f64]) {
        let mut squared = 0.0;
        // A draw of almost zero length has no direction.
        while squared < 1e-12 {
            b.iter_mut().for_each(|v| *v = 2.0 * self.uniform() - 1.0);
            squared = b.iter().map(|v| v * v).sum::<f64>();
        }
        let scale = 1.0 / squared.sqrt();
        b.iter_mut().for_each(|v| *v *= scale);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_frozen() {
        let mut rng = stream(7, 3);
        let drawn: Vec<f64> = (0..3).map(|_| rng.uniform()).collect();
        assert_eq!(drawn, [0.0, 0.0, 0.0]);
    }

    #[test]
    fn streams_differ_and_repeat() {
        let draw = |seed, index| stream(seed, index).uniform();
        assert_eq!(draw(1, 2), draw(1, 2));
        assert_ne!(draw(1, 2), draw(1, 3));
        assert_ne!(draw(1, 2), draw(2, 2));
    }

    #[test]
    fn directions_have_unit_length_and_no_bias() {
        let mut rng = stream(0, 0);
        let mut sum = [0.0; 3];
        for _ in 0..4000 {
            let mut b = [0.0; 3];
            rng.direction(&mut b);
            assert!((b.iter().map(|v| v * v).sum::<f64>() - 1.0).abs() < 1e-14);
            (0..3).for_each(|k| sum[k] += b[k]);
        }
        assert!(sum.iter().all(|s| s.abs() < 4.0 * (4000.0_f64 / 3.0).sqrt()), "{sum:?}");
    }
}
