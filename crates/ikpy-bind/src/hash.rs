//! Hashes of values that compare equal by content, so that they can be keys of dicts and caches.

use std::fmt::{Debug, Result, Write};
use std::hash::{DefaultHasher, Hasher};

/// Returns the hash of the `Debug` form of a value.
pub fn content_hash(content: &impl Debug) -> u64 {
    let mut shown = Signless(DefaultHasher::new());
    // Writing to a hasher cannot fail.
    let _ = write!(shown, "{content:?}");
    shown.0.finish()
}

/// Hashes text without minus signs: 0.0 and -0.0 are equal, so they must have the same hash.
struct Signless(DefaultHasher);

impl Write for Signless {
    fn write_str(&mut self, text: &str) -> Result {
        text.split('-').for_each(|part| self.0.write(part.as_bytes()));
        Ok(())
    }
}
