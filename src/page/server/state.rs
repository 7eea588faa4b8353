//! The state as the page reads it: what the tank is doing, its channels, its alarms.

use serde::Serialize;
use serde_json::{Value, json};

use crate::page::board::Board;
use crate::page::status::{ChannelStatus, DeviceStatus, Status};
use crate::page::words::{alarms, doing};

/// What a channel is called and measured in on the page.
#[derive(Serialize)]
struct ChannelState<'s> {
    device: &'s str,
    quantity: &'static str,
    unit: &'static str,
    linked: bool,
    silent: bool,
    quality: &'s [&'static str],
    bound_s: Option<f64>,
    received: u64,
    lost: u64,
    repeated: u64,
    over_range: u64,
    damaged: u64,
}

/// The state as JSON, and the same without what changes with every sample.
pub(super) fn state(board: &Board) -> (String, String) {
    let status = board.now();
    let shown = board.shown().number;
    let judgements = board.judgements().next_number();
    let slow = json!({
        "campaign": status.campaign,
        "condition": status.condition,
        "recording": status.recording,
        "sessions": status.n_sessions,
        "paused_by": status.paused_by,
        "reload_waits": status.reload_waits,
        "alarms": alarms(&status),
        "runs": {
            "found": status.runs.n_found,
            "identified": status.runs.n_identified,
            "refused": status.runs.n_refused,
            "rejected": status.runs.n_rejected,
        },
        "links": links(&status),
        "at_rest": status.motion.at_rest,
        "shown": shown,
        "judgements": judgements,
    });
    let mut whole = slow.clone();
    whole["at_s"] = json!(status.at_s);
    whole["doing"] = json!(doing(&status));
    whole["provisional"] = json!(status.provisional);
    whole["pass"] = json!(status.pass);
    whole["tank_length_m"] = json!(status.tank_length_m);
    let froude = status.pass.speed_m_s.abs() / status.froude_one_m_s;
    whole["froude"] = json!(froude.is_finite().then_some(froude));
    whole["part_bytes"] = json!(status.recorded.part_bytes);
    whole["channels"] = channels(&status);
    (whole.to_string(), slow.to_string())
}

fn links(status: &Status) -> Value {
    let link = |device: &DeviceStatus| {
        json!({
            "name": device.name, "port": device.port, "linked": device.linked,
            "identity": device.identity, "trouble": device.trouble,
            "losses": device.n_losses, "gaps": device.n_gaps, "dropped": device.n_dropped,
        })
    };
    status.devices.iter().map(link).collect()
}

fn channels(status: &Status) -> Value {
    let state = |device: &DeviceStatus, channel: &ChannelStatus| {
        json!(ChannelState {
            device: &device.name,
            quantity: channel.quantity.name(),
            unit: channel.shown_unit(),
            linked: device.linked,
            silent: channel.is_silent(status.at_s),
            quality: &channel.quality,
            bound_s: channel.bound_s,
            received: channel.counts.received,
            lost: channel.counts.lost,
            repeated: channel.counts.repeated,
            over_range: channel.counts.over_range,
            damaged: channel.counts.damaged,
        })
    };
    let devices = status.devices.iter();
    let all = devices.flat_map(|device| device.channels.iter().map(move |of| (device, of)));
    all.map(|(device, channel)| state(device, channel)).collect()
}
