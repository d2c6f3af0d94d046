//! Our own look at a model file, before any back-end sees it.

use super::ports::check_ports;
use super::reference::ReferenceSet;
use super::{CheckError, Limits, MAX_OPSET};
use policy::contract::{self, Contract, Found};
use policy::digest::sha256;
use policy::folder::{MANIFEST_FILE, MODEL_FILE, REFERENCE_FILE};
use policy::onnx::{Model, Node};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Oldest operator set that exporters still write.
const MIN_OPSET: i64 = 7;

/// A model that passed [`look`].
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Where it came from.
    pub file: PathBuf,
    /// Its bytes, read once: these were hashed and these are loaded.
    pub bytes: Vec<u8>,
    /// Their SHA-256.
    pub sha256: String,
    /// Its contract.
    pub contract: Contract,
    /// What was assumed about it, one sentence each.
    pub notes: Vec<String>,
    /// What the file says of itself.
    pub model: Model,
    /// Answers it must give.
    pub reference: Option<ReferenceSet>,
}

/// What is read from the disk before anything is judged.
struct Files {
    bytes: Vec<u8>,
    contract: Option<(Vec<u8>, String)>,
    reference: Option<(Vec<u8>, String)>,
}

/// Reads the model at `file` with the contract and reference set beside it and looks at them;
/// `robots` is the number of the run, `None` accepts any.
pub fn look(file: &Path, robots: Option<usize>, limits: &Limits) -> Result<Candidate, CheckError> {
    let files = read_files(file, limits)?;
    let found = files.contract.as_ref().map(|(json, place)| (json.as_slice(), place.as_str()));
    let mut candidate = look_at(file, files.bytes, found, robots)?;
    if let Some((json, place)) = &files.reference {
        candidate.reference = Some(ReferenceSet::from_json(json, place, &candidate.contract)?);
    }
    Ok(candidate)
}

/// Looks at a model in memory; `beside` is a contract and its place.
pub fn look_at(
    file: &Path,
    bytes: Vec<u8>,
    beside: Option<(&[u8], &str)>,
    robots: Option<usize>,
) -> Result<Candidate, CheckError> {
    let name = file.display().to_string();
    let sha256 = sha256(&bytes);
    // The manifest's word on size and hash comes first: a half-written file is called half-written
    // and not whatever its bytes happen to look like.
    if let Some((json, place)) = beside {
        let manifest = contract::from_json(json, place)?;
        check_identity(&name, &bytes, &sha256, &manifest)?;
    }
    let onnx = |source| CheckError::Onnx { file: name.clone(), source };
    let model = Model::read(&bytes).map_err(onnx)?;
    check_graph(&name, &model)?;
    let Found { contract, notes } = contract::find(&model, beside)?;
    check_identity(&name, &bytes, &sha256, &contract)?;
    if let Some(wanted) = robots.filter(|&wanted| wanted != contract.robots) {
        return Err(CheckError::Robots { file: name, has: contract.robots, wanted });
    }
    check_ports(&name, &model, &contract)?;
    Ok(Candidate { file: file.to_path_buf(), bytes, sha256, contract, notes, model, reference: None })
}

fn read_files(file: &Path, limits: &Limits) -> Result<Files, CheckError> {
    let bytes = read(file, limits.bytes)?;
    // `manifest.json` belongs to a policies folder; beside a bare file only NAME.json is meant.
    let in_folder = file.file_name().is_some_and(|name| name == MODEL_FILE);
    let manifest = file.with_file_name(MANIFEST_FILE);
    let place = if in_folder && manifest.exists() { manifest } else { file.with_extension("json") };
    let optional = |place: PathBuf| -> Result<Option<(Vec<u8>, String)>, CheckError> {
        let there = place.exists();
        there.then(|| Ok((read(&place, limits.bytes)?, place.display().to_string()))).transpose()
    };
    let reference = file.with_file_name(REFERENCE_FILE);
    let reference = if in_folder { optional(reference)? } else { optional(file.with_extension("reference.json"))? };
    Ok(Files { bytes, contract: optional(place)?, reference })
}

/// Reads a regular file of at most `limit` bytes, without trusting what the system says of its size.
fn read(file: &Path, limit: u64) -> Result<Vec<u8>, CheckError> {
    let name = || file.display().to_string();
    let unreadable = |reason: String| CheckError::Unreadable { file: name(), reason };
    let meta = std::fs::metadata(file).map_err(|error| unreadable(error.to_string()))?;
    if !meta.is_file() {
        return Err(unreadable("it is not a file".into()));
    }
    let mut bytes = Vec::new();
    let whole = File::open(file).and_then(|open| open.take(limit + 1).read_to_end(&mut bytes));
    whole.map_err(|error| unreadable(error.to_string()))?;
    let size = meta.len().max(bytes.len() as u64);
    if size > limit {
        return Err(CheckError::TooLarge { file: name(), bytes: size, limit });
    }
    Ok(bytes)
}

fn check_identity(file: &str, bytes: &[u8], digest: &str, contract: &Contract) -> Result<(), CheckError> {
    let has = bytes.len() as u64;
    if let Some(says) = contract.bytes.filter(|&says| says != has) {
        return Err(CheckError::Cut { file: file.into(), has, says });
    }
    match &contract.sha256 {
        Some(says) if says != digest => {
            Err(CheckError::Sha256 { file: file.into(), has: digest.into(), says: says.clone() })
        }
        _ => Ok(()),
    }
}

fn check_graph(name: &str, model: &Model) -> Result<(), CheckError> {
    let file = || name.to_string();
    if let Some(tensor) = model.tensors.iter().find(|tensor| tensor.external) {
        return Err(CheckError::ExternalData { file: file(), tensor: tensor.name.clone() });
    }
    match model.opset() {
        Some(version) if (MIN_OPSET..=MAX_OPSET).contains(&version) => {}
        other => {
            let has = other.map_or("none".into(), |version| version.to_string());
            return Err(CheckError::Opset { file: file(), has });
        }
    }
    if model.functions > 0 {
        return Err(CheckError::Operator { file: file(), operator: "defined in the file itself".into() });
    }
    if let Some(node) = model.nodes.iter().find(|node| !is_allowed(node)) {
        let dot = if node.domain.is_empty() { "" } else { "." };
        return Err(CheckError::Operator { file: file(), operator: format!("{}{dot}{}", node.domain, node.operator) });
    }
    let bad = model.tensors.iter().find_map(|tensor| Some((tensor, tensor.first_not_finite?)));
    match bad {
        Some((tensor, index)) => {
            let tensor = if tensor.name.is_empty() { "constant".into() } else { tensor.name.clone() };
            Err(CheckError::Weights { file: file(), tensor, index })
        }
        None => Ok(()),
    }
}

/// Deterministic operators without loops, state or random numbers: what multilayer actors are made of.
const OPERATORS: [&str; 58] = [
    "Abs",
    "Add",
    "BatchNormalization",
    "Cast",
    "CastLike",
    "Ceil",
    "Celu",
    "Clip",
    "Concat",
    "Constant",
    "ConstantOfShape",
    "Div",
    "Dropout",
    "Elu",
    "Erf",
    "Exp",
    "Expand",
    "Flatten",
    "Floor",
    "Gather",
    "Gelu",
    "Gemm",
    "HardSigmoid",
    "HardSwish",
    "Identity",
    "LayerNormalization",
    "LeakyRelu",
    "Log",
    "MatMul",
    "Max",
    "Min",
    "Mish",
    "Mul",
    "Neg",
    "PRelu",
    "Pow",
    "Reciprocal",
    "ReduceMax",
    "ReduceMean",
    "ReduceSum",
    "Relu",
    "Reshape",
    "Selu",
    "Shape",
    "Sigmoid",
    "Sin",
    "Cos",
    "Slice",
    "Softmax",
    "Softplus",
    "Split",
    "Sqrt",
    "Squeeze",
    "Sub",
    "Tanh",
    "Transpose",
    "Unsqueeze",
    "Where",
];

fn is_allowed(node: &Node) -> bool {
    let onnx = node.domain.is_empty() || node.domain == "ai.onnx";
    onnx && !node.subgraph && OPERATORS.contains(&node.operator.as_str())
}
