//! Tables put into documents, between the marks that name them.

use super::{NamedTable, ResultsError};

/// The documents with tables, below the root of the repository.
pub const DOCUMENTS: [&str; 2] = ["README.md", "docs/RESULTS.md"];

const OPEN: &str = "<!-- table: ";
const END: &str = " -->";

/// `text` of `document` with every table between `<!-- table: NAME -->` and `<!-- /table: NAME -->` written anew.
///
/// # Errors
/// A mark without its end, or for a table that is not among `tables`.
pub fn filled(document: &str, text: &str, tables: &[NamedTable]) -> Result<String, ResultsError> {
    let mut result = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(OPEN) {
        let Some((name, inside)) = after.split_once(END) else { break };
        let close = format!("<!-- /table: {name}{END}");
        let open = || ResultsError::OpenMark { document: document.into(), name: name.into() };
        let (_, behind) = inside.split_once(&close).ok_or_else(open)?;
        let (_, table) = tables.iter().find(|(known, _)| known == name).ok_or_else(|| ResultsError::NoTable {
            document: document.into(),
            name: name.into(),
            known: tables.iter().map(|(known, _)| known.as_str()).collect::<Vec<_>>().join(", "),
        })?;
        result += &format!("{before}{OPEN}{name}{END}\n{}{close}", table);
        rest = behind;
    }
    Ok(result + rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tables() -> Vec<NamedTable> {
        vec![("one".into(), "| a |\n|---|\n| 1 |\n".into())]
    }

    #[test]
    fn a_table_replaces_what_stood_between_its_marks() {
        let text = "x\n<!-- table: one -->\nold\n<!-- /table: one -->\ny\n";
        let new = filled("R", text, &tables()).unwrap();
        assert_eq!(new, "x\n<!-- table: one -->\n| a |\n|---|\n| 1 |\n<!-- /table: one -->\ny\n");
        assert_eq!(filled("R", &new, &tables()).unwrap(), new);
    }

    #[test]
    fn a_mark_that_cannot_be_served_is_named() {
        let message = |text: &str| filled("R", text, &tables()).unwrap_err().to_string();
        assert_eq!(
            message("<!-- table: two --><!-- /table: two -->"),
            "R: there is no table `two`; the tables are: one"
        );
        assert!(message("<!-- table: one -->").starts_with("R: the mark of table `one` has no"));
    }
}
