//! A place for what a higher module derives from the bodies of a robot.

use std::any::Any;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Derived data, made at first use. This module cannot name its type, which belongs to a higher one.
#[derive(Clone, Default)]
pub(super) struct Derived(Arc<OnceLock<Arc<dyn Any + Send + Sync>>>);

impl Derived {
    /// What `make` made at the first call. To be called with one type alone.
    pub fn get<T: Any + Send + Sync>(&self, make: impl Fn() -> T) -> Arc<T> {
        let shared = self.0.get_or_init(|| Arc::new(make()));
        Arc::clone(shared).downcast().unwrap_or_else(|_| Arc::new(make()))
    }
}

impl fmt::Debug for Derived {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.get().is_some() { "made" } else { "not made" })
    }
}
