//! The run that is meant, by where it lies: ids change when another run is found before it.

use serde::{Deserialize, Serialize};

/// A stretch of a recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// Name of the recording, as in the campaign file.
    pub recording: String,
    /// Start [s].
    pub start_s: f64,
    /// End [s].
    pub end_s: f64,
}

impl Place {
    /// Whether a run that lies there is the one meant: both share more than half of the longer.
    ///
    /// A later version of the program may end a run some samples earlier, and means the same run.
    pub fn is(&self, recording: &str, start_s: f64, end_s: f64) -> bool {
        let shared_s = self.end_s.min(end_s) - self.start_s.max(start_s);
        let longer_s = (self.end_s - self.start_s).max(end_s - start_s);
        self.recording == recording && shared_s > 0.5 * longer_s
    }
}

#[cfg(test)]
mod tests {
    use super::Place;

    #[test]
    fn a_run_is_meant_though_it_ends_a_little_earlier_and_its_neighbours_are_not() {
        let place = Place { recording: "a".to_owned(), start_s: 10.0, end_s: 30.0 };
        assert!(place.is("a", 10.0, 29.4) && place.is("a", 10.2, 30.0));
        assert!(!place.is("b", 10.0, 30.0) && !place.is("a", 30.0, 50.0));
        assert!(!place.is("a", 0.0, 100.0) && !place.is("a", 10.0, 19.0));
    }
}
