//! Profile, overlaid by a scenario's `[params]`, overlaid by `--set KEY=VALUE`.
//!
//! `cell.separation` follows `model.min_separation` where only that one was given: who asks for more room
//! means the guarantee too.

use super::table::{self, Refusal};
use super::{Params, Profile};
use crate::suggest;
use toml::{Table, Value};

/// Why an overlay cannot be applied. `origin` says which one: a scenario or a `--set`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OverlayError {
    /// `--set` without `=`.
    #[error("--set {0}: expected KEY=VALUE, for example --set vodca.rows=each")]
    NoValue(String),
    /// A section that does not exist.
    #[error("{origin}: there is no parameter section `{section}`; the sections are: {}{hint}", table::sections().join(", "))]
    UnknownSection {
        /// Scenario or `--set`.
        origin: String,
        /// As written.
        section: String,
        /// "; did you mean ...?" or empty.
        hint: String,
    },
    /// A field that does not exist.
    #[error("{origin}: section `{section}` has no parameter `{field}`; it has: {accepted}{hint}")]
    UnknownField {
        /// Scenario or `--set`.
        origin: String,
        /// The section.
        section: String,
        /// As written.
        field: String,
        /// The section's fields.
        accepted: String,
        /// "; did you mean ...?" or empty.
        hint: String,
    },
    /// A value where a section was expected.
    #[error("{origin}: `{section}` is a section; write {section}.FIELD = VALUE with one of: {accepted}")]
    NotASection {
        /// Scenario or `--set`.
        origin: String,
        /// The section.
        section: String,
        /// The section's fields.
        accepted: String,
    },
    /// A value of the wrong type or outside its range.
    #[error("{origin}: {refusal}")]
    Refused {
        /// Scenario or `--set`, or the values together.
        origin: String,
        /// The value and what is allowed.
        refusal: Refusal,
    },
}

impl Params {
    /// The effective parameters of a run: `profile`, then `scenario_params` (a scenario's `[params]`
    /// table, `scenario` its name or file for errors), then each `KEY=VALUE` of `sets` in order. Checked.
    pub fn resolve(
        profile: Profile,
        scenario: &str,
        scenario_params: &Table,
        sets: &[String],
    ) -> Result<Self, OverlayError> {
        let mut overlay = Overlay { tree: table::tree(&Params::of(profile)), given: Vec::new() };
        let origin = format!("scenario {scenario} [params]");
        for (section, fields) in scenario_params {
            overlay.apply_section(&origin, section, fields)?;
        }
        for set in sets {
            let origin = format!("--set {set}");
            let (key, value) = set.split_once('=').ok_or_else(|| OverlayError::NoValue(set.clone()))?;
            let value = parse_value(value.trim());
            match key.trim().split_once('.') {
                Some((section, field)) => overlay.apply_field(&origin, section, field, &value)?,
                None => overlay.apply_section(&origin, key.trim(), &value)?,
            }
        }
        let refused = |refusal| OverlayError::Refused { origin: "the parameters together".into(), refusal };
        // Every key and type was checked against the table, whose words a test compares with the structs.
        let mut params: Params = overlay.tree.try_into().map_err(|error: toml::de::Error| {
            refused(Refusal {
                key: "params",
                value: error.to_string(),
                allowed: "see docs/PARAMETERS.md".into(),
                unit: "-",
            })
        })?;
        let given = |key: &str| overlay.given.contains(&key);
        if given("model.min_separation") && !given("cell.separation") {
            params.cell.separation = params.model.min_separation;
        }
        params.validate().map_err(refused)?;
        Ok(params)
    }
}

/// A TOML value; anything that is none is taken as a word, so that `vodca.rows=each` needs no quotes.
fn parse_value(text: &str) -> Value {
    text.parse().unwrap_or_else(|_| Value::String(text.into()))
}

/// Values under construction.
struct Overlay {
    /// The parameters as two levels of tables.
    tree: Table,
    /// Keys that a scenario or a `--set` gave.
    given: Vec<&'static str>,
}

impl Overlay {
    fn apply_section(&mut self, origin: &str, section: &str, fields: &Value) -> Result<(), OverlayError> {
        let names = table::fields(section);
        if names.is_empty() {
            return Err(unknown_section(origin, section));
        }
        let fields = fields.as_table().ok_or_else(|| OverlayError::NotASection {
            origin: origin.into(),
            section: section.into(),
            accepted: names.join(", "),
        })?;
        fields.iter().try_for_each(|(field, value)| self.apply_field(origin, section, field, value))
    }

    fn apply_field(&mut self, origin: &str, section: &str, field: &str, value: &Value) -> Result<(), OverlayError> {
        let slot = self.tree.get_mut(section).ok_or_else(|| unknown_section(origin, section))?;
        let (Some(entry), Some(slot)) = (table::find(&format!("{section}.{field}")), slot.get_mut(field)) else {
            let names = table::fields(section);
            return Err(OverlayError::UnknownField {
                origin: origin.into(),
                section: section.into(),
                field: field.into(),
                accepted: names.join(", "),
                hint: suggest::hint(field, names),
            });
        };
        *slot = entry.check(value).map_err(|refusal| OverlayError::Refused { origin: origin.into(), refusal })?;
        self.given.push(entry.key);
        Ok(())
    }
}

/// A bare field name is the likeliest mistake: it is answered with its full key.
fn unknown_section(origin: &str, section: &str) -> OverlayError {
    let full = table::ENTRIES.iter().find(|entry| entry.key.ends_with(&format!(".{section}")));
    let hint = full
        .map(|entry| format!("; did you mean `{}`?", entry.key))
        .unwrap_or_else(|| suggest::hint(section, table::sections()));
    OverlayError::UnknownSection { origin: origin.into(), section: section.into(), hint }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::{Reference, RowChoice};

    fn resolve(params: &str, sets: &[&str]) -> Result<Params, String> {
        let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
        Params::resolve(Profile::Paper, "mine", &params.parse().unwrap(), &sets).map_err(|error| error.to_string())
    }

    #[test]
    fn the_later_overlay_wins() {
        let params = resolve("vodca.turn = 0.2\n[aim]\nangle = 0.1", &["vodca.turn=0.3", "vodca.rows = each"]).unwrap();
        assert_eq!((params.vodca.turn, params.aim.angle), (0.3, 0.1));
        assert_eq!(params.vodca.rows, RowChoice::Each);
        assert_eq!(params.mpc.reference, Reference::SetPoint, "what nobody set stays as in the profile");
    }

    #[test]
    fn the_guaranteed_separation_follows_the_wanted_one_unless_it_is_given() {
        let separation = |params: &str, sets: &[&str]| resolve(params, sets).unwrap().cell.separation;
        assert_eq!(separation("", &["vodca.turn=0.3"]), 1.5, "nobody touched either");
        assert_eq!(separation("", &["model.min_separation=2.5"]), 2.5);
        assert_eq!(separation("model.min_separation = 2", &[]), 2.0);
        assert_eq!(separation("", &["model={min_separation=1}"]), 1.0);
        assert_eq!(separation("", &["cell.separation=3", "model.min_separation=2.5"]), 3.0);
        assert_eq!(
            separation("cell.separation = 1.5", &["model.min_separation=2.5"]),
            1.5,
            "warned about, not changed"
        );
    }

    #[test]
    fn whole_numbers_and_quoted_words_are_accepted() {
        let params =
            resolve("", &["model.min_separation=2", "mpc.reference=\"straight\"", "cell.enabled=true"]).unwrap();
        assert_eq!(params.model.min_separation, 2.0);
        assert_eq!(params.mpc.reference, Reference::Straight);
        assert!(params.cell.enabled);
    }

    #[test]
    fn an_unknown_field_is_answered_with_the_fields_of_its_section() {
        let message = resolve("", &["aim.angel=1"]).unwrap_err();
        assert_eq!(
            message,
            "--set aim.angel=1: section `aim` has no parameter `angel`; it has: angle, memory, fade_start, fade_end, look_ahead, most, price; \
             did you mean `angle`?"
        );
        let message = resolve("vodca.rws = 1", &[]).unwrap_err();
        assert!(message.starts_with("scenario mine [params]: section `vodca` has no parameter `rws`"), "{message}");
    }

    #[test]
    fn an_unknown_section_is_answered_with_the_sections_or_the_full_key() {
        let message = resolve("", &["vodka.rows=each"]).unwrap_err();
        assert!(message.contains("the sections are: model, mpc, vodca,"), "{message}");
        assert!(message.ends_with("did you mean `vodca`?"), "{message}");
        assert!(resolve("", &["rows=each"]).unwrap_err().ends_with("did you mean `vodca.rows`?"));
    }

    #[test]
    fn wrong_types_values_and_forms_are_refused_with_what_is_allowed() {
        let cases = [
            ("vodca.rows=all", "= `all` is not allowed; allowed: first, each, nearby"),
            ("vodca.turn=left", "= `left` is not allowed; allowed: a number in -1.5..=1.5 (unit: rad)"),
            ("vodca.turn=nan", "= NaN is not allowed"),
            ("horizon.jitter=2.5", "a whole number in 0..=48"),
            ("cell.enabled=1", "true or false"),
            ("aim.fade_end=1", "a number above aim.fade_start = 1.5"),
            ("vodca.rows", "expected KEY=VALUE"),
            ("vodca=each", "`vodca` is a section"),
            ("model.max_speed=1\nmin_separation=9", "is not allowed"),
        ];
        for (set, part) in cases {
            let message = resolve("", &[set]).unwrap_err();
            assert!(message.contains(part), "{set}: {message}");
        }
    }
}
