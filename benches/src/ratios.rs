//! Times over other times: the geometric mean, and the cases that it hides.

use std::fmt::{self, Display, Formatter};

/// Ratios, each with the name of the case that it is of.
#[derive(Clone, Debug, Default)]
pub struct Ratios<'a>(Vec<(&'a str, f64)>);

impl Ratios<'_> {
    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The geometric mean, which is that of the inverse ratios inverted: neither side is preferred. NaN of no ratios.
    #[must_use]
    pub fn mean(&self) -> f64 {
        (self.0.iter().map(|(_, ratio)| ratio.ln()).sum::<f64>() / self.0.len() as f64).exp()
    }
}

impl<'a> FromIterator<(&'a str, f64)> for Ratios<'a> {
    fn from_iter<I: IntoIterator<Item = (&'a str, f64)>>(ratios: I) -> Self {
        Self(ratios.into_iter().collect())
    }
}

/// The mean, the least and the most: `0.81 (0.53 cone to 1.02 ball)`.
impl Display for Ratios<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let by_ratio = |a: &&(&str, f64), b: &&(&str, f64)| a.1.total_cmp(&b.1);
        let (Some(least), Some(most)) = (self.0.iter().min_by(by_ratio), self.0.iter().max_by(by_ratio)) else {
            return f.write_str("-");
        };
        write!(f, "{:.2} ({:.2} {} to {:.2} {})", self.mean(), least.1, least.0, most.1, most.0)
    }
}
