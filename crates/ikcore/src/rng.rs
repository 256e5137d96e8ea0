//! The only place where random generators are born: repeatable from (seed, stream), and lazily, since most targets
//! are solved without a draw.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Numbers drawn at once; a quarter of the cost of single draws.
const BUFFER: usize = 64;

/// A generator that is built at its first draw. Equal (seed, stream) give equal draws on every platform.
#[derive(Debug, Clone)]
pub struct LazyRng {
    seed: u64,
    stream: u64,
    source: Option<Source>,
}

#[derive(Debug, Clone)]
struct Source {
    generator: ChaCha8Rng,
    uniforms: [f64; BUFFER],
    next: usize,
}

/// The generator of item `index` of a job with this `seed`; items are independent of each other.
pub fn stream(seed: u64, index: u64) -> LazyRng {
    LazyRng { seed, stream: index, source: None }
}

impl LazyRng {
    /// Uniform in [0, 1).
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        match &mut self.source {
            Some(source) if source.next < BUFFER => {
                source.next += 1;
                source.uniforms[source.next - 1]
            }
            _ => self.refill(),
        }
    }

    #[cold]
    fn refill(&mut self) -> f64 {
        let source = self.source.get_or_insert_with(|| {
            let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
            generator.set_stream(self.stream);
            Source { generator, uniforms: [0.0; BUFFER], next: BUFFER }
        });
        let mut bytes = [0; 8 * BUFFER];
        source.generator.fill_bytes(&mut bytes);
        for (uniform, bytes) in source.uniforms.iter_mut().zip(bytes.as_chunks().0) {
            // The upper 53 bits: our own conversion, so that no library update can change the numbers.
            *uniform = (u64::from_le_bytes(*bytes) >> 11) as f64 / (1_u64 << 53) as f64;
        }
        source.next = 1;
        source.uniforms[0]
    }

    /// Uniform in [lower, upper); both finite.
    pub fn uniform_in(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * self.uniform()
    }

    /// Entries uniform in [-1, 1).
    pub fn symmetric(&mut self, b: &mut [f64]) {
        self.draw(b, |v, uniform| *v = 2.0 * uniform - 1.0);
    }

    /// A Gaussian draw of mean zero and unit deviation (Box and Muller 1958).
    pub fn gaussian(&mut self) -> f64 {
        // 1 - uniform lies in (0, 1], which has a logarithm.
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// A vector of unit length: entries uniform in [-1, 1), then normalised.
    pub fn direction(&mut self, b: &mut [f64]) {
        let mut squared = 0.0;
        // A draw of almost zero length has no direction.
        while squared < 1e-12 {
            squared = 0.0;
            self.draw(b, |v, uniform| {
                *v = 2.0 * uniform - 1.0;
                squared += *v * *v;
            });
        }
        let scale = 1.0 / squared.sqrt();
        b.iter_mut().for_each(|v| *v *= scale);
    }

    /// Hands every entry of `out` a draw of its own, in order; straight from the buffer where that has enough.
    #[inline]
    fn draw(&mut self, out: &mut [f64], mut set: impl FnMut(&mut f64, f64)) {
        match &mut self.source {
            Some(source) if source.next + out.len() <= BUFFER => {
                let drawn = &source.uniforms[source.next..source.next + out.len()];
                out.iter_mut().zip(drawn).for_each(|(v, uniform)| set(v, *uniform));
                source.next += out.len();
            }
            _ => out.iter_mut().for_each(|v| set(v, self.uniform())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_frozen() {
        let mut rng = stream(7, 3);
        let drawn: Vec<f64> = (0..3).map(|_| rng.uniform()).collect();
        assert_eq!(drawn, [0.18154186395125538, 0.09286437521737823, 0.9790049704535125]);
    }

    #[test]
    fn streams_differ_and_repeat() {
        let draw = |seed, index| stream(seed, index).uniform();
        assert_eq!(draw(1, 2), draw(1, 2));
        assert_ne!(draw(1, 2), draw(1, 3));
        assert_ne!(draw(1, 2), draw(2, 2));
    }

    #[test]
    fn gaussian_draws_have_zero_mean_and_unit_deviation() {
        let mut rng = stream(1, 0);
        let draws: Vec<f64> = (0..4000).map(|_| rng.gaussian()).collect();
        let mean = draws.iter().sum::<f64>() / 4000.0;
        let variance = draws.iter().map(|v| v * v).sum::<f64>() / 4000.0;
        let beyond = draws.iter().filter(|v| v.abs() > 1.96).count();
        assert!(mean.abs() < 0.06 && (variance - 1.0).abs() < 0.09 && (150..250).contains(&beyond), "{mean} {variance} {beyond}");
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
