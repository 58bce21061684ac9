//! Observers, and the iterates that they see.

/// What an observer of [`inscribed_with`](crate::inscribed_with) sees after every Newton step.
#[derive(Clone, Copy, Debug)]
pub struct InscribedIterate {
    /// Newton steps so far.
    pub iteration: usize,
    /// The barrier parameter the step aimed at.
    pub mu: f64,
    /// The bound on ln det X − ln det X* of this iterate; infinite while the multipliers prove nothing.
    pub log_det_gap: f64,
}

/// Who sees the iterates. The solver is compiled once for all observers.
pub(crate) type Observer<'a> = dyn FnMut(InscribedIterate) + 'a;
