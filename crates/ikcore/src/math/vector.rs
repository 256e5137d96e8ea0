//! Products and norms of vectors of any length. Hot code with three-vectors uses [`so3`](super::so3).

/// Returns the dot product a'b.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the Euclidean norm |v|.
#[inline]
pub fn norm(v: &[f64]) -> f64 {
    dot(v, v).sqrt()
}

/// Returns |a - b|^2.
#[inline]
pub fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// Returns the Euclidean distance |a - b|.
#[inline]
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    squared_distance(a, b).sqrt()
}

/// Returns the largest absolute difference of two entries.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Writes q + fraction * (end - q), clamped so that rounding cannot take it beyond `end`.
pub fn between(q: &[f64], end: &[f64], fraction: f64, out: &mut [f64]) {
    for (out, (q, end)) in out.iter_mut().zip(q.iter().zip(end)) {
        *out = (q + fraction * (end - q)).clamp(q.min(*end), q.max(*end));
    }
}

/// Returns the squared Frobenius norm of all columns. Each row has its own sum, so that additions do not wait for one
/// another.
#[inline]
pub fn squared_size<const R: usize>(columns: &[[f64; R]]) -> f64 {
    let mut rows = [0.0; R];
    for column in columns {
        (0..R).for_each(|k| rows[k] += column[k] * column[k]);
    }
    rows.iter().sum()
}

/// Returns the median of three numbers.
#[inline]
pub fn median(a: f64, b: f64, c: f64) -> f64 {
    a.max(b).min(a.min(b).max(c))
}
