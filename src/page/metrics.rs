//! The status as Prometheus scrapes it.

use std::fmt;

use prometheus_client::collector::Collector;
use prometheus_client::encoding::text::encode;
use prometheus_client::encoding::{DescriptorEncoder, MetricEncoder, NoLabelSet};
use prometheus_client::metrics::MetricType;
use prometheus_client::registry::Registry;

use super::status::{ChannelStatus, DeviceStatus, Status};

/// What the text is, for whoever asked.
pub(super) const CONTENT_TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// The gauges of a status, as text.
pub(super) fn text(status: &Status) -> Result<String, fmt::Error> {
    let mut registry = Registry::with_prefix("rolltank");
    registry.register_collector(Box::new(Gauges(status.clone())));
    let mut text = String::new();
    encode(&mut text, &registry)?;
    Ok(text)
}

#[derive(Debug)]
struct Gauges(Status);

/// A value with what tells it from others of its name.
type Row = (Vec<(&'static str, String)>, f64);

impl Collector for Gauges {
    fn encode(&self, mut encoder: DescriptorEncoder<'_>) -> fmt::Result {
        let status = &self.0;
        let mut tell = |name: &str, help: &str, kind: MetricType, rows: Vec<Row>| {
            family(&mut encoder, (name, help, kind), &rows)
        };
        let of_device = |value: fn(&DeviceStatus) -> f64| -> Vec<Row> {
            let row =
                |device: &DeviceStatus| (vec![("device", device.name.clone())], value(device));
            status.devices.iter().map(row).collect()
        };
        let linked = of_device(|device| f64::from(u8::from(device.linked)));
        tell("device_linked", "Whether the port is open", MetricType::Gauge, linked)?;
        let losses = of_device(|device| device.n_losses as f64);
        tell("link_losses", "Links lost", MetricType::Counter, losses)?;
        let gaps = of_device(|device| device.n_gaps as f64);
        tell("gaps", "Gaps in the samples", MetricType::Counter, gaps)?;
        let dropped = of_device(|device| device.n_dropped as f64);
        tell("events_dropped", "Events without a place", MetricType::Counter, dropped)?;
        let counts = "Samples by channel and what became of them";
        tell("samples", counts, MetricType::Counter, samples(status))?;
        let ages = "Age of the newest sample [s of the daemon's clock]";
        tell("sample_age_seconds", ages, MetricType::Gauge, ages_s(status))?;
        let plain = |value: u64| vec![(Vec::new(), value as f64)];
        let recorded = &status.recorded;
        tell("records", "Records taken", MetricType::Counter, plain(recorded.records))?;
        let lost = plain(recorded.unrecorded);
        tell("records_lost", "Records not kept", MetricType::Counter, lost)?;
        let stopped = plain(u64::from(recorded.stopped));
        tell("recording_stopped", "Whether the disk is full", MetricType::Gauge, stopped)?;
        let bytes = plain(recorded.part_bytes);
        tell("recording_bytes", "Size of the growing file", MetricType::Gauge, bytes)?;
        let runs = &status.runs;
        let outcomes = [
            ("found", runs.n_found),
            ("identified", runs.n_identified),
            ("refused", runs.n_refused),
            ("unheard", runs.n_unheard),
        ];
        let row = |(outcome, n): (&str, u64)| (vec![("outcome", outcome.to_owned())], n as f64);
        let outcomes = outcomes.into_iter().map(row).collect();
        tell("runs", "Runs by what became of them", MetricType::Counter, outcomes)?;
        let rejected = plain(runs.n_rejected);
        tell("stretches_rejected", "Stretches not used", MetricType::Counter, rejected)?;
        let latency = runs.latencies_s.last().map(|latency_s| (Vec::new(), *latency_s));
        let help = "From the last sample that the latest run needed to its report on disk";
        tell("report_latency_seconds", help, MetricType::Gauge, latency.into_iter().collect())?;
        let ready = plain(u64::from(status.is_ready()));
        tell("ready", "Whether every instrument streams", MetricType::Gauge, ready)
    }
}

fn family(
    encoder: &mut DescriptorEncoder<'_>,
    (name, help, kind): (&str, &str, MetricType),
    rows: &[Row],
) -> fmt::Result {
    let mut metric = encoder.encode_descriptor(name, help, None, kind)?;
    for (labels, value) in rows {
        if labels.is_empty() {
            write(&mut metric, kind, *value)?;
        } else {
            write(&mut metric.encode_family(labels)?, kind, *value)?;
        }
    }
    Ok(())
}

fn write(one: &mut MetricEncoder<'_>, kind: MetricType, value: f64) -> fmt::Result {
    match kind {
        MetricType::Counter => one.encode_counter::<NoLabelSet, _, u64>(&value, None),
        _ => one.encode_gauge(&value),
    }
}

fn channels(status: &Status) -> impl Iterator<Item = (&DeviceStatus, &ChannelStatus)> {
    status.devices.iter().flat_map(|device| device.channels.iter().map(move |of| (device, of)))
}

fn samples(status: &Status) -> Vec<Row> {
    let rows = channels(status).flat_map(|(device, channel)| {
        let counts = &channel.counts;
        [
            ("received", counts.received),
            ("lost", counts.lost),
            ("repeated", counts.repeated),
            ("over_range", counts.over_range),
            ("damaged", counts.damaged),
        ]
        .map(|(outcome, count)| {
            let labels = vec![
                ("device", device.name.clone()),
                ("channel", channel.quantity.name().to_owned()),
                ("outcome", outcome.to_owned()),
            ];
            (labels, count as f64)
        })
    });
    rows.collect()
}

fn ages_s(status: &Status) -> Vec<Row> {
    let rows = channels(status).filter_map(|(device, channel)| {
        let labels =
            vec![("device", device.name.clone()), ("channel", channel.quantity.name().to_owned())];
        Some((labels, status.at_s - channel.time_s?))
    });
    rows.collect()
}
