//! What the player merges: samples of one file on one time base, in time order.

use devices::Sample;
use devices::channel::Counted;

use crate::error::ReplayError;
use crate::note::Note;

/// Samples of one file on one time base.
pub(crate) trait Stream: Send {
    /// The next sample in the order of time and, at equal times, of the quantities.
    fn next(&mut self) -> Result<Option<Sample>, ReplayError>;

    /// What instruments counted since the last call and before the sample given last.
    fn take_counted(&mut self) -> Vec<Counted> {
        Vec::new()
    }

    /// Bytes read so far, never more than [`Stream::bytes_total`].
    fn bytes_read(&self) -> u64;

    /// Bytes of the file.
    fn bytes_total(&self) -> u64;

    /// Appends what was mended and lost so far.
    fn notes(&self, notes: &mut Vec<Note>);
}
