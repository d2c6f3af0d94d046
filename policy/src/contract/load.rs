//! Finds the contract of a model: beside it, inside it, or inferred.

use super::infer::infer;
use super::{Contract, ContractError, METADATA_KEY, SCHEMA};
use crate::onnx::Model;
use std::path::{Path, PathBuf};
use vodca::horizon::MAX_HORIZON;
use vodca::scenario::MAX_ROBOTS;

/// Largest contract that is read, bytes.
const MAX_BYTES: usize = 64 << 10;

/// A contract and where it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The contract.
    pub contract: Contract,
    /// What was assumed or is missing, one sentence each; empty for a complete contract.
    pub notes: Vec<String>,
}

/// Reads a contract from JSON; `place` is named in errors.
pub fn from_json(json: &[u8], place: &str) -> Result<Contract, ContractError> {
    if json.len() > MAX_BYTES {
        return Err(ContractError::TooLarge { place: place.into(), most: MAX_BYTES });
    }
    let contract: Contract = serde_json::from_slice(json)
        .map_err(|error| ContractError::Malformed { place: place.into(), message: error.to_string() })?;
    validate(&contract, place)?;
    Ok(contract)
}

/// The contract of `model`: from `beside` (JSON and its place), from the metadata, or inferred. When
/// there are two they must say the same.
pub fn find(model: &Model, beside: Option<(&[u8], &str)>) -> Result<Found, ContractError> {
    let beside = beside.map(|(json, place)| from_json(json, place)).transpose()?;
    let inside = match model.metadata.get(METADATA_KEY) {
        Some(json) => Some(from_json(json.as_bytes(), METADATA_KEY)?),
        None => None,
    };
    match (beside, inside) {
        (Some(beside), Some(inside)) => {
            agree(&beside, &inside)?;
            Ok(Found { notes: identity_notes(&beside), contract: beside })
        }
        (Some(beside), None) => Ok(Found { notes: identity_notes(&beside), contract: beside }),
        (None, Some(inside)) => Ok(Found { notes: identity_notes(&inside), contract: inside }),
        (None, None) => infer(model),
    }
}

/// Where a contract of the model at `path` may stand, in the order of looking.
pub fn places(path: &Path) -> [PathBuf; 2] {
    [path.with_extension("json"), path.with_file_name("manifest.json")]
}

fn identity_notes(contract: &Contract) -> Vec<String> {
    if contract.sha256.is_some() {
        return Vec::new();
    }
    vec!["no sha256 is stated, so a flipped byte would not be noticed; `policy publish` adds it".into()]
}

fn validate(contract: &Contract, place: &str) -> Result<(), ContractError> {
    if contract.schema != SCHEMA {
        return Err(ContractError::Schema { place: place.into(), schema: contract.schema.clone() });
    }
    let refuse = |field: &'static str, value: String, allowed: String| {
        Err(ContractError::Value { place: place.into(), field, value, allowed })
    };
    if !(1..=MAX_ROBOTS).contains(&contract.robots) {
        return refuse("robots", contract.robots.to_string(), format!("1..={MAX_ROBOTS}"));
    }
    let bounds = contract.horizon;
    if bounds.min < 1 || bounds.max > MAX_HORIZON as u64 || bounds.min > bounds.max {
        let value = format!("{}..={}", bounds.min, bounds.max);
        return refuse("horizon", value, format!("1 <= min <= max <= {MAX_HORIZON}"));
    }
    let usable = |scale: &f64| scale.is_finite() && scale.abs() >= 1e-9;
    if !contract.observation.scale.iter().all(usable) {
        let value = format!("{:?}", contract.observation.scale);
        return refuse("observation.scale", value, "finite numbers other than 0".into());
    }
    if !contract.observation.offset.iter().all(|offset| offset.is_finite()) {
        return refuse("observation.offset", format!("{:?}", contract.observation.offset), "finite numbers".into());
    }
    if let Some(digest) = &contract.sha256
        && (digest.len() != 64 || !digest.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f')))
    {
        return refuse("sha256", digest.clone(), "64 lower-case hexadecimal digits".into());
    }
    Ok(())
}

/// Compares two contracts of one model field by field.
fn agree(beside: &Contract, inside: &Contract) -> Result<(), ContractError> {
    let fields = |contract: &Contract| serde_json::to_value(contract.meaning()).unwrap_or_default();
    let (beside, inside) = (fields(beside), fields(inside));
    let none = serde_json::Map::new();
    let (one, two) = (beside.as_object().unwrap_or(&none), inside.as_object().unwrap_or(&none));
    let mut names: Vec<&String> = one.keys().chain(two.keys()).collect();
    names.sort();
    for field in names {
        // A name or training run may be written beside a model that does not know it.
        if one.get(field) != two.get(field) && one.contains_key(field) && two.contains_key(field) {
            let show = |value: Option<&serde_json::Value>| value.map(ToString::to_string).unwrap_or_default();
            return Err(ContractError::Disagree {
                field: field.clone(),
                beside: show(one.get(field)),
                inside: show(two.get(field)),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contract_survives_its_own_json() {
        let mut contract = Contract::standard(14, true);
        contract.sha256 = Some("0".repeat(64));
        contract.observation.scale = [0.1, 1.0 / 3.0];
        assert_eq!(from_json(contract.to_json().as_bytes(), "x").unwrap(), contract);
    }

    #[test]
    fn each_bad_value_is_named_with_what_is_allowed() {
        let good = Contract::standard(14, true).to_json();
        let message = |from: &str, to: &str| {
            assert!(good.contains(from), "{from}");
            from_json(good.replace(from, to).as_bytes(), "p.json").unwrap_err().to_string()
        };
        assert_eq!(
            message("\"robots\": 14", "\"robots\": 0"),
            format!("contract p.json: robots = 0 is not allowed; allowed: 1..={MAX_ROBOTS}")
        );
        assert!(message("\"max\": 49", "\"max\": 50").contains("horizon = 1..=50 is not allowed"));
        assert!(message("policy/1", "policy/9").contains("schema \"vodca/policy/9\" is not known"));
        assert!(message("\"robots\"", "\"robot\"").contains("unknown field `robot`"));
        assert!(message("\"tanh\"", "\"sinh\"").contains("unknown variant `sinh`"));
        assert!(message("\"tanh\",", "\"tanh\"").contains(" at line "));
    }

    #[test]
    fn two_contracts_must_say_the_same() {
        let mut model = Model::default();
        let inside = Contract::standard(14, true);
        model.metadata.insert(METADATA_KEY.into(), inside.to_json());
        let mut beside = inside.clone();
        beside.sha256 = Some("a".repeat(64));
        beside.name = Some("mine".into());
        let found = find(&model, Some((beside.to_json().as_bytes(), "p.json"))).unwrap();
        assert_eq!((found.contract, found.notes.len()), (beside.clone(), 0));
        beside.robots = 2;
        let error = find(&model, Some((beside.to_json().as_bytes(), "p.json"))).unwrap_err();
        assert!(error.to_string().contains("says robots = 2, the one inside it says 14"), "{error}");
    }
}
