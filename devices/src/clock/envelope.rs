//! From an instrument's clock to the host's, by the lower envelope of the arrivals.
//!
//! `arrival = offset + rate · device time + delay`, and the delay has a floor but no ceiling: a
//! busy host or an adapter that sends every 16 ms only makes it longer. A least-squares line
//! carries the mean delay as bias; the lower convex hull touches the floor (Moon, Skelly and
//! Towsley 1999; Zhang, Liu and Xia 2002). Where a timer's grid keeps arrivals off the floor, the
//! line is the middle of a corridor; elsewhere it is the hull's edge over the mean abscissa. The
//! fixed delay (wire, conversion) is not seen by it and is declared with the device.

use std::collections::VecDeque;

use super::corridor::{Corridor, Middle, Point};

/// Device time covered by one window [s].
const WINDOW_S: f64 = 2.0;
/// Windows kept: a minute bends less than 0.1 ms at 0.05 ppm/s of drift.
const WINDOWS: usize = 30;
/// Windows before which the hull has not seen enough to tell its own spread.
const WINDOWS_FOR_BOUND: usize = 4;
/// No crystal or ceramic resonator is further off [s/s]; it keeps short spans sane.
const RATE_OFF_MAX: f64 = 0.005;
/// Bound per mean of the windows' smallest residuals, from the simulated links of the tests.
const BOUND_PER_SPREAD: f64 = 1.5;
/// Bound per half width of the corridor, from the same: jitter blurs its walls.
const BOUND_PER_HALF_WIDTH: f64 = 2.5;
/// Reading the host's clock and rounding device ticks costs at least this much [s].
const BOUND_FLOOR_S: f64 = 20e-6;
/// Jitter blurs the edges of a timer's grid by this much [s].
const SLACK_S: f64 = 0.2e-3;
/// The lowest part of a window's arrivals, in which the grid of a timer shows as a gap.
const LOW_PART: f64 = 0.3;
/// Arrivals of a window kept to look for a gap; the rest of a faster stream adds nothing.
const ARRIVALS_MAX: usize = 1024;
/// Fewer arrivals show gaps everywhere.
const ARRIVALS_MIN: usize = 20;

/// The estimator: arrivals in, a line out; memory is bounded however long it runs.
#[derive(Debug, Clone)]
pub struct Envelope {
    /// Delay of the adapter or host that may hide before the hull has seen its spread [s].
    latency_s: f64,
    origin: Option<Point>,
    windows: VecDeque<Window>,
    /// Arrivals of the last window.
    arrivals: Vec<Point>,
}

#[derive(Debug, Clone)]
struct Window {
    start: f64,
    end: f64,
    sum_x: f64,
    n_points: usize,
    hull: Vec<Point>,
    /// The line is not below this, by the gap above the lowest arrivals.
    below: Option<Point>,
}

/// The host time of a device time, with its bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockLine {
    device_s: f64,
    host_s: f64,
    /// Host seconds that pass in one device second.
    pub rate: f64,
    /// The mapping is at most this far off [s], the fixed delay apart.
    pub bound_s: f64,
}

impl ClockLine {
    /// Host time [s] of a device time [s].
    pub fn host_s(&self, device_s: f64) -> f64 {
        self.host_s + self.rate * (device_s - self.device_s)
    }
}

impl Envelope {
    /// An estimator behind an adapter that may hold bytes back for `latency_s` (FTDI: 16 ms).
    pub fn new(latency_s: f64) -> Self {
        Self { latency_s, origin: None, windows: VecDeque::new(), arrivals: Vec::new() }
    }

    /// Takes the arrival [s, host] of what the device stamped [s, device]; device time never falls.
    pub fn push(&mut self, device_s: f64, arrival_s: f64) {
        let origin = *self.origin.get_or_insert(Point { x: device_s, y: arrival_s });
        let x = device_s - origin.x;
        let point = Point { x, y: arrival_s - origin.y - x };
        if self.windows.back().is_none_or(|window| x - window.start >= WINDOW_S) {
            self.close_window();
            self.windows.push_back(Window::new(x));
        }
        if let Some(window) = self.windows.back_mut() {
            window.end = x;
            window.sum_x += x;
            window.n_points += 1;
            push_hull(&mut window.hull, point);
        }
        if self.arrivals.len() < ARRIVALS_MAX {
            self.arrivals.push(point);
        }
    }

    fn close_window(&mut self) {
        let slope = self.line().map_or(0.0, |line| line.rate - 1.0);
        if let Some(window) = self.windows.back_mut() {
            window.below = below(&self.arrivals, slope);
        }
        self.arrivals.clear();
        if self.windows.len() == WINDOWS {
            self.windows.pop_front();
        }
    }

    /// The line through what was pushed in the last minute; none before the first point.
    pub fn line(&self) -> Option<ClockLine> {
        let origin = self.origin?;
        let base = *self.windows.front()?.hull.first()?;
        let local = |point: &Point| Point { x: point.x - base.x, y: point.y - base.y };
        let mut hull = Vec::new();
        for point in self.windows.iter().flat_map(|window| &window.hull) {
            push_hull(&mut hull, local(point));
        }
        let end = self.windows.back()?.end - base.x;
        let below: Vec<Point> =
            self.windows.iter().filter_map(|window| window.below.as_ref().map(local)).collect();
        let corridor =
            Corridor { above: &hull, below: &below, slack: SLACK_S, slope_max: RATE_OFF_MAX };
        let settled = self.windows.len() >= WINDOWS_FOR_BOUND;
        let middle = if settled { corridor.middle(0.0, end) } else { None };
        let (slope, height, bound_s) = match middle {
            Some(Middle { slope, height, half_width }) => {
                (slope, height, BOUND_PER_HALF_WIDTH * half_width)
            }
            None => self.edge(&hull, base),
        };
        Some(ClockLine {
            device_s: origin.x + base.x,
            host_s: origin.y + base.x + base.y + height,
            rate: 1.0 + slope,
            bound_s: bound_s.max(BOUND_FLOOR_S),
        })
    }

    /// Slope, height and bound of the hull's edge over the mean abscissa.
    fn edge(&self, hull: &[Point], base: Point) -> (f64, f64, f64) {
        let n_points: usize = self.windows.iter().map(|window| window.n_points).sum();
        let sum_x: f64 = self.windows.iter().map(|window| window.sum_x).sum();
        let mean_x = sum_x / n_points.max(1) as f64 - base.x;
        let after = hull.partition_point(|point| point.x <= mean_x).min(hull.len() - 1);
        let (left, right) = (hull[after.saturating_sub(1)], hull[after]);
        let run = right.x - left.x;
        let slope = if run > 0.0 { (right.y - left.y) / run } else { 0.0 };
        let slope = slope.clamp(-RATE_OFF_MAX, RATE_OFF_MAX);
        // The line of this slope that supports the hull from below.
        let height = |point: &Point| point.y - slope * point.x;
        let floor = hull.iter().map(height).fold(f64::INFINITY, f64::min);
        if self.windows.len() < WINDOWS_FOR_BOUND {
            return (slope, floor, self.latency_s);
        }
        // The windows' smallest residuals say how rarely the floor is met, so how far it may lie.
        let smallest = self.windows.iter().map(|window| {
            let local = window.hull.iter().map(|point| Point { x: point.x - base.x, ..*point });
            let residuals = local.map(|point| height(&point) - base.y - floor);
            residuals.fold(f64::INFINITY, f64::min)
        });
        let mean = smallest.sum::<f64>() / self.windows.len() as f64;
        (slope, floor, BOUND_PER_SPREAD * mean)
    }
}

impl Window {
    fn new(start: f64) -> Self {
        Self { start, end: start, sum_x: 0.0, n_points: 0, hull: Vec::new(), below: None }
    }
}

/// The lowest arrival less the widest gap among the lowest ones.
fn below(arrivals: &[Point], slope: f64) -> Option<Point> {
    if arrivals.len() < ARRIVALS_MIN {
        return None;
    }
    let height = |point: &Point| point.y - slope * point.x;
    let lowest = arrivals.iter().min_by(|a, b| height(a).total_cmp(&height(b)))?;
    let mut heights: Vec<f64> = arrivals.iter().map(height).collect();
    heights.sort_unstable_by(f64::total_cmp);
    let n_low = (LOW_PART * heights.len() as f64) as usize;
    let gap = heights[..=n_low].windows(2).map(|two| two[1] - two[0]).fold(0.0, f64::max);
    Some(Point { x: lowest.x, y: lowest.y - gap })
}

/// Extends a lower convex hull by a point that is not left of its last.
fn push_hull(hull: &mut Vec<Point>, point: Point) {
    while let [.., a, b] = hull[..] {
        let turn = (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
        if turn > 0.0 {
            break;
        }
        hull.pop();
    }
    // Of two points at one abscissa only the lower can touch the line.
    match hull.last_mut() {
        Some(last) if point.x <= last.x => last.y = last.y.min(point.y),
        _ => hull.push(point),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_arrival_does_not_move_the_line() {
        let mut envelope = Envelope::new(0.016);
        for index in 0..6000 {
            let device_s = f64::from(index) * 0.01;
            let late = if index % 3 == 0 { 0.0 } else { 0.15 };
            envelope.push(device_s, 7.0 + device_s * (1.0 + 50e-6) + late);
        }
        let line = envelope.line().unwrap();
        assert!((line.host_s(30.0) - (7.0 + 30.0 * (1.0 + 50e-6))).abs() < 1e-9, "{line:?}");
        assert!((line.rate - 1.0 - 50e-6).abs() < 1e-9, "{line:?}");
    }

    #[test]
    fn the_first_points_have_the_adapter_as_their_bound() {
        let mut envelope = Envelope::new(0.016);
        assert!(envelope.line().is_none());
        envelope.push(5.0, 100.0);
        let line = envelope.line().unwrap();
        assert!((line.host_s(6.0) - 101.0).abs() < 1e-12);
        assert!((line.bound_s - 0.016).abs() < 1e-12);
    }
}
