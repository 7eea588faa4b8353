//! Lines of text by example: `$RD,{sequence},{time_us},{0},{1}*{xor}`, read and written.

/// A line's form; blanks in it match any number of blanks, also none.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pattern {
    tokens: Vec<Token>,
    decimal_comma: bool,
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Blanks,
    Literal(u8),
    Field(usize),
    Sequence,
    /// Device time, with its ticks per second.
    Time(f64),
    Skip,
    Xor,
    Sum,
}

/// What a line carries.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct PatternValues {
    /// Field number and value, in the order of the line.
    pub(crate) fields: Vec<(usize, f64)>,
    pub(crate) sequence: Option<u64>,
    /// In the ticks of the pattern: seconds are counted in microseconds.
    pub(crate) ticks: Option<u64>,
}

/// Why a line is not of the pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mismatch {
    Form,
    Checksum,
}

impl Pattern {
    /// Reads a pattern; the error says what is wrong with it.
    pub(crate) fn new(text: &str, decimal_comma: bool) -> Result<Self, String> {
        let mut tokens = Vec::new();
        let mut rest = text;
        while let Some(first) = rest.chars().next() {
            if first == '{' {
                let (name, after) = rest[1..]
                    .split_once('}')
                    .ok_or_else(|| format!("pattern \"{text}\" has a brace that is not closed"))?;
                tokens.push(token(name).ok_or_else(|| {
                    format!(
                        "pattern \"{text}\" has {{{name}}}, known are {{0}}, {{1}} .. {{15}}, \
                         {{sequence}}, {{time_s}}, {{time_ms}}, {{time_us}}, {{skip}}, {{xor}}, \
                         {{sum}}"
                    )
                })?);
                rest = after;
                continue;
            }
            rest = &rest[first.len_utf8()..];
            if first == ' ' {
                if tokens.last() != Some(&Token::Blanks) {
                    tokens.push(Token::Blanks);
                }
            } else {
                let mut bytes = [0; 4];
                tokens.extend(first.encode_utf8(&mut bytes).bytes().map(Token::Literal));
            }
        }
        if !tokens.iter().any(|token| matches!(token, Token::Field(_))) {
            return Err(format!("pattern \"{text}\" has no field such as {{0}}"));
        }
        Ok(Self { tokens, decimal_comma })
    }

    /// One more than the highest field number.
    pub(crate) fn n_fields(&self) -> usize {
        let number = |token: &Token| if let Token::Field(field) = token { field + 1 } else { 0 };
        self.tokens.iter().map(number).max().unwrap_or(0)
    }

    pub(crate) fn has_sequence(&self) -> bool {
        self.tokens.contains(&Token::Sequence)
    }

    /// Ticks of the device time in a second, where the line has one.
    pub(crate) fn ticks_per_s(&self) -> Option<f64> {
        self.tokens.iter().find_map(|token| match token {
            Token::Time(ticks_per_s) => Some(if *ticks_per_s < 10.0 { 1e6 } else { *ticks_per_s }),
            _ => None,
        })
    }

    /// What a line without its terminator carries.
    pub(crate) fn read(&self, line: &[u8]) -> Result<PatternValues, Mismatch> {
        let mut values = PatternValues::default();
        let mut at = 0;
        for (index, token) in self.tokens.iter().enumerate() {
            let rest = &line[at..];
            at += match token {
                Token::Blanks => rest.iter().take_while(|byte| b" \t".contains(byte)).count(),
                Token::Literal(byte) if rest.first() == Some(byte) => 1,
                Token::Literal(_) => return Err(Mismatch::Form),
                Token::Xor | Token::Sum => {
                    let digits = rest.get(..2).ok_or(Mismatch::Form)?;
                    let text = str::from_utf8(digits).map_err(|_| Mismatch::Form)?;
                    let sent = u8::from_str_radix(text, 16).map_err(|_| Mismatch::Form)?;
                    if sent != check(token, &line[..at]) {
                        return Err(Mismatch::Checksum);
                    }
                    2
                }
                Token::Skip => self.span(index, rest),
                Token::Field(_) | Token::Sequence | Token::Time(_) => {
                    let end = self.span(index, rest);
                    self.take(token, &rest[..end], &mut values).ok_or(Mismatch::Form)?;
                    end
                }
            };
        }
        if at == line.len() { Ok(values) } else { Err(Mismatch::Form) }
    }

    /// A value reaches to the next literal or blank of the pattern.
    fn span(&self, index: usize, rest: &[u8]) -> usize {
        let signed = usize::from(rest.first().is_some_and(|byte| b"+- ".contains(byte)));
        let is_end = |byte: u8| match self.tokens.get(index + 1) {
            Some(Token::Literal(literal)) => byte == *literal,
            Some(Token::Blanks) => b" \t".contains(&byte),
            Some(Token::Xor | Token::Sum) => !b"0123456789.,+-".contains(&byte),
            _ => false,
        };
        let body = rest.get(signed..).unwrap_or_default();
        body.iter().position(|byte| is_end(*byte)).unwrap_or(body.len()) + signed
    }

    fn take(&self, token: &Token, text: &[u8], values: &mut PatternValues) -> Option<()> {
        let mut text = str::from_utf8(text).ok()?.trim().to_owned();
        if self.decimal_comma {
            text = text.replace(',', ".");
        }
        // Scales fill up between sign and digits: `+  4.876`.
        if text.starts_with(['+', '-']) {
            text.retain(|c| c != ' ');
        }
        match token {
            Token::Field(field) => values.fields.push((*field, super::decimal(text.as_bytes())?)),
            Token::Sequence => values.sequence = Some(text.parse().ok()?),
            Token::Time(ticks_per_s) if *ticks_per_s < 10.0 => {
                let seconds = super::decimal(text.as_bytes()).filter(|time_s| *time_s >= 0.0)?;
                values.ticks = Some((seconds * 1e6).round() as u64);
            }
            Token::Time(_) => values.ticks = Some(text.parse().ok()?),
            _ => {}
        }
        Some(())
    }

    /// Writes a line without its terminator; an instrument that is emulated speaks so.
    pub(crate) fn write(&self, values: &PatternValues) -> Vec<u8> {
        let mut line = Vec::new();
        for token in &self.tokens {
            let text = match token {
                Token::Blanks => " ".to_owned(),
                Token::Literal(byte) => {
                    line.push(*byte);
                    continue;
                }
                Token::Field(field) => {
                    let found = values.fields.iter().find(|(number, _)| number == field);
                    let text = format!("{}", found.map_or(0.0, |(_, value)| *value));
                    if self.decimal_comma { text.replace('.', ",") } else { text }
                }
                Token::Sequence => values.sequence.unwrap_or(0).to_string(),
                Token::Time(ticks_per_s) if *ticks_per_s < 10.0 => {
                    let ticks = values.ticks.unwrap_or(0);
                    format!("{}.{:06}", ticks / 1_000_000, ticks % 1_000_000)
                }
                Token::Time(_) => values.ticks.unwrap_or(0).to_string(),
                Token::Skip => String::new(),
                Token::Xor | Token::Sum => format!("{:02X}", check(token, &line)),
            };
            line.extend_from_slice(text.as_bytes());
        }
        line
    }
}

fn token(name: &str) -> Option<Token> {
    Some(match name {
        "sequence" => Token::Sequence,
        "time_s" => Token::Time(1.0),
        "time_ms" => Token::Time(1e3),
        "time_us" => Token::Time(1e6),
        "skip" => Token::Skip,
        "xor" => Token::Xor,
        "sum" => Token::Sum,
        _ => Token::Field(name.parse().ok().filter(|field| *field < 16)?),
    })
}

/// The check of the line so far: NMEA's XOR between `$` or `!` and `*`, or the sum of all bytes.
fn check(token: &Token, before: &[u8]) -> u8 {
    if *token == Token::Sum {
        return before.iter().fold(0, |sum, byte| sum.wrapping_add(*byte));
    }
    let inside = before.strip_suffix(b"*").unwrap_or(before);
    let inside = inside.strip_prefix(b"$").or(inside.strip_prefix(b"!")).unwrap_or(inside);
    inside.iter().fold(0, |check, byte| check ^ byte)
}
