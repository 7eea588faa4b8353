//! The state in words: what the tank waits for, and what cannot wait.

use serde::Serialize;

use super::status::Status;
use crate::settling::ToGo;

/// What a person must see.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(super) struct Alarm {
    /// Whether data is being lost, or only a wish was refused.
    pub(super) severe: bool,
    /// What is wrong.
    pub(super) text: String,
    /// What to do.
    pub(super) hint: &'static str,
}

/// What the tank is doing, in a sentence for whoever stands beside it.
pub(super) fn doing(status: &Status) -> String {
    let motion = &status.motion;
    let Some(swing_rad) = motion.swing_rad else {
        return "waiting for the instruments: no roll has come yet".to_owned();
    };
    let since_s = (status.at_s - motion.since_s).max(0.0);
    let run = motion.run_ended_s.map_or_else(
        || "no run yet".to_owned(),
        |ended_s| format!("{:.0} s since the last run", (status.at_s - ended_s).max(0.0)),
    );
    let swing_deg = swing_rad.to_degrees();
    if !motion.at_rest {
        return format!("the model has moved for {since_s:.0} s: roll {swing_deg:.2} deg, {run}");
    }
    let known = status.calm.and_then(|calm| Some((calm.level_deg?, calm.to_go)));
    let Some((level_deg, to_go)) = known else {
        return format!("at rest for {since_s:.0} s: roll {swing_deg:.2} deg, {run}");
    };
    // The level is that of a whole window, which may have begun before the model was caught.
    let level_deg = level_deg.min(swing_deg);
    match to_go {
        ToGo::Calm => format!("calm, ready for a run: roll {level_deg:.2} deg, {run}"),
        ToGo::Seconds { median_s, lo95_s, hi95_s } => format!(
            "waiting for calm: roll {level_deg:.2} deg, {run}, about {median_s:.0} s to go \
             ({lo95_s:.0} to {hi95_s:.0})"
        ),
        ToGo::CantTell { why } => {
            format!("waiting for calm: roll {level_deg:.2} deg, {run}; {why}")
        }
    }
}

/// Everything that a person must see, the worst first.
pub(super) fn alarms(status: &Status) -> Vec<Alarm> {
    let mut alarms = Vec::new();
    let mut alarm = |severe: bool, text: String, hint: &'static str| {
        alarms.push(Alarm { severe, text, hint });
    };
    if status.recorded.stopped {
        let text = "nothing is recorded: the disk is full or fails".to_owned();
        alarm(true, text, "free space: recording begins again by itself, at the next rest");
    }
    if let Some(by) = &status.paused_by {
        let text = format!("nothing is recorded: {by} stopped the recording");
        alarm(true, text, "start recording again before the next run");
    }
    for device in &status.devices {
        let name = &device.name;
        if let Some(trouble) = &device.trouble {
            alarm(true, format!("{name}: {trouble}"), "see to the cable and the instrument");
        } else if !device.linked {
            let text = format!("{name}: not linked");
            alarm(true, text, "see to the cable and the instrument");
        } else {
            for channel in device.channels.iter().filter(|channel| channel.is_silent(status.at_s)) {
                let text = format!("{name} brings no {}", channel.quantity.name());
                alarm(true, text, "see to the instrument: its port is open, but it is silent");
            }
        }
    }
    if let Some(why) = &status.refused_reload {
        let text = format!("the campaign file was refused and stays as it was: {why}");
        alarm(false, text, "mend it and reload");
    }
    if status.runs.n_unheard > 0 {
        let text = format!("{} runs found no place in the queue", status.runs.n_unheard);
        alarm(false, text, "`rolltank replay` has them");
    }
    alarms.sort_by_key(|alarm| !alarm.severe);
    alarms
}

#[cfg(test)]
mod tests {
    use super::super::status::DeviceStatus;
    use super::*;
    use crate::settling::Calm;

    #[test]
    fn a_full_disk_stands_above_a_refused_file() {
        let mut status = Status { refused_reload: Some("gm".to_owned()), ..Status::default() };
        status.recorded.stopped = true;
        status.devices.push(DeviceStatus { name: "cell".to_owned(), ..DeviceStatus::default() });
        let told: Vec<String> = alarms(&status).into_iter().map(|alarm| alarm.text).collect();
        assert!(told[0].contains("disk") && told[1].contains("cell: not linked"), "{told:?}");
        assert!(told[2].contains("refused"), "{told:?}");
    }

    #[test]
    fn rest_is_told_with_its_roll_and_the_time_since_the_last_run() {
        let mut status = Status { at_s: 200.0, ..Status::default() };
        status.motion.swing_rad = Some(0.08_f64.to_radians());
        (status.motion.at_rest, status.motion.since_s) = (true, 150.0);
        status.motion.run_ended_s = Some(60.0);
        assert_eq!(doing(&status), "at rest for 50 s: roll 0.08 deg, 140 s since the last run");
        let to_go = ToGo::Seconds { median_s: 60.0, lo95_s: 41.0, hi95_s: 88.0 };
        status.calm = Some(Calm { level_deg: Some(0.08), decay_time_s: Some(70.0), to_go });
        assert_eq!(
            doing(&status),
            "waiting for calm: roll 0.08 deg, 140 s since the last run, about 60 s to go (41 to 88)"
        );
    }
}
