//! Hashes of values: what compares equal by its content hashes by it, and serves as a key of dicts and caches.

use std::fmt::{Debug, Result, Write};
use std::hash::{DefaultHasher, Hasher};

/// The hash of a content, taken of all that its `Debug` form shows.
pub fn content_hash(content: &impl Debug) -> u64 {
    let mut shown = Signless(DefaultHasher::new());
    // A hasher takes whatever is written.
    let _ = write!(shown, "{content:?}");
    shown.0.finish()
}

/// Hashes text without its minus signs: 0.0 and -0.0 are equal, so they must hash alike.
struct Signless(DefaultHasher);

impl Write for Signless {
    fn write_str(&mut self, text: &str) -> Result {
        text.split('-').for_each(|part| self.0.write(part.as_bytes()));
        Ok(())
    }
}
