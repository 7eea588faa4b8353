//! The program's daemon as a child process, with what it said.

use std::fs::{self, File};
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::LiveTank;

/// Longest wait for anything: the machine may be busy with every other story.
const PATIENCE: Duration = Duration::from_mins(2);

/// A running `rolltank run`, killed when the story ends.
pub(crate) struct Daemon {
    child: Child,
    log: PathBuf,
}

impl Daemon {
    /// Starts the daemon on a tank, with more arguments.
    pub(crate) fn start(tank: &LiveTank, arguments: &[&str]) -> Self {
        Self::start_with(tank, arguments, &[])
    }

    /// The same with variables of the environment.
    pub(crate) fn start_with(
        tank: &LiveTank,
        arguments: &[&str],
        environment: &[(&str, &str)],
    ) -> Self {
        let log = tank.path().join("daemon.log");
        let said = File::options().create(true).append(true).open(&log).expect("a log");
        let child = Command::new(env!("CARGO_BIN_EXE_rolltank"))
            .args(["run", ".", "--clock-speed", &tank.speed.to_string()])
            .args(if arguments.contains(&"--listen") {
                &[][..]
            } else {
                &["--listen", "127.0.0.1:0"]
            })
            .args(arguments)
            .current_dir(tank.path())
            .env_remove("RUST_LOG")
            .envs(environment.iter().copied())
            .stdin(Stdio::null())
            .stdout(said.try_clone().expect("another handle"))
            .stderr(said)
            .spawn()
            .expect("the program was built");
        Self { child, log }
    }

    /// Everything that it and the daemons before it on this tank have said.
    pub(crate) fn said(&self) -> String {
        fs::read_to_string(&self.log).unwrap_or_default()
    }

    /// Waits until something is so, and fails with what the daemon said when it never is.
    #[expect(clippy::disallowed_methods, reason = "a story must not wait for ever")]
    pub(crate) fn wait_until(&mut self, what: &str, is_so: impl Fn() -> bool) {
        let start = Instant::now();
        while !is_so() {
            let ended = self.child.try_wait().expect("it is our child");
            assert!(ended.is_none(), "ended before {what}: {}", self.said());
            assert!(start.elapsed() < PATIENCE, "never {what}: {}", self.said());
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits until it has said something so often.
    pub(crate) fn wait_for(&mut self, words: &str, times: usize) {
        let log = self.log.clone();
        let said = || fs::read_to_string(&log).unwrap_or_default().matches(words).count();
        self.wait_until(&format!("\"{words}\" {times} times"), || said() >= times);
    }

    /// The address of its page, which its log names.
    pub(crate) fn address(&mut self) -> String {
        self.wait_for("serving the page", 1);
        let said = self.said();
        let after = said.rsplit("address=").next().expect("the address is told");
        after.split_whitespace().next().expect("an address").trim_matches('"').to_owned()
    }

    pub(crate) fn signal(&self, name: &str) {
        let sent = Command::new("kill").args([name, &self.child.id().to_string()]).status();
        assert!(sent.expect("kill is there").success());
    }

    /// Processor time that it has taken [s], all threads.
    pub(crate) fn cpu_s(&self) -> f64 {
        let stat = self.told("stat");
        let after_name = stat.rsplit(')').next().unwrap_or_default();
        let ticks = after_name.split_whitespace().skip(11).take(2);
        ticks.map(|ticks| ticks.parse::<f64>().expect("a count")).sum::<f64>() / 100.0
    }

    /// Processor time that its living threads have taken [s], to the nanosecond: what is nearly
    /// idle takes less than the ticks of [`Daemon::cpu_s`] tell apart.
    pub(crate) fn exact_cpu_s(&self) -> f64 {
        let taken_ns = self.scheduled(0);
        assert!(taken_ns > 0.0, "the kernel tells no schedstat");
        taken_ns * 1e-9
    }

    /// How often its living threads were given a processor, all together.
    pub(crate) fn wakes(&self) -> f64 {
        self.scheduled(2)
    }

    /// Sum over its living threads of a column of the scheduler's own figures.
    fn scheduled(&self, column: usize) -> f64 {
        let tasks = fs::read_dir(format!("/proc/{}/task", self.child.id())).expect("it lives");
        let figures = tasks.filter_map(|task| {
            let told = fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
            told.split_whitespace().nth(column)?.parse::<f64>().ok()
        });
        figures.sum()
    }

    /// Its resident memory [MB].
    pub(crate) fn resident_mb(&self) -> f64 {
        let status = self.told("status");
        let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap_or_default();
        let kilobytes = line.split_whitespace().nth(1).and_then(|text| text.parse::<f64>().ok());
        kilobytes.expect("a number") / 1024.0
    }

    /// What the system tells of it.
    fn told(&self, name: &str) -> String {
        let path = format!("/proc/{}/{name}", self.child.id());
        fs::read_to_string(path).expect("Linux tells it of a process that runs")
    }

    /// Sends SIGTERM and waits for the end.
    pub(crate) fn terminate(mut self) -> (ExitStatus, String) {
        self.signal("-TERM");
        let status = self.child.wait().expect("it is our child");
        let said = self.said();
        (status, said)
    }

    /// Kills it without a warning.
    pub(crate) fn kill(mut self) {
        self.child.kill().expect("it runs");
        self.child.wait().expect("it is our child");
    }
}

impl Drop for Daemon {
    fn drop(&mut self) {
        // It may have ended long ago.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}
