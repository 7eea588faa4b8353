//! From a field's path to the steps that lead to it, by the descriptor embedded in the file.
//!
//! Field numbers are those of `google/protobuf/descriptor.proto`.

use crate::message::Found;
use crate::protobuf_field::{Kind, Step};
use crate::protobuf_wire::{Fields, Wire};

const SET_FILE: u64 = 1;
const FILE_PACKAGE: u64 = 2;
const FILE_MESSAGE: u64 = 4;
const FILE_SYNTAX: u64 = 12;
const NAME: u64 = 1;
const MESSAGE_FIELD: u64 = 2;
const MESSAGE_NESTED: u64 = 3;
const FIELD_NUMBER: u64 = 3;
const FIELD_LABEL: u64 = 4;
const FIELD_TYPE: u64 = 5;
const FIELD_TYPE_NAME: u64 = 6;
const FIELD_ONEOF: u64 = 9;
const FIELD_PROTO3_OPTIONAL: u64 = 17;
const LABEL_REPEATED: u64 = 3;

/// A message type: its descriptor, and whether its file is proto3.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MessageType<'a> {
    descriptor: &'a [u8],
    proto3: bool,
}

/// The message type of a full name in a `FileDescriptorSet`.
pub(crate) fn message_type<'a>(set: &'a [u8], name: &str) -> Option<MessageType<'a>> {
    messages(set, SET_FILE).find_map(|file| {
        let package = text(file, FILE_PACKAGE).unwrap_or("");
        let name = match package {
            "" => name,
            _ => name.strip_prefix(package)?.strip_prefix('.')?,
        };
        let descriptor = nested(file, FILE_MESSAGE, name)?;
        Some(MessageType { descriptor, proto3: text(file, FILE_SYNTAX) == Some("proto3") })
    })
}

/// The steps along a path of field names and list indices, or what is there instead of a number.
pub(crate) fn steps(set: &[u8], start: MessageType<'_>, path: &str) -> Result<Vec<Step>, Found> {
    let mut steps = Vec::new();
    let mut here = Some(start);
    let mut names = path.split('.');
    while let Some(name) = names.next() {
        let message = here.ok_or(Found::Absent)?;
        let mut fields = messages(message.descriptor, MESSAGE_FIELD);
        let field = fields.find(|field| text(field, NAME) == Some(name)).ok_or(Found::Absent)?;
        let element = if number(field, FIELD_LABEL) == Some(LABEL_REPEATED) {
            let index = names.next().ok_or(Found::Other("a list"))?;
            Some(index.parse().map_err(|_| Found::Absent)?)
        } else {
            None
        };
        let kind = kind(number(field, FIELD_TYPE));
        let presence = number(field, FIELD_ONEOF).or(number(field, FIELD_PROTO3_OPTIONAL));
        steps.push(Step {
            field: number(field, FIELD_NUMBER).ok_or(Found::Absent)?,
            kind,
            element,
            zero_when_unset: message.proto3 && presence.is_none() && kind != Kind::Message,
        });
        here = match kind {
            Kind::Message => {
                let name = text(field, FIELD_TYPE_NAME).unwrap_or("");
                Some(message_type(set, name.trim_start_matches('.')).ok_or(Found::Absent)?)
            }
            Kind::Other(what) if names.clone().next().is_none() => return Err(Found::Other(what)),
            _ => None,
        };
    }
    if here.is_some() { Err(Found::Other("a message")) } else { Ok(steps) }
}

/// The descriptor of a message by its name below a file or a message.
fn nested<'a>(parent: &'a [u8], field: u64, name: &str) -> Option<&'a [u8]> {
    messages(parent, field).find_map(|message| {
        // A message without name, which no compiler writes, would lead here again and again.
        let own = text(message, NAME).filter(|own| !own.is_empty())?;
        match name.strip_prefix(own)? {
            "" => Some(message),
            rest => nested(message, MESSAGE_NESTED, rest.strip_prefix('.')?),
        }
    })
}

fn kind(number: Option<u64>) -> Kind {
    match number {
        Some(1) => Kind::Double,
        Some(2) => Kind::Float,
        Some(3 | 5) => Kind::Int,
        Some(4 | 13) => Kind::Uint,
        Some(6) => Kind::Fixed64,
        Some(7) => Kind::Fixed32,
        Some(8) => Kind::Other("true or false"),
        Some(9) => Kind::Other("text"),
        Some(11) => Kind::Message,
        Some(12) => Kind::Other("bytes"),
        Some(14) => Kind::Other("a choice"),
        Some(15) => Kind::Sfixed32,
        Some(16) => Kind::Sfixed64,
        Some(17 | 18) => Kind::Sint,
        _ => Kind::Other("of a kind that is not read"),
    }
}

/// The values of a field that holds messages; what is no protobuf ends them.
fn messages(message: &[u8], field: u64) -> impl Iterator<Item = &[u8]> {
    Fields::of(message).map_while(Result::ok).filter_map(move |found| match found {
        (number, Wire::Bytes(bytes)) if number == field => Some(bytes),
        _ => None,
    })
}

fn text(message: &[u8], field: u64) -> Option<&str> {
    messages(message, field).last().and_then(|bytes| std::str::from_utf8(bytes).ok())
}

fn number(message: &[u8], field: u64) -> Option<u64> {
    let numbers = Fields::of(message).map_while(Result::ok).filter_map(|found| match found {
        (number, Wire::Varint(value)) if number == field => Some(value),
        _ => None,
    });
    numbers.last()
}
