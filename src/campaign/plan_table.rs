//! A plan kept as a table, written anew as the `[[plan]]` that it means, line under line.

use std::fmt::Write;
use std::path::Path;

use csv::ReaderBuilder;

/// The TOML that a CSV file means: each row an inline table on the line of the row, so that what
/// is wrong with it is told with the line of the CSV file.
///
/// # Errors
/// Why the file cannot be read, as the end of a sentence about it.
pub(super) fn read(path: &Path) -> Result<String, String> {
    let told = |error: &dyn std::fmt::Display| format!("cannot be read: {error}");
    let text = std::fs::read_to_string(path).map_err(|error| told(&error))?;
    let header = text.lines().next().unwrap_or_default();
    let delimiter = if header.contains(';') { b';' } else { b',' };
    let bytes = text.trim_start_matches('\u{feff}').as_bytes();
    let mut reader = ReaderBuilder::new()
        .delimiter(delimiter)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let names = reader.headers().map_err(|error| told(&error))?.clone();
    let mut written = "plan = [".to_owned();
    let mut line = 1;
    for record in reader.records() {
        let record = record.map_err(|error| told(&error))?;
        let own_line = record.position().map(|at| {
            // The reader places a row at the blank lines before it.
            let blank = bytes[at.byte() as usize..].iter().take_while(|b| b"\r\n".contains(b));
            at.line() + blank.filter(|byte| **byte == b'\n').count() as u64
        });
        while own_line.is_some_and(|own_line| line < own_line) {
            written.push('\n');
            line += 1;
        }
        let cells = record.iter().enumerate().filter(|(_, cell)| !cell.is_empty());
        let pairs: Vec<String> = cells
            .map(|(index, cell)| {
                let unnamed = format!("cell_{}", index + 1);
                let name = names.get(index).filter(|name| !name.is_empty()).unwrap_or(&unnamed);
                format!("{} = {}", quoted(name), value(cell, delimiter))
            })
            .collect();
        if !pairs.is_empty() {
            // Writing to memory cannot fail.
            write!(written, "{{ {} }},", pairs.join(", ")).ok();
        }
    }
    written.push(']');
    Ok(written)
}

fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string().replace('\n', " ")
}

/// A number where the cell holds one, else a text; a table with semicolons may have a comma in its
/// numbers.
fn value(cell: &str, delimiter: u8) -> String {
    let point = if delimiter == b';' { cell.replace(',', ".") } else { cell.to_owned() };
    match point.parse::<f64>() {
        Ok(number) if number.is_finite() => toml::Value::from(number).to_string(),
        _ => quoted(cell),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_any_usual_style_becomes_inline_tables_on_its_own_lines() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.csv");
        std::fs::write(&path, "condition;froude;repeats\n\n\"a \"\"b\"\"\";0,2;4\nc;;\n").unwrap();
        let lines: Vec<String> = read(&path).unwrap().lines().map(str::to_owned).collect();
        assert_eq!(lines[2], r#"{ "condition" = 'a "b"', "froude" = 0.2, "repeats" = 4.0 },"#);
        assert_eq!(lines[3], r#"{ "condition" = "c" },]"#);
    }
}
