//! Recordings on an absolute clock claim a stretch of time, which no other may claim.

use super::PipelineError;

/// Times above this [s] count from 1970, not from the start of a recording: it is 1973, and no
/// record of a towing tank lasts three years.
const EPOCH_LIKE_S: f64 = 1e8;

/// The stretches of absolute time that recordings have claimed.
#[derive(Debug, Default)]
pub(super) struct Claims {
    earlier: Vec<Claim>,
    current: Option<Claim>,
}

#[derive(Debug, Clone)]
struct Claim {
    recording: String,
    start_s: f64,
    end_s: f64,
}

impl Claims {
    /// Adds the stretch that a batch of samples covers to the claim of its recording.
    pub(super) fn extend(
        &mut self,
        recording: &str,
        start_s: f64,
        end_s: f64,
    ) -> Result<(), PipelineError> {
        if start_s < EPOCH_LIKE_S {
            return Ok(());
        }
        let claim = self.current.get_or_insert_with(|| Claim {
            recording: recording.to_owned(),
            start_s,
            end_s,
        });
        claim.start_s = claim.start_s.min(start_s);
        claim.end_s = claim.end_s.max(end_s);
        let overlapped = self
            .earlier
            .iter()
            .find(|earlier| claim.start_s < earlier.end_s && earlier.start_s < claim.end_s);
        match overlapped {
            None => Ok(()),
            Some(earlier) => Err(PipelineError::Overlap {
                first: earlier.recording.clone(),
                first_start_s: earlier.start_s,
                first_end_s: earlier.end_s,
                second: claim.recording.clone(),
                second_start_s: claim.start_s,
            }),
        }
    }

    /// Closes the claim of the recording that has ended.
    pub(super) fn end_recording(&mut self) {
        self.earlier.extend(self.current.take());
    }
}

#[cfg(test)]
mod tests {
    use super::Claims;

    #[test]
    fn recordings_one_after_the_other_may_touch() {
        let mut claims = Claims::default();
        claims.extend("a", 2e9, 2e9 + 60.0).unwrap();
        claims.end_recording();
        claims.extend("b", 2e9 + 60.0, 2e9 + 90.0).unwrap();
    }

    #[test]
    fn recordings_that_each_start_at_zero_are_no_conflict() {
        let mut claims = Claims::default();
        claims.extend("a", 0.0, 60.0).unwrap();
        claims.end_recording();
        claims.extend("b", 0.0, 60.0).unwrap();
    }

    #[test]
    fn two_recordings_of_one_minute_are_refused_with_both_names() {
        let mut claims = Claims::default();
        claims.extend("a.mcap", 2e9, 2e9 + 60.0).unwrap();
        claims.end_recording();
        let error = claims.extend("b.mcap", 2e9 + 59.0, 2e9 + 61.0).unwrap_err().to_string();
        assert!(error.contains("a.mcap") && error.contains("b.mcap"), "{error}");
    }
}
