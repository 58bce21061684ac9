//! convex-support
