//! Random generators, constructed only here: repeatable from (seed, stream), and built at the first draw, since most targets
//! are solved without one.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Number of draws made together, at a quarter of the cost of single draws.
const BUFFER: usize = 64;

/// Random generator that is built at its first draw. Equal (seed, stream) give equal draws on every platform.
#[derive(Debug, Clone)]
pub struct LazyRng {
    seed: u64,
    stream: u64,
    source: Option<Box<Source>>,
}

#[derive(Debug, Clone)]
struct Source {
    generator: ChaCha8Rng,
    uniforms: [f64; BUFFER],
    next: usize,
}

impl Source {
    fn of_stream(seed: u64, stream: u64) -> Box<Self> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Box::new(Self { generator, uniforms: [0.0; BUFFER], next: BUFFER })
    }
}

/// Returns the generator of item `index` of a job with this `seed`; items are independent of each other.
pub fn stream(seed: u64, index: u64) -> LazyRng {
    LazyRng { seed, stream: index, source: None }
}

/// Splits a draw into two independent uniforms in [0, 1), of 26 and 27 bits.
#[inline]
pub fn split(uniform: f64) -> [f64; 2] {
    const HALF: f64 = (1_u64 << 26) as f64;
    const ROUNDER: f64 = (1_u64 << 52) as f64;
    let scaled = HALF * uniform;
    // Adding 2^52 rounds to an integer, which is then corrected downwards. Casts would prevent vectorisation of loops over
    // it.
    let rounded = (scaled + ROUNDER) - ROUNDER;
    let whole = if rounded > scaled { rounded - 1.0 } else { rounded };
    [whole * (1.0 / HALF), scaled - whole]
}

impl LazyRng {
    /// The same generator, whose first draw allocates nothing.
    pub(crate) fn prepared(mut self) -> Self {
        self.source.get_or_insert_with(|| Source::of_stream(self.seed, self.stream));
        self
    }

    /// Draws uniformly from [0, 1).
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
        let source = self.source.get_or_insert_with(|| Source::of_stream(self.seed, self.stream));
        let mut bytes = [0; 8 * BUFFER];
        source.generator.fill_bytes(&mut bytes);
        for (uniform, bytes) in source.uniforms.iter_mut().zip(bytes.as_chunks().0) {
            // The upper 53 bits, converted here so that no library update can change the numbers.
            *uniform = (u64::from_le_bytes(*bytes) >> 11) as f64 / (1_u64 << 53) as f64;
        }
        source.next = 1;
        source.uniforms[0]
    }

    /// Draws uniformly from [lower, upper); both must be finite.
    pub fn uniform_in(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * self.uniform()
    }

    /// Fills `b` with uniform draws from [-1, 1).
    pub fn symmetric(&mut self, b: &mut [f64]) {
        self.draw(b, |v, uniform| *v = 2.0 * uniform - 1.0);
    }

    /// Returns two independent uniforms in [0, 1) from one draw: 26 bits for the first, 27 for the second. Enough for
    /// weights, at half the cost.
    #[inline]
    fn uniform_pair(&mut self) -> [f64; 2] {
        split(self.uniform())
    }

    /// Draws an integer below `count`, which is at least 1 and fits into 32 bits.
    #[inline]
    pub fn below(&mut self, count: usize) -> usize {
        (count as f64 * self.uniform()) as i64 as usize
    }

    /// Draws two integers below `count` from one draw.
    #[inline]
    pub fn pair_below(&mut self, count: usize) -> [usize; 2] {
        self.uniform_pair().map(|u| (count as f64 * u) as i64 as usize)
    }

    /// Fills `out` with uniform draws, in order.
    pub fn fill(&mut self, mut out: &mut [f64]) {
        while let Some((first, rest)) = out.split_first_mut() {
            *first = self.uniform();
            let Some(source) = &mut self.source else { return };
            let count = rest.len().min(BUFFER - source.next);
            let (copied, later) = rest.split_at_mut(count);
            copied.copy_from_slice(&source.uniforms[source.next..source.next + count]);
            source.next += count;
            out = later;
        }
    }

    /// Returns two independent draws from a normal distribution with mean 0 and standard deviation 1 (Box and Muller 1958).
    pub fn normal_pair(&mut self) -> [f64; 2] {
        // 1 - u is in (0, 1], so its logarithm is finite.
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        let (sine, cosine) = (std::f64::consts::TAU * self.uniform()).sin_cos();
        [radius * cosine, radius * sine]
    }

    /// Fills `b` with a unit vector: entries uniform in [-1, 1), then normalised.
    pub fn direction(&mut self, b: &mut [f64]) {
        let mut squared = 0.0;
        // Redraw a vector of almost zero length, which has no direction.
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

    /// Calls `set` with each entry of `out` and a draw, in order; reads directly from the buffer if it holds enough.
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
    fn pairs_are_uniform_and_independent() {
        let mut rng = stream(1, 0);
        let pairs: Vec<_> = (0..4000).map(|_| rng.uniform_pair()).collect();
        let mean = |value: fn(&[f64; 2]) -> f64| pairs.iter().map(value).sum::<f64>() / pairs.len() as f64;
        assert!(pairs.iter().flatten().all(|u| (0.0..1.0).contains(u)));
        let ends = [0.0, 0.5, 1.0 - f64::EPSILON / 2.0, 1.5 / (1_u64 << 26) as f64].map(split);
        let last = 1.0 / (1_u64 << 26) as f64;
        assert_eq!(ends, [[0.0, 0.0], [0.5, 0.0], [1.0 - last, 1.0 - last / 2.0], [last, 0.5]]);
        // Four standard deviations of a mean of 4000 draws: 0.018 for a uniform, 0.014 for the product of two.
        assert!((mean(|pair| pair[0]) - 0.5).abs() < 0.018 && (mean(|pair| pair[1]) - 0.5).abs() < 0.018);
        assert!((mean(|pair| pair[0] * pair[1]) - 0.25).abs() < 0.014);
    }

    #[test]
    fn normal_draws_have_their_moments() {
        let mut rng = stream(2, 0);
        let draws: Vec<f64> = (0..2000).flat_map(|_| rng.normal_pair()).collect();
        let moment = |power| draws.iter().map(|z: &f64| z.powi(power)).sum::<f64>() / draws.len() as f64;
        // Four standard deviations: sqrt(1, 2, 15, 96) / sqrt(4000) each.
        assert!(moment(1).abs() < 0.064 && (moment(2) - 1.0).abs() < 0.09, "{} {}", moment(1), moment(2));
        assert!(moment(3).abs() < 0.25 && (moment(4) - 3.0).abs() < 0.62, "{} {}", moment(3), moment(4));
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
