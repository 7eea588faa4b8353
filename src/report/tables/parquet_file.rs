//! A table as Apache Parquet: one row group, and null for what is not known.

use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType};
use parquet::errors::Result;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{Type, TypePtr};

use super::{Cell, Table};

/// The bytes of the file.
pub(super) fn bytes(table: &Table) -> Result<Vec<u8>> {
    let columns: Vec<Vec<&Cell>> = (0..table.headers.len())
        .map(|index| table.rows.iter().map(|row| &row[index]).collect())
        .collect();
    let fields = table.headers.iter().zip(&columns).map(|(name, cells)| field(name, cells));
    let schema = Type::group_type_builder(table.name).with_fields(fields.collect::<Result<_>>()?);
    let made_by = concat!("rolltank version ", env!("CARGO_PKG_VERSION"));
    let properties = WriterProperties::builder().set_created_by(made_by.to_owned()).build();
    let mut file =
        SerializedFileWriter::new(Vec::new(), Arc::new(schema.build()?), Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for cells in &columns {
        if let Some(mut column) = group.next_column()? {
            write(&mut column, cells)?;
            column.close()?;
        }
    }
    group.close()?;
    file.into_inner()
}

/// A column without rows is one of numbers.
fn field(name: &str, cells: &[&Cell]) -> Result<TypePtr> {
    let (physical, logical) = match cells.first() {
        Some(Cell::Text(_)) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        Some(Cell::Flag(_)) => (Physical::BOOLEAN, None),
        Some(Cell::Number(_)) | None => (Physical::DOUBLE, None),
    };
    let field = Type::primitive_type_builder(name, physical)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical);
    Ok(Arc::new(field.build()?))
}

fn write(column: &mut SerializedColumnWriter<'_>, cells: &[&Cell]) -> Result<()> {
    let is_known = |cell: &Cell| !matches!(cell, Cell::Number(number) if !number.is_finite());
    let known: Vec<i16> = cells.iter().map(|cell| i16::from(is_known(cell))).collect();
    let (mut numbers, mut flags, mut texts) = (Vec::new(), Vec::new(), Vec::new());
    for cell in cells.iter().filter(|cell| is_known(cell)) {
        match cell {
            Cell::Number(number) => numbers.push(*number),
            Cell::Flag(flag) => flags.push(*flag),
            Cell::Text(text) => texts.push(ByteArray::from(text.as_str())),
        }
    }
    match cells.first() {
        Some(Cell::Text(_)) => {
            column.typed::<ByteArrayType>().write_batch(&texts, Some(&known), None)
        }
        Some(Cell::Flag(_)) => column.typed::<BoolType>().write_batch(&flags, Some(&known), None),
        _ => column.typed::<DoubleType>().write_batch(&numbers, Some(&known), None),
    }?;
    Ok(())
}
