//! Time stamps put in order: missing and repeated ones are placed between their neighbours.

use std::collections::VecDeque;
use std::mem;

/// Rows that may wait for their next time stamp, which bounds the memory.
pub(crate) const WAITING_MAX: usize = 65_536;

/// Gives every row a time of its own, later than the row before.
///
/// A stamp is kept to the bit. A row without one, and a row that repeats the stamp before it (a
/// clock coarser than the sampling), is placed evenly between its stamped neighbours. Rows before
/// the first stamp or after the last have no neighbour on one side and are left out.
#[derive(Debug)]
pub(crate) struct Stamps<T> {
    last_s: Option<f64>,
    waiting: Vec<T>,
    ready: VecDeque<(f64, T)>,
    /// Rows that had no neighbour on one side, counted.
    pub(crate) left_out: u64,
}

/// What happened to a row's time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stamped {
    /// The stamp was used as it is.
    Kept,
    /// The row had no stamp and waits for its neighbour.
    Missing,
    /// The row repeats the stamp before it and waits for its neighbour.
    Repeated,
}

/// A stamp that cannot be used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum StampFault {
    /// Earlier than the one before.
    Backwards { previous_s: f64 },
    /// More than [`WAITING_MAX`] rows wait.
    TooManyWaiting,
}

impl<T> Stamps<T> {
    pub(crate) fn new() -> Self {
        Self { last_s: None, waiting: Vec::new(), ready: VecDeque::new(), left_out: 0 }
    }

    /// Takes the next row with its stamp [s], which is finite.
    pub(crate) fn push(&mut self, time_s: Option<f64>, row: T) -> Result<Stamped, StampFault> {
        match (time_s, self.last_s) {
            (None, None) => {
                self.left_out += 1;
                Ok(Stamped::Missing)
            }
            (None, Some(_)) => self.wait(row).map(|()| Stamped::Missing),
            (Some(time_s), Some(last_s)) if time_s < last_s => {
                Err(StampFault::Backwards { previous_s: last_s })
            }
            (Some(time_s), Some(last_s)) if time_s <= last_s => {
                self.wait(row).map(|()| Stamped::Repeated)
            }
            (Some(time_s), last_s) => {
                self.place(last_s.unwrap_or(time_s), time_s);
                self.ready.push_back((time_s, row));
                self.last_s = Some(time_s);
                Ok(Stamped::Kept)
            }
        }
    }

    fn wait(&mut self, row: T) -> Result<(), StampFault> {
        if self.waiting.len() == WAITING_MAX {
            return Err(StampFault::TooManyWaiting);
        }
        self.waiting.push(row);
        Ok(())
    }

    fn place(&mut self, before_s: f64, after_s: f64) {
        let intervals = (self.waiting.len() + 1) as f64;
        let mut placed_s = before_s;
        for (index, row) in mem::take(&mut self.waiting).into_iter().enumerate() {
            let share = (index + 1) as f64 / intervals;
            // Weighted so that huge stamps of opposite sign cannot overflow their difference;
            // clamped because rounding must not run time backwards.
            let time_s = (before_s * (1.0 - share) + after_s * share).clamp(placed_s, after_s);
            self.ready.push_back((time_s, row));
            placed_s = time_s;
        }
    }

    /// Leaves out what still waits, because no stamp can follow.
    pub(crate) fn finish(&mut self) {
        self.left_out += self.waiting.len() as u64;
        self.waiting = Vec::new();
    }

    /// Whether any stamp was seen.
    pub(crate) fn any(&self) -> bool {
        self.last_s.is_some()
    }

    /// The next row that has its time.
    pub(crate) fn pop(&mut self) -> Option<(f64, T)> {
        self.ready.pop_front()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_without_a_stamp_of_their_own_are_placed_between_their_neighbours() {
        let mut stamps = Stamps::new();
        let given = [None, Some(1.0), None, Some(1.0), None, Some(2.0), Some(2.5), Some(2.5)];
        for (row, time_s) in given.into_iter().enumerate() {
            stamps.push(time_s, row).expect("in order");
        }
        stamps.finish();
        let placed: Vec<_> = std::iter::from_fn(|| stamps.pop()).collect();
        assert_eq!(
            placed,
            [(1.0, 1), (1.25, 2), (1.5, 3), (1.75, 4), (2.0, 5), (2.5, 6)],
            "quarters of a second are exact in binary"
        );
        assert_eq!(stamps.left_out, 2, "the first row and the last have one neighbour only");
    }

    #[test]
    fn time_running_backwards_names_the_time_before() {
        let mut stamps = Stamps::new();
        stamps.push(Some(3.0), ()).expect("first");
        let fault = stamps.push(Some(2.9), ()).expect_err("earlier");
        assert_eq!(fault, StampFault::Backwards { previous_s: 3.0 });
    }
}
