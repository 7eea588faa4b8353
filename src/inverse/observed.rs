//! The observable (2.4) of a run, and the moment history by the method asked for.

use super::Setting;
use super::forced::drive::Drive;
use super::identification::{Chain, DampingFit, Method, MomentHistory};
use super::paper::{Convolution, least_squares};
use super::paper_method;
use super::record::Record;

/// A record with what turns it into the observable.
pub(super) struct Observed<'a> {
    /// The roll.
    pub(super) record: &'a Record,
    /// Natural frequency `w` [rad/s].
    pub(super) natural_frequency_rad_s: f64,
    /// Zero offset of the roll channel [rad].
    pub(super) zero_rad: f64,
    /// Roll [rad] and roll rate [rad/s] at the start of the record.
    pub(super) start: (f64, f64),
    /// The measured moment of a forced run.
    pub(super) drive: Option<&'a Drive>,
}

/// The moment history with what the paper shows beside it.
pub(super) struct Told {
    pub(super) moment: MomentHistory,
    /// Least-squares solution (Fig. 9), empty when the record is not evenly spaced.
    pub(super) least_squares_per_s2: Vec<f64>,
    pub(super) chain: Option<Chain>,
    /// The law fitted to the chain's scatter of moments, when a chain was drawn from a decay.
    pub(super) scatter_fit: Option<DampingFit>,
    pub(super) remarks: Vec<String>,
}

impl Observed<'_> {
    /// Completes the exact history, or replaces it by the one that the chains give.
    pub(super) fn tell(&self, exact: MomentHistory, setting: &Setting) -> Result<Told, String> {
        let mut told = Told {
            moment: exact,
            least_squares_per_s2: Vec::new(),
            chain: None,
            scatter_fit: None,
            remarks: Vec::new(),
        };
        if setting.method == Method::PaperMcmc {
            let short = self.record.at_most(paper_method::n_samples_max(self.record));
            let (convolution, g) = self.observable(&short)?;
            let drawn = paper_method::draw(&short, &convolution, &g, &told.moment, setting.seed)?;
            told.least_squares_per_s2 = least_squares(&g, &convolution);
            told.scatter_fit = self.drive.is_none().then_some(drawn.damping);
            (told.moment, told.chain) = (drawn.moment, Some(drawn.chain));
            told.remarks = drawn.remarks;
        } else if self.record.is_even() {
            let (convolution, g) = self.observable(self.record)?;
            told.least_squares_per_s2 = least_squares(&g, &convolution);
            told.moment.observable_rad = g;
        }
        Ok(told)
    }

    fn observable(&self, record: &Record) -> Result<(Convolution, Vec<f64>), String> {
        if !record.is_even() {
            return Err(
                "the paper's method needs evenly spaced samples, this record has holes or \
                        uneven time stamps (hint: --method exact takes them as they are)"
                    .into(),
            );
        }
        let w = self.natural_frequency_rad_s;
        let convolution = Convolution::new(record.roll_rad.len(), record.time_s[1], w)
            .map_err(|error| error.to_string())?;
        let roll: Vec<f64> = record.roll_rad.iter().map(|r| r - self.zero_rad).collect();
        let moment: Option<Vec<f64>> = self.drive.map(|drive| {
            let later_s = record.origin_s - drive.origin_s();
            record.time_s.iter().map(|t| drive.at(later_s + t)).collect()
        });
        let g = convolution.observable(&roll, self.start.0, self.start.1, moment.as_deref());
        Ok((convolution, g))
    }
}
