//! Health, metrics and status over HTTP, reloads by SIGHUP, and what systemd hears.

use std::os::unix::net::UnixDatagram;
use std::time::Duration;

use clap::Parser;
use rolltank::command::CommandLine;

use super::http::{self, Answer};
use super::live_tank::{Daemon, LiveTank};

/// The answer to a request, with a token where one is given.
fn get(address: &str, path: &str, token: Option<&str>) -> Answer {
    let bearer = token.map(|token| format!("Bearer {token}"));
    let header = bearer.as_deref().map(|bearer| ("Authorization", bearer));
    http::get(address, path, header.as_slice())
}

fn is_ok(answer: &Answer) -> bool {
    answer.status == 200
}

#[test]
fn health_readiness_and_gauges_follow_the_instruments() {
    let tank = LiveTank::at_speed(1.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    assert!(is_ok(&get(&address, "/healthz", None)));
    daemon.wait_until("ready", || is_ok(&get(&address, "/readyz", None)));
    let gauges = get(&address, "/metrics", None).body;
    for line in [
        "rolltank_device_linked{device=\"potentiometer\"} 1.0",
        "rolltank_samples_total{device=\"carriage\",channel=\"speed\",outcome=\"lost\"} 0.0",
        "rolltank_records_total ",
        "rolltank_runs_total{outcome=\"identified\"} 0.0",
        "# EOF",
    ] {
        assert!(gauges.contains(line), "{line} is not in:\n{gauges}");
    }
    tank.port(0).unplug();
    daemon.wait_until("unready", || !is_ok(&get(&address, "/readyz", None)));
    let told = get(&address, "/readyz", None);
    assert!(told.status == 503 && told.body.contains("potentiometer"), "{told:?}");
    assert!(is_ok(&get(&address, "/healthz", None)), "the daemon itself is well");
    tank.port(0).replug();
    daemon.wait_until("ready again", || is_ok(&get(&address, "/readyz", None)));
    let status = get(&address, "/status", None);
    let status: serde_json::Value = serde_json::from_str(&status.body).expect("JSON");
    assert_eq!(status["schema"], "rolltank.status/1");
    assert_eq!(status["devices"][0]["n_losses"], 1, "{status}");
}

#[test]
fn a_token_is_asked_for_where_one_is_set_and_must_be_beyond_this_machine() {
    let tank = LiveTank::at_speed(1.0);
    let token = tank.path().join("token");
    std::fs::write(&token, "open sesame\n").unwrap();
    let mut daemon = Daemon::start(&tank, &["--token-file", "token"]);
    let address = daemon.address();
    for wrong in [None, Some("open"), Some("open sesame!")] {
        assert_eq!(get(&address, "/healthz", wrong).status, 401, "{wrong:?}");
    }
    assert!(is_ok(&get(&address, "/healthz", Some("open sesame"))));
    daemon.terminate();
    let arguments = ["run", ".", "--listen", "0.0.0.0:0"];
    let told = super::campaign_folder::rolltank(tank.path(), &arguments);
    assert_eq!(told.exit, 1, "{}", told.err);
    assert!(told.err.contains("needs a token\nhint: name a file"), "{}", told.err);
}

#[test]
fn a_new_campaign_file_comes_into_force_at_rest_and_a_wrong_one_never() {
    let tank = LiveTank::at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("latency_s=", 1);
    tank.edit("gm_m = 0.074", "gm_m = 74");
    daemon.signal("-HUP");
    daemon.wait_for("stays as it was", 1);
    tank.edit("gm_m = 74", "gm_m = 0.074");
    tank.edit("condition = \"bare hull\"", "condition = \"bilge keels\"");
    daemon.signal("-HUP");
    daemon.wait_for("session begun", 2);
    // On a busy machine more than one run may have come under the old file.
    let n_before = daemon.said().matches("latency_s=").count();
    daemon.wait_for("latency_s=", n_before + 1);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    assert!(said.contains("gm_m = 74 m is above the beam"), "{said}");
    assert_eq!(tank.files("live", ".mcap").len(), 2, "{said}");
    let live = tank.text("results/identification.json");
    let results: serde_json::Value = serde_json::from_str(&live).expect("JSON");
    let runs = results["runs"].as_array().expect("runs");
    let conditions: Vec<&str> = runs.iter().filter_map(|run| run["condition"].as_str()).collect();
    assert_eq!(conditions.first(), Some(&"bare hull"), "{conditions:?}");
    assert_eq!(conditions.last(), Some(&"bilge keels"), "{conditions:?}");
    let replayed = super::campaign_folder::rolltank(tank.path(), &["identify", ".", "--json"]);
    assert_eq!(replayed.out, live, "{said}");
}

#[test]
fn a_zero_is_taken_from_the_daemon_itself_and_in_force_from_the_next_rest_on() {
    // The model rests for the first six seconds of a round.
    let tank = LiveTank::at_speed(1.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    daemon.wait_until("ready", || is_ok(&get(&address, "/readyz", None)));
    std::thread::sleep(Duration::from_millis(500));
    let body = "{\"by\": \"C. Costa\", \"note\": \"calm water\"}";
    let post = |kind: &str| http::post(&address, "/zero", &[("Content-Type", kind)], body);
    assert_eq!(post("text/plain").status, 415, "a page could have sent that");
    let answer = post("application/json");
    assert!(is_ok(&answer) && answer.body.contains("roll of potentiometer: zero "), "{answer:?}");
    assert!(tank.text("calibrations.toml").contains("by = \"C. Costa\""));
    daemon.wait_for("session begun", 2);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
}

#[test]
fn systemd_hears_that_the_daemon_is_ready_alive_reloading_and_stopping() {
    let tank = LiveTank::at_speed(1.0);
    let path = tank.path().join("notify");
    let socket = UnixDatagram::bind(&path).unwrap();
    socket.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
    // Every word to systemd is one datagram of lines.
    let hear = |wanted: &str| {
        let mut heard = [0; 512];
        loop {
            let length = socket.recv(&mut heard).unwrap_or_else(|_| panic!("never {wanted}"));
            let said = String::from_utf8_lossy(&heard[..length]).into_owned();
            if said.lines().any(|line| line == wanted) {
                return said;
            }
        }
    };
    let path = path.display().to_string();
    let systemd = [("NOTIFY_SOCKET", path.as_str()), ("WATCHDOG_USEC", "300000")];
    let json = ["--log-format", "json"];
    let daemon = Daemon::start_with(&tank, &json, &systemd);
    assert!(hear("READY=1").contains("STATUS=recording"));
    hear("WATCHDOG=1");
    hear("WATCHDOG=1");
    daemon.signal("-HUP");
    // Without the instant in the same word systemd 253 takes the reload for failed.
    let reloading = hear("RELOADING=1");
    let told = reloading.lines().find_map(|line| line.strip_prefix("MONOTONIC_USEC="));
    let told_us: u64 = told.and_then(|told| told.parse().ok()).expect(&reloading);
    let uptime = std::fs::read_to_string("/proc/uptime").expect("Linux tells it");
    let uptime_s = uptime.split('.').next().and_then(|whole| whole.parse::<u64>().ok());
    assert!((told_us / 1_000_000).abs_diff(uptime_s.expect("a number")) < 120, "{reloading}");
    hear("READY=1");
    let (status, said) = {
        daemon.signal("-TERM");
        hear("STOPPING=1");
        daemon.terminate()
    };
    assert_eq!(status.code(), Some(0), "{said}");
    let line = said.lines().find(|line| line.contains("linked")).expect("a log line");
    let line: serde_json::Value = serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((&line["message"], &line["level"]), (&"linked".into(), &"INFO".into()), "{line}");
    assert!(line["timestamp"].is_string() && line["device"].is_string(), "{line}");
}

#[test]
fn the_unit_starts_the_program_with_arguments_that_it_knows() {
    let unit = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/rolltank@.service");
    let unit = std::fs::read_to_string(unit).unwrap();
    for line in ["Type=notify-reload", "WatchdogSec=", "Restart=on-failure", "LimitRTPRIO="] {
        assert!(unit.contains(line), "{line}");
    }
    let start = unit.lines().find_map(|line| line.strip_prefix("ExecStart=")).expect("a command");
    let parsed = CommandLine::try_parse_from(start.split_whitespace());
    assert!(parsed.is_ok(), "{start}: {:?}", parsed.err());
}
