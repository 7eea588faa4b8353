//! A line that the runs share in what a model leaves, which each may show too faintly to be sure.

use super::facts::windowed_powers;
use crate::model::effects::{MAINS_OFF_HZ, mains_hz};
use crate::model::{Line, Recurs};

/// Multiple of the roll's own frequency below which a model leaves what it lacks of the roll, which
/// is no line (EFFECTS.md, section 8: 0.3 to 3 natural frequencies).
const ABOVE_ROLL: f64 = 3.0;
/// Values without which there is no spectrum.
const LEAST_VALUES: usize = 64;
/// Bins to either side whose powers tell the noise at a bin, and those beside it that do not.
const NEIGHBOURS: usize = 20;
const BESIDE: usize = 2;
/// What a line at one of three bins (ln 3), of an amplitude and a phase that may be twenty times as
/// many as the noise tells apart (ln 20), costs in evidence; the twenty by judgement.
const OCCAM: f64 = 4.1;
/// Power over the noise from which a run shows its line for itself: noise does one time in fifty at
/// the highest of three bins.
const SHOWN: f64 = 5.0;
/// Runs, and times by which the fastest of them is faster than the slowest, in which a line must go
/// with the speed.
const RUNS_IN_PROPORTION: usize = 3;
const SPEEDS_IN_PROPORTION: f64 = 1.3;

/// The powers of what a model leaves of one run.
pub(in crate::diagnosis) struct Spectrum {
    froude: f64,
    rate_hz: f64,
    n: usize,
    /// Its lowest bin.
    first: usize,
    powers: Vec<f64>,
}

/// A line of several runs.
pub(in crate::diagnosis) struct Shared {
    /// How it recurs.
    pub(in crate::diagnosis) recurs: Recurs,
    /// The line of each run that shows it for itself.
    pub(in crate::diagnosis) lines: Vec<Option<Line>>,
    log_bayes_factor: f64,
}

impl Spectrum {
    /// That above the roll of what a model leaves at a rate [Hz], of a run at a Froude number that
    /// rolls at a frequency [Hz]; none of too few values.
    pub(in crate::diagnosis) fn of(
        left: &[f64],
        rate_hz: f64,
        froude: f64,
        rolling_hz: f64,
    ) -> Option<Self> {
        let n = left.len();
        let first = (ABOVE_ROLL * rolling_hz * n as f64 / rate_hz).ceil() as usize;
        if n < LEAST_VALUES || 2 * (first + NEIGHBOURS) > n {
            return None;
        }
        let powers = windowed_powers(left, first).into_iter().map(|(power, _)| power).collect();
        Some(Self { froude, rate_hz, n, first, powers })
    }

    fn resolution_hz(&self) -> f64 {
        self.rate_hz / self.n as f64
    }

    /// The highest of three bins about a frequency, and its power over the noise; none outside the
    /// band.
    fn near(&self, hz: f64) -> Option<(usize, f64)> {
        let place = (hz / self.resolution_hz()).round() as usize;
        let middle = place.checked_sub(self.first).filter(|bin| *bin < self.powers.len())?;
        let three = middle.saturating_sub(1)..(middle + 2).min(self.powers.len());
        let best = three.max_by(|a, b| self.powers[*a].total_cmp(&self.powers[*b]))?;
        Some((best, self.powers[best] / self.noise(best)))
    }

    /// Mean power of noise at a bin, by the median of those around it.
    fn noise(&self, bin: usize) -> f64 {
        let around = bin.saturating_sub(NEIGHBOURS)..(bin + NEIGHBOURS + 1).min(self.powers.len());
        let mut others: Vec<f64> =
            around.filter(|k| k.abs_diff(bin) > BESIDE).map(|k| self.powers[k]).collect();
        let middle = others.len() / 2;
        *others.select_nth_unstable_by(middle, f64::total_cmp).1 / std::f64::consts::LN_2
    }

    fn line(&self, bin: usize, excess: f64) -> Line {
        let n = self.n as f64;
        // The Hann window passes half of an amplitude and 3/8 of a power.
        let noise_sd = (self.powers[bin] / excess / (0.375 * n)).sqrt();
        Line {
            frequency_hz: (self.first + bin) as f64 * self.resolution_hz(),
            amplitude_rad: 4.0 * self.powers[bin].sqrt() / n,
            amplitude_sd_rad: noise_sd * (2.0 / n).sqrt(),
            log_bayes_factor: excess - OCCAM,
        }
    }
}

impl Shared {
    /// The line that goes with the carriage's speed, or that of the mains, whichever all runs
    /// together speak for the more; none where they do not speak for one by more than `sure`.
    pub(in crate::diagnosis) fn of(runs: &[Option<Spectrum>], sure: f64) -> Option<Self> {
        let lines = [in_proportion(runs), of_mains(runs)].map(|tried| best(runs, &tried));
        let is_sure = |line: &Self| line.log_bayes_factor > sure && line.is_shown(runs);
        let sure = lines.into_iter().flatten().filter(is_sure);
        sure.max_by(|a, b| a.log_bayes_factor.total_cmp(&b.log_bayes_factor))
    }

    /// Whether runs enough show it for themselves: half of those in whose band it lies, and where
    /// it goes with the speed some of several speeds.
    fn is_shown(&self, runs: &[Option<Spectrum>]) -> bool {
        let line = |run: &Spectrum| run.near(self.recurs.frequency_hz(run.froude));
        let n_able = runs.iter().flatten().filter(|run| line(run).is_some()).count();
        let n_shown = self.lines.iter().flatten().count();
        let shown = runs.iter().zip(&self.lines).filter(|(_, line)| line.is_some());
        let speeds = || shown.clone().filter_map(|(run, _)| Some(run.as_ref()?.froude));
        let (slowest, fastest) =
            (speeds().fold(f64::INFINITY, f64::min), speeds().fold(0.0, f64::max));
        let is_of_speeds =
            n_shown >= RUNS_IN_PROPORTION && fastest >= SPEEDS_IN_PROPORTION * slowest;
        2 * n_shown >= n_able && (is_of_speeds || matches!(self.recurs, Recurs::Fixed(_)))
    }
}

/// The best of the lines tried, weighed against none by all runs: each shows it or does not.
fn best(runs: &[Option<Spectrum>], tried: &[Recurs]) -> Option<Shared> {
    let near = |run: &Spectrum, recurs: &Recurs| run.near(recurs.frequency_hz(run.froude));
    let log = |recurs: &Recurs| -> f64 {
        let excesses = runs.iter().flatten().filter_map(|run| Some(near(run, recurs)?.1));
        excesses.map(|excess| (0.5 + 0.5 * (excess - OCCAM).min(500.0).exp()).ln()).sum()
    };
    let logs = tried.iter().map(|recurs| (*recurs, log(recurs)));
    let (recurs, log) = logs.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let line = |run: &Option<Spectrum>| {
        let run = run.as_ref()?;
        let (bin, excess) = near(run, &recurs)?;
        (excess > SHOWN).then(|| run.line(bin, excess))
    };
    let lines = runs.iter().map(line).collect();
    Some(Shared { recurs, lines, log_bayes_factor: log - (tried.len() as f64).ln() })
}

/// Every line in proportion to the Froude number that the fastest run can tell from the next.
fn in_proportion(runs: &[Option<Spectrum>]) -> Vec<Recurs> {
    let fastest = runs.iter().flatten().max_by(|a, b| a.froude.total_cmp(&b.froude));
    let Some(fastest) = fastest.filter(|run| run.froude > 0.01) else { return Vec::new() };
    let step = |run: &Spectrum| 0.5 * run.resolution_hz() / run.froude.max(0.01);
    let step_hz = runs.iter().flatten().map(step).fold(f64::INFINITY, f64::min);
    let n = 0.5 * fastest.rate_hz / fastest.froude / step_hz;
    (1..n as usize).map(|k| Recurs::PerFroude(step_hz * k as f64)).collect()
}

/// Lines of the mains as they show.
fn of_mains(runs: &[Option<Spectrum>]) -> Vec<Recurs> {
    let Some(first) = runs.iter().flatten().next() else { return Vec::new() };
    let step_hz = 0.5 * first.resolution_hz();
    let n = (MAINS_OFF_HZ / step_hz) as i32;
    let about = |hz: f64| (-n..=n).map(move |k| Recurs::Fixed(hz + step_hz * f64::from(k)));
    mains_hz(first.rate_hz).into_iter().flat_map(about).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Decays' leftovers at speeds: noise of one, and a line of an amplitude at a frequency each.
    fn runs(amplitude: f64, hz: impl Fn(f64) -> f64) -> Vec<Option<Spectrum>> {
        let mut state = 7_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5
        };
        let froudes = [0.0, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4];
        let mut run = |froude: f64| {
            let turn = std::f64::consts::TAU * hz(froude) / 100.0;
            let left: Vec<f64> = (0..900)
                .map(|i| {
                    let noise: f64 = (0..12).map(|_| uniform()).sum();
                    noise + amplitude * (turn * f64::from(i) + 3.0 * froude).sin()
                })
                .collect();
            Spectrum::of(&left, 100.0, froude, 1.1)
        };
        froudes.map(&mut run).into()
    }

    #[test]
    fn a_line_that_no_run_is_sure_of_is_told_by_all_and_none_by_noise() {
        let runs = |amplitude| runs(amplitude, |froude| 37.3 * froude);
        let shared = Shared::of(&runs(0.35), 14.0).expect("a line");
        let Recurs::PerFroude(hz) = shared.recurs else { panic!("it is no hum") };
        assert!((hz - 37.3).abs() < 0.4, "{hz} Hz");
        let most = shared.lines.iter().flatten().map(|line| line.log_bayes_factor);
        assert!(most.clone().fold(0.0, f64::max) < 22.0, "{:?}", most.collect::<Vec<_>>());
        assert!(Shared::of(&runs(0.0), 14.0).is_none());
    }

    #[test]
    fn what_is_left_within_the_roll_s_own_band_is_no_line() {
        assert!(Shared::of(&runs(1.0, |froude| 8.0 * froude), 14.0).is_none());
        assert!(Shared::of(&runs(1.0, |froude| 20.0 * froude), 14.0).is_some());
    }

    #[test]
    fn a_faint_hum_is_the_mains_and_not_the_carriage() {
        let shared = Shared::of(&runs(0.35, |_| 40.1), 14.0).expect("a line");
        assert!(matches!(shared.recurs, Recurs::Fixed(_)), "it is no carriage");
        let off_hz = shared.lines.iter().flatten().map(|line| (line.frequency_hz - 40.1).abs());
        // A bin of nine seconds.
        assert!(off_hz.fold(0.0, f64::max) < 0.111);
        let elsewhere = Shared::of(&runs(0.35, |_| 33.0), 14.0);
        assert!(elsewhere.is_none(), "no mains are there, and no carriage does that");
    }
}
