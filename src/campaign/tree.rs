//! A walk over a TOML file that remembers the line of every value and collects every mistake.

use std::cell::RefCell;
use std::ops::Range;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::mistake::{Mistake, nearest};

/// The text being read, with the mistakes found so far.
pub(super) struct Source<'t> {
    file: String,
    text: &'t str,
    mistakes: RefCell<Vec<Mistake>>,
}

impl<'t> Source<'t> {
    pub(super) fn new(file: String, text: &'t str) -> Self {
        Self { file, text, mistakes: RefCell::default() }
    }

    /// The root table, or the syntax errors of the text.
    pub(super) fn parse(&self) -> Option<Spanned<DeTable<'t>>> {
        let (tree, errors) = DeTable::parse_recoverable(self.text);
        if errors.is_empty() {
            return Some(tree);
        }
        for error in errors {
            let line = error.span().map(|span| self.line(span.start));
            self.add(
                line,
                error.message().trim().to_lowercase().replace('\n', ", "),
                Some(SYNTAX.to_owned()),
            );
        }
        None
    }

    pub(super) fn root<'s>(&'s self, table: &'s DeTable<'t>) -> Section<'s> {
        Section::new(self, String::new(), None, table)
    }

    pub(super) fn add(&self, line: Option<usize>, message: String, hint: Option<String>) {
        let mistake = Mistake { file: self.file.clone(), line, message, hint };
        self.mistakes.borrow_mut().push(mistake);
    }

    /// Every mistake in the order of its line.
    pub(super) fn into_mistakes(self) -> Vec<Mistake> {
        let mut mistakes = self.mistakes.into_inner();
        mistakes.sort_by_key(|mistake| mistake.line);
        mistakes
    }

    fn line(&self, offset: usize) -> usize {
        1 + self.text.get(..offset).map_or(0, |before| before.matches('\n').count())
    }
}

/// What most syntax errors come from.
const SYNTAX: &str =
    "texts stand in double quotes, table names in brackets, numbers take a decimal point";

/// The kind of a value with its article.
fn kind(value: &DeValue<'_>) -> String {
    let kind = value.type_str();
    let article = if kind.starts_with(['a', 'i']) { "an" } else { "a" };
    format!("{article} {kind}")
}

/// The numbers that a key accepts, in words for the message.
pub(super) struct Limits {
    words: &'static str,
    hold: fn(f64) -> bool,
}

/// Any length, volume, rate: a number above zero.
pub(super) const POSITIVE: Limits =
    Limits { words: "a finite number above 0", hold: |value| value > 0.0 };

/// A speed: zero or above.
pub(super) const NOT_NEGATIVE: Limits =
    Limits { words: "a finite number, 0 or above", hold: |value| value >= 0.0 };

/// A count: a whole number from one up.
pub(super) const COUNT: Limits = Limits {
    words: "a whole number, 1 to 1000",
    hold: |value| (1.0..=1000.0).contains(&value) && (value - value.round()).abs() < 1e-9,
};

/// A relative standard uncertainty.
pub(super) const SHARE: Limits = Limits {
    words: "a share of the value, 0 to 0.2, such as 0.005 for half a percent",
    hold: |value| (0.0..=0.2).contains(&value),
};

/// A sign.
pub(super) const SIGN: Limits =
    Limits { words: "1 or -1", hold: |value| [1.0, -1.0].contains(&value) };

/// One table of the file; what is asked of it is what it may hold.
pub(super) struct Section<'s> {
    source: &'s Source<'s>,
    title: String,
    line: Option<usize>,
    /// Where it stands in the text [bytes].
    span: Range<usize>,
    table: &'s DeTable<'s>,
    asked: RefCell<Vec<&'static str>>,
    missing: RefCell<Vec<(&'static str, String)>>,
}

impl<'s> Section<'s> {
    fn new(
        source: &'s Source<'s>,
        title: String,
        line: Option<usize>,
        table: &'s DeTable<'s>,
    ) -> Self {
        let (asked, missing) = (RefCell::default(), RefCell::default());
        Self { source, title, line, span: 0..0, table, asked, missing }
    }

    /// The line of a key, or of the table when it does not hold the key.
    pub(super) fn line(&self, key: &str) -> Option<usize> {
        let held = self.table.get_key_value(key);
        held.map(|(key, _)| self.source.line(key.span().start)).or(self.line)
    }

    /// The line on which the table begins.
    pub(super) fn own_line(&self) -> Option<usize> {
        self.line
    }

    /// Whether the table holds the key, right or wrong.
    pub(super) fn holds(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// Whether a table below this one holds the key, right or wrong.
    pub(super) fn holds_below(&self, table: &str, key: &str) -> bool {
        let below = self.table.get(table).and_then(|value| value.get_ref().as_table());
        below.is_some_and(|table| table.contains_key(key))
    }

    /// Adds a mistake about a key of a table below this one.
    pub(super) fn mistake_below(&self, table: &str, key: &str, message: String, hint: &str) {
        let below = self.table.get(table).and_then(|value| value.get_ref().as_table());
        let held = below.and_then(|table| table.get_key_value(key));
        let line = held.map(|(key, _)| self.source.line(key.span().start));
        self.source.add(line.or(self.line(table)), message, Some(hint.to_owned()));
    }

    /// Adds a mistake about a key.
    pub(super) fn mistake(&self, key: &str, message: String, hint: impl Into<String>) {
        self.source.add(self.line(key), message, Some(hint.into()));
    }

    /// A number, if the key is there and within its limits.
    pub(super) fn number(&self, key: &'static str, limits: &Limits) -> Option<f64> {
        let value = self.value(key)?;
        let number = match value {
            DeValue::Float(float) => float.as_str().parse::<f64>().ok(),
            DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
                .ok()
                .map(|whole| whole as f64),
            other => {
                self.wrong_type(key, other, "a number");
                return None;
            }
        };
        match number {
            Some(number) if number.is_finite() && (limits.hold)(number) => Some(number),
            _ => {
                let written = match value {
                    DeValue::Float(float) => float.to_string(),
                    DeValue::Integer(integer) => integer.to_string(),
                    _ => String::new(),
                };
                let place = self.place(key);
                let message = format!("{place} is {written}, but must be {}", limits.words);
                self.mistake(key, message, format!("write `{key} = ` with the measured value"));
                None
            }
        }
    }

    /// A number that must be there.
    pub(super) fn required_number(&self, key: &'static str, limits: &Limits) -> Option<f64> {
        self.require(key, limits.words);
        self.number(key, limits)
    }

    /// A text that is not blank, if the key is there.
    pub(super) fn text(&self, key: &'static str) -> Option<&'s str> {
        match self.value(key)? {
            DeValue::String(text) if !text.trim().is_empty() => Some(text),
            DeValue::String(_) => {
                let message = format!("{} is an empty text", self.place(key));
                self.mistake(key, message, format!("give `{key}` a text or leave it out"));
                None
            }
            other => {
                self.wrong_type(key, other, "a text in quotes");
                None
            }
        }
    }

    /// The text of a key that may also hold an array of tables; none where it does or is absent.
    pub(super) fn text_or_tables(&self, key: &'static str) -> Option<&'s str> {
        match self.value(key)? {
            DeValue::Array(_) => None,
            _ => self.text(key),
        }
    }

    /// A text that must be there.
    pub(super) fn required_text(&self, key: &'static str) -> Option<&'s str> {
        self.require(key, "a text in quotes");
        self.text(key)
    }

    /// A table that must be there.
    pub(super) fn required_section(&self, key: &'static str) -> Option<Section<'s>> {
        if !self.holds(key) {
            self.missing.borrow_mut().push((key, format!("add a [{key}] table")));
        }
        self.section(key)
    }

    /// A table below this one, if the key is there.
    pub(super) fn section(&self, key: &'static str) -> Option<Section<'s>> {
        match self.value(key)? {
            DeValue::Table(table) => Some(self.below(key, format!("[{key}]"), table)),
            other => {
                self.wrong_type(key, other, "a table");
                None
            }
        }
    }

    /// The whole table as a value that knows its own keys; a mistake in it is added.
    pub(super) fn whole<T: DeserializeOwned>(&self) -> Option<T> {
        let whole = Spanned::new(self.span.clone(), DeValue::Table(self.table.clone()));
        match T::deserialize(ValueDeserializer::from(whole)) {
            Ok(value) => Some(value),
            Err(error) => {
                let line = error.span().map(|span| self.source.line(span.start));
                let message = format!("{}: {}", self.title, error.message().trim());
                self.mistake_on(line.or(self.line), message, None);
                None
            }
        }
    }

    /// Adds a mistake on a line.
    pub(super) fn mistake_on(&self, line: Option<usize>, message: String, hint: Option<String>) {
        self.source.add(line, message, hint);
    }

    /// Adds a mistake of another file.
    pub(super) fn add(&self, mistake: Mistake) {
        self.source.mistakes.borrow_mut().push(mistake);
    }

    /// Every table of an array of tables, none when the key is absent.
    pub(super) fn sections(&self, key: &'static str) -> Vec<Section<'s>> {
        let items = match self.value(key) {
            None => return Vec::new(),
            Some(DeValue::Array(items)) => items,
            Some(other) => {
                self.wrong_type(key, other, "an array of tables, written with double brackets");
                return Vec::new();
            }
        };
        let mut sections = Vec::new();
        for item in items {
            let DeValue::Table(table) = item.get_ref() else {
                self.wrong_type(key, item.get_ref(), "an array of tables");
                continue;
            };
            let mut section = self.below(key, format!("[[{key}]]"), table);
            section.line = Some(self.source.line(item.span().start));
            section.span = item.span();
            sections.push(section);
        }
        sections
    }

    /// Accepts a key that another part of the program reads.
    pub(super) fn leave(&self, key: &'static str) {
        if !self.asked.borrow().contains(&key) {
            self.asked.borrow_mut().push(key);
        }
    }

    /// Reports every key that is missing or that nobody asked for; the last call on a section.
    pub(super) fn close(&self) {
        let asked = self.asked.borrow();
        let mut missing = self.missing.take();
        for key in self.table.keys() {
            let word = key.get_ref().as_ref();
            if asked.contains(&word) {
                continue;
            }
            // A misspelt key is one mistake, not also a missing one.
            let known = nearest(word, &asked).filter(|known| !self.holds(known));
            missing.retain(|(key, _)| Some(*key) != known);
            let hint = known.map_or_else(
                || format!("known keys: {}", asked.join(", ")),
                |known| format!("did you mean `{known}`?"),
            );
            self.mistake(word, format!("unknown key {}", self.place(word)), hint);
        }
        for (key, hint) in missing {
            self.mistake(key, format!("{} is missing", self.place(key)), hint);
        }
    }

    fn below(&self, key: &str, title: String, table: &'s DeTable<'s>) -> Section<'s> {
        let title =
            if self.title.is_empty() { title } else { format!("`{key}` of {}", self.title) };
        let line = self.line(key);
        Section::new(self.source, title, line, table)
    }

    fn value(&self, key: &'static str) -> Option<&'s DeValue<'s>> {
        self.leave(key);
        self.table.get(key).map(Spanned::get_ref)
    }

    /// Asks for a key that must be there.
    pub(super) fn require(&self, key: &'static str, expected: &str) {
        self.leave(key);
        if !self.holds(key) {
            let place = if self.title.starts_with('[') {
                format!(" below {}", self.title)
            } else {
                String::new()
            };
            self.missing.borrow_mut().push((key, format!("add `{key} = ...`{place}, {expected}")));
        }
    }

    fn wrong_type(&self, key: &str, value: &DeValue<'_>, expected: &str) {
        let message = format!("{} is {}, expected {expected}", self.place(key), kind(value));
        let hint = match value {
            DeValue::String(text) if text.replace(',', ".").trim().parse::<f64>().is_ok() => {
                format!("write {key} = {} without quotes", text.replace(',', ".").trim())
            }
            _ => format!("`{key}` takes {expected}"),
        };
        self.mistake(key, message, hint);
    }

    fn place(&self, key: &str) -> String {
        if self.title.is_empty() {
            format!("`{key}`")
        } else {
            format!("`{key}` in {}", self.title)
        }
    }
}
