//! The thread of a port has the machine's own priority for it, where the system gives that.

use std::process::Command;
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::Duration;

use devices::clock::WallClock;
use devices::driver::Session;
use devices::port::{LinkOptions, LinkThread};

use crate::bench::{channels, device};

/// `SCHED_FIFO` in the list of sched(7).
const FIFO: &str = "1";

/// The policy of the calling thread, as proc(5) numbers it.
fn policy() -> String {
    let stat = std::fs::read_to_string("/proc/thread-self/stat").expect("Linux tells it");
    // What stands in parentheses is the thread's name; the policy is field 41.
    let (_, fields) = stat.rsplit_once(')').expect("it has a name");
    fields.split_whitespace().nth(38).expect("it has so many fields").to_owned()
}

/// Policy of a port's thread that is to be real-time or not.
fn policy_of_reader(realtime: bool) -> String {
    let (_folder, config) = device("cobs-board", &channels(1));
    let session =
        Session::new(config.protocol().expect("good settings"), config.pace.pace(&config.line));
    let options = LinkOptions { path: config.port.clone(), line: config.line, realtime };
    let (sender, told) = channel();
    // The port is not there, which its thread tells by calling this.
    let outlet = Box::new(move |_| sender.send(policy()).is_ok());
    let _thread = LinkThread::start(options, session, Arc::new(WallClock::start()), outlet)
        .expect("the system has a thread");
    told.recv_timeout(Duration::from_secs(10)).expect("it tells that its port is missing")
}

#[test]
fn the_reader_of_a_port_is_real_time_where_the_system_allows_it() {
    let allowed = Command::new("chrt").args(["--fifo", "20", "true"]).output();
    let is_allowed = allowed.is_ok_and(|output| output.status.success());
    println!("SCHED_FIFO is {}", if is_allowed { "allowed" } else { "not allowed" });
    assert_eq!(policy_of_reader(true) == FIFO, is_allowed);
    assert_ne!(policy_of_reader(false), FIFO);
}
