//! Strip charts without their paper: lowest and highest value of each short stretch of a channel.
//!
//! However fast a channel samples, a stretch is two numbers, so that no spike is lost and a page
//! costs the same at 10 Hz and at 10 kHz. What is not fetched is let go of, oldest first.

use std::collections::VecDeque;
use std::fmt::Write as _;

/// Stretches a second [1/s] of the world's time: one for each frame that is sent.
const PER_S: f64 = 40.0;
/// Longest stretch [s]: on a clock that runs faster than the world's a roll period stays one.
const LONGEST_S: f64 = 0.1;
/// Stretches of a channel that wait to be fetched: some seconds of them.
const WAITING: usize = 512;
/// Stretch of what a page that is opened late is shown [s].
const PAST_STRETCH_S: f64 = 0.2;
/// How many of those are kept: five minutes.
const PAST_KEPT: usize = 1500;

/// One stretch of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    /// Its middle [s].
    at_s: f64,
    low: f64,
    high: f64,
}

impl Stretch {
    fn widen(&mut self, low: f64, high: f64) {
        (self.low, self.high) = (self.low.min(low), self.high.max(high));
    }
}

/// Collects stretches of one length.
#[derive(Debug, Clone)]
struct Collecting {
    length_s: f64,
    index: i64,
    under_way: Option<Stretch>,
}

impl Collecting {
    fn new(length_s: f64) -> Self {
        Self { length_s, index: i64::MIN, under_way: None }
    }

    /// Takes values; the stretch before, once it is complete.
    fn push(&mut self, at_s: f64, low: f64, high: f64) -> Option<Stretch> {
        let index = (at_s / self.length_s).floor() as i64;
        if let Some(under_way) = self.under_way.as_mut().filter(|_| index <= self.index) {
            under_way.widen(low, high);
            return None;
        }
        self.index = index;
        let at_s = (index as f64 + 0.5) * self.length_s;
        self.under_way.replace(Stretch { at_s, low, high })
    }
}

#[derive(Debug, Clone)]
struct Channel {
    fine: Collecting,
    waiting: VecDeque<Stretch>,
    coarse: Collecting,
    past: VecDeque<Stretch>,
}

/// The strips of every channel.
#[derive(Debug, Clone, Default)]
pub struct Strips {
    names: Vec<&'static str>,
    channels: Vec<Channel>,
}

impl Strips {
    /// Empty strips of these channels, on a clock of that speed [-].
    pub fn new(names: Vec<&'static str>, clock_speed: f64) -> Self {
        let fine = Collecting::new((clock_speed / PER_S).min(LONGEST_S));
        let coarse = Collecting::new(PAST_STRETCH_S.max(fine.length_s));
        let channel = Channel { fine, waiting: VecDeque::new(), coarse, past: VecDeque::new() };
        Self { channels: vec![channel; names.len()], names }
    }

    /// Goes on with these channels: anew, unless they are those there were.
    pub fn go_on(&mut self, names: Vec<&'static str>, clock_speed: f64) {
        if names != self.names {
            *self = Self::new(names, clock_speed);
        }
    }

    /// Takes a value of a channel, in the unit in which it is shown; holes are no values.
    pub fn push(&mut self, channel: usize, time_s: f64, value: f64) {
        let Some(channel) = self.channels.get_mut(channel).filter(|_| value.is_finite()) else {
            return;
        };
        let Some(done) = channel.fine.push(time_s, value, value) else { return };
        keep(&mut channel.waiting, done, WAITING);
        if let Some(past) = channel.coarse.push(done.at_s, done.low, done.high) {
            keep(&mut channel.past, past, PAST_KEPT);
        }
    }

    /// Until when the values of every channel have come [s], to the length of a stretch.
    pub fn until_s(&self) -> Option<f64> {
        let newest = |channel: &Channel| channel.fine.under_way.map(|stretch| stretch.at_s);
        let until: Option<Vec<f64>> = self.channels.iter().map(newest).collect();
        until?.into_iter().reduce(f64::min)
    }

    /// What came since the last fetch, as JSON; none when nothing did.
    pub fn fetch(&mut self) -> Option<String> {
        if self.channels.iter().all(|channel| channel.waiting.is_empty()) {
            return None;
        }
        let text = json(self.channels.iter().map(|channel| &channel.waiting));
        self.channels.iter_mut().for_each(|channel| channel.waiting.clear());
        Some(text)
    }

    /// The last minutes, as JSON of the same shape.
    pub fn past(&self) -> String {
        json(self.channels.iter().map(|channel| &channel.past))
    }
}

fn keep(kept: &mut VecDeque<Stretch>, stretch: Stretch, most: usize) {
    if kept.len() == most {
        kept.pop_front();
    }
    kept.push_back(stretch);
}

/// `{"t": S, "c": [[MS, LOW, HIGH, ...], ...]}`: times in whole milliseconds after `t` [s].
fn json<'c>(channels: impl Iterator<Item = &'c VecDeque<Stretch>> + Clone) -> String {
    let first_s = channels.clone().filter_map(|stretches| Some(stretches.front()?.at_s));
    let from_s = first_s.reduce(f64::min).unwrap_or(0.0).floor();
    let mut text = format!("{{\"t\":{from_s},\"c\":[");
    for (number, stretches) in channels.enumerate() {
        text.push_str(if number == 0 { "[" } else { ",[" });
        for (k, Stretch { at_s, low, high }) in stretches.iter().enumerate() {
            let comma = if k == 0 { "" } else { "," };
            let ms = (1e3 * (at_s - from_s)).round();
            // A string takes every text.
            let _ = write!(text, "{comma}{ms},{},{}", five_digits(*low), five_digits(*high));
        }
        text.push(']');
    }
    text.push_str("]}");
    text
}

/// Rounded to five significant digits: finer than a strip is drawn.
fn five_digits(value: f64) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let scale = 10_f64.powi(4 - value.abs().log10().floor() as i32);
    if scale.is_finite() && scale > 0.0 { (value * scale).round() / scale } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_of_one_sample_is_in_its_stretch() {
        let mut strips = Strips::new(vec!["roll"], 1.0);
        for k in 0..1000 {
            strips.push(0, f64::from(k) * 1e-3, if k == 500 { 7.0 } else { 0.5 });
        }
        let text = strips.fetch().expect("a second of stretches");
        assert!(text.contains(",0.5,7,"), "{text}");
        assert_eq!(strips.fetch(), None, "fetched once");
    }

    #[test]
    fn a_page_that_nobody_fetches_for_is_bounded_and_keeps_the_newest() {
        let mut strips = Strips::new(vec!["roll"], 1.0);
        (0..2_000_000).for_each(|k| strips.push(0, f64::from(k) * 1e-3, 1.0));
        assert_eq!(strips.channels[0].waiting.len(), WAITING);
        assert_eq!(strips.channels[0].past.len(), PAST_KEPT);
        let text = strips.fetch().expect("the newest");
        assert!(text.starts_with("{\"t\":1987,"), "{}", &text[..40]);
    }

    #[test]
    fn eight_channels_at_a_kilohertz_are_a_few_kilobytes_a_second() {
        let mut strips = Strips::new(vec!["roll"; 8], 1.0);
        for k in 0..10_000 {
            let time_s = f64::from(k) * 1e-3;
            (0..8).for_each(|channel| strips.push(channel, time_s, (time_s * 7.0).sin() / 3.0));
        }
        let bytes_per_s = strips.fetch().expect("ten seconds").len() / 10;
        assert!(bytes_per_s < 10_000, "{bytes_per_s}");
    }

    #[test]
    fn a_fast_clock_keeps_the_roll_within_its_stretches() {
        let mut strips = Strips::new(vec!["roll"], 20.0);
        (0..100).for_each(|k| strips.push(0, f64::from(k) * 0.01, f64::from(k)));
        let text = strips.fetch().expect("a second");
        assert!(text.contains("50,0,9,150,10,19,"), "{text}");
    }

    #[test]
    fn what_is_no_number_and_what_is_no_channel_leaves_no_trace() {
        let mut strips = Strips::new(vec!["roll"], 1.0);
        (0..9).for_each(|k| strips.push(0, f64::from(k), f64::NAN));
        (0..9).for_each(|k| strips.push(1, f64::from(k), 1.0));
        assert_eq!(strips.fetch(), None);
    }
}
