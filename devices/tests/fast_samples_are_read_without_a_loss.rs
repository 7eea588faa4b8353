//! Two fast instruments together: nothing lost, memory flat.

use std::time::Duration;

use devices::InstrumentEvent;
use devices::emulator::Fault;

use crate::bench::{Bench, bench, channels};

/// Resident memory of this process [MB].
fn resident_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux tells it");
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap_or_default();
    let kilobytes = line.split_whitespace().nth(1).and_then(|text| text.parse::<f64>().ok());
    kilobytes.expect("a number") / 1024.0
}

/// CPU time of this process [s], all threads.
fn cpu_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("Linux tells it");
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let ticks = after_name.split_whitespace().skip(11).take(2);
    ticks.map(|ticks| ticks.parse::<f64>().expect("a count")).sum::<f64>() / 100.0
}

/// Takes what came, and keeps nothing but its number.
fn drain(bench: &mut Bench) -> usize {
    let mut n_samples = 0;
    while bench.instrument.next(Duration::ZERO, &mut bench.events).is_some() {
        for event in bench.events.drain(..) {
            match event {
                InstrumentEvent::Sample(_) => n_samples += 1,
                InstrumentEvent::Linked { .. } | InstrumentEvent::Identity(_) => {}
                other => panic!("{other:?}"),
            }
        }
    }
    n_samples
}

fn soak(duration_s: f64) -> String {
    let binary = format!("[settings]\nfields = 4\n{}", channels(4));
    let mut binary = bench("cobs-board", &binary, 2000.0);
    // A quantity may come from two fields of one device here; a campaign would refuse it.
    let second_half = (0..4).fold(channels(4), |lines, field| {
        lines.replace(&format!("field = {field}\n"), &format!("field = 1{field}\n"))
    });
    let second_half = (0..4).fold(second_half, |lines, field| {
        lines.replace(&format!("field = 1{field}\n"), &format!("field = {}\n", field + 4))
    });
    let eight = channels(4) + &second_half;
    let pattern = "$RD,{sequence},{time_us},{0},{1},{2},{3},{4},{5},{6},{7}*{xor}";
    let text = format!(
        "baud = 921600\n[settings]\npattern = \"{pattern}\"\nterminators = \"\\r\\n\"\n{eight}"
    );
    let mut text = bench("arduino-text", &text, 100.0);
    text.port.fault(Fault::DriftPpm(-50.0));
    let clock = std::sync::Arc::clone(&binary.clock);
    let (mut n_binary, mut n_text) = (drain(&mut binary), drain(&mut text));
    let mut settled = None;
    let start_ns = clock.now_ns();
    let elapsed_s = |now_ns: u64| (now_ns - start_ns) as f64 * 1e-9;
    while elapsed_s(clock.now_ns()) < duration_s {
        std::thread::sleep(Duration::from_millis(20));
        n_binary += drain(&mut binary);
        n_text += drain(&mut text);
        // Allocators grow at first; a leak grows for ever.
        if settled.is_none() && elapsed_s(clock.now_ns()) > duration_s / 4.0 {
            settled = Some((resident_mb(), cpu_s(), clock.now_ns()));
        }
    }
    let (settled_mb, settled_cpu_s, settled_ns) = settled.expect("a quarter passed");
    let (end_mb, end_cpu_s) = (resident_mb(), cpu_s());
    let cpu = (end_cpu_s - settled_cpu_s) / ((clock.now_ns() - settled_ns) as f64 * 1e-9);
    for (quantity, counts) in binary.instrument.counts().chain(text.instrument.counts()) {
        let faultless = (counts.lost, counts.damaged, counts.repeated) == (0, 0, 0);
        assert!(faultless, "{quantity:?}: {counts:?}");
    }
    assert!(n_binary as f64 > 0.9 * 4.0 * 2000.0 * duration_s, "{n_binary} samples");
    assert!(n_text as f64 > 0.9 * 8.0 * 100.0 * duration_s, "{n_text} samples");
    assert!(end_mb < settled_mb + 4.0, "from {settled_mb:.1} to {end_mb:.1} MB");
    format!(
        "{duration_s} s: {n_binary} binary and {n_text} text samples, none lost; CPU {:.1} % with \
         the emulators; memory {settled_mb:.1} to {end_mb:.1} MB",
        100.0 * cpu
    )
}

#[test]
fn a_few_seconds_lose_nothing() {
    println!("{}", soak(4.0));
}
