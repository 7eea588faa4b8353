//! Threads that must not wait for others: `SCHED_FIFO`, where the system allows it.

use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// Below the kernel's own threads, above every ordinary one.
const FIFO_PRIORITY: u8 = 20;

/// Puts the calling thread under `SCHED_FIFO`; whether the system allowed it.
pub(crate) fn become_realtime() -> bool {
    let Ok(priority) = FIFO_PRIORITY.try_into() else { return false };
    let fifo = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let priority = ThreadPriority::Crossplatform(priority);
    set_thread_priority_and_policy(thread_native_id(), priority, fifo).is_ok()
}
