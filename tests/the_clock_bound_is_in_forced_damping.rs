//! Two boards behind two adapters: what their clocks leave unsure of a forced run is in its bands.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use devices::Attachment;
use devices::emulator::{Fault, Faults, emulator};
use devices::port::LinkEvent;
use devices::setup::DeviceConfig;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp};
use replay::{AttachedDevice, Exit, LIVE_SOURCE, Provenance, Raw, Record, Recorder};
use rolltank::campaign;
use rolltank::pipeline::{self, Options};
use rolltank::results::IdentifiedRun;
use rolltank::roll::damping::cubic_weight;
use rolltank::uncertainty;

/// Whatever boards are added read a model on a rod.
const CAMPAIGN: &str = r#"name = "forced rolling"
[hull]
length_pp_m = 2.5
beam_m = 0.387
draft_m = 0.132
displacement_m3 = 0.110
gm_m = 0.074
[exciter]
moment_arm_m = 0.43
"#;

const RESTORING_N_M_PER_RAD: f64 = 1000.0 * 9.80665 * 0.110 * 0.074;
const NATURAL_RAD_S: f64 = 6.905;
const INERTIA_KG_M2: f64 = RESTORING_N_M_PER_RAD / (NATURAL_RAD_S * NATURAL_RAD_S);
const B1_PER_S: f64 = 0.45;
/// Well below resonance, where restoring passes for damping.
const FREQUENCY_RAD_S: f64 = 0.6 * NATURAL_RAD_S;
const AMPLITUDE_RAD: f64 = 0.14;
const BEGINS_S: f64 = 8.0;
const GROWS_S: f64 = 4.0;
const ENDS_S: f64 = 60.0;
/// Raw units per rad and per N.
const PER_UNIT: f64 = 1e5;

fn board(name: &str, quantities: &[&str]) -> String {
    let device = format!(
        "[[device]]\nname = \"{name}\"\nprofile = \"cobs-board\"\nport = \"/dev/{name}\"\n\
         settings = {{ fields = {} }}\n",
        quantities.len()
    );
    let gain = 1.0 / PER_UNIT;
    let channels = quantities.iter().enumerate().map(|(field, quantity)| {
        format!(
            "[[device.channel]]\nquantity = \"{quantity}\"\nfield = {field}\n\
             calibration = {{ curve = {{ gain = {gain} }} }}\n"
        )
    });
    [device].into_iter().chain(channels).collect()
}

fn roll_rad(time_s: f64) -> f64 {
    let share = ((time_s - BEGINS_S) / GROWS_S).clamp(0.0, 1.0);
    let left = ((ENDS_S - time_s) / GROWS_S).clamp(0.0, 1.0);
    let grown = |share: f64| share.powi(3) * (10.0 + share * (6.0 * share - 15.0));
    AMPLITUDE_RAD * grown(share) * grown(left) * (FREQUENCY_RAD_S * (time_s - BEGINS_S)).sin()
}

fn force_n(time_s: f64) -> f64 {
    const STEP_S: f64 = 1e-3;
    let [before, here, after] = [-STEP_S, 0.0, STEP_S].map(|by_s| roll_rad(time_s + by_s));
    let rate = (after - before) / (2.0 * STEP_S);
    let acceleration = (after - 2.0 * here + before) / (STEP_S * STEP_S);
    let damping = INERTIA_KG_M2 * B1_PER_S;
    (INERTIA_KG_M2 * acceleration + damping * rate + RESTORING_N_M_PER_RAD * here) / 0.43
}

/// Noise that repeats exactly: tones far above the roll.
fn noise(time_s: f64, phase: f64) -> f64 {
    let tones = [17.3, 23.9, 31.7, 41.1];
    tones.iter().map(|hz| (TAU * hz * time_s + phase * hz).sin()).sum::<f64>() / 2.0_f64.sqrt()
}

/// What a device has sent, each frame when an adapter with a timer handed it over.
fn received(config: &DeviceConfig, timer_s: f64, random: &mut ChaCha8Rng) -> Vec<Record> {
    let phase = random.random_range(0.0..TAU);
    let quantities: Vec<_> = config.channels.iter().map(|channel| channel.quantity).collect();
    let signal = move |field: usize, time_s: f64| match quantities[field] {
        devices::Quantity::Roll => PER_UNIT * (roll_rad(time_s) + 2e-5 * noise(time_s, phase)),
        _ => PER_UNIT * (force_n(time_s) + 0.005 * noise(time_s, phase + 1.0)),
    };
    let rate_hz = random.random_range(95.0..105.0);
    let mut faults = Faults::default();
    faults.command(Fault::DriftPpm(random.random_range(-50.0..50.0)));
    let board = emulator(&config.driver, &config.settings, rate_hz, Box::new(signal));
    let mut board = board.expect("the settings are good");
    let jitter = Exp::new(1.0 / 0.3e-3).expect("a positive rate");
    let timer_phase_s = random.random_range(0.0..timer_s);
    let device: Arc<str> = config.name.as_str().into();
    let mut records = Vec::new();
    let mut keep = |event: &LinkEvent| {
        records.extend(Raw::of_link(&device, event, 0.0).map(Record::Raw));
    };
    keep(&LinkEvent::Opened { at_ns: 1_000_000_000 });
    let mut now_s = 1.0 + random.random_range(0.0..0.01);
    while now_s < ENDS_S + 15.0 {
        let mut bytes = Vec::new();
        board.tick(now_s, &mut faults, &mut bytes);
        // The emulator answers at its conversions alone: each is sent as soon as it was made.
        if !bytes.is_empty() {
            let ready_s = now_s + jitter.sample(random);
            let ticks = ((ready_s - timer_phase_s) / timer_s).ceil();
            let arrived_s = ticks * timer_s + timer_phase_s;
            keep(&LinkEvent::Received {
                at_ns: (arrived_s * 1e9) as u64,
                bytes,
                decoded: Vec::new(),
            });
        }
        now_s += 2e-5;
    }
    records
}

/// The forced run of a campaign of these boards, each behind an adapter of its own, and what the
/// budget says of the time between them.
fn run(boards: &[(String, f64)], seed: u64) -> (IdentifiedRun, Option<f64>) {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let devices: String = boards.iter().map(|(text, _)| text.as_str()).collect();
    let text = format!("{CAMPAIGN}{devices}");
    fs::write(folder.path().join("campaign.toml"), &text).expect("the disk has room");
    write(folder.path(), &text, boards, seed);
    let campaign = campaign::read(folder.path()).unwrap_or_else(|error| panic!("{error:?}"));
    let listen = &mut |_: pipeline::Learnt<'_>| Ok(());
    let results = pipeline::replay(&campaign, &Options::default(), &mut |_| {}, listen);
    let results = results.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(results.runs.len(), 1, "{:?}", results.rejected);
    let budgets = uncertainty::budgets(&campaign, &results);
    (results.runs[0].clone(), budgets[0].skew_per_s)
}

fn write(folder: &Path, text: &str, boards: &[(String, f64)], seed: u64) {
    let campaign = campaign::read(folder).unwrap_or_else(|error| panic!("{error:?}"));
    let provenance = Provenance {
        campaign_text: text.to_owned(),
        source: LIVE_SOURCE.to_owned(),
        zero_log_time_ns: 0,
    };
    let mut recorder = Recorder::create(&folder.join("pass.mcap"), &provenance).expect("it starts");
    let random = &mut ChaCha8Rng::seed_from_u64(seed);
    let mut records = Vec::new();
    for (device, (_, timer_s)) in campaign.live.devices.iter().zip(boards) {
        let attachment = Attachment { latency_s: *timer_s, device: device.clone() };
        let attached = AttachedDevice {
            time_s: 0.0,
            device: device.name.clone(),
            profile: "cobs-board".to_owned(),
            port: device.port.display().to_string(),
            settings: attachment.to_text().expect("it is text"),
        };
        recorder.push(Record::Device(attached)).expect("the disk has room");
        records.extend(received(device, *timer_s, random));
    }
    records.sort_by(|a, b| a.time_s().total_cmp(&b.time_s()));
    for record in records {
        recorder.push(record).expect("the disk has room");
    }
    recorder.finish(Exit::success("the pass ended")).expect("the disk has room");
}

fn apart(timer_s: f64, seed: u64) -> (IdentifiedRun, f64) {
    let boards = [(board("roller", &["roll"]), timer_s), (board("cell", &["force"]), timer_s)];
    let (run, skew_per_s) = run(&boards, seed);
    (run, skew_per_s.expect("the bounds are stated"))
}

/// Whether the truth is within 1.96 of what two uncertainties together make.
fn covers(run: &IdentifiedRun, skew_per_s: f64) -> bool {
    let b1 = own_per_s(run, 0.0).hypot(skew_per_s);
    (damping_per_s(run) - B1_PER_S).abs() < 1.96 * b1
}

fn damping_per_s(run: &IdentifiedRun) -> f64 {
    run.at_comparison().expect("it reaches 5 deg").fitted_per_s.mean
}

/// Standard deviation of `b_eq` less a part of it.
fn own_per_s(run: &IdentifiedRun, part_per_s: f64) -> f64 {
    let sd = run.at_comparison().expect("it reaches 5 deg").fitted_per_s.sd;
    (sd * sd - part_per_s * part_per_s).max(0.0).sqrt()
}

#[test]
fn a_coarser_timer_makes_the_band_of_the_same_run_wider_and_the_band_holds() {
    let (mut held, mut held_without) = (0, 0);
    let n = 10;
    for seed in 0..n {
        let [(fine, fine_skew), (coarse, coarse_skew)] = [1e-3, 16e-3].map(|t| apart(t, seed));
        let weight = cubic_weight(FREQUENCY_RAD_S, 5.0_f64.to_radians());
        for (run, told) in [(&fine, fine_skew), (&coarse, coarse_skew)] {
            let skew = run.identification.skew.expect("the bounds are stated");
            let bounds: Vec<f64> =
                run.brought.iter().map(|channel| channel.bound_s.expect("stated")).collect();
            let by_hand = (bounds.iter().map(|b| b * b).sum::<f64>() / 3.0).sqrt();
            assert!((skew.sd_s - by_hand).abs() < 1e-12, "{bounds:?}");
            // (K/(I+dI) - w^2) u(t), and the budget says the same.
            let slope = NATURAL_RAD_S.powi(2) - FREQUENCY_RAD_S.powi(2);
            let skew_per_s = skew.damping_sd_per_s(weight);
            let ratio = skew_per_s / (slope * skew.sd_s);
            assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
            assert!((told - skew_per_s).abs() < 0.01 * skew_per_s, "{told}");
            let at = run.at_comparison().expect("it reaches 5 deg").fitted_per_s;
            assert!(at.sd >= skew_per_s, "{at:?}");
        }
        let sd = |run: &IdentifiedRun| own_per_s(run, 0.0);
        println!(
            "b_eq {:.4} ± {:.4} behind 1 ms, {:.4} ± {:.4} behind 16 ms; skew {:.4} and {:.4}",
            damping_per_s(&fine),
            sd(&fine),
            damping_per_s(&coarse),
            sd(&coarse),
            fine_skew,
            coarse_skew
        );
        assert!(sd(&coarse) > sd(&fine), "{} and {}", sd(&coarse), sd(&fine));
        let width = |run: &IdentifiedRun| {
            let moment = &run.identification.moment;
            moment.sd_per_s2.iter().sum::<f64>() / moment.sd_per_s2.len() as f64
        };
        assert!(width(&coarse) > width(&fine), "the band of the moment is wider too");
        held += usize::from(covers(&coarse, 0.0));
        let without = own_per_s(&coarse, coarse_skew);
        held_without += usize::from((damping_per_s(&coarse) - B1_PER_S).abs() < 1.96 * without);
    }
    println!("held {held} of {n}, without the clocks {held_without}");
    assert!(held >= 9, "{held} of {n}");
    assert!(held_without <= 5, "{held_without} of {n} would do without");
}

#[test]
fn channels_of_one_board_err_together() {
    let (run, skew_per_s) = run(&[(board("both", &["roll", "force"]), 16e-3)], 3);
    let skew = run.identification.skew.expect("the bound is stated");
    assert!(run.run.timing.is_common && skew.sd_s == 0.0 && skew_per_s == Some(0.0), "{skew:?}");
    assert!(run.brought.iter().all(|channel| channel.bound_s > Some(0.0)));
    assert!((damping_per_s(&run) - B1_PER_S).abs() < 0.01, "{}", damping_per_s(&run));
}

#[test]
fn a_cell_behind_a_filter_that_nobody_declared_states_no_bound() {
    let undeclared =
        board("cell", &["force"]).replace("settings", "lag = { kind = \"unknown\" }\nsettings");
    let (run, skew_per_s) = run(&[(board("roller", &["roll"]), 1e-3), (undeclared, 1e-3)], 3);
    let told: Vec<bool> = run.brought.iter().map(|channel| channel.bound_s.is_some()).collect();
    assert_eq!(told, [true, false], "{:?}", run.brought);
    assert!(run.identification.skew.is_none() && skew_per_s.is_none());
    let remarks = &run.identification.remarks;
    assert!(remarks.iter().any(|remark| remark.contains("no bound of the time")), "{remarks:?}");
}
