//! The bands of a decay's posterior over runs drawn from what tanks see.

use rolltank::bench::{Calibration, calibrate};

/// Campaigns of five runs.
const N_CAMPAIGNS: usize = 20;
const SEED: u64 = 1;

fn told() -> Calibration {
    let calibration = calibrate(N_CAMPAIGNS, SEED);
    for ranks in &calibration.ranks {
        println!(
            "{:18} {:4} runs: 95 % band {:5.1} %, 50 % band {:5.1} %, uniform {:.3} {}",
            ranks.name,
            ranks.below.len(),
            100.0 * ranks.coverage(0.95),
            100.0 * ranks.coverage(0.5),
            ranks.uniformity(),
            ranks.bars()
        );
    }
    calibration
}

#[test]
fn the_bands_hold_the_truth_as_often_as_they_say() {
    let calibration = told();
    assert!(calibration.refused.is_empty(), "{:?}", calibration.refused);
    assert_eq!(calibration.ranks.len(), 8);
    for ranks in &calibration.ranks {
        for band in [0.95, 0.5] {
            // Four standard errors: one case in sixteen thousand.
            let stray = (ranks.coverage(band) - band) / ranks.standard_error(band);
            assert!(stray.abs() < 4.0, "{}: {stray} standard errors off {band}", ranks.name);
        }
        assert!(ranks.uniformity() > 1e-4, "{}: {:?}", ranks.name, ranks.histogram());
    }
}

#[test]
fn the_same_seed_gives_the_same_ranks_to_the_bit() {
    assert_eq!(calibrate(3, 9), calibrate(3, 9));
    assert_ne!(calibrate(3, 9), calibrate(3, 10));
}
