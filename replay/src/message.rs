//! A message of a foreign recording, whatever its encoding, as a place to find numbers in.

use crate::flat_json;
use crate::json_field;
use crate::protobuf_field::{self, Step};
use crate::protobuf_schema::{message_type, steps};

/// Encodings of the messages that can be read.
pub(crate) const READABLE: [&str; 2] = ["json", "protobuf"];

/// What stands at the end of a path into a message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Found {
    /// A number; not finite only in encodings that know such numbers.
    Number(f64),
    /// A value left out by its writer: `null`, or a part of the message that was not set.
    Null,
    /// Nothing: the message has no such field.
    Absent,
    /// Something else, in words.
    Other(&'static str),
}

/// How the messages of a channel are decoded.
#[derive(Debug)]
pub(crate) enum Format {
    /// Text that describes itself.
    Json,
    /// Protobuf: the way to each path, or what stands there instead of a number.
    Protobuf(Vec<(String, Result<Vec<Step>, Found>)>),
}

impl Format {
    /// The format of an encoding with its schema, a name and a definition, for the paths asked for.
    ///
    /// # Errors
    /// What the schema lacks, in words.
    pub(crate) fn new(
        encoding: &str,
        schema: Option<&(String, Vec<u8>)>,
        paths: &[&str],
    ) -> Result<Self, String> {
        match (encoding, schema) {
            ("json", _) => Ok(Self::Json),
            ("protobuf", Some((name, set))) => {
                let message = message_type(set, name);
                let message = message.ok_or_else(|| format!("it does not define \"{name}\""))?;
                let way = |path: &&str| ((*path).to_owned(), steps(set, message, path));
                Ok(Self::Protobuf(paths.iter().map(way).collect()))
            }
            ("protobuf", None) => Err("the file does not hold it".to_owned()),
            _ => Err(format!("its messages are encoded in \"{encoding}\"")),
        }
    }

    /// What stands in a message at one of the paths: names and list indices joined by points, such
    /// as `position.0`.
    ///
    /// # Errors
    /// What is wrong with the message, in words.
    pub(crate) fn number_at(&self, message: &[u8], path: &str) -> Result<Found, String> {
        match self {
            Self::Json => match flat_json::number_at(message, path) {
                Some(number) => Ok(Found::Number(number)),
                None => json_field::number_at(message, path)
                    .map_err(|error| format!("not JSON ({error})")),
            },
            Self::Protobuf(ways) => match ways.iter().find(|(way, _)| way == path) {
                Some((_, Ok(steps))) => protobuf_field::number_at(message, steps)
                    .map_err(|_| "not the protobuf its schema describes".to_owned()),
                Some((_, Err(found))) => Ok(*found),
                None => Ok(Found::Absent),
            },
        }
    }
}
