//! Built-in robots: data tables, each with its source. [`named`] lists them.

mod arm;
mod franka;
mod hydraulic;
mod kinova;
mod kuka;
mod named;
mod universal_robots;
