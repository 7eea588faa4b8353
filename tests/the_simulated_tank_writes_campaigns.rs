//! Campaign folders from scenarios: the paper's, the documented one, and those that are refused.

use devices::{Device, Quantity, Reading, Sample};
use proptest::prelude::*;
use replay::{ChannelColumn, Columns, Player, TimeColumn};
use rolltank::tank::{Scenario, TrueKind, paper, simulate_pass, truth_path, write_campaign};

const DOCUMENTED: &str = include_str!("../docs/scenario.md");

fn documented() -> &'static str {
    let (_, rest) = DOCUMENTED.split_once("```toml").expect("an example in the page");
    rest.split_once("```").expect("an end to the example").0
}

/// The documented scenario with one thing changed.
fn changed(from: &str, to: &str) -> String {
    assert!(documented().contains(from), "\"{from}\" is not in the example");
    documented().replacen(from, to, 1)
}

fn refusal(text: &str) -> String {
    Scenario::parse(text, "morning.toml").expect_err("a mistake in the file").to_string()
}

#[test]
fn the_documented_example_parses_and_every_pass_of_it_holds_runs() {
    let scenario = Scenario::parse(documented(), "docs/scenario.md").unwrap();
    assert_eq!(scenario.pass_count(), 6);
    for index in 0..scenario.pass_count() {
        let pass = simulate_pass(&scenario, index, 1);
        assert!(!pass.truth.runs.is_empty(), "no run in {}", pass.name);
        assert!(pass.samples.iter().all(|s| s.value.is_finite()));
        assert!(pass.samples.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s));
    }
}

#[test]
fn the_papers_campaign_has_a_decay_for_each_row_of_table_2_and_the_whole_forced_ladder() {
    let scenario = Scenario::builtin("paper").unwrap().checked().unwrap();
    let passes: Vec<_> =
        (0..scenario.pass_count()).map(|index| simulate_pass(&scenario, index, 3).truth).collect();
    for (name, rows) in [("bare hull", paper::BARE_HULL), ("bilge keels", paper::BILGE_KEELS)] {
        let of = |kind| {
            let mine = passes.iter().filter(|p| p.condition == name);
            mine.flat_map(|p| &p.runs).filter(move |r| r.kind == kind)
        };
        let decays: Vec<_> = of(TrueKind::Decay).collect();
        assert_eq!(decays.len(), 5);
        for (run, row) in decays.iter().zip(rows) {
            assert!((run.froude - row.froude).abs() < 1e-12);
            assert!((run.b1_per_s - row.b1_per_s).abs() < 1e-12);
            assert!((run.b3_s - row.b3_s).abs() < 1e-12);
        }
        for row in rows {
            let speeds = of(TrueKind::Forced).filter(|r| (r.froude - row.froude).abs() < 1e-9);
            let runs: Vec<_> = speeds.collect();
            assert_eq!(runs.len(), 7, "{name} at Fr {}", row.froude);
            for run in runs {
                let period_s = std::f64::consts::TAU / run.excitation_rad_s.unwrap();
                assert!(run.end_s - run.start_s > 7.9 * period_s, "too few periods: {run:?}");
            }
        }
    }
}

#[test]
fn a_campaign_is_written_once_with_its_truth_beside_it() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("morning");
    let scenario = Scenario::parse(documented(), "docs/scenario.md").unwrap();
    let mut told = Vec::new();
    write_campaign(&scenario, 5, &folder, &mut |done, total| told.push((done, total))).unwrap();
    assert_eq!(told, [0, 1, 2, 3, 4, 5, 6].map(|done| (done, 6)));
    let truth = std::fs::read_to_string(truth_path(&folder).unwrap()).unwrap();
    assert!(truth.contains("\"schema\": \"rolltank.truth/1\"") && truth.contains("\"b1_per_s\""));
    let campaign = std::fs::read_to_string(folder.join("campaign.toml")).unwrap();
    assert!(campaign.contains("roll = \"runs/troubled_roll.csv\""), "{campaign}");
    assert!(!campaign.contains("b1_per_s"), "the truth stays outside the folder");
    let roll = std::fs::read_to_string(folder.join("runs/pass_01_roll.csv")).unwrap();
    assert!(roll.starts_with("t;roll\n0;"), "{}", &roll[..40]);
    let again = write_campaign(&scenario, 5, &folder, &mut |_, _| ()).unwrap_err().to_string();
    assert!(again.contains("is not empty\nhint: "), "{again}");
}

/// Plays one recording to its end.
fn played(files: &[(Option<Quantity>, std::path::PathBuf)], columns: &Columns) -> Vec<Sample> {
    let mut player = Player::open("pass_01", files, columns).expect("a recording");
    let mut samples = Vec::new();
    while player.read(&mut samples).expect("a whole recording") == Reading::More {}
    samples
}

#[test]
fn an_mcap_campaign_plays_back_the_samples_that_were_simulated() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("day");
    let text = changed("format = \"csv\"", "format = \"mcap\"");
    let scenario = Scenario::parse(&text, "mcap").unwrap();
    write_campaign(&scenario, 5, &folder, &mut |_, _| ()).unwrap();
    let samples = played(&[(None, folder.join("runs/pass_01.mcap"))], &Columns::default());
    let simulated = simulate_pass(&scenario, 0, 5).samples;
    assert_eq!(samples.len(), simulated.len());
    for (a, b) in samples.iter().zip(&simulated) {
        assert_eq!((a.quantity, a.value.to_bits()), (b.quantity, b.value.to_bits()));
        // Log times are whole nanoseconds.
        assert!((a.time_s - b.time_s).abs() < 1e-9, "{a:?} {b:?}");
    }
}

#[test]
fn a_csv_campaign_plays_back_the_samples_that_were_simulated() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("day");
    let scenario = Scenario::parse(documented(), "csv").unwrap();
    write_campaign(&scenario, 5, &folder, &mut |_, _| ()).unwrap();
    let quantities = [Quantity::Roll, Quantity::Force, Quantity::Speed];
    let channels = quantities.map(|quantity| ChannelColumn {
        quantity,
        column: quantity.name().to_owned(),
        topic: None,
        time: None,
        si_per_unit: if quantity == Quantity::Roll { 1.0_f64.to_radians() } else { 1.0 },
    });
    let columns = Columns {
        time: Some(TimeColumn { column: "t".to_owned(), seconds_per_unit: 1.0 }),
        sample_rate_hz: None,
        channels: channels.into(),
    };
    let files = quantities.map(|quantity| {
        (Some(quantity), folder.join(format!("runs/troubled_{}.csv", quantity.name())))
    });
    let samples = played(&files, &columns);
    let simulated = simulate_pass(&scenario, 3, 5).samples;
    assert_eq!(samples.len(), simulated.len());
    for (a, b) in samples.iter().zip(&simulated) {
        assert_eq!(a.quantity, b.quantity);
        // The table keeps six decimals of a time and of degrees, eight of any other value.
        assert!((a.time_s - b.time_s).abs() < 1e-6 && (a.value - b.value).abs() < 2e-8);
    }
}

#[test]
fn equal_seeds_give_equal_samples_and_other_seeds_do_not() {
    let scenario = Scenario::parse(documented(), "docs/scenario.md").unwrap();
    let samples = |index, seed| simulate_pass(&scenario, index, seed).samples;
    assert_eq!(samples(0, 11), samples(0, 11));
    assert_ne!(samples(0, 11), samples(0, 12));
    assert_ne!(samples(0, 11), samples(1, 11), "repeats have draws of their own");
}

#[test]
fn the_scatter_of_a_law_is_drawn_from_pass_to_pass() {
    let text = changed("condition = \"bare hull\"", "condition = \"bilge keels\"")
        .replace("repeat = 3", "repeat = 200")
        .replace("duration_s = 30.0, fade_s = 0.0", "duration_s = 4.0");
    let scenario = Scenario::parse(&text, "scatter").unwrap();
    let b1: Vec<f64> =
        (0..200).map(|index| simulate_pass(&scenario, index, 9).truth.runs[0].b1_per_s).collect();
    let mean = b1.iter().sum::<f64>() / 200.0;
    let sd = (b1.iter().map(|b| (b - mean).powi(2)).sum::<f64>() / 199.0).sqrt();
    // The standard error of the mean is 0.05/sqrt(200), of the sd 0.05/sqrt(400); four of each.
    assert!((mean - 1.13 * (1.0 + 11.9 * 0.04)).abs() < 0.0142, "{mean}");
    assert!((sd - 0.05).abs() < 0.01, "{sd}");
}

#[test]
fn a_misspelt_key_is_told_with_its_line_and_the_right_spelling() {
    let message = refusal(&changed("displacement_m3", "displacment_m3"));
    assert!(message.starts_with("morning.toml:8: unknown field `displacment_m3`"), "{message}");
    assert!(message.ends_with("hint: did you mean `displacement_m3`?"), "{message}");
    let message = refusal(&changed("heel_deg = 12.0", "heel_dge = 12.0"));
    assert!(message.contains("keys in table: heel_dge") && message.contains("`heel_deg`?"));
    let message = refusal(&changed("{ catch = ", "{ cach = "));
    assert!(message.ends_with("hint: did you mean `catch`?"), "{message}");
}

#[test]
fn a_froude_number_beyond_the_carriage_is_refused_with_the_arithmetic() {
    let message = refusal(&changed("froude = 0.2", "froude = 1.0"));
    assert!(message.contains("[[pass]] number 1: a speed of 4.952 m/s exceeds"), "{message}");
    assert!(message.contains("sqrt(9.81 x 2.5)") && message.contains("0.404"), "{message}");
    let line = documented().lines().position(|l| l == "[[pass]]").unwrap() + 1;
    assert!(message.starts_with(&format!("morning.toml:{line}: ")), "{message}");
}

#[test]
fn values_outside_their_limits_are_refused_by_name() {
    let cases = [
        ("gm_m = 0.074", "gm_m = -0.074", "gm_m = -0.074 is not positive"),
        ("draft_m = 0.132", "draft_m = nan", "draft_m = NaN is not positive"),
        ("heel_deg = 12.0", "heel_deg = 120.0", "action 2: hold.heel_deg = 120"),
        ("repeat = 3", "repeat = 0", "repeat = 0 is outside 1 to 1000"),
        ("channel = \"roll\"", "channel = \"heave\"", "gap.channel = \"heave\" is not recorded"),
        ("brake_s = 60.0", "brake_s = 99.0", "overruns the tank"),
        ("condition = \"bare hull\"", "condition = \"bear\"", "condition \"bear\" is not in"),
        ("delimiter = \";\"", "delimiter = \",\"", "decimal_comma needs another delimiter"),
        ("one_file_per_channel = true", "", "different clocks cannot share one table"),
        ("froude = 0.2 ", "froude = 0.2\nspeed_m_s = 1.0 ", "needs either froude or speed_m_s"),
        ("{ froude = 0.4,", "{ froude = 0.15,", "0.200 is outside the damping table of"),
        ("impulse_n_m_s = 1.5", "impulse_n_m_s = 90.0", "strike.impulse_n_m_s = 90 is outside"),
        ("b1_per_s = 0.3796", "b1_per_s = 0.0", "b1_per_s of the damping = 0 is not positive"),
        ("arm = \"constant\"", "arm = \"rod\"", "arm = \"rod\" needs rod_length_m"),
        ("force_sign = 1.0", "force_sign = 0.5", "force_sign = 0.5 is neither 1.0 nor -1.0"),
        ("name = \"troubled\"", "name = \"a/b\"", "name = \"a/b\" cannot be a file name"),
    ];
    for (from, to, expected) in cases {
        let message = refusal(&changed(from, to));
        assert!(message.contains(expected) && message.contains("\nhint: "), "{message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_damaged_scenario_is_refused_or_can_be_simulated(
        at in 0.0..1.0_f64,
        length in 0_usize..12,
        patch in "[-0-9a-z.=\\[\\]{}\"\\n ]{0,6}",
    ) {
        let text: Vec<char> = documented().chars().collect();
        let start = (at * text.len() as f64) as usize;
        let end = (start + length).min(text.len());
        let around = |part: &[char]| part.iter().collect::<String>();
        let damaged = around(&text[..start]) + &patch + &around(&text[end..]);
        match Scenario::parse(&damaged, "damaged.toml") {
            Err(error) => {
                let message = error.to_string();
                prop_assert!(message.starts_with("damaged.toml:"), "{message}");
                prop_assert!(message.contains("\nhint: "), "{message}");
            }
            Ok(scenario) => {
                let pass = simulate_pass(&scenario, scenario.pass_count() / 2, 1);
                prop_assert!(pass.samples.iter().all(|s| s.value.is_finite()));
            }
        }
    }
}
