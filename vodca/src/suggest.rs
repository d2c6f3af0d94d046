//! "Did you mean ...?" for everything a user names.

/// The entries of `known` that look most like `given`, best first, at most `most` of them.
pub fn nearest<'a>(given: &str, known: impl IntoIterator<Item = &'a str>, most: usize) -> Vec<&'a str> {
    let given = given.to_lowercase();
    let mut near: Vec<(f64, &str)> = known
        .into_iter()
        .map(|name| (strsim::normalized_damerau_levenshtein(&given, &name.to_lowercase()), name))
        .filter(|&(likeness, _)| likeness >= 0.5)
        .collect();
    // Equal likeness keeps the order of `known`: the sort is stable.
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    near.into_iter().take(most).map(|(_, name)| name).collect()
}

/// `"; did you mean `x`?"`, or nothing when no name is near.
pub fn hint<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(given, known, 1).first().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_comes_first_and_strangers_do_not_come() {
        assert_eq!(nearest("rws", ["tie", "rows", "row_step"], 2), ["rows"]);
        assert_eq!(hint("slack_liner", ["slack_linear", "slack_quadratic"]), "; did you mean `slack_linear`?");
        assert_eq!(hint("zzz", ["rows"]), "");
    }
}
