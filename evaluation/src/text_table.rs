//! Aligned tables for the terminal, and the same rows as CSV.

/// A table of text: a header and rows of as many cells.
#[derive(Clone, Debug, Default)]
pub struct TextTable {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl TextTable {
    /// A table with these column names.
    pub fn new(header: &[&str]) -> Self {
        Self { header: header.iter().map(|name| name.to_string()).collect(), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// For the terminal: columns two spaces apart, words to the left, numbers to the right.
    pub fn aligned(&self) -> String {
        let columns = self.header.len();
        let cell = |row: &'_ [String], column: usize| row.get(column).map_or(String::new(), String::clone);
        let widths: Vec<usize> = (0..columns)
            .map(|column| self.all_rows().map(|row| cell(row, column).chars().count()).max().unwrap_or(0))
            .collect();
        let is_word =
            |column: usize| self.rows.iter().any(|row| cell(row, column).starts_with(|c: char| c.is_alphabetic()));
        let words: Vec<bool> = (0..columns).map(is_word).collect();
        let mut text = String::new();
        for row in self.all_rows() {
            let line: Vec<String> = (0..columns)
                .map(|column| {
                    let (cell, width) = (cell(row, column), widths[column]);
                    if words[column] { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
                })
                .collect();
            text += line.join("  ").trim_end();
            text.push('\n');
        }
        text
    }

    /// As CSV; cells with a comma or a quote are quoted.
    pub fn csv(&self) -> String {
        let quoted = |cell: &String| {
            if cell.contains([',', '"', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.clone() }
        };
        self.all_rows().map(|row| row.iter().map(quoted).collect::<Vec<_>>().join(",") + "\n").collect()
    }

    /// As a table of Markdown.
    pub fn markdown(&self) -> String {
        let line = |row: &[String]| format!("| {} |\n", row.join(" | ").replace('\n', " "));
        let rule = format!("|{}\n", "---|".repeat(self.header.len()));
        line(&self.header) + &rule + &self.rows.iter().map(|row| line(row)).collect::<String>()
    }

    fn all_rows(&self) -> impl Iterator<Item = &Vec<String>> {
        std::iter::once(&self.header).chain(&self.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> TextTable {
        let mut table = TextTable::new(&["horizon", "path", "ok"]);
        table.row(["fixed:9,40".into(), "8.5".into(), "yes".into()]);
        table.row(["fixed:5".into(), "112.25".into(), "no".into()]);
        table
    }

    #[test]
    fn words_stand_left_and_numbers_right() {
        assert_eq!(sample().aligned(), "horizon       path  ok\nfixed:9,40     8.5  yes\nfixed:5     112.25  no\n");
    }

    #[test]
    fn markdown_has_a_rule_below_the_header() {
        let expected =
            "| horizon | path | ok |\n|---|---|---|\n| fixed:9,40 | 8.5 | yes |\n| fixed:5 | 112.25 | no |\n";
        assert_eq!(sample().markdown(), expected);
    }

    #[test]
    fn cells_with_commas_are_quoted() {
        assert_eq!(sample().csv(), "horizon,path,ok\n\"fixed:9,40\",8.5,yes\nfixed:5,112.25,no\n");
    }
}
