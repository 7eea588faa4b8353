//! Samples missing from a stream that neither counts nor stamps them, by the beat of its arrivals.

/// Shortest time in which some arrival is on time [s].
const WINDOW_S: f64 = 1.0;
/// And the fewest arrivals of which one is.
const WINDOW_SAMPLES: usize = 4;
/// More are not kept, however fast the stream is.
const WINDOW_SAMPLES_MAX: usize = 4096;
/// Arrivals before which nothing is known of the period.
const FIRST_SAMPLES: usize = 8;
/// A sample is missing when arrivals stay late by more than this part of a period.
const LATE_PERIODS: f64 = 0.6;
/// And by more than this [s]: a busy host makes a whole second late by less.
const LATE_MIN_S: f64 = 3e-3;
/// A steady stream keeps its beat to this part of a period.
const STEADY_PERIODS: f64 = 0.25;
/// Windows in a row that must be steady before a lateness is believed to be a loss.
const STEADY_WINDOWS: u32 = 8;
/// Windows over which the period is averaged.
const WINDOWS_AVERAGED: f64 = 16.0;

/// Learns how often samples come, and notices by lasting lateness that some are missing.
///
/// A stall or an adapter's timer makes some arrivals late; a missing sample makes all that follow
/// late, also the earliest of each window. A window that is late is doubted until the next one, and
/// only after several that were on time, so that an instrument without a beat is never said to have
/// lost anything.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rhythm {
    /// None while the first arrivals are gathered.
    beat: Option<Beat>,
    /// Arrivals [s] and their lateness [s] in the window that is open and in those before it.
    open: Vec<(f64, f64)>,
    doubted: Vec<(f64, f64)>,
    before: Vec<(f64, f64)>,
    /// The last window was late, and the next has not told yet.
    is_doubted: bool,
    n_steady: u32,
    n_windows: u32,
}

#[derive(Debug, Clone, Copy)]
struct Beat {
    period_s: f64,
    /// When the next sample is due, if it is as early as the earliest [s].
    due_s: f64,
}

/// Samples that never came.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Missing {
    pub(crate) n_samples: u64,
    /// Arrivals [s] between which they belong.
    pub(crate) between_s: [f64; 2],
}

impl Rhythm {
    /// Takes an arrival [s]; what is certainly missing by now.
    pub(crate) fn next(&mut self, arrival_s: f64) -> Option<Missing> {
        let Some(beat) = &mut self.beat else {
            self.first(arrival_s);
            return None;
        };
        let lateness_s = arrival_s - beat.due_s;
        beat.due_s += beat.period_s;
        self.open.push((arrival_s, lateness_s));
        let lasted_s = arrival_s - self.open[0].0;
        let is_whole = lasted_s >= WINDOW_S && self.open.len() >= WINDOW_SAMPLES;
        if is_whole || self.open.len() >= WINDOW_SAMPLES_MAX { self.close() } else { None }
    }

    fn first(&mut self, arrival_s: f64) {
        self.open.push((arrival_s, 0.0));
        let lasted_s = arrival_s - self.open[0].0;
        let n_periods = self.open.len() - 1;
        if (lasted_s >= WINDOW_S && n_periods >= FIRST_SAMPLES) || n_periods > WINDOW_SAMPLES_MAX {
            let period_s = lasted_s / n_periods as f64;
            self.beat = Some(Beat { period_s, due_s: arrival_s + period_s });
            self.open.clear();
        }
    }

    /// Compares a whole window's earliest arrival with what was due.
    fn close(&mut self) -> Option<Missing> {
        let window = std::mem::take(&mut self.open);
        let beat = self.beat.as_mut()?;
        let n_samples = window.len() as f64;
        let lateness_s = window.iter().map(|(_, late_s)| *late_s).fold(f64::INFINITY, f64::min);
        let is_steady = lateness_s.abs() < STEADY_PERIODS * beat.period_s;
        let can_tell = self.n_steady >= STEADY_WINDOWS;
        if can_tell && !self.is_doubted && lateness_s > 0.0 && !is_steady {
            // The loss may lie in the middle of this window, so that only the next is all late.
            (self.is_doubted, self.doubted) = (true, window);
            return None;
        }
        let is_doubted = std::mem::take(&mut self.is_doubted);
        if is_doubted && lateness_s > LATE_MIN_S.max(LATE_PERIODS * beat.period_s) {
            return self.missing(window, lateness_s);
        }
        self.n_steady = if is_steady { self.n_steady + 1 } else { 0 };
        self.n_windows += 1;
        beat.due_s += lateness_s;
        beat.period_s += lateness_s / n_samples / f64::from(self.n_windows).min(WINDOWS_AVERAGED);
        // Arrivals all at once have no period.
        if beat.period_s <= 0.0 {
            *self = Self::default();
            return None;
        }
        self.before = window;
        None
    }

    /// All arrivals of a window were late by at least so much [s], and the one before it was late.
    fn missing(&mut self, window: Vec<(f64, f64)>, lateness_s: f64) -> Option<Missing> {
        let beat = self.beat.as_mut()?;
        let n_periods = (lateness_s / beat.period_s).round();
        beat.due_s += lateness_s;
        // Not by whole periods: it may have another beat from here on.
        if (lateness_s - n_periods * beat.period_s).abs() > STEADY_PERIODS * beat.period_s {
            self.n_steady = 0;
        }
        let near: Vec<(f64, f64)> =
            self.before.drain(..).chain(self.doubted.drain(..)).chain(window).collect();
        let on_time = near.iter().rposition(|(_, late_s)| *late_s < lateness_s / 2.0)?;
        let between_s = [near[on_time].0, near.get(on_time + 1)?.0];
        Some(Missing { n_samples: n_periods as u64, between_s })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A reproducible number in 0..1.
    fn chance(seed: &mut u64) -> f64 {
        *seed =
            seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A link behind an adapter's timer [s], with jitter and with stalls of 50 to 200 ms.
    struct Link {
        rate_hz: f64,
        timer_s: f64,
        seed: u64,
    }

    impl Link {
        /// What is said of so long a stream [s] without these samples.
        fn told(&self, duration_s: f64, lost: impl Fn(u64) -> bool) -> Vec<Missing> {
            let (mut seed, mut rhythm) = (self.seed, Rhythm::default());
            let mut blocked_until_s = 0.0_f64;
            let mut told = Vec::new();
            for index in (0..(duration_s * self.rate_hz) as u64).filter(|index| !lost(*index)) {
                let sent_s = 100.0 + index as f64 / self.rate_hz * (1.0 + 50e-6);
                let sent_s = sent_s + 0.003 - 0.3e-3 * (1.0 - chance(&mut seed)).ln();
                let arrival_s = (sent_s / self.timer_s).ceil() * self.timer_s;
                if chance(&mut seed) < 0.002 {
                    blocked_until_s = arrival_s + 0.05 + 0.15 * chance(&mut seed);
                }
                told.extend(rhythm.next(arrival_s.max(blocked_until_s)));
            }
            told
        }
    }

    fn links() -> impl Iterator<Item = Link> {
        let rates_hz = [1.0, 10.0, 49.7, 100.0, 225.0];
        rates_hz.into_iter().flat_map(|rate_hz| {
            [0.001, 0.016].into_iter().flat_map(move |timer_s| {
                (0..20).map(move |seed| Link { rate_hz, timer_s, seed: seed * 7919 })
            })
        })
    }

    #[test]
    fn a_link_with_jitter_a_timer_and_stalls_invents_no_gap() {
        for link in links() {
            let told = link.told(300.0, |_| false);
            assert_eq!(told, [], "{} Hz, timer {} s", link.rate_hz, link.timer_s);
        }
    }

    #[test]
    fn missing_samples_are_counted_where_they_are_missing() {
        for link in links() {
            for n_lost in [1, 2, 7] {
                let first = (100.0 * link.rate_hz) as u64;
                let told = link.told(200.0, |index| (first..first + n_lost).contains(&index));
                let what = format!("{} Hz, timer {} s: {told:?}", link.rate_hz, link.timer_s);
                let [missing] = told[..] else { panic!("{what}") };
                assert_eq!(missing.n_samples, n_lost, "{what}");
                let truth_s = 100.0 + first as f64 / link.rate_hz;
                let [from_s, to_s] = missing.between_s;
                let slack_s = 0.25 + n_lost as f64 / link.rate_hz;
                assert!(from_s > truth_s - slack_s && to_s < truth_s + slack_s, "{what}");
            }
        }
    }

    #[test]
    fn an_instrument_without_a_beat_is_not_said_to_lose_anything() {
        let (mut seed, mut rhythm, mut arrival_s) = (5, Rhythm::default(), 10.0);
        for _ in 0..20_000 {
            arrival_s += 0.02 + 0.3 * chance(&mut seed);
            assert_eq!(rhythm.next(arrival_s), None);
        }
    }
}
