//! Writes samples as delimited text, one column per channel.

use std::fmt::Write as _;

use devices::{Quantity, Sample};

use super::instruments::{RecordingFormat, RollUnit};

/// Header of the time column.
pub(super) const TIME_COLUMN: &str = "t";

/// Unit of a channel's column.
pub(super) fn column_unit(quantity: Quantity, format: RecordingFormat) -> &'static str {
    match (quantity, format.roll_unit) {
        (Quantity::Roll, RollUnit::Deg) => "deg",
        _ => quantity.unit(),
    }
}

/// The table of `channels`: a row per time stamp, an empty cell where a channel has no sample.
pub(super) fn table(samples: &[Sample], channels: &[Quantity], format: RecordingFormat) -> String {
    let mut text = String::with_capacity(samples.len() * 16);
    text.push_str(TIME_COLUMN);
    for quantity in channels {
        text.push(format.delimiter);
        text.push_str(quantity.name());
    }
    text.push('\n');
    let wanted: Vec<&Sample> = samples.iter().filter(|s| channels.contains(&s.quantity)).collect();
    for row in wanted.chunk_by(|a, b| a.time_s.total_cmp(&b.time_s).is_eq()) {
        push_number(&mut text, row[0].time_s, 6, format);
        for quantity in channels {
            text.push(format.delimiter);
            if let Some(sample) = row.iter().find(|s| s.quantity == *quantity) {
                let (value, digits) = match (quantity, format.roll_unit) {
                    (Quantity::Roll, RollUnit::Deg) => (sample.value.to_degrees(), 6),
                    _ => (sample.value, 8),
                };
                push_number(&mut text, value, digits, format);
            }
        }
        text.push('\n');
    }
    text
}

fn push_number(text: &mut String, value: f64, digits: usize, format: RecordingFormat) {
    let start = text.len();
    write!(text, "{value:.digits$}").expect("writing to a string cannot fail");
    let kept = text[start..].trim_end_matches('0').trim_end_matches('.').len();
    text.truncate(start + kept);
    if format.decimal_comma
        && let Some(point) = text[start..].find('.')
    {
        text.replace_range(start + point..=start + point, ",");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_sample_leaves_its_cell_empty() {
        let sample = |quantity, time_s, value| Sample { quantity, time_s, value };
        let samples = [
            sample(Quantity::Roll, 0.0, 0.1_f64.to_radians()),
            sample(Quantity::Speed, 0.0, 1.25),
            sample(Quantity::Speed, 0.01, -0.5),
        ];
        let channels = [Quantity::Roll, Quantity::Speed];
        let format =
            RecordingFormat { delimiter: ';', decimal_comma: true, ..RecordingFormat::default() };
        assert_eq!(table(&samples, &channels, format), "t;roll;speed\n0;0,1;1,25\n0,01;;-0,5\n");
    }
}
