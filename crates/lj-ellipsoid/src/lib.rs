//! lj-ellipsoid
