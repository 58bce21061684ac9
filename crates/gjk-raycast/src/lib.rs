//! gjk-raycast
