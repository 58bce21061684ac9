//! ellip-margin
