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

/// The number at `fraction` of the way from `from` to `to`.
#[inline]
pub fn between(from: f64, to: f64, fraction: f64) -> f64 {
    from + fraction * (to - from)
}

/// The point at `fraction` of the straight line.
#[inline]
pub fn point_between(from: &[f64], to: &[f64], fraction: f64) -> impl Iterator<Item = f64> {
    from.iter().zip(to).map(move |(from, to)| between(*from, *to, fraction))
}

/// Writes the point at `fraction` of the straight line.
#[inline]
pub fn write_between(from: &[f64], to: &[f64], fraction: f64, out: &mut [f64]) {
    out.iter_mut().zip(point_between(from, to, fraction)).for_each(|(out, value)| *out = value);
}

/// Writes the point at `fraction` of the straight line; rounding cannot take it beyond an end.
pub fn write_within(from: &[f64], to: &[f64], fraction: f64, out: &mut [f64]) {
    write_between(from, to, fraction, out);
    for (out, (from, to)) in out.iter_mut().zip(from.iter().zip(to)) {
        *out = out.clamp(from.min(*to), from.max(*to));
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
