//! One number out of a protobuf message, by the way to it that the descriptor tells.

use crate::message::Found;
use crate::protobuf_wire::{Fields, NotProtobuf, Wire, array, varint};

/// How a field's bytes are to be read, with its number in `descriptor.proto`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Double,
    Float,
    /// 32 and 64 bits alike: the wire carries 64.
    Int,
    Uint,
    Sint,
    Fixed32,
    Fixed64,
    Sfixed32,
    Sfixed64,
    Message,
    /// No number, in words.
    Other(&'static str),
}

/// One step on the way to a number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Step {
    /// Number of the field.
    pub(crate) field: u64,
    pub(crate) kind: Kind,
    /// Which element, where the field is a list.
    pub(crate) element: Option<usize>,
    /// Whether a number that was not set means zero, as in proto3.
    pub(crate) zero_when_unset: bool,
}

/// The number at the end of the steps.
pub(crate) fn number_at(message: &[u8], steps: &[Step]) -> Result<Found, NotProtobuf> {
    let mut message = message;
    for step in steps {
        let mut found = None;
        let mut passed = 0;
        for field in Fields::of(message) {
            let (_, wire) = match field? {
                (number, wire) if number == step.field => (number, wire),
                _ => continue,
            };
            match step.element {
                // The last value of a field that is set more than once counts.
                None => found = Some(wire),
                Some(element) if found.is_none() => {
                    found = pick(wire, step.kind, element, &mut passed)?;
                }
                Some(_) => {}
            }
        }
        match (found, step.kind) {
            (None, _) if step.element.is_some() => return Ok(Found::Absent),
            (None, _) if step.zero_when_unset => return Ok(Found::Number(0.0)),
            (None, _) => return Ok(Found::Null),
            (Some(Wire::Bytes(inner)), Kind::Message) => message = inner,
            (Some(wire), kind) => return number(wire, kind).map(Found::Number),
        }
    }
    Ok(Found::Other("a message"))
}

/// One element of a list, written one by one or packed; `passed` counts those before.
fn pick<'a>(
    wire: Wire<'a>,
    kind: Kind,
    element: usize,
    passed: &mut usize,
) -> Result<Option<Wire<'a>>, NotProtobuf> {
    let Wire::Bytes(mut packed) = wire else {
        *passed += 1;
        return Ok((*passed > element).then_some(wire));
    };
    if kind == Kind::Message {
        *passed += 1;
        return Ok((*passed > element).then_some(wire));
    }
    while !packed.is_empty() {
        let wire = match kind {
            Kind::Double | Kind::Fixed64 | Kind::Sfixed64 => array(&mut packed).map(Wire::Fixed64),
            Kind::Float | Kind::Fixed32 | Kind::Sfixed32 => array(&mut packed).map(Wire::Fixed32),
            _ => varint(&mut packed).map(Wire::Varint),
        };
        let wire = wire.ok_or(NotProtobuf)?;
        *passed += 1;
        if *passed > element {
            return Ok(Some(wire));
        }
    }
    Ok(None)
}

fn number(wire: Wire<'_>, kind: Kind) -> Result<f64, NotProtobuf> {
    Ok(match (kind, wire) {
        (Kind::Double, Wire::Fixed64(bytes)) => f64::from_le_bytes(bytes),
        (Kind::Float, Wire::Fixed32(bytes)) => f64::from(f32::from_le_bytes(bytes)),
        (Kind::Int, Wire::Varint(bits)) => bits.cast_signed() as f64,
        (Kind::Uint, Wire::Varint(bits)) => bits as f64,
        // Zigzag: 0, -1, 1, -2, ... are written as 0, 1, 2, 3, ...
        (Kind::Sint, Wire::Varint(bits)) => {
            ((bits >> 1).cast_signed() ^ -(bits & 1).cast_signed()) as f64
        }
        (Kind::Fixed32, Wire::Fixed32(bytes)) => f64::from(u32::from_le_bytes(bytes)),
        (Kind::Fixed64, Wire::Fixed64(bytes)) => u64::from_le_bytes(bytes) as f64,
        (Kind::Sfixed32, Wire::Fixed32(bytes)) => f64::from(i32::from_le_bytes(bytes)),
        (Kind::Sfixed64, Wire::Fixed64(bytes)) => i64::from_le_bytes(bytes) as f64,
        _ => return Err(NotProtobuf),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_number_is_read() {
        let eight = |bytes: [u8; 8]| Wire::Fixed64(bytes);
        let cases: [(Kind, Wire<'_>, f64); 10] = [
            (Kind::Double, eight((-0.1_f64).to_le_bytes()), -0.1),
            (Kind::Float, Wire::Fixed32(1.5_f32.to_le_bytes()), 1.5),
            (Kind::Int, Wire::Varint(u64::MAX), -1.0),
            (Kind::Uint, Wire::Varint(7), 7.0),
            (Kind::Sint, Wire::Varint(3), -2.0),
            (Kind::Sint, Wire::Varint(4), 2.0),
            (Kind::Fixed32, Wire::Fixed32([0xff; 4]), 4_294_967_295.0),
            (Kind::Fixed64, eight(5_u64.to_le_bytes()), 5.0),
            (Kind::Sfixed32, Wire::Fixed32([0xff; 4]), -1.0),
            (Kind::Sfixed64, eight([0xff; 8]), -1.0),
        ];
        for (kind, wire, expected) in cases {
            let read = number(wire, kind).map(f64::to_bits);
            assert_eq!(read, Ok(expected.to_bits()), "{kind:?}");
        }
        assert_eq!(number(Wire::Varint(1), Kind::Double), Err(NotProtobuf), "the wrong wire type");
    }
}
