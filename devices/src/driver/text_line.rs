//! Lines of text by a pattern: own electronics, scales, NMEA-like speed logs.

use serde::Deserialize;

use super::pattern::{Mismatch, Pattern, PatternValues};
use super::{
    Content, Damage, DeviceTicks, Found, Protocol, Purpose, Request, SettingsError, ask,
    first_line, settings, tell, value,
};
use crate::Quality;

/// Longest line waited for [bytes].
const LINE_BYTES_MAX: usize = 256;

/// `[settings]` of a profile of this driver.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    /// `{0}`, `{sequence}`, `{time_us}`, `{skip}`, `{xor}` between literal text.
    pub(crate) pattern: String,
    /// Each of these characters ends a line.
    #[serde(default = "line_ends")]
    pub(crate) terminators: String,
    #[serde(default)]
    pub(crate) decimal_comma: bool,
    /// Sent once when the port opens.
    #[serde(default)]
    pub(crate) start: Option<String>,
    /// Sent for every line; without it the instrument talks unasked.
    #[serde(default)]
    pub(crate) request: Option<String>,
    /// Sent when the port opens, to be answered by a line of the form of `identity_line`.
    #[serde(default)]
    pub(crate) identify: Option<String>,
    /// `ID {name}`: a line of this form says who the instrument is, asked or not.
    #[serde(default)]
    pub(crate) identity_line: Option<String>,
    #[serde(default = "counter_bits")]
    pub(crate) sequence_bits: u32,
    #[serde(default = "counter_bits")]
    pub(crate) time_bits: u32,
}

fn line_ends() -> String {
    "\r\n".to_owned()
}

fn counter_bits() -> u32 {
    32
}

struct TextLine {
    settings: Settings,
    pattern: Pattern,
    identity: Option<IdentityLine>,
}

pub(super) fn open(table: &toml::Table) -> Result<Box<dyn Protocol>, SettingsError> {
    let settings: Settings = settings(table)?;
    let pattern = Pattern::new(&settings.pattern, settings.decimal_comma).map_err(SettingsError)?;
    for (name, bits) in
        [("sequence_bits", settings.sequence_bits), ("time_bits", settings.time_bits)]
    {
        if !(1..=64).contains(&bits) {
            return Err(SettingsError(format!("{name} is {bits}, allowed are 1 to 64")));
        }
    }
    let identity = settings.identity_line.as_deref().map(IdentityLine::new).transpose()?;
    if settings.identify.is_some() && identity.is_none() {
        let form = "identity_line, such as \"ID {name}\"";
        return Err(SettingsError(format!("identify needs {form}: what the answer looks like")));
    }
    Ok(Box::new(TextLine { settings, pattern, identity }))
}

/// What stands around the name in a line that says who the instrument is.
#[derive(Debug, Clone)]
pub(crate) struct IdentityLine {
    before: String,
    after: String,
}

impl IdentityLine {
    pub(crate) fn new(form: &str) -> Result<Self, SettingsError> {
        let around = form.split_once("{name}").filter(|(before, _)| !before.is_empty());
        let (before, after) = around.ok_or_else(|| {
            SettingsError(format!("identity_line is \"{form}\", expected text and then {{name}}"))
        })?;
        Ok(Self { before: before.to_owned(), after: after.to_owned() })
    }

    fn read(&self, line: &[u8]) -> Option<String> {
        let name = line.strip_prefix(self.before.as_bytes())?;
        let name = str::from_utf8(name.strip_suffix(self.after.as_bytes())?).ok()?.trim();
        let is_name = !name.is_empty() && !name.contains(char::is_control);
        is_name.then(|| name.to_owned())
    }

    /// The line of an instrument of that name, without its terminator.
    pub(crate) fn write(&self, name: &str) -> String {
        format!("{}{name}{}", self.before, self.after)
    }
}

impl Protocol for TextLine {
    fn fields(&self) -> Vec<String> {
        (0..self.pattern.n_fields()).map(|field| format!("{{{field}}}")).collect()
    }

    fn opening(&self) -> Vec<Request> {
        let bytes = |text: &String| text.clone().into_bytes();
        let identify = self.settings.identify.as_ref();
        let identify = identify.map(|text| ask(bytes(text), Purpose::Identify, 0));
        let start = self.settings.start.as_ref();
        let start = start.map(|text| tell(bytes(text), Purpose::Configure));
        identify.into_iter().chain(start).collect()
    }

    fn cycle(&self) -> Vec<Request> {
        let request = self.settings.request.as_ref();
        request.map(|text| ask(text.clone().into_bytes(), Purpose::Read, 0)).into_iter().collect()
    }

    fn fields_asked(&self, _request: &Request) -> Vec<usize> {
        (0..self.pattern.n_fields()).collect()
    }

    fn decode(&mut self, bytes: &[u8], _asked: Option<&Request>) -> Found {
        let is_end = |byte: u8| self.settings.terminators.as_bytes().contains(&byte);
        let Some((line, n_bytes)) = first_line(bytes, is_end) else {
            if bytes.len() > LINE_BYTES_MAX {
                return Found::Noise { n_bytes: bytes.len(), damage: Damage::TooLong };
            }
            return Found::Part;
        };
        if line.is_empty() {
            return Found::Skip { n_bytes };
        }
        if let Some(name) = self.identity.as_ref().and_then(|identity| identity.read(line)) {
            return Found::Frame { n_bytes, content: Content::Identity(name) };
        }
        match self.pattern.read(line) {
            Ok(values) => Found::Frame { n_bytes, content: content(&values) },
            Err(Mismatch::Form) => Found::Noise { n_bytes, damage: Damage::Form },
            Err(Mismatch::Checksum) => Found::Noise { n_bytes, damage: Damage::Checksum },
        }
    }

    fn device_clock(&self) -> DeviceTicks {
        let ticks_per_s = self.pattern.ticks_per_s();
        DeviceTicks {
            sequence_bits: self.pattern.has_sequence().then_some(self.settings.sequence_bits),
            time_bits: ticks_per_s.map(|_| self.settings.time_bits),
            ticks_per_s: ticks_per_s.unwrap_or(0.0),
        }
    }
}

fn content(line: &PatternValues) -> Content {
    let values = line.fields.iter().map(|(field, raw)| value(*field, *raw, Quality::GOOD));
    Content::Values { values: values.collect(), sequence: line.sequence, ticks: line.ticks }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(settings: &str) -> Box<dyn Protocol> {
        open(&settings.parse().unwrap()).unwrap()
    }

    fn read(protocol: &mut dyn Protocol, bytes: &[u8]) -> (Vec<f64>, Option<u64>, Option<u64>) {
        match protocol.decode(bytes, None) {
            Found::Frame { n_bytes, content: Content::Values { values, sequence, ticks } } => {
                assert!(bytes.len() - n_bytes <= 1, "{n_bytes} of {}", bytes.len());
                (values.iter().map(|value| value.raw).collect(), sequence, ticks)
            }
            found => panic!("{found:?}"),
        }
    }

    #[test]
    fn an_nmea_like_line_with_its_check_is_read() {
        let mut carriage = line(r#"pattern = "$PCARR,{time_s},{0},M*{xor}""#);
        let (values, _, ticks) = read(carriage.as_mut(), b"$PCARR,1234.567890,1.2345,M*03\r\n");
        assert_eq!((values, ticks), (vec![1.2345], Some(1_234_567_890)));
        let found = carriage.decode(b"$PCARR,1234.567890,1.2346,M*03\r\n", None);
        assert_eq!(found, Found::Noise { n_bytes: 31, damage: Damage::Checksum });
        let mut log = line(r#"pattern = "$IIVBW,{0},{1},A*{xor}""#);
        assert_eq!(read(log.as_mut(), b"$IIVBW,1.23,0.00,A*2E\r\n").0, [1.23, 0.0]);
    }

    #[test]
    fn an_arduino_and_two_scales_are_read() {
        let mut arduino = line(r#"pattern = "{time_us},{0},{1}""#);
        let (values, _, ticks) = read(arduino.as_mut(), b"4294967295,-12,8388607\r\n");
        assert_eq!((values, ticks), (vec![-12.0, 8_388_607.0], Some(4_294_967_295)));
        let mut scale = line(r#"pattern = "ST,{skip},{0}kg""#);
        assert_eq!(read(scale.as_mut(), b"ST,GS,+  4.876kg\r\n").0, [4.876]);
        let mut spd = line("pattern = \"S{0}\"\nrequest = \"SX\\r\\n\"");
        assert_eq!(read(spd.as_mut(), b"S+0125785\r\n").0, [125_785.0]);
        assert_eq!(spd.cycle()[0].bytes, b"SX\r\n");
    }

    #[test]
    fn a_decimal_comma_and_frames_of_stx_and_etx_are_read() {
        let text =
            "pattern = \"\\u0002 {0} ;{1}\"\ndecimal_comma = true\nterminators = \"\\u0003\"";
        let mut probe = line(text);
        assert_eq!(read(probe.as_mut(), b"\x02  -1,25 ;3\x03").0, [-1.25, 3.0]);
    }

    #[test]
    fn a_partial_line_waits_and_an_endless_one_is_given_up() {
        let mut arduino = line(r#"pattern = "{0}""#);
        assert_eq!(arduino.decode(b"12", None), Found::Part);
        let endless = arduino.decode(&[b'7'; 300], None);
        assert_eq!(endless, Found::Noise { n_bytes: 300, damage: Damage::TooLong });
    }

    #[test]
    fn a_board_that_is_asked_says_its_name_between_its_readings() {
        let text = "pattern = \"{0}\"\nidentify = \"ID?\\r\"\nidentity_line = \"ID {name};\"";
        let mut board = line(text);
        assert_eq!(board.opening()[0].bytes, b"ID?\r");
        let name = Content::Identity("roll board 2".to_owned());
        let found = board.decode(b"ID roll board 2;\r\n", None);
        assert_eq!(found, Found::Frame { n_bytes: 17, content: name });
        assert_eq!(read(board.as_mut(), b"1.5\r\n").0, [1.5]);
        assert!(!line("pattern = \"{0}\"").asks_who());
        let error = open(&"pattern = \"{0}\"\nidentify = \"ID?\"".parse().unwrap()).err().unwrap();
        assert!(error.to_string().contains("identify needs identity_line"), "{error}");
    }

    #[test]
    fn a_wrong_pattern_is_told_with_what_is_known() {
        let error = open(&"pattern = \"{volt}\"".parse().unwrap()).err().unwrap();
        assert!(error.to_string().contains("has {volt}, known are {0}"), "{error}");
    }
}
