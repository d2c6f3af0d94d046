//! The file of effective parameters that a run folder keeps.

use super::Params;
use super::table::Refusal;

/// Why a file of effective parameters cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ParamsFileError {
    /// Not TOML, or fields that are missing, unknown or of the wrong type.
    #[error("{file}: {message}")]
    Malformed {
        /// Where the text came from.
        file: String,
        /// Line, caret and accepted names, from the TOML reader.
        message: String,
    },
    /// A value outside its range.
    #[error("{file}: {refusal}")]
    Refused {
        /// Where the text came from.
        file: String,
        /// The value and what is allowed.
        refusal: Refusal,
    },
}

impl Params {
    /// All values as TOML; [`Params::from_toml`] reads the same f64 back.
    pub fn to_toml(&self) -> String {
        let header = "# Effective parameters: profile, overlaid by the scenario, overlaid by --set.\n\n";
        // Plain numbers, strings and booleans in two levels of tables always have a TOML form.
        header.to_string() + &toml::to_string(self).unwrap_or_default()
    }

    /// Reads what [`Params::to_toml`] wrote; every field must be there. `file` is named in errors.
    pub fn from_toml(text: &str, file: &str) -> Result<Self, ParamsFileError> {
        let params: Self = toml::from_str(text)
            .map_err(|error| ParamsFileError::Malformed { file: file.into(), message: error.to_string() })?;
        params.validate().map_err(|refusal| ParamsFileError::Refused { file: file.into(), refusal })?;
        Ok(params)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_file_with_an_unknown_field_shows_the_line_and_the_names() {
        let text = Params::safe().to_toml().replace("turn = ", "trun = ");
        let message = Params::from_toml(&text, "params.toml").unwrap_err().to_string();
        for part in ["params.toml:", "line ", "unknown field `trun`", "`turn`", "^"] {
            assert!(message.contains(part), "{part} is not in:\n{message}");
        }
    }

    proptest! {
        #[test]
        fn toml_reads_back_to_the_same_bits(time in 1e-9f64..10.0, weight in 1e-300f64..1e6, jitter in 0u64..=48) {
            let mut params = Params::safe();
            params.model.sample_time = time;
            params.mpc.state_weight = weight;
            params.horizon.jitter = jitter;
            prop_assert_eq!(Params::from_toml(&params.to_toml(), "p").unwrap(), params);
        }
    }
}
