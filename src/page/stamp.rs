//! Date and time in words, from a clock that is given.

use devices::clock::WallClock;
use jiff::Timestamp;

/// Date and time in UTC at a time of the clock [ns].
pub fn stamp(clock: &WallClock, now_ns: u64, format: &str) -> String {
    let unix_ns = clock.start_unix_ns() as i128 + i128::from(now_ns);
    Timestamp::from_nanosecond(unix_ns).unwrap_or_default().strftime(format).to_string()
}

/// Date and time in UTC now, as calibrations and judgements carry it.
pub fn stamp_of_now() -> String {
    stamp(&WallClock::start(), 0, "%Y-%m-%d %H:%M:%S UTC")
}
