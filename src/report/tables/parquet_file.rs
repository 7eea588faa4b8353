//! A table as Apache Parquet: one row group, one uncompressed page a column, plain encoding.
//!
//! This is the least of the format that every reader takes, and it needs no dependency; the crate
//! `parquet` without its features costs 14 crates and half a minute of building. Numbers that are
//! not known are null. Field numbers are those of `parquet.thrift`, format version 1.

use super::thrift::{Struct, varint};
use super::{Cell, Table};

const MAGIC: &[u8; 4] = b"PAR1";
/// Physical types, encodings and the rest, by their numbers in `parquet.thrift`.
const BOOLEAN: i32 = 0;
const DOUBLE: i32 = 5;
const BYTE_ARRAY: i32 = 6;
const OPTIONAL: i32 = 1;
const UTF8: i32 = 0;
const PLAIN: i32 = 0;
const RLE: i32 = 3;
const UNCOMPRESSED: i32 = 0;
const DATA_PAGE: i32 = 0;

/// The bytes of the file.
pub(super) fn bytes(table: &Table) -> Vec<u8> {
    let mut file = MAGIC.to_vec();
    let n_columns = table.headers.len();
    let mut elements = vec![Struct::default().text(4, table.name).int(5, n_columns as i32)];
    let mut chunks = Vec::new();
    for (index, header) in table.headers.iter().enumerate() {
        let cells: Vec<&Cell> = table.rows.iter().map(|row| &row[index]).collect();
        let kind = physical_type(&cells);
        let element = Struct::default().int(1, kind).int(3, OPTIONAL).text(4, header);
        elements.push(if kind == BYTE_ARRAY { element.int(6, UTF8) } else { element });
        let offset = file.len();
        file.extend(page(&cells));
        let n_bytes = file.len() - offset;
        let column = Struct::default()
            .int(1, kind)
            .ints(2, &[PLAIN, RLE])
            .texts(3, &[header])
            .int(4, UNCOMPRESSED)
            .long(5, cells.len())
            .long(6, n_bytes)
            .long(7, n_bytes)
            .long(9, offset);
        chunks.push(Struct::default().long(2, offset).inner(3, column));
    }
    let n_rows = table.rows.len();
    let group = Struct::default().inners(1, chunks).long(2, file.len() - 4).long(3, n_rows);
    let metadata = Struct::default()
        .int(1, 1)
        .inners(2, elements)
        .long(3, n_rows)
        .inners(4, vec![group])
        .text(6, concat!("rolltank version ", env!("CARGO_PKG_VERSION")))
        .finish();
    file.extend(&metadata);
    file.extend((metadata.len() as u32).to_le_bytes());
    file.extend(MAGIC);
    file
}

/// A column without rows is one of numbers.
fn physical_type(cells: &[&Cell]) -> i32 {
    match cells.first() {
        Some(Cell::Text(_)) => BYTE_ARRAY,
        Some(Cell::Flag(_)) => BOOLEAN,
        Some(Cell::Number(_)) | None => DOUBLE,
    }
}

/// Header and content of the one page of a column.
fn page(cells: &[&Cell]) -> Vec<u8> {
    let is_known = |cell: &Cell| !matches!(cell, Cell::Number(number) if !number.is_finite());
    let known: Vec<bool> = cells.iter().map(|cell| is_known(cell)).collect();
    let levels = levels(&known);
    let mut content = (levels.len() as u32).to_le_bytes().to_vec();
    content.extend(levels);
    let mut flags = Vec::new();
    for cell in cells.iter().filter(|cell| is_known(cell)) {
        match cell {
            Cell::Number(number) => content.extend(number.to_le_bytes()),
            Cell::Flag(flag) => flags.push(*flag),
            Cell::Text(text) => {
                content.extend((text.len() as u32).to_le_bytes());
                content.extend(text.as_bytes());
            }
        }
    }
    // Flags are packed, the first in the lowest bit.
    content.extend(
        flags
            .chunks(8)
            .map(|eight| eight.iter().rev().fold(0, |byte, flag| byte << 1 | u8::from(*flag))),
    );
    let data = Struct::default().int(1, cells.len() as i32).int(2, PLAIN).int(3, RLE).int(4, RLE);
    let size = content.len() as i32;
    let header = Struct::default().int(1, DATA_PAGE).int(2, size).int(3, size).inner(5, data);
    let mut page = header.finish();
    page.extend(content);
    page
}

/// Which cells are known, in runs of equal ones.
fn levels(known: &[bool]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for run in known.chunk_by(|a, b| a == b) {
        varint(&mut bytes, (run.len() as u64) << 1);
        bytes.push(u8::from(run[0]));
    }
    bytes
}
