//! Just enough of Thrift's compact protocol to write the metadata of a Parquet file.

/// Type of a field on the wire.
#[derive(Clone, Copy)]
enum Wire {
    I32 = 5,
    I64 = 6,
    Binary = 8,
    List = 9,
    Struct = 12,
}

/// A structure as it is written, its fields in rising order.
#[derive(Default)]
pub(super) struct Struct {
    bytes: Vec<u8>,
    last: u8,
}

impl Struct {
    /// A whole number of 32 bits, or a value of an enumeration.
    pub(super) fn int(mut self, field: u8, value: i32) -> Self {
        self.head(field, Wire::I32);
        zigzag(&mut self.bytes, value.into());
        self
    }

    /// A whole number of 64 bits.
    pub(super) fn long(mut self, field: u8, value: usize) -> Self {
        self.head(field, Wire::I64);
        zigzag(&mut self.bytes, value as i64);
        self
    }

    /// A text.
    pub(super) fn text(mut self, field: u8, text: &str) -> Self {
        self.head(field, Wire::Binary);
        binary(&mut self.bytes, text);
        self
    }

    /// A structure within.
    pub(super) fn inner(mut self, field: u8, inner: Self) -> Self {
        self.head(field, Wire::Struct);
        self.bytes.extend(inner.finish());
        self
    }

    /// A list of values of enumerations.
    pub(super) fn ints(mut self, field: u8, values: &[i32]) -> Self {
        self.list(field, Wire::I32, values.len());
        for value in values {
            zigzag(&mut self.bytes, (*value).into());
        }
        self
    }

    /// A list of texts.
    pub(super) fn texts(mut self, field: u8, texts: &[&str]) -> Self {
        self.list(field, Wire::Binary, texts.len());
        for text in texts {
            binary(&mut self.bytes, text);
        }
        self
    }

    /// A list of structures.
    pub(super) fn inners(mut self, field: u8, inners: Vec<Self>) -> Self {
        self.list(field, Wire::Struct, inners.len());
        for inner in inners {
            self.bytes.extend(inner.finish());
        }
        self
    }

    /// The bytes, with the mark of their end.
    pub(super) fn finish(mut self) -> Vec<u8> {
        self.bytes.push(0);
        self.bytes
    }

    /// Type, and the step from the field before.
    fn head(&mut self, field: u8, wire: Wire) {
        self.bytes.push((field - self.last) << 4 | wire as u8);
        self.last = field;
    }

    fn list(&mut self, field: u8, wire: Wire, n: usize) {
        self.head(field, Wire::List);
        if n < 15 {
            self.bytes.push((n as u8) << 4 | wire as u8);
        } else {
            self.bytes.push(0xf0 | wire as u8);
            varint(&mut self.bytes, n as u64);
        }
    }
}

fn binary(bytes: &mut Vec<u8>, text: &str) {
    varint(bytes, text.len() as u64);
    bytes.extend(text.as_bytes());
}

fn zigzag(bytes: &mut Vec<u8>, value: i64) {
    varint(bytes, (value << 1 ^ value >> 63) as u64);
}

/// Seven bits a byte, the lowest first, the highest bit of each telling that more follow.
pub(super) fn varint(bytes: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}
