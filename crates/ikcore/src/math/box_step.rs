//! Box step.
