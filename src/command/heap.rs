//! The heap of the C library, which is set up only as a process starts.

use std::env;
use std::os::unix::process::CommandExt;
use std::process::Command;

/// Names and values that the C library reads.
type Settings = &'static [(&'static str, &'static str)];

/// One heap for all threads, and none for what is large. The C library gives each thread its own,
/// and what a diagnosis has let go of then stays with every thread that ever worked on one; and it
/// learns to keep large series in the heap, where what is kept of a run holds fast what was below
/// it: a day of them takes more with each run. Large is what the library takes for it at first [B];
/// of what lies free at the end of the heap it keeps the series of a run or two [B].
pub(super) const OF_A_DAY: Settings = &[
    ("MALLOC_ARENA_MAX", "1"),
    ("MALLOC_MMAP_THRESHOLD_", "131072"),
    ("MALLOC_TRIM_THRESHOLD_", "4194304"),
];

/// A heap that keeps what a search lets go of, for the next fit takes as much again: giving it back
/// and asking for it anew took as long as the search itself.
pub(super) const OF_A_SEARCH: Settings =
    &[("MALLOC_TRIM_THRESHOLD_", "1073741824"), ("MALLOC_TOP_PAD_", "67108864")];

/// Goes on as the same process with some settings; whoever has set one of them otherwise is left
/// with that.
pub(super) fn go_on_with(settings: Settings) {
    if settings.iter().any(|(name, _)| env::var_os(name).is_some()) {
        return;
    }
    let failed = match env::current_exe() {
        Ok(program) => {
            Command::new(program).args(env::args_os().skip(1)).envs(settings.iter().copied()).exec()
        }
        Err(error) => error,
    };
    tracing::warn!("the heap stays as it is, which takes more memory or time: {failed}");
}
