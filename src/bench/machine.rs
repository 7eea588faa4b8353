//! The machine that the figures come from.

use std::fs;
use std::thread::available_parallelism;

/// Processor and number of cores, as the machine tells them.
pub fn machine() -> String {
    let information = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = information
        .lines()
        .find_map(|line| line.strip_prefix("model name"))
        .and_then(|rest| rest.split_once(':'))
        .map_or("a processor without a name", |(_, name)| name.trim());
    let cores = available_parallelism().map_or(1, usize::from);
    format!("{model}, {cores} cores")
}
