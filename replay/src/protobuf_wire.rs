//! Protobuf's wire format: numbered fields, one after the other.
//!
//! Written out here because only two numbers of a message are wanted, and because the descriptors
//! come from files that may be damaged: nothing here can panic, whatever the bytes.
//! Source: Protocol Buffers Documentation, "Encoding",
//! <https://protobuf.dev/programming-guides/encoding/>.

/// Value of a field as the wire carries it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Wire<'a> {
    /// Wire type 0.
    Varint(u64),
    /// Wire type 1.
    Fixed64([u8; 8]),
    /// Wire type 2: text, bytes, a message, or packed numbers.
    Bytes(&'a [u8]),
    /// Wire type 5.
    Fixed32([u8; 4]),
}

/// Bytes that are no protobuf.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NotProtobuf;

/// Reads a message's fields from its bytes.
#[derive(Debug, Clone)]
pub(crate) struct Fields<'a> {
    rest: &'a [u8],
}

impl<'a> Fields<'a> {
    /// The fields of a message.
    pub(crate) fn of(message: &'a [u8]) -> Self {
        Self { rest: message }
    }

    fn field(&mut self) -> Option<(u64, Wire<'a>)> {
        let key = varint(&mut self.rest)?;
        let value = match key & 7 {
            0 => Wire::Varint(varint(&mut self.rest)?),
            1 => Wire::Fixed64(array(&mut self.rest)?),
            2 => {
                let length = usize::try_from(varint(&mut self.rest)?).ok()?;
                let (bytes, rest) = self.rest.split_at_checked(length)?;
                self.rest = rest;
                Wire::Bytes(bytes)
            }
            5 => Wire::Fixed32(array(&mut self.rest)?),
            _ => return None,
        };
        Some((key >> 3, value))
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<(u64, Wire<'a>), NotProtobuf>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let field = self.field();
        if field.is_none() {
            self.rest = &[];
        }
        Some(field.ok_or(NotProtobuf))
    }
}

/// Takes a number of seven bits a byte, the lowest first, from the front.
pub(crate) fn varint(rest: &mut &[u8]) -> Option<u64> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let (byte, behind) = rest.split_first()?;
        *rest = behind;
        number |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(number);
        }
    }
    None
}

/// Takes a fixed number of bytes from the front.
pub(crate) fn array<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (bytes, behind) = rest.split_first_chunk()?;
    *rest = behind;
    Some(*bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_examples_of_the_documentation_are_read() {
        let fields = |bytes| Fields::of(bytes).collect::<Vec<_>>();
        assert_eq!(fields(&[0x08, 0x96, 0x01]), [Ok((1, Wire::Varint(150)))]);
        let testing = [0x12, 0x07, b't', b'e', b's', b't', b'i', b'n', b'g'];
        assert_eq!(fields(&testing), [Ok((2, Wire::Bytes(b"testing")))]);
        assert_eq!(fields(&[0x1d, 1, 2, 3, 4]), [Ok((3, Wire::Fixed32([1, 2, 3, 4])))]);
    }

    #[test]
    fn bytes_that_stop_or_make_no_sense_are_refused() {
        for bytes in [&[0x08_u8][..], &[0x08, 0x96], &[0x12, 5, 0], &[0x0b], &[0xff; 11]] {
            assert_eq!(Fields::of(bytes).last(), Some(Err(NotProtobuf)), "{bytes:?}");
        }
    }
}
