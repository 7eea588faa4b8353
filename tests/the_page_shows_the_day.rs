//! The live page in a real browser: a day at an emulated tank, seen, judged and survived.

use std::time::{SystemTime, UNIX_EPOCH};

use super::browser;
use super::campaign_folder::rolltank;
use super::live_tank::{Daemon, LiveTank};

#[test]
#[expect(clippy::disallowed_methods, reason = "the browser tells when it saw by the same clock")]
fn a_day_is_seen_as_it_happens_judged_and_found_again_after_a_restart() {
    let tank = LiveTank::at_speed(8.0);
    let plan = "[[plan]]\ncondition = \"bare hull\"\nfroude = 0\nkind = \"decay\"\nrepeats = 999\n";
    tank.edit("[live]", &format!("{plan}[live]"));
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    let mut daemon = Some(daemon);
    browser::play("day", &[&address], |what| {
        match what {
            "unplug" => tank.port(0).unplug(),
            "replug" => tank.port(0).replug(),
            "restart" => {
                let before = daemon.take().expect("it runs");
                let (status, said) = before.terminate();
                assert_eq!(status.code(), Some(0), "{said}");
                daemon = Some(Daemon::start(&tank, &["--listen", &address]));
            }
            other => panic!("nobody knows how to {other}"),
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH).expect("it is after 1970");
        now.as_millis().to_string()
    });
    let (status, said) = daemon.expect("it runs").terminate();
    assert_eq!(status.code(), Some(0), "{said}");

    let live = tank.text("results/identification.json");
    assert!(live.contains("UTC: wave maker ran"), "{live}");
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    let differing = replayed.out.lines().zip(live.lines()).find(|(again, live)| again != live);
    assert!(replayed.out == live, "first replayed, then live: {differing:?}\n{said}");
    let deeds = tank.text("judgements.jsonl").lines().count();
    assert_eq!(deeds, 11, "{}", tank.text("judgements.jsonl"));
}
