//! A labelled scene of the simulated tank, and the check that its runs are found.

use devices::Sample;
use rolltank::run::{Aftermath, Event, Limits, Rejection, Run, RunEnd, RunFinder, RunKind};
use rolltank::tank::{Scenario, SimulatedPass, TrueKind, TrueRun, simulate_pass};

/// One pass with its instruments.
#[derive(Clone)]
pub(crate) struct Scene {
    /// Natural frequency [rad/s], `b1` [1/s], `b3` [s].
    pub(crate) model: (f64, f64, f64),
    /// Keys of the roll instrument.
    pub(crate) roll: &'static str,
    /// Keys of the force instrument; not recorded when empty.
    pub(crate) force: &'static str,
    /// Keys of the speed instrument; not recorded when empty.
    pub(crate) speed: &'static str,
    /// Keys of the pass beside its actions.
    pub(crate) pass: &'static str,
    /// Seed of the draws.
    pub(crate) seed: u64,
}

/// Bare hull of the paper at rest, roll alone.
pub(crate) const AT_REST: Scene = Scene {
    model: (6.905, 0.3796, 0.1436),
    roll: "sample_rate_hz = 100.0\nnoise_deg = 0.05\nquantum_deg = 0.01",
    force: "",
    speed: "",
    pass: "froude = 0.0",
    seed: 20,
};

/// The same with force and speed recorded, at Froude number 0.2.
pub(crate) const UNDER_WAY: Scene = Scene {
    force: FORCE,
    speed: "sample_rate_hz = 20.0\nnoise_m_s = 0.003\nquantum_m_s = 0.001",
    pass: "froude = 0.2\ncarriage = { start_s = 6.0 }",
    ..AT_REST
};

/// The same with the force recorded, at rest.
pub(crate) const ON_THE_ROD: Scene = Scene { force: FORCE, ..AT_REST };

/// A load cell.
const FORCE: &str = "sample_rate_hz = 100.0\nnoise_n = 0.12\nquantum_n = 0.02";

impl Scene {
    fn text(&self, actions: &str) -> String {
        let (w, b1, b3) = self.model;
        let instrument = |name: &str, keys: &str| match keys {
            "" => String::new(),
            keys => format!("[instruments.{name}]\n{keys}\n"),
        };
        let roll = instrument("roll", self.roll);
        let force = instrument("force", self.force);
        let speed = instrument("speed", self.speed);
        let pass = self.pass;
        format!(
            "name = \"scene\"\n\
             [hull]\nlength_pp_m = 2.5\nbeam_m = 0.387\ndraft_m = 0.132\n\
             displacement_m3 = 0.110\ngm_m = 0.074\n\
             [tank]\nlength_m = 50.0\nwidth_m = 10.0\ndepth_m = 5.0\n\
             carriage_max_speed_m_s = 2.0\n\
             [recordings]\none_file_per_channel = true\n\
             [exciter]\nmoment_arm_m = 0.43\n\
             {roll}{force}{speed}\
             [[condition]]\nname = \"hull\"\nnatural_frequency_rad_s = {w}\n\
             damping.law = {{ b0_per_s = {b1}, kappa = 5.0, b3_s = {b3} }}\n\
             [[pass]]\ncondition = \"hull\"\n{pass}\naction = [ {actions} ]\n"
        )
    }

    /// Plays the actions and gives the samples with their truth.
    pub(crate) fn play(&self, actions: &str) -> SimulatedPass {
        let scenario = Scenario::parse(&self.text(actions), "scene.toml").expect("a valid scene");
        simulate_pass(&scenario, 0, self.seed)
    }

    /// Plays the actions, finds the runs and checks each against the truth.
    pub(crate) fn check(&self, actions: &str) -> Found {
        let played = self.play(actions);
        let found = find(&played, LIMITS);
        for truth in &played.truth.runs {
            println!(
                "truth {:?} {:.2} to {:.2} s, {:?}",
                truth.kind, truth.start_s, truth.end_s, truth.end
            );
        }
        found.print();
        let truths = &played.truth.runs;
        let natural_s = std::f64::consts::TAU / self.model.0;
        assert_eq!(found.runs.len(), truths.len(), "number of runs");
        for (run, truth) in found.runs.iter().zip(truths) {
            check_run(run, truth, natural_s);
        }
        found
    }
}

/// The tank of the scenes.
pub(crate) const LIMITS: Limits = Limits {
    carriage_max_speed_m_s: Some(2.0),
    declared_speed_m_s: None,
    length_pp_m: 2.5,
    gravity_m_s2: 9.81,
};

/// What the run finder made of a scene.
pub(crate) struct Found {
    pub(crate) runs: Vec<Run>,
    pub(crate) rejected: Vec<Rejection>,
    pub(crate) aftermaths: Vec<Aftermath>,
}

impl Found {
    pub(crate) fn print(&self) {
        for run in &self.runs {
            println!(
                "found {:?} {:.2} to {:.2} s, {:?}, {:?} rad/s, {:?}",
                run.kind, run.start_s, run.end_s, run.end, run.excitation_rad_s, run.still
            );
        }
        for stretch in &self.rejected {
            println!("{:.2} to {:.2} s: {}", stretch.start_s, stretch.end_s, stretch.reason);
        }
    }

    /// The rejection whose reason holds `part`.
    pub(crate) fn rejected_for(&self, part: &str) -> &Rejection {
        let with = |r: &&Rejection| r.reason.contains(part);
        self.rejected.iter().find(with).unwrap_or_else(|| panic!("nothing rejected for {part}"))
    }
}

/// Feeds a played pass to the run finder.
pub(crate) fn find(played: &SimulatedPass, limits: Limits) -> Found {
    find_in(&played.samples, limits)
}

/// Feeds samples to the run finder.
pub(crate) fn find_in(samples: &[Sample], limits: Limits) -> Found {
    let mut finder = RunFinder::new(limits);
    let mut events = Vec::new();
    for sample in samples {
        finder.push(sample, &mut events);
    }
    finder.finish(&mut events);
    let (mut runs, mut rejected, mut aftermaths) = (Vec::new(), Vec::new(), Vec::new());
    for event in events {
        match event {
            Event::Run(run) => runs.push(run),
            Event::Rejected(rejection) => rejected.push(rejection),
            Event::Aftermath(after) => aftermaths.push(after),
        }
    }
    Found { runs, rejected, aftermaths }
}

/// Start and end within 0.1 s or half a roll period, whichever is longer; never before the model
/// is free, but for what the smoothing over three bins of 0.05 s blurs.
fn check_run(run: &Run, truth: &TrueRun, natural_s: f64) {
    let kind = match truth.kind {
        TrueKind::Decay => RunKind::Decay,
        TrueKind::Forced => RunKind::Forced,
    };
    assert_eq!(run.kind, kind);
    let period_s = truth.excitation_rad_s.map_or(natural_s, |w| std::f64::consts::TAU / w);
    let allowed_s = (0.5 * period_s).max(0.1);
    let driven = truth.kind == TrueKind::Forced && truth.imposed_amplitude_rad.is_none();
    let (early_s, late_s) = match truth.kind {
        TrueKind::Decay => (0.0, allowed_s),
        // The truth waits until linear damping alone has taken the transient below 1 %; with the
        // cubic damping it dies sooner. What counts is that the amplitude is steady.
        TrueKind::Forced if driven => {
            check_amplitude(run, period_s);
            (0.7 * 2.0 * 100.0_f64.ln() / truth.b1_per_s, allowed_s)
        }
        // The last quarter of a smooth ramp of 2 s moves the phase by hundredths of a radian.
        TrueKind::Forced => (allowed_s + 0.5, allowed_s),
    };
    let start_off_s = run.start_s - truth.start_s;
    assert!((-early_s - 0.05..=late_s).contains(&start_off_s), "start {start_off_s:+.3} s");
    let end_off_s = run.end_s - truth.end_s;
    // A noise known to 15 % loses the roll at a time known to a fall by 15 %.
    let lost_s = if run.end == RunEnd::LostInNoise { 0.3 / truth.b1_per_s } else { 0.0 };
    let allowed_s = allowed_s.max(lost_s);
    assert!(end_off_s.abs() <= allowed_s, "end {end_off_s:+.3} s of {allowed_s:.3} s");
    // The two enums name the same ends.
    assert_eq!(format!("{:?}", run.end), format!("{:?}", truth.end));
    if let (Some(found), Some(true_rad_s)) = (run.excitation_rad_s, truth.excitation_rad_s) {
        // A tenth of a degree of phase error over the run at the least.
        assert!((found / true_rad_s - 1.0).abs() < 2e-3, "{found} rad/s");
    }
    assert_eq!(run.excitation_rad_s.is_some(), kind == RunKind::Forced);
    assert!(run.roll.time_s.first() == Some(&run.start_s));
    assert!(run.roll.time_s.last() == Some(&run.end_s));
}

/// The amplitude over the first two periods is that of the last two, within 5 %.
fn check_amplitude(run: &Run, period_s: f64) {
    let swing = |from_s: f64| {
        let inside = |t: &f64| (from_s..=from_s + 2.0 * period_s).contains(t);
        let pairs = run.roll.time_s.iter().zip(&run.roll.value).filter(|(t, _)| inside(t));
        let (low, high) = pairs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, v)| {
            (low.min(*v), high.max(*v))
        });
        high - low
    };
    let ratio = swing(run.start_s) / swing(run.end_s - 2.0 * period_s);
    assert!((ratio - 1.0).abs() < 0.05, "the amplitude changes by a factor of {ratio}");
}
