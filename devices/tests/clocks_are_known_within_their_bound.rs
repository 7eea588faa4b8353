//! A minute of any link gives the device's clock, with a bound that holds.

use devices::clock::{ClockLine, Envelope};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp};

const DRAWS: u64 = 200;

/// A link: fixed latency, exponential jitter, an adapter's timer, stalls, dropped frames, drift.
struct Link {
    timer_s: f64,
    rate_hz: f64,
    drift: f64,
    drop_share: f64,
}

const FIXED_S: f64 = 0.003;

impl Link {
    /// At exactly 100 Hz the sampling beats with the timer, at any other rate it sweeps through it.
    fn draw(timer_s: f64, beats: bool, random: &mut ChaCha8Rng) -> Self {
        let ahead = if random.random_bool(0.5) { 50e-6 } else { -50e-6 };
        Self {
            timer_s,
            rate_hz: if beats { 100.0 } else { random.random_range(95.0..105.0) },
            drift: if beats { ahead } else { random.random_range(-50e-6..50e-6) },
            drop_share: random.random_range(0.0..0.01),
        }
    }

    /// Host time at which the device's clock showed `device_s`, when its sample left no trace of
    /// latency but the fixed one.
    fn true_host_s(&self, device_s: f64) -> f64 {
        1000.0 + device_s * (1.0 + self.drift) + FIXED_S
    }

    /// Pushes so many seconds of samples as the host would see them arrive.
    fn run(&self, envelope: &mut Envelope, duration_s: f64, random: &mut ChaCha8Rng) {
        let jitter = Exp::new(1.0 / 0.3e-3).expect("a positive rate");
        let timer_phase = random.random_range(0.0..self.timer_s);
        let mut blocked_until_s = f64::NEG_INFINITY;
        for index in 0..(duration_s * self.rate_hz) as u64 {
            // The device stamps by its own clock, in whole microseconds.
            let device_s = (index as f64 / self.rate_hz * 1e6).round() / 1e6;
            let sent_s = self.true_host_s(device_s) + jitter.sample(random);
            let ticks = ((sent_s - timer_phase) / self.timer_s).ceil();
            let mut arrival_s = ticks * self.timer_s + timer_phase;
            if random.random_bool(0.001) {
                blocked_until_s = arrival_s + random.random_range(0.05..0.2);
            }
            arrival_s = arrival_s.max(blocked_until_s);
            if !random.random_bool(self.drop_share) {
                envelope.push(device_s, arrival_s);
            }
        }
    }
}

/// Largest error of the line over the run [s].
fn error_s(line: &ClockLine, link: &Link, duration_s: f64) -> f64 {
    let at = |device_s: f64| (line.host_s(device_s) - link.true_host_s(device_s)).abs();
    at(0.0).max(at(duration_s / 2.0)).max(at(duration_s))
}

/// Errors and bounds [s] of all draws at one adapter timer.
fn draws(timer_s: f64, beats: bool) -> Vec<(f64, f64)> {
    let draw = |seed| {
        let random = &mut ChaCha8Rng::seed_from_u64(seed);
        let link = Link::draw(timer_s, beats, random);
        let mut envelope = Envelope::new(timer_s);
        link.run(&mut envelope, 60.0, random);
        let line = envelope.line().expect("points were pushed");
        (error_s(&line, &link, 60.0), line.bound_s)
    };
    (0..DRAWS).map(draw).collect()
}

/// Checks all draws, and says how they came out.
fn check(timer_s: f64, beats: bool, error_max_s: f64, bound_max_s: f64) -> String {
    let draws = draws(timer_s, beats);
    let worst = draws.iter().map(|(error, _)| *error).fold(0.0, f64::max);
    let mean = draws.iter().map(|(error, _)| *error).sum::<f64>() / draws.len() as f64;
    let bound = draws.iter().map(|(_, bound)| *bound).sum::<f64>() / draws.len() as f64;
    let honest = draws.iter().filter(|(error, bound)| error <= bound).count();
    let [worst_ms, mean_ms, bound_ms] = [worst, mean, bound].map(|time_s| 1e3 * time_s);
    let told = format!(
        "timer {} ms{}: error mean {mean_ms:.3} ms, worst {worst_ms:.3} ms; bound mean \
         {bound_ms:.3} ms, honest in {honest} of {DRAWS}",
        1e3 * timer_s,
        if beats { ", beating" } else { "" }
    );
    assert!(worst <= error_max_s, "worst error {worst_ms} ms");
    assert!(bound <= bound_max_s, "mean bound {bound_ms} ms");
    assert!(honest as f64 >= 0.95 * DRAWS as f64, "honest in {honest} of {DRAWS}");
    told
}

#[test]
fn behind_a_timer_of_one_millisecond_the_error_stays_below_a_third_of_it() {
    println!("{}", check(0.001, false, 0.3e-3, 0.3e-3));
    println!("{}", check(0.001, true, 0.3e-3, 1e-3));
}

#[test]
fn behind_a_timer_of_sixteen_milliseconds_the_error_stays_below_one() {
    println!("{}", check(0.016, false, 1e-3, 1e-3));
    println!("{}", check(0.016, true, 1e-3, 2e-3));
}

#[test]
fn ten_minutes_of_changing_drift_are_followed() {
    let random = &mut ChaCha8Rng::seed_from_u64(7);
    let jitter = Exp::new(1.0 / 0.3e-3).unwrap();
    let mut envelope = Envelope::new(0.001);
    // 0.05 ppm more of drift in every second, as a board does that warms up.
    let truth_s = |device_s: f64| device_s + 0.5 * 0.05e-6 * device_s * device_s;
    let mut worst_s: f64 = 0.0;
    for index in 0..60_000 {
        let device_s = f64::from(index) * 0.01;
        envelope.push(device_s, truth_s(device_s) + jitter.sample(random));
        if index >= 6000 && index % 500 == 0 {
            let line = envelope.line().unwrap();
            worst_s = worst_s.max((line.host_s(device_s) - truth_s(device_s)).abs());
        }
    }
    assert!(worst_s < 0.2e-3, "{worst_s} s");
}
