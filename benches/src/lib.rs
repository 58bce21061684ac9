//! The workloads answered by this workspace and by other libraries, timed and compared with the truth.
//!
//! What is asked, and what is true of it, is in the package `workloads`. The same queries are answered by [`ours`] and
//! by `parry`, `box3d` and `jolt`, where those features are on, each with the inputs in its own types and timed by
//! [`measure`]. [`rows`] does so for everything, [`report`] prints it; [`profiles`] does so for ours as two build
//! profiles make it.

#[cfg(feature = "box3d")]
pub mod box3d;
#[cfg(feature = "jolt")]
pub mod jolt;
pub mod measure;
pub mod ours;
#[cfg(feature = "parry")]
pub mod parry;
pub mod profiles;
pub mod ratios;
pub mod report;
pub mod rows;
pub mod scene;
