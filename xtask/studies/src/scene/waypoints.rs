//! A trajectory through waypoints.

/// The rows of a motion that rests at every waypoint: in joint space straight from each to the next, in so many steps,
/// and with the least jerk, as arms of people move (Flash and Hogan, *The coordination of arm movements*, 1985): at the
/// part `t` of the time it has made `10t³ − 15t⁴ + 6t⁵` of the way.
pub(super) fn through(waypoints: &[Vec<f64>], steps: usize) -> Vec<Vec<f64>> {
    let row = |from: &[f64], to: &[f64], step: usize| {
        let t = step as f64 / steps as f64;
        let made = t * t * t * (10.0 + t * (6.0 * t - 15.0));
        from.iter().zip(to).map(|(from, to)| from + (to - from) * made).collect()
    };
    let legs = waypoints.windows(2).flat_map(|ends| (0..steps).map(move |step| row(&ends[0], &ends[1], step)));
    legs.chain(waypoints.last().cloned()).collect()
}

#[cfg(test)]
mod tests {
    use super::through;

    #[test]
    fn it_rests_at_every_waypoint() {
        let rows = through(&[vec![0.0, 1.0], vec![8.0, 1.0], vec![8.0, 0.0]], 100);
        assert_eq!(rows.len(), 201, "a hundred rows a leg, and the end");
        assert_eq!((&rows[0], &rows[100], &rows[200]), (&vec![0.0, 1.0], &vec![8.0, 1.0], &vec![8.0, 0.0]));
        assert_eq!(rows[50], [4.0, 1.0], "half of the way in half of the time");
        assert!(rows[1][0] < 1e-4 && rows[99][0] > 8.0 - 1e-4, "slow at both ends");
        assert!(rows.windows(2).all(|pair| pair[0][0] <= pair[1][0] && pair[0][1] >= pair[1][1]), "and never back");
    }
}
