//! OBJ reader: vertices and polygons; all other statements are ignored.

use super::parsed::{Parsed, Triangles, number};

pub(super) fn parse(text: &str) -> Parsed {
    let mut read = Triangles::default();
    let mut polygon = vec![];
    for (i, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        let at = |problem: String| format!("line {}: {problem}", i + 1);
        match words.next() {
            Some("v") => {
                // Weights or colours may follow the coordinates.
                let numbers: Vec<f64> = words.take(3).map(number).collect::<Result<_, _>>().map_err(at)?;
                let vertex = numbers.try_into().map_err(|_| at("a vertex has three coordinates".into()))?;
                read.vertices.push(vertex);
            }
            Some("f") => {
                polygon.clear();
                for word in words {
                    polygon.push(index(word, read.vertices.len()).map_err(at)?);
                }
                if polygon.len() < 3 {
                    return Err(at("a face has at least three corners".into()));
                }
                read.add_polygon(&polygon);
            }
            _ => {}
        }
    }
    Ok(read)
}

/// Parses a corner of the form `3`, `3/1`, `3//2` or `3/1/2`: its first number counts vertices from 1, or backwards from -1.
fn index(word: &str, count: usize) -> Result<u32, String> {
    let given = word.split('/').next().unwrap_or_default();
    let index = given.parse::<i64>().ok().and_then(|index| match index {
        1.. => usize::try_from(index - 1).ok(),
        _ if index < 0 => count.checked_sub(index.unsigned_abs() as usize),
        _ => None,
    });
    match index {
        Some(index) if index < count => Ok(index as u32),
        _ => Err(format!("a face names none of the {count} vertices before it")),
    }
}
