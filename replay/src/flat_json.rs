//! A flat JSON object of numbers, read in one scan: the form of every message that we write.

/// The number under `key` in an object that holds nothing but numbers and has no blanks.
///
/// None where the message has another form or lacks the key: what it is then is for a whole parser
/// to say.
pub(crate) fn number_at(message: &[u8], key: &str) -> Option<f64> {
    let mut scan = Scan { left: message };
    scan.take(b'{')?;
    let mut found = None;
    loop {
        let here = scan.key()?;
        scan.take(b':')?;
        let number = scan.number()?;
        if found.is_none() && here == key.as_bytes() {
            found = Some(number);
        }
        if scan.take(b',').is_none() {
            break;
        }
    }
    scan.take(b'}')?;
    if !scan.left.is_empty() {
        return None;
    }
    let number: f64 = std::str::from_utf8(found?).ok()?.parse().ok()?;
    number.is_finite().then_some(number)
}

/// Digits of a power of ten, and bytes of a number, up to which no float overflows (the largest is
/// 1.8e308); what is beyond is for a whole parser to refuse.
const POWER_DIGITS: usize = 2;
const NUMBER_BYTES: usize = 200;

/// What is left of a message.
struct Scan<'a> {
    left: &'a [u8],
}

impl<'a> Scan<'a> {
    fn take(&mut self, byte: u8) -> Option<()> {
        self.left = self.left.strip_prefix(&[byte])?;
        Some(())
    }

    /// A key of plain letters, without its quotes.
    fn key(&mut self) -> Option<&'a [u8]> {
        self.take(b'"')?;
        let is_plain = |byte: &u8| matches!(byte, b' '..=b'~') && !matches!(byte, b'"' | b'\\');
        let key = self.run_of(is_plain);
        self.take(b'"')?;
        Some(key)
    }

    /// A number in the grammar of RFC 8259, section 6.
    fn number(&mut self) -> Option<&'a [u8]> {
        let start = self.left;
        let _ = self.take(b'-');
        if self.take(b'0').is_none() {
            self.digits()?;
        }
        if self.take(b'.').is_some() {
            self.digits()?;
        }
        let mut is_in_range = true;
        if self.take(b'e').or_else(|| self.take(b'E')).is_some() {
            let _ = self.take(b'-').or_else(|| self.take(b'+'));
            let power = self.left;
            self.digits()?;
            is_in_range = power.len() - self.left.len() <= POWER_DIGITS;
        }
        let number = &start[..start.len() - self.left.len()];
        (is_in_range && number.len() <= NUMBER_BYTES).then_some(number)
    }

    fn digits(&mut self) -> Option<()> {
        (!self.run_of(u8::is_ascii_digit).is_empty()).then_some(())
    }

    fn run_of(&mut self, belongs: impl Fn(&u8) -> bool) -> &'a [u8] {
        let length = self.left.iter().position(|byte| !belongs(byte)).unwrap_or(self.left.len());
        let (run, left) = self.left.split_at(length);
        self.left = left;
        run
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::json_field;
    use crate::message::Found;

    #[test]
    fn the_messages_that_we_write_are_read_in_one_scan() {
        let message = br#"{"time_s":12.3405,"roll_rad":-1.5e-7}"#;
        assert_eq!(number_at(message, "time_s"), Some(12.3405));
        assert_eq!(number_at(message, "roll_rad"), Some(-1.5e-7));
    }

    #[test]
    fn any_other_form_is_left_to_the_parser() {
        let others: [&[u8]; 14] = [
            b"",
            b"{}",
            b"{\"x\":01}",
            b"{\"x\":.5}",
            b"{\"x\":5.}",
            b"{\"x\":+5}",
            b"{\"x\":1e}",
            b"{\"x\":1e999}",
            b"{\"x\":1,\"y\":1e999}",
            b"{\"x\":inf}",
            b"{\"x\":1,}",
            b"{\"x\":1}}",
            b"{\"x\":1,\"y\":null}",
            b"{\"\\u0078\":1}",
        ];
        for message in others {
            assert_eq!(number_at(message, "x"), None, "{}", String::from_utf8_lossy(message));
        }
        assert_eq!(number_at(b"{\"y\":1}", "x"), None, "the key is not there");
    }

    proptest! {
        #[test]
        fn what_the_scan_reads_the_parser_reads_too(
            message in concat!(
                r#"\{("(x|y|x\.y)":-?(0|[0-9]{1,25})(\.[0-9]{0,20})?"#,
                r"(e-?[0-9]{1,3})?,?){0,3}\}?",
            ),
            path in "(x|y|x\\.y)",
        ) {
            if let Some(number) = number_at(message.as_bytes(), &path) {
                let parsed = json_field::number_at(message.as_bytes(), &path);
                let parsed = parsed.expect("what the scan accepts is JSON");
                prop_assert!(matches!(parsed, Found::Number(n) if n.to_bits() == number.to_bits()));
            }
        }
    }
}
