//! Lines that lie below all arrivals and above what the adapter's timer can hide.
//!
//! A timer that beats with the sampling (16 ms against 100 Hz: a grid of 2 ms) leaves no sample at
//! the floor of the delay, but the gap between the lowest arrivals and the next ones shows the
//! grid: the floor is at most one gap below the lowest. Between those two the line must lie.

/// Device time and lead of the arrival [s].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub(super) x: f64,
    pub(super) y: f64,
}

/// Halvings of an interval of slopes; beyond this a double has no more digits.
const HALVINGS: usize = 60;

/// The lines between two sets of points.
pub(super) struct Corridor<'p> {
    /// No line lies above any of these.
    pub(super) above: &'p [Point],
    /// No line lies below any of these.
    pub(super) below: &'p [Point],
    /// At most so much the lower bound gives way, when otherwise no line fits.
    pub(super) slack: f64,
    /// Slopes lie in plus or minus this.
    pub(super) slope_max: f64,
}

/// The middle of a corridor, as a line by its slope and its height at x = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Middle {
    pub(super) slope: f64,
    pub(super) height: f64,
    /// No line of the corridor is further from the middle than this between the ends, nor the
    /// lower bound in the wrong by more.
    pub(super) half_width: f64,
}

impl Corridor<'_> {
    /// Highest and lowest height at x = 0 of lines of that slope; crossed when there is none.
    fn heights(&self, slope: f64) -> (f64, f64) {
        let height = |point: &Point| point.y - slope * point.x;
        let highest = self.above.iter().map(height).fold(f64::INFINITY, f64::min);
        let lowest = self.below.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
        (highest, lowest)
    }

    fn room(&self, slope: f64) -> f64 {
        let (highest, lowest) = self.heights(slope);
        highest - lowest
    }

    /// The slope with most room: room is concave in the slope, so thirds find it.
    fn widest(&self) -> f64 {
        let (mut low, mut high) = (-self.slope_max, self.slope_max);
        for _ in 0..2 * HALVINGS {
            let third = (high - low) / 3.0;
            if self.room(low + third) < self.room(high - third) {
                low += third;
            } else {
                high -= third;
            }
        }
        f64::midpoint(low, high)
    }

    /// The furthest slope towards `limit` that still has room, when the lower bound gives way.
    fn furthest(&self, widest: f64, limit: f64, slack: f64) -> f64 {
        if self.room(limit) + slack >= 0.0 {
            return limit;
        }
        let (mut inside, mut outside) = (widest, limit);
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(inside, outside);
            if self.room(middle) + slack >= 0.0 { inside = middle } else { outside = middle }
        }
        inside
    }

    /// The middle between `from` and `to`; none when no line fits.
    pub(super) fn middle(&self, from: f64, to: f64) -> Option<Middle> {
        let widest = self.widest();
        let slack = (-self.room(widest)).max(0.0);
        if self.below.is_empty() || to <= from || slack > self.slack {
            return None;
        }
        let ends =
            [-self.slope_max, self.slope_max].map(|limit| self.furthest(widest, limit, slack));
        let slopes = [ends[0], widest, ends[1]];
        // Where the corridor's lines can be at either end, and the middle of that.
        let range = |x: f64| {
            let heights = slopes.iter().flat_map(|slope| {
                let (highest, lowest) = self.heights(*slope);
                [highest + slope * x, lowest - slack + slope * x]
            });
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| {
                (low.min(height), high.max(height))
            })
        };
        let ((low_from, high_from), (low_to, high_to)) = (range(from), range(to));
        let (y_from, y_to) = (f64::midpoint(low_from, high_from), f64::midpoint(low_to, high_to));
        let slope = (y_to - y_from) / (to - from);
        let half_width = (high_from - low_from).max(high_to - low_to) / 2.0 + slack;
        Some(Middle { slope, height: y_from - slope * from, half_width })
    }
}
