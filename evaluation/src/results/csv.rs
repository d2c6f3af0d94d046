//! CSV as [`crate::text_table::TextTable`] writes it, found by the names of columns.

use std::collections::BTreeMap;

/// A header and its lines.
pub(super) struct Csv {
    columns: BTreeMap<String, usize>,
    lines: Vec<Vec<String>>,
}

impl Csv {
    /// Reads a text whose lines have as many cells as its header.
    ///
    /// # Errors
    /// What is wrong, with its line.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let mut all = text.lines().map(cells);
        let header = all.next().ok_or("the file is empty")?;
        let columns: BTreeMap<String, usize> = header.into_iter().enumerate().map(|(at, name)| (name, at)).collect();
        let lines: Vec<Vec<String>> = all.collect();
        match lines.iter().position(|line| line.len() != columns.len()) {
            Some(at) => Err(format!("line {} has {} cells, not {}", at + 2, lines[at].len(), columns.len())),
            None => Ok(Self { columns, lines }),
        }
    }

    /// Where column `name` is, if it is there.
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        self.columns.get(name).copied()
    }

    /// Where column `name` is.
    ///
    /// # Errors
    /// There is none of that name.
    pub(super) fn needed(&self, name: &str) -> Result<usize, String> {
        self.column(name).ok_or_else(|| format!("there is no column `{name}`"))
    }

    /// The lines, cell by cell.
    pub(super) fn lines(&self) -> &[Vec<String>] {
        &self.lines
    }
}

/// The number in `cell`, which may be empty.
///
/// # Errors
/// Something else is in it.
pub(super) fn number(cell: &str) -> Result<Option<f64>, String> {
    match cell {
        "" => Ok(None),
        text => text.parse().map(Some).map_err(|_| format!("`{text}` is not a number")),
    }
}

fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        let last = cells.len() - 1;
        match character {
            '"' if quoted && characters.next_if_eq(&'"').is_some() => cells[last].push('"'),
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            other => cells[last].push(other),
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text_table::TextTable;

    #[test]
    fn what_a_table_writes_is_read_back() {
        let mut table = TextTable::new(&["controller", "runs"]);
        table.row(["safe[a=1,b=\"x\"]".into(), String::new()]);
        let csv = Csv::parse(&table.csv()).unwrap();
        assert_eq!(csv.lines(), [["safe[a=1,b=\"x\"]".to_string(), String::new()]]);
        assert_eq!((csv.column("runs"), csv.column("seed")), (Some(1), None));
    }

    #[test]
    fn lines_that_are_cut_off_are_named() {
        assert_eq!(Csv::parse("a,b\n1,2\n3\n").err(), Some("line 3 has 1 cells, not 2".into()));
    }
}
