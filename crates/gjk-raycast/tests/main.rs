//! Everything that is held of queries from outside the crate.
//!
//! One program of all files: what they ask is compiled once.

mod aimed;
mod algorithm_1;
mod batch;
mod boxes;
mod brackets;
mod cast_derivatives;
mod cast_methods;
mod certificate_points;
mod certificates;
mod closed_forms;
mod closest_points;
mod common;
mod contact;
mod curved_casts;
mod data;
mod depth_shortcuts;
mod derivatives;
mod descent_2d;
mod differences;
mod edges;
mod exact;
mod exact_oracle;
mod given_up;
mod half_space;
mod half_space_motion;
mod hit_derivatives;
mod invariances;
mod lies;
mod motion_cast;
mod motion_laws;
mod moving_boxes;
mod options;
mod paper;
mod regressions_distance;
mod regressions_linear_cast;
mod regressions_ray_cast;
mod scene;
mod signed_distance;
mod signed_distance_laws;
mod single_precision;
mod starts;
mod stepping;
mod sub_algorithms;
mod tolerance;
