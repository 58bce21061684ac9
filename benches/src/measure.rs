//! How long a query takes: thread CPU time, so that other work on the machine counts as little as possible.

use std::hint::black_box;
use std::ops::Range;
use std::time::Duration;

use cpu_time::ThreadTime;

/// Queries that one library can answer, with the inputs already in its own types.
///
/// One answer is one number: a `λ` or a distance, infinite for a miss; 1 or 0 for yes or no; NaN for "I do not know".
#[allow(missing_debug_implementations, reason = "it is little more than a closure")]
pub struct Solver {
    count: usize,
    solve: Box<Solve>,
}

/// Answers a range of the queries.
type Solve = dyn Fn(Range<usize>, &mut [f64]);

impl Solver {
    /// Answers each of `queries` by `answer`. The loop over the queries is compiled together with `answer`.
    pub fn new<Q: 'static>(queries: Vec<Q>, answer: impl Fn(&Q) -> f64 + 'static) -> Self {
        let count = queries.len();
        let solve = move |range: Range<usize>, answers: &mut [f64]| {
            for (query, slot) in queries[range].iter().zip(answers) {
                *slot = answer(black_box(query));
            }
        };
        Self { count, solve: Box::new(solve) }
    }

    /// All answers.
    #[must_use]
    pub fn answers(&self) -> Vec<f64> {
        let mut answers = vec![f64::NAN; self.count];
        (self.solve)(0..self.count, &mut answers);
        answers
    }

    /// Answers the queries of a range and throws the answers away.
    pub fn run(&self, range: Range<usize>) {
        let mut answers = [0.0; BLOCK];
        for start in range.clone().step_by(BLOCK) {
            let end = range.end.min(start + BLOCK);
            (self.solve)(start..end, &mut answers[..end - start]);
            black_box(&answers);
        }
    }

    /// The time of one query in nanoseconds: the smallest over the passes of the median over blocks of 100 queries,
    /// without what reading the clock takes.
    ///
    /// Both are the smallest of the same passes: what slows the machine for a while slows the clock by as much as ten
    /// of the quickest queries. `range` selects queries, at least a block of them; at most `budget` is spent, but never
    /// less than three passes.
    #[must_use]
    pub fn nanoseconds(&self, range: Range<usize>, budget: Duration) -> f64 {
        let begin = ThreadTime::now();
        let (mut least, mut least_clock) = (f64::INFINITY, f64::INFINITY);
        for pass in 0.. {
            if pass >= 3 && begin.elapsed() > budget {
                break;
            }
            let starts = range.clone().step_by(BLOCK).filter(|start| start + BLOCK <= range.end);
            least = least.min(median(starts.map(|start| elapsed_ns(|| self.run(start..start + BLOCK)))));
            least_clock = least_clock.min(median((0..101).map(|_| elapsed_ns(|| ()))));
        }
        (least - least_clock).max(0.0) / BLOCK as f64
    }

    /// How many queries there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }
}

/// Reading the clock costs some 500 ns, as much as a hundred of the quickest queries, so it is read once per this many
/// queries.
const BLOCK: usize = 100;

/// The thread CPU time of what is run, reading the clock included.
fn elapsed_ns(run: impl FnOnce()) -> f64 {
    let clock = ThreadTime::now();
    run();
    black_box(&clock).elapsed().as_nanos() as f64
}

fn median(times: impl Iterator<Item = f64>) -> f64 {
    let mut times: Vec<f64> = times.collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
