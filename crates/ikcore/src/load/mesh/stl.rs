//! STL reader, for text and binary files: triangles with separate corners.

use super::parsed::{Parsed, Triangles, number};

/// Header of a binary file (bytes): a comment, and the number of triangles.
const HEADER: usize = 84;
/// Size of a triangle in a binary file (bytes): a normal, three corners, and two unused bytes.
const TRIANGLE: usize = 50;

/// Parses a file. Its length decides whether it is binary, since some binary files begin like text.
pub(super) fn parse(bytes: &[u8]) -> Parsed {
    let count = bytes.get(80..HEADER).map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]));
    let expected = count.map(|count| HEADER as u64 + TRIANGLE as u64 * u64::from(count));
    match expected {
        Some(expected) if expected <= bytes.len() as u64 => binary(&bytes[HEADER..expected as usize]),
        _ if bytes.trim_ascii_start().starts_with(b"solid") => text(&String::from_utf8_lossy(bytes)),
        Some(expected) => Err(format!("a binary STL file of {expected} bytes ends after {}", bytes.len())),
        None => Err("it is neither a text nor a binary STL file".into()),
    }
}

fn binary(triangles: &[u8]) -> Parsed {
    let mut read = Triangles::default();
    for triangle in triangles.chunks_exact(TRIANGLE) {
        let first = read.vertices.len() as u32;
        for corner in triangle[12..48].chunks_exact(12) {
            let coordinate = |k: usize| f32::from_le_bytes([0, 1, 2, 3].map(|i| corner[4 * k + i]));
            read.vertices.push([0, 1, 2].map(|k| f64::from(coordinate(k))));
        }
        read.faces.push([first, first + 1, first + 2]);
    }
    Ok(read)
}

fn text(text: &str) -> Parsed {
    let mut read = Triangles::default();
    for (i, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("vertex") => {
                let at = |problem| format!("line {}: {problem}", i + 1);
                let numbers: Vec<f64> = words.map(number).collect::<Result<_, _>>().map_err(at)?;
                let vertex = numbers.try_into().map_err(|_| at("a vertex has three coordinates".into()))?;
                read.vertices.push(vertex);
            }
            Some("endfacet") => {
                let count = read.vertices.len() as u32;
                if count != 3 * (read.faces.len() as u32 + 1) {
                    return Err(format!("line {}: a facet has three vertices", i + 1));
                }
                read.faces.push([count - 3, count - 2, count - 1]);
            }
            _ => {}
        }
    }
    if read.vertices.len() != 3 * read.faces.len() {
        return Err("it ends within a facet".into());
    }
    Ok(read)
}
