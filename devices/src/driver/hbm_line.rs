//! What the HBM/HBK digitisers' text and binary drivers share: commands and their set-up.

use serde::Deserialize;

use super::{Content, Purpose, Request, SettingsError, ask, tell};

/// Set-up commands sent after the flush and the identity, each answered by `0` or `?`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SetUp {
    /// Such as `ASF0` (no filter) and `ICR0` (fastest), without their semicolon.
    #[serde(default)]
    pub(crate) commands: Vec<String>,
}

impl SetUp {
    pub(super) fn check(&self) -> Result<(), SettingsError> {
        let wrong = self.commands.iter().find(|command| {
            command.len() < 3 || command.contains([';', '\n', '\r']) || !command.is_ascii()
        });
        match wrong {
            Some(command) => Err(SettingsError(format!(
                "command \"{command}\": three letters and parameters, without semicolon"
            ))),
            None => Ok(()),
        }
    }

    /// Stop and flush, ask who it is, then the commands and the output format.
    pub(super) fn opening(&self, stations: &[u8], format: u8) -> Vec<Request> {
        let mut requests = vec![tell(b"STP;".to_vec(), Purpose::Configure)];
        let selections: Vec<String> = if stations.is_empty() {
            vec![String::new()]
        } else {
            stations.iter().map(|station| format!("S{station:02};")).collect()
        };
        for (tag, select) in selections.iter().enumerate() {
            let to = |command: &str| format!("{select}{command};").into_bytes();
            requests.push(ask(to("IDN?"), Purpose::Identify, tag));
            for command in &self.commands {
                requests.push(ask(to(command), Purpose::Configure, tag));
            }
            requests.push(ask(to(&format!("COF{format}")), Purpose::Configure, tag));
        }
        requests
    }
}

/// What a line of text says while a text answer is due; none when it is no such answer.
pub(super) fn answer(line: &[u8], purpose: Purpose) -> Option<Content> {
    match (line, purpose) {
        (b"?", _) => Some(Content::Refused("?".to_owned())),
        (b"0", Purpose::Configure) => Some(Content::Accepted),
        (line, Purpose::Identify) if line.len() > 1 && line.iter().all(u8::is_ascii) => {
            Some(Content::Identity(String::from_utf8_lossy(line).into_owned()))
        }
        _ => None,
    }
}

/// The first line that ends in CR LF, without and with it.
pub(super) fn line(bytes: &[u8]) -> Option<(&[u8], usize)> {
    let end = bytes.windows(2).position(|pair| pair == b"\r\n")?;
    Some((&bytes[..end], end + 2))
}

/// 24-bit two's complement.
pub(crate) fn signed_24(high: u8, middle: u8, low: u8) -> i32 {
    i32::from_be_bytes([high, middle, low, 0]) >> 8
}

/// The largest and smallest values mean that the input is over-driven.
pub(super) fn is_overflow(raw: i32) -> bool {
    raw <= -8_388_608 || raw >= 8_388_607
}
