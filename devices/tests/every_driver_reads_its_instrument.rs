//! Every driver reads the instrument it is for, over a real pseudo-terminal, with times and counts.

use devices::driver::DRIVERS;
use devices::emulator::{EMULATORS, Fault};
use devices::probe::probe;
use devices::{InstrumentEvent, Quality};

use crate::bench::{Bench, bench, bench_of, channels, swing};

/// Scheduling on a busy machine moves the emulator's stamps as well as ours [s].
const BUSY_S: f64 = 0.05;

/// Checks that so many samples come, each of the signal at its own time.
fn values_follow_the_signal(bench: &mut Bench, n_samples: usize, resolution: f64) {
    bench.listen_until(|bench| bench.n_samples() >= n_samples);
    // A slope of 1000 · 2π/4 a second turns an error of time into one of value.
    let tolerance = resolution + 1000.0 * std::f64::consts::TAU / 4.0 * BUSY_S;
    for measured in bench.samples() {
        let field = measured.sample.quantity as usize;
        let expected = swing(field, measured.sample.time_s);
        let error = (measured.raw - expected).abs();
        assert!(error < tolerance + 1571.0 * measured.bound_s, "{measured:?}, not {expected}");
        assert!(!measured.quality.has(Quality::OVER_RANGE), "{measured:?}");
    }
    assert_eq!(bench.troubles(), Vec::<String>::new());
}

fn identity(bench: &Bench) -> Option<&str> {
    bench.events.iter().find_map(|event| match event {
        InstrumentEvent::Identity(text) => Some(text.as_str()),
        _ => None,
    })
}

#[test]
fn every_driver_has_its_emulator() {
    let drivers = DRIVERS.iter().map(|driver| driver.name);
    assert!(drivers.eq(EMULATORS.iter().map(|emulator| emulator.driver)));
}

#[test]
fn a_board_of_text_lines_is_read_with_its_own_clock() {
    let mut bench = bench("arduino-text", &channels(2), 200.0);
    values_follow_the_signal(&mut bench, 400, 1e-3);
    assert!(bench.samples().iter().all(|measured| measured.sequence.is_some()));
    assert!(bench.instrument.counts().all(|(_, counts)| counts.lost == 0));
}

#[test]
fn a_scale_is_asked_for_every_line() {
    let lines = format!(
        "[pace]\nrate_hz = 100.0\n[settings]\npattern = \"S{{0}}\"\nrequest = \"SX\\r\\n\"\n{}",
        channels(1)
    );
    let mut bench = bench("scale-continuous", &lines, 500.0);
    values_follow_the_signal(&mut bench, 100, 1.0);
}

#[test]
fn mantracourt_cells_measure_at_one_snap() {
    let lines = format!("[settings]\nstations = [1, 14]\n{}", channels(2));
    let mut bench = bench("mantracourt-dsc", &lines, 500.0);
    values_follow_the_signal(&mut bench, 60, 1e-2);
    assert_eq!(identity(&bench), Some("Mantracourt version 3.1"));
    // Both stations carry the instant of the command, not that of their answers.
    let samples = bench.samples();
    for two in samples.chunks_exact(2) {
        let apart_s = two[1].sample.time_s - two[0].sample.time_s;
        assert!(apart_s.abs() < 1e-9, "{two:?}");
        assert!(two[0].bound_s < 0.002, "{two:?}");
    }
}

#[test]
fn a_mantracourt_value_read_twice_is_counted_and_dropped() {
    // One conversion in 50 ms, asked every 10 ms: most answers are old.
    let lines = format!("pace = {{ rate_hz = 100.0 }}\n{}", channels(1));
    let mut bench = bench("mantracourt-dscusb", &lines, 20.0);
    bench.listen_until(|bench| bench.n_samples() >= 20);
    let (_, counts) = bench.instrument.counts().next().unwrap();
    assert!(counts.repeated > counts.received, "{counts:?}");
    let samples = bench.samples();
    let apart = |two: &[devices::Measured]| (two[0].raw - two[1].raw).abs() > 0.0;
    assert!(samples.windows(2).all(apart), "{samples:?}");
}

#[test]
fn mantrabus_cells_are_read() {
    let lines = format!("[settings]\nstations = [1, 20]\ncommand = 40\n{}", channels(2));
    let mut bench = bench("mantrabus-dsc", &lines, 500.0);
    values_follow_the_signal(&mut bench, 100, 1e-2);
}

#[test]
fn dcon_modules_are_read_plain_summed_in_hexadecimal_and_synchronised() {
    let small = |field: usize, time_s: f64| swing(field, time_s) / 200.0;
    let variants = [
        "modules = [{ address = 1, channels = 2 }]",
        "modules = [{ address = 1 }, { address = 0x21 }]\nchecksum = true",
        "modules = [{ address = 1, channels = 2 }]\nhexadecimal = true",
        "modules = [{ address = 1 }, { address = 2 }]\nchecksum = true\nsynchronised = true",
    ];
    for settings in variants {
        let lines =
            format!("pace = {{ timeout_s = 0.1 }}\n[settings]\n{settings}\n{}", channels(2));
        let mut bench = bench_of("adam-4017", &lines, 500.0, Box::new(small));
        bench.listen_until(|bench| bench.n_samples() >= 40);
        assert_eq!(bench.troubles(), Vec::<String>::new(), "{settings}");
        assert_eq!(identity(&bench), Some("4017"));
        for measured in bench.samples() {
            let field = measured.sample.quantity as usize;
            let expected = small(field, measured.sample.time_s + bench.config.lag.delay_s());
            let tolerance = 8.0 * (BUSY_S + measured.bound_s)
                + if settings.contains("hex") { 0.5 } else { 1e-3 };
            assert!((measured.raw - expected).abs() < tolerance, "{measured:?}, not {expected}");
        }
    }
}

#[test]
fn modbus_registers_of_every_type_are_read() {
    let lines = r#"
        [settings]
        fields = [
            { function = 4, address = 0, type = "float32", order = "CDAB" },
            { function = 4, address = 2, type = "int32", order = "DCBA" },
            { function = 3, address = 7, type = "int16" },
            { station = 9, function = 3, address = 7, type = "float32", order = "BADC" },
        ]
    "#;
    let mut bench = bench("modbus-transmitter", &format!("{lines}\n{}", channels(4)), 500.0);
    values_follow_the_signal(&mut bench, 200, 1.0);
}

#[test]
fn hbm_digitisers_are_read_in_text_alone_on_a_bus_and_unasked() {
    let variants = [
        ("", 1),
        ("[settings]\nstations = [1, 2, 31]\n", 3),
        ("[settings]\ncontinuous = true\n", 1),
    ];
    for (settings, n_fields) in variants {
        let sends = if settings.contains("continuous") { "sends_hz = 100.0" } else { "" };
        let lines = format!("baud = 38400\n[pace]\n{sends}\n{settings}{}", channels(n_fields));
        let mut bench = bench("hbm-ad104", &lines, 100.0);
        values_follow_the_signal(&mut bench, 60, 1.0);
        assert_eq!(identity(&bench), Some("HBM,AD104C,170123,P54"));
        assert!(bench.samples().iter().all(|measured| measured.quality.has(Quality::LAGGED)));
    }
}

#[test]
fn hbm_digitisers_are_read_in_every_binary_format() {
    for format in [0, 2, 4, 6, 8, 12] {
        let checked = format & 8 != 0;
        let lines = format!("[settings]\nformat = {format}\nchecked = {checked}\n{}", channels(1));
        let mut bench = bench("hbm-ad104-binary", &lines, 100.0);
        values_follow_the_signal(&mut bench, 40, 1.0);
    }
}

#[test]
fn cobs_frames_come_at_two_kilohertz_without_a_loss() {
    let lines = format!("[settings]\nfields = 4\nidentify = true\n{}", channels(4));
    let mut bench = bench("cobs-board", &lines, 2000.0);
    values_follow_the_signal(&mut bench, 8000, 1.0);
    assert_eq!(identity(&bench), Some("rolltank emulated board"));
    for (_, counts) in bench.instrument.counts() {
        assert_eq!((counts.lost, counts.damaged, counts.repeated), (0, 0, 0), "{counts:?}");
    }
}

#[test]
fn skipped_repeated_damaged_and_over_driven_samples_are_counted() {
    let mut bench = bench("cobs-board", &format!("[settings]\nfields = 1\n{}", channels(1)), 500.0);
    bench.listen_until(|bench| bench.n_samples() >= 50);
    bench.port.fault(Fault::Skip(7));
    bench.listen_for(0.1);
    bench.port.fault(Fault::Repeat(3));
    bench.listen_for(0.1);
    bench.port.fault(Fault::Noise(40));
    bench.listen_for(0.1);
    bench.port.fault(Fault::Restart);
    bench.listen_for(0.1);
    let (_, counts) = bench.instrument.counts().next().unwrap();
    // Noise before a frame costs that frame: its end is found, its beginning is not.
    assert!((7..=8).contains(&counts.lost), "{counts:?}");
    assert_eq!(counts.repeated, 3, "{counts:?}");
    assert!((1..=3).contains(&counts.damaged), "{counts:?}");
    let gap = bench.events.iter().find_map(|event| match event {
        InstrumentEvent::Gap { n_missing, .. } => *n_missing,
        _ => None,
    });
    assert_eq!(gap, Some(7));
    let restarts = |event: &&InstrumentEvent| matches!(event, InstrumentEvent::Restarted { .. });
    assert_eq!(bench.events.iter().filter(restarts).count(), 1);
}

#[test]
fn an_over_driven_input_is_flagged_by_every_instrument_that_can() {
    let devices = [
        ("mantracourt-dscusb", String::new(), 1),
        ("adam-4017", String::new(), 1),
        ("hbm-ad104", "baud = 38400\n".to_owned(), 1),
        ("hbm-ad104-binary", String::new(), 1),
    ];
    for (profile, lines, n_fields) in devices {
        let mut bench = bench(profile, &format!("{lines}{}", channels(n_fields)), 100.0);
        bench.port.fault(Fault::Saturate(true));
        bench.listen_until(|bench| {
            let over = |measured: &devices::Measured| measured.quality.has(Quality::OVER_RANGE);
            bench.samples().iter().filter(|measured| over(measured)).count() >= 5
        });
        let (_, counts) = bench.instrument.counts().next().unwrap();
        assert!(counts.over_range >= 5, "{profile}: {counts:?}");
    }
}

#[test]
fn a_probe_tells_who_answers_and_what_it_reads() {
    let lines = format!("[settings]\nstations = [1, 2]\n{}", channels(2));
    let bench = bench("mantracourt-dsc", &lines, 500.0);
    let Bench { port, instrument, config, clock, .. } = bench;
    // One program at a time has the port.
    drop(instrument);
    let report = probe(&config, 1_000_000_000, &clock).unwrap();
    drop(port);
    assert!(report.linked && report.troubles.is_empty(), "{report:?}");
    assert_eq!(report.identity.as_deref(), Some("Mantracourt version 3.1"));
    for channel in &report.channels {
        let rate_hz = channel.rate_hz.unwrap();
        assert!(rate_hz > 20.0 && channel.counts.received > 10, "{channel:?}");
        assert!(channel.last.is_some() && channel.quality == Quality::LAGGED, "{channel:?}");
    }
}

#[test]
fn times_are_true_within_their_bound_though_the_boards_clock_is_fast() {
    // The emulator looks at its clock every half millisecond, and so is late by up to that.
    const TURN_S: f64 = 0.5e-3;
    // The board says when it measured, by the host's clock, in the value itself.
    let microseconds = |_: usize, time_s: f64| 1e6 * time_s;
    let lines = format!("[settings]\nfields = 1\n{}", channels(1));
    let mut bench = bench_of("cobs-board", &lines, 200.0, Box::new(microseconds));
    bench.port.fault(Fault::DriftPpm(50.0));
    bench.listen_for(8.0);
    let samples = bench.samples();
    let error_s = |measured: &devices::Measured| measured.sample.time_s - measured.raw * 1e-6;
    let errors_s = samples.iter().map(error_s);
    let worst =
        samples.iter().skip(20).map(error_s).fold((0.0, 0.0), |(low, high), error_s| {
            (f64::min(low, error_s), f64::max(high, error_s))
        });
    let late = |(measured, error_s): &(&devices::Measured, f64)| {
        *error_s < -measured.bound_s - 5e-6 || *error_s > measured.bound_s + TURN_S + 0.2e-3
    };
    let n_late = samples.iter().zip(errors_s).skip(20).filter(late).count();
    let n_samples = samples.len();
    assert!(
        n_samples > 1500 && 20 * n_late <= n_samples,
        "{n_late} of {n_samples} beyond, {worst:?}"
    );
    let bound_s = samples.last().unwrap().bound_s;
    println!("bound after 8 s: {:.3} ms; {n_late} of {n_samples} beyond", 1e3 * bound_s);
    assert!(bound_s < 0.5e-3, "{bound_s}");
}
