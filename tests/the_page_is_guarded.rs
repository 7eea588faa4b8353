//! Who may look and who may act: hosts, origins, tokens, paths, headers, and pages that stall.

use std::io::Read;
use std::time::Duration;

use super::http::{begin, get, post};
use super::live_tank::{Daemon, LiveTank};

const MARK: &str = "{\"by\": \"C. Costa\", \"what\": \"mark\"}";

#[test]
fn no_foreign_name_or_page_reaches_the_daemon_and_every_answer_says_what_may_run() {
    let tank = LiveTank::calm_at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    daemon.wait_for("linked", 2);
    let own = format!("http://{address}");

    for host in ["evil.example", "evil.example:8440", "127.0.0.1.evil.example"] {
        for path in ["/", "/status", "/stream", "/assets/page.js"] {
            let answer = get(&address, path, &[("Host", host)]);
            assert_eq!(answer.status, 421, "{host} {path}");
        }
    }
    for origin in ["http://evil.example", "null", "http://127.0.0.1:1"] {
        for path in ["/stream", "/status", "/view", "/results/identification.json"] {
            assert_eq!(get(&address, path, &[("Origin", origin)]).status, 403, "{origin} {path}");
        }
        for path in ["/act", "/zero", "/enter"] {
            assert_eq!(post(&address, path, &[("Origin", origin)], MARK).status, 403, "{path}");
        }
    }
    let cross = [("Sec-Fetch-Site", "cross-site"), ("Sec-Fetch-Mode", "no-cors")];
    assert_eq!(get(&address, "/stream", &cross).status, 403);
    let followed = [("Sec-Fetch-Site", "cross-site"), ("Sec-Fetch-Mode", "navigate")];
    assert_eq!(get(&address, "/", &followed).status, 200, "a link may be followed");
    // What a form of another site could send without asking.
    for kind in ["text/plain", "application/x-www-form-urlencoded"] {
        assert_eq!(post(&address, "/act", &[("Content-Type", kind)], MARK).status, 415);
    }
    assert!(tank.text("judgements.jsonl").is_empty(), "{}", tank.text("judgements.jsonl"));
    assert_eq!(post(&address, "/act", &[("Origin", &own)], MARK).status, 200);
    assert_eq!(tank.text("judgements.jsonl").lines().count(), 1);

    for path in ["/", "/assets/page.js", "/status", "/nothing", "/results/nothing"] {
        let answer = get(&address, path, &[]);
        let policy = answer.header("content-security-policy");
        assert!(policy.contains("default-src 'none'"), "{path}: {policy}");
        assert!(policy.contains("frame-ancestors 'none'") && !policy.contains("unsafe"), "{path}");
        assert_eq!(answer.header("x-content-type-options"), "nosniff", "{path}");
        assert_eq!(answer.header("referrer-policy"), "no-referrer", "{path}");
        assert_eq!(answer.header("cache-control"), "no-store", "{path}");
        assert_eq!(answer.header("cross-origin-resource-policy"), "same-origin", "{path}");
    }
}

#[test]
fn no_path_of_a_request_reaches_the_file_system() {
    let tank = LiveTank::at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    daemon.wait_for("latency_s=", 1);
    let listed = |path: &str| get(&address, path, &[]).status == 200;
    daemon.wait_until("the report", || listed("/results/index.html"));
    // It lies beside the report, and no list of the daemon's names it.
    std::fs::write(tank.path().join("results/secret.html"), "secret").unwrap();
    for path in [
        "/results/secret.html",
        "/results/../campaign.toml",
        "/results/..%2fcampaign.toml",
        "/results/%2e%2e%2fcampaign.toml",
        "/results/..%5ccampaign.toml",
        "/results/%2fetc%2fpasswd",
        "/results//etc/passwd",
        "/results/index.html%00",
        "/assets/..%2f..%2fCargo.toml",
        "/assets/../page.html",
        "/campaign.toml",
    ] {
        let answer = get(&address, path, &[]);
        assert_eq!(answer.status, 404, "{path}: {}", answer.body);
        assert!(!answer.body.contains("secret") && !answer.body.contains("root:"), "{path}");
    }
    let page = get(&address, "/results/index.html", &[]);
    assert!(page.body.contains("<link rel=\"stylesheet\" href=\"/assets/report.css\">"));
    assert!(!page.body.contains("<style>"), "what the policy forbids would not be shown");
}

#[test]
fn a_page_tells_the_token_once_and_only_a_cookie_without_scripts_keeps_it() {
    let tank = LiveTank::calm_at_speed(8.0);
    std::fs::write(tank.path().join("token"), "open sesame; really\n").unwrap();
    let mut daemon = Daemon::start(&tank, &["--token-file", "token"]);
    let address = daemon.address();
    assert_eq!(get(&address, "/", &[]).status, 200, "the way in");
    for path in ["/stream", "/status", "/view", "/judgements", "/results/index.html", "/healthz"] {
        assert_eq!(get(&address, path, &[]).status, 401, "{path}");
    }
    assert_eq!(post(&address, "/act", &[], MARK).status, 401);
    assert_eq!(post(&address, "/enter", &[], "{\"token\": \"open\"}").status, 401);
    let entered = post(&address, "/enter", &[], "{\"token\": \"open sesame; really\"}");
    let cookie = entered.header("set-cookie").to_owned();
    for part in ["HttpOnly", "SameSite=Strict", "Path=/"] {
        assert!(cookie.contains(part), "{cookie}");
    }
    assert!(!cookie.contains("sesame"), "{cookie}");
    let cookie = cookie.split(';').next().expect("a value");
    let cut = &cookie[..cookie.len() - 2];
    assert_eq!(get(&address, "/status", &[("Cookie", cookie)]).status, 200);
    assert_eq!(get(&address, "/status", &[("Cookie", cut)]).status, 401);
    assert_eq!(post(&address, "/act", &[("Cookie", cookie)], MARK).status, 200);
    let foreign = [("Cookie", cookie), ("Origin", "http://evil.example")];
    assert_eq!(post(&address, "/act", &foreign, MARK).status, 403, "the cookie does not help it");
    let bearer = ("Authorization", "Bearer open sesame; really");
    assert_eq!(get(&address, "/status", &[bearer]).status, 200);
}

#[test]
fn what_is_not_understood_or_has_no_name_changes_nothing() {
    let tank = LiveTank::calm_at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    daemon.wait_for("linked", 2);
    let long = "x".repeat(20_000);
    for (body, status) in [
        ("{\"by\": \" \", \"what\": \"mark\"}", 422),
        ("{\"by\": \"C\", \"what\": \"explode\"}", 422),
        ("{\"by\": \"C\", \"what\": {\"reject\": {\"run\": \"../etc\"}}}", 409),
        ("{\"by\": \"C\", \"what\": {\"undo\": {\"of\": 7}}}", 409),
        ("{\"by\": \"C\", \"what\": \"start_recording\"}", 409),
        ("{\"by\": \"C\", \"what\": \"mark\", \"more\": 1}", 422),
        ("nonsense", 400),
        (&format!("{{\"by\": \"C\", \"why\": \"{long}\", \"what\": \"mark\"}}"), 413),
    ] {
        let answer = post(&address, "/act", &[], body);
        assert_eq!(answer.status, status, "{}: {}", &body[..body.len().min(80)], answer.body);
    }
    assert!(tank.text("judgements.jsonl").is_empty());
}

#[test]
fn a_zero_taken_on_the_page_is_logged_and_taken_back_and_taken_again() {
    let tank = LiveTank::calm_at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    daemon.wait_until("ready", || get(&address, "/readyz", &[]).status == 200);
    std::thread::sleep(Duration::from_millis(300));
    let zero = post(&address, "/zero", &[], "{\"by\": \"C. Costa\", \"channel\": \"roll\"}");
    assert_eq!(zero.status, 200, "{}", zero.body);
    daemon.wait_for("session begun", 2);
    let undo = "{\"by\": \"C. Costa\", \"what\": {\"undo\": {\"of\": 1}}}";
    assert_eq!(post(&address, "/act", &[], undo).status, 200);
    assert_eq!(post(&address, "/act", &[], undo).status, 409, "once");
    let kept = tank.text("calibrations.toml");
    let zeros: Vec<&str> = kept.lines().filter(|line| line.starts_with("zero_raw")).collect();
    assert_eq!(zeros.len(), 2, "{kept}");
    assert_ne!(zeros[0], "zero_raw = 0.0");
    assert_eq!(zeros[1], "zero_raw = 0.0", "the campaign file's own");
    daemon.wait_for("session begun", 3);
    let again = undo.replace("of\": 1", "of\": 2");
    assert_eq!(post(&address, "/act", &[], &again).status, 200, "an undo can be undone");
    assert_eq!(post(&address, "/act", &[], undo).status, 200, "and the zero taken back again");
    let kept = tank.text("calibrations.toml");
    let restored: Vec<&str> = kept.lines().filter(|line| line.starts_with("zero_raw")).collect();
    assert_eq!(restored, [zeros[0], zeros[1], zeros[0], zeros[1]]);
}

#[test]
fn pages_that_stall_cost_neither_samples_nor_time_and_do_not_crowd_out_health() {
    let tank = LiveTank::at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    let mut stalled: Vec<_> = (0..64).map(|_| begin(&address, "GET /stream", &[], "")).collect();
    for stream in &mut stalled {
        let mut first = [0; 12];
        stream.read_exact(&mut first).expect("it begins");
        assert_eq!(&first, b"HTTP/1.1 200");
    }
    let told = get(&address, "/stream", &[]);
    assert_eq!((told.status, told.body.as_str()), (503, "too many pages are open\n"));
    daemon.wait_for("latency_s=", 2);
    let status: serde_json::Value =
        serde_json::from_str(&get(&address, "/status", &[]).body).expect("JSON");
    for device in status["devices"].as_array().expect("devices") {
        assert_eq!(device["n_dropped"], 0, "{device}");
        for channel in device["channels"].as_array().expect("channels") {
            assert_eq!(channel["counts"]["lost"], 0, "{channel}");
        }
    }
    let latencies = status["runs"]["latencies_s"].as_array().expect("latencies");
    assert!(latencies.iter().all(|latency| latency.as_f64() < Some(1.0)), "{latencies:?}");
    drop(stalled);
    daemon.wait_until("room for another page", || {
        let mut stream = begin(&address, "GET /stream", &[], "");
        let mut first = [0; 12];
        stream.read_exact(&mut first).is_ok() && &first == b"HTTP/1.1 200"
    });
}
