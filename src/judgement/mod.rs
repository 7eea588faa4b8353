//! What people have judged of a campaign: marks, notes, runs rejected by hand, and what was undone.
//!
//! `judgements.jsonl` beside the campaign file holds one judgement a line and is only ever added
//! to. Every identification reads it: a run that is rejected in it leaves the laws of the campaign,
//! whether it was found live or in a replay. An undo is a further line.

mod file;
mod line;
mod place;

pub use file::{JUDGEMENTS_FILE, append, read};
pub use line::{BadLine, Deed, Judgement, Zeroed, is_note};
pub use place::Place;

/// Everything judged, in the order in which it was.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Judgements {
    all: Vec<Judgement>,
}

impl Judgements {
    /// Reads every line of a text.
    ///
    /// # Errors
    /// Every line that is no judgement.
    pub fn parse(text: &str) -> Result<Self, Vec<BadLine>> {
        line::parse(text).map(|all| Self { all })
    }

    /// All of them, those that were undone included.
    pub fn all(&self) -> &[Judgement] {
        &self.all
    }

    /// The number of the next.
    pub fn next_number(&self) -> u64 {
        self.all.iter().map(|judgement| judgement.number).max().unwrap_or(0) + 1
    }

    /// One more.
    pub fn push(&mut self, judgement: Judgement) {
        self.all.push(judgement);
    }

    /// Those that nothing has undone, in order; undoing an undo does the deed again.
    pub fn in_force(&self) -> Vec<&Judgement> {
        let mut undone = std::collections::BTreeSet::new();
        let mut left: Vec<&Judgement> = Vec::new();
        for judgement in self.all.iter().rev() {
            if undone.contains(&judgement.number) {
                continue;
            }
            if let Deed::Undo { of } = judgement.deed {
                undone.insert(of);
            }
            left.push(judgement);
        }
        left.reverse();
        left
    }

    /// What undoing that number bears on: the deed at the end of the chain of undoings, and whether
    /// it is then done again.
    pub fn meant(&self, number: u64) -> Option<(&Judgement, bool)> {
        let numbered = |number| self.all.iter().find(|judgement| judgement.number == number);
        let (mut meant, mut is_again) = (numbered(number)?, false);
        while let Deed::Undo { of } = meant.deed {
            // Whoever edits the file may have an undo undo itself.
            meant = numbered(of).filter(|earlier| earlier.number < meant.number)?;
            is_again = !is_again;
        }
        Some((meant, is_again))
    }

    /// Whether a judgement stands, and can therefore be undone.
    pub fn stands(&self, number: u64) -> bool {
        self.in_force().iter().any(|judgement| judgement.number == number)
    }

    /// The rejection of a run that lies there, where one is in force.
    pub fn rejection(&self, recording: &str, start_s: f64, end_s: f64) -> Option<&Judgement> {
        self.in_force().into_iter().find(|judgement| {
            matches!(&judgement.deed, Deed::Reject { run } if run.is(recording, start_s, end_s))
        })
    }

    /// What was noted of a run that lies there.
    pub fn notes(&self, recording: &str, start_s: f64, end_s: f64) -> Vec<&Judgement> {
        let mut notes = self.in_force();
        notes.retain(|judgement| {
            matches!(&judgement.deed, Deed::Annotate { run } if run.is(recording, start_s, end_s))
        });
        notes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judgement(number: u64, deed: Deed) -> Judgement {
        let (by, why) = ("C. Costa".to_owned(), "a hand touched it".to_owned());
        Judgement { number, at: "2026-11-26 09:12:33 UTC".to_owned(), by, why, deed }
    }

    fn run() -> Place {
        Place { recording: "live/a.mcap".to_owned(), start_s: 10.0, end_s: 30.0 }
    }

    #[test]
    fn an_undo_takes_a_rejection_back_and_its_own_undo_brings_it_again() {
        let mut judgements = Judgements::default();
        let rejected = |judgements: &Judgements| {
            judgements.rejection("live/a.mcap", 10.0, 30.0).map(|judgement| judgement.number)
        };
        judgements.push(judgement(1, Deed::Reject { run: run() }));
        assert_eq!(rejected(&judgements), Some(1));
        judgements.push(judgement(2, Deed::Undo { of: 1 }));
        assert_eq!(rejected(&judgements), None);
        assert!(!judgements.stands(1) && judgements.stands(2));
        judgements.push(judgement(3, Deed::Undo { of: 2 }));
        assert_eq!(rejected(&judgements), Some(1));
        assert_eq!(judgements.next_number(), 4);
        let meant = |number| judgements.meant(number).map(|(meant, again)| (meant.number, again));
        assert_eq!([1, 2, 3].map(meant), [Some((1, false)), Some((1, true)), Some((1, false))]);
        assert_eq!(meant(9), None);
        judgements.push(judgement(9, Deed::Undo { of: 9 }));
        assert_eq!(judgements.meant(9), None, "an undo of itself bears on nothing");
    }

    #[test]
    fn what_is_written_is_read_again() {
        let deeds = [
            Deed::Mark { recording: "live/a.mcap".to_owned(), time_s: 12.5 },
            Deed::Annotate { run: run() },
            Deed::Reject { run: run() },
            Deed::StopRecording,
            Deed::StartRecording,
            Deed::Zero {
                channels: vec![Zeroed {
                    device: "cell".to_owned(),
                    quantity: devices::Quantity::Force,
                    before: devices::channel::Calibration {
                        zero_raw: 12.5,
                        ..devices::channel::Calibration::default()
                    },
                    after: devices::channel::Calibration::default(),
                }],
            },
            Deed::Undo { of: 3 },
        ];
        let mut judgements = Judgements::default();
        for (k, deed) in deeds.into_iter().enumerate() {
            judgements.push(judgement(k as u64 + 1, deed));
        }
        let text: String = judgements.all().iter().map(|one| one.line() + "\n").collect();
        assert_eq!(Judgements::parse(&text).unwrap(), judgements);
    }

    #[test]
    fn every_line_that_is_none_is_told_with_its_number() {
        let good = judgement(1, Deed::StopRecording).line();
        let text = format!("{good}\n{{\"number\": 2}}\n\nnonsense\n{good}\n");
        let bad = Judgements::parse(&text).unwrap_err();
        assert_eq!(bad.iter().map(|bad| bad.line).collect::<Vec<_>>(), [2, 4]);
    }
}
