//! Cache of mesh covers in the user's cache directory, keyed by a hash of their input.

use std::collections::hash_map::{DefaultHasher, RandomState};
use std::fs::{self, File, OpenOptions};
use std::hash::{BuildHasher, Hash, Hasher};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use super::mesh::{parse_mesh, read_bytes};
use crate::error::{Error, Result};
use crate::shape::{Cover, Geometry};
use crate::stored;

/// Cache version, raised whenever covers change: entries of other versions are ignored.
const VERSION: u32 = 3;
/// Largest valid entry (bytes): a cover has few shapes, so larger entries are damaged.
const LARGEST_ENTRY: u64 = 1 << 20;

/// Covers the mesh in a file, scaled, by at most `most` spheres and capsules (see
/// [`Mesh::cover`](crate::shape::Mesh::cover)). The result is stored in the user's cache directory and read from there
/// afterwards; an unreadable or unwritable cache is ignored.
///
/// # Errors
/// [`Error::Unreadable`] names the file and its problem.
pub fn covered_mesh(path: &Path, scale: [f64; 3], most: usize) -> Result<Cover> {
    let bytes = read_bytes(path)?;
    let name = path.display().to_string();
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let entry =
        cache_directory().map(|directory| directory.join(key(&(ending, &bytes, scale.map(f64::to_bits), most))));
    if let Some(cover) = entry.as_deref().and_then(read_entry) {
        return Ok(cover);
    }
    let shape = parse_mesh(&name, &bytes, scale)?;
    let Geometry::Mesh(mesh) = shape.geometry() else {
        return Err(Error::unreadable(&name, "it holds no mesh"));
    };
    let cover = mesh.cover(most)?;
    if let Some(entry) = entry {
        // Failure to write only means that the cover is computed again next time.
        let _ = write_entry(&entry, &cover);
    }
    Ok(cover)
}

/// Returns the cache directory; `None` if the system has none.
fn cache_directory() -> Option<PathBuf> {
    let absolute = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let home = || absolute("HOME");
    let base = if cfg!(windows) {
        absolute("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home().map(|home| home.join("Library/Caches"))
    } else {
        absolute("XDG_CACHE_HOME").or_else(|| home().map(|home| home.join(".cache")))
    };
    base.map(|base| base.join("beetle-ik").join("covers"))
}

/// Returns a 128-bit hash in hexadecimal.
fn key(content: &impl Hash) -> String {
    let half = |which: u32| {
        let mut hasher = DefaultHasher::new();
        (VERSION, which).hash(&mut hasher);
        content.hash(&mut hasher);
        hasher.finish()
    };
    format!("{:016x}{:016x}", half(0), half(1))
}

/// Reads an entry; `None` if it is missing or damaged.
fn read_entry(path: &Path) -> Option<Cover> {
    let mut bytes = vec![];
    File::open(path).ok()?.take(LARGEST_ENTRY).read_to_end(&mut bytes).ok()?;
    // Shapes are validated as they are read.
    stored::from_bytes("cover", &bytes).ok()
}

/// Writes an entry under a random name, without following links, then renames it: readers see all of it or nothing.
fn write_entry(path: &Path, cover: &Cover) -> std::io::Result<()> {
    let Some(directory) = path.parent() else { return Ok(()) };
    fs::create_dir_all(directory)?;
    let content = stored::to_bytes("cover", cover).map_err(std::io::Error::other)?;
    let temporary = directory.join(format!(".{:016x}", RandomState::new().hash_one(path)));
    let mut file = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
    let written = file.write_all(&content);
    drop(file);
    let kept = written.and_then(|()| fs::rename(&temporary, path));
    if kept.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Shape;

    fn cover() -> Cover {
        let shapes =
            vec![Shape::sphere([0.1, 0.2, 0.3], 0.4).unwrap(), Shape::capsule([0.0; 3], [1.0; 3], 0.1).unwrap()];
        Cover { shapes, volume_ratio: 1.5, largest_distance: 0.01 }
    }

    #[test]
    fn an_entry_is_read_as_it_was_written() {
        let directory = std::env::temp_dir().join(format!("covers-{:016x}", RandomState::new().hash_one(1)));
        let path = directory.join("entry");
        assert_eq!(read_entry(&path), None);
        write_entry(&path, &cover()).unwrap();
        assert_eq!(read_entry(&path), Some(cover()));
        assert_eq!(fs::read_dir(&directory).unwrap().count(), 1);
        // Damaged entries count as missing, and are replaced.
        let mut bytes = fs::read(&path).unwrap();
        for i in 0..bytes.len() {
            bytes[i] ^= 1;
            fs::write(&path, &bytes).unwrap();
            assert_eq!(read_entry(&path), None, "byte {i}");
            bytes[i] ^= 1;
        }
        fs::write(&path, &bytes[..10]).unwrap();
        assert_eq!(read_entry(&path), None);
        write_entry(&path, &cover()).unwrap();
        assert_eq!(read_entry(&path), Some(cover()));
        fs::remove_dir_all(&directory).unwrap();
    }
}
