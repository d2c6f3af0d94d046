//! Promise: a bad model never acts, and each kind of bad has its own clear error.
#![allow(clippy::unwrap_used)] // a panic is how a test fails

mod common;

use common::{constant_actor, contract, dense, prober};
use policy::contract::ContractError;
use policy::digest::sha256;
use policy::onnx::proto::{GraphProto, Message, ModelProto, NodeProto, OperatorSetIdProto, TensorProto};
use policy_server::check::{CheckError, Limits, Prober, TryError};
use std::fs;
use std::path::{Path, PathBuf};

const ROBOTS: usize = 2;

/// A folder with a good model, its contract and what `spoil` did to them.
struct Bad {
    _place: tempfile::TempDir,
    model: PathBuf,
}

impl Bad {
    fn new(spoil: impl FnOnce(&mut Vec<u8>, &mut serde_json::Value)) -> Self {
        Self::with(constant_actor(ROBOTS, 0.3).write(), spoil)
    }

    fn with(mut bytes: Vec<u8>, spoil: impl FnOnce(&mut Vec<u8>, &mut serde_json::Value)) -> Self {
        let place = tempfile::tempdir().unwrap();
        let model = place.path().join("model.onnx");
        let mut json = serde_json::to_value(contract(ROBOTS)).unwrap();
        spoil(&mut bytes, &mut json);
        fs::write(&model, bytes).unwrap();
        fs::write(model.with_extension("json"), json.to_string()).unwrap();
        Self { _place: place, model }
    }

    fn refused_by(&self, prober: &Prober) -> CheckError {
        prober.check(&self.model, Some(ROBOTS)).map(|(_, report)| report).unwrap_err()
    }

    fn refused(&self) -> CheckError {
        self.refused_by(&prober())
    }
}

fn with_limits(change: impl FnOnce(&mut Limits)) -> Prober {
    let mut prober = prober();
    change(&mut prober.limits);
    prober
}

/// The good model, changed.
fn changed(change: impl FnOnce(&mut ModelProto)) -> Vec<u8> {
    let mut model = ModelProto::decode(constant_actor(ROBOTS, 0.3).write().as_slice()).unwrap();
    change(&mut model);
    model.encode_to_vec()
}

fn with_graph(change: impl FnOnce(&mut GraphProto)) -> Vec<u8> {
    changed(|model| change(model.graph.as_mut().unwrap()))
}

/// The model with one more node that calls `operator`.
fn with_operator(operator: &str) -> Vec<u8> {
    let node = NodeProto {
        input: vec!["state".into()],
        output: vec!["unused".into()],
        op_type: Some(operator.into()),
        ..Default::default()
    };
    with_graph(|graph| graph.node.push(node))
}

/// The model with one more tensor, four float32 that `change` stores somewhere.
fn with_tensor(name: &str, change: impl FnOnce(&mut TensorProto)) -> Vec<u8> {
    let mut tensor = TensorProto { dims: vec![4], data_type: Some(1), name: Some(name.into()), ..Default::default() };
    change(&mut tensor);
    with_graph(|graph| graph.initializer.push(tensor))
}

fn with_opset(version: i64) -> Vec<u8> {
    let set = OperatorSetIdProto { domain: Some(String::new()), version: Some(version) };
    changed(|model| model.opset_import = vec![set])
}

/// One bad model with the kind of error it must give and words that its message must hold.
struct Kind {
    what: &'static str,
    error: CheckError,
    words: &'static [&'static str],
    is: fn(&CheckError) -> bool,
}

macro_rules! kind {
    ($what:literal, $error:expr, $pattern:pat, $words:expr) => {
        Kind { what: $what, error: $error, words: &$words, is: |error| matches!(error, $pattern) }
    };
}

fn tried(actor: policy::onnx::ActorGraph) -> CheckError {
    Bad::with(actor.write(), |_, _| {}).refused()
}

fn kinds() -> Vec<Kind> {
    let bad = |spoil: fn(&mut Vec<u8>, &mut serde_json::Value)| Bad::new(spoil).refused();
    let mut infinite = constant_actor(ROBOTS, 0.3);
    infinite.hidden[0].weight[3] = f32::INFINITY;
    let mut overflowing = constant_actor(ROBOTS, 0.3);
    overflowing.hidden[0] = dense(2 * ROBOTS, 8, 3e38, 1.0);
    overflowing.mean = dense(8, ROBOTS, 3e38, 0.0);
    let mut misfit = constant_actor(ROBOTS, 0.3);
    misfit.mean.inputs = 9;
    misfit.mean.weight = vec![0.0; 9 * ROBOTS];
    let reference = Bad::new(|_, _| {});
    let case = r#"{"tolerance":1e-5,"cases":[{"observation":[0,0,0,0],"mean":[0.3,0.4],"log_std":[-1,-1],"horizon":[32,35]}]}"#;
    fs::write(reference.model.with_extension("reference.json"), case).unwrap();
    let garbage = Bad::new(|_, _| {});
    fs::write(garbage.model.with_extension("reference.json"), "{}").unwrap();
    let missing = Bad::new(|_, _| {});
    fs::remove_file(&missing.model).unwrap();
    let folder = Bad::new(|_, _| {});
    let crashing = Prober { program: "/bin/false".into(), ..prober() };
    let absent = Prober { program: "/nowhere/policy-server".into(), ..prober() };
    let fine = || Bad::new(|_, _| {});
    vec![
        kind!("missing file", missing.refused(), CheckError::Unreadable { .. }, ["cannot read", "model.onnx"]),
        kind!(
            "a folder instead of a file",
            prober().check(folder.model.parent().unwrap(), None).map(|_| ()).unwrap_err(),
            CheckError::Unreadable { .. },
            ["it is not a file"]
        ),
        kind!("empty file", bad(|bytes, _| bytes.clear()), CheckError::Onnx { .. }, ["holds no graph"]),
        kind!(
            "truncated",
            bad(|bytes, _| bytes.truncate(bytes.len() / 2)),
            CheckError::Onnx { .. },
            ["not a whole ONNX file", "export or copy it again"]
        ),
        kind!(
            "half-written, with a manifest",
            bad(|bytes, json| {
                json["bytes"] = bytes.len().into();
                json["sha256"] = sha256(bytes).into();
                bytes.truncate(bytes.len() / 2);
            }),
            CheckError::Cut { .. },
            ["still being written", "copy it again"]
        ),
        kind!(
            "flipped byte",
            bad(|bytes, json| {
                json["sha256"] = sha256(bytes).into();
                bytes[200] ^= 0x40;
            }),
            CheckError::Sha256 { .. },
            ["bytes have changed", "publish it again"]
        ),
        kind!("text", bad(|bytes, _| *bytes = b"no model at all\n".to_vec()), CheckError::Onnx { .. }, ["not a"]),
        kind!(
            "over the size limit",
            fine().refused_by(&with_limits(|limits| limits.bytes = 900)),
            CheckError::TooLarge { limit: 900, .. },
            ["more than the 900 that are allowed", "--max-bytes"]
        ),
        kind!(
            "external data",
            bad(|bytes, _| *bytes = with_tensor("far", |tensor| tensor.data_location = Some(1))),
            CheckError::ExternalData { .. },
            ["`far`", "external_data=False"]
        ),
        kind!(
            "more nodes than memory should hold",
            bad(|bytes, _| *bytes = with_graph(|graph| graph.node = vec![NodeProto::default(); 4097])),
            CheckError::Onnx { .. },
            ["more than 4096 nodes", "a few dozen"]
        ),
        kind!("future opset", bad(|bytes, _| *bytes = with_opset(26)), CheckError::Opset { .. }, ["operator set 26"]),
        kind!("ancient opset", bad(|bytes, _| *bytes = with_opset(6)), CheckError::Opset { .. }, ["7..=25"]),
        kind!(
            "unsupported operator",
            bad(|bytes, _| *bytes = with_operator("Loop")),
            CheckError::Operator { .. },
            ["operator Loop", "feed-forward"]
        ),
        kind!(
            "random operator",
            bad(|bytes, _| *bytes = with_operator("RandomNormal")),
            CheckError::Operator { .. },
            ["RandomNormal"]
        ),
        kind!(
            "infinite weight",
            tried(infinite),
            CheckError::Weights { index: 3, .. },
            ["hidden0.weight", "element 3"]
        ),
        kind!(
            "tensor that does not fill its shape",
            bad(|bytes, _| *bytes = with_tensor("short", |tensor| tensor.raw_data = Some(vec![0; 8]))),
            CheckError::Onnx { .. },
            ["`short`", "do not fill it"]
        ),
        kind!(
            "contract that is no JSON",
            bad(|_, json| *json = "{".into()),
            CheckError::Contract(ContractError::Malformed { .. }),
            ["model.json", "policy contract"]
        ),
        kind!(
            "wrong input name",
            bad(|_, json| json["input"]["name"] = "obs".into()),
            CheckError::Name { role: "input", .. },
            ["no input `obs`", "`state`"]
        ),
        kind!(
            "wrong output name",
            bad(|_, json| json["outputs"]["mean"]["name"] = "mu".into()),
            CheckError::Name { role: "output", .. },
            ["no output `mu`", "`mean`, `log_std`"]
        ),
        kind!(
            "wrong shape",
            bad(|bytes, json| {
                *bytes = constant_actor(3, 0.3).write();
                json["robots"] = 2.into();
            }),
            CheckError::Shape { .. },
            ["`state` float32 [batch, 6]", "need [batch, 4]"]
        ),
        kind!(
            "wrong robot count",
            bad(|bytes, json| {
                *bytes = constant_actor(3, 0.3).write();
                *json = serde_json::to_value(contract(3)).unwrap();
            }),
            CheckError::Robots { has: 3, wanted: 2, .. },
            ["is for 3 robots, this run has 2"]
        ),
        kind!(
            "answers that are not finite",
            tried(overflowing),
            CheckError::Try { source: TryError::NotFinite { .. }, .. },
            ["canary", "not finite"]
        ),
        kind!("layers that do not fit", tried(misfit), CheckError::Try { .. }, ["the back-end cannot"]),
        kind!(
            "over the time limit",
            fine().refused_by(&with_limits(|limits| limits.inference_us = 0)),
            CheckError::Try { source: TryError::Slow { .. }, .. },
            ["the limit is 0 us", "--max-inference-us"]
        ),
        kind!(
            "a trial that does not end",
            fine().refused_by(&with_limits(|limits| limits.trial_seconds = 0)),
            CheckError::Try { source: TryError::Hung { .. }, .. },
            ["after 0 s"]
        ),
        kind!(
            "a trial that crashes",
            fine().refused_by(&crashing),
            CheckError::Try { source: TryError::Crashed { .. }, .. },
            ["exit code 1"]
        ),
        kind!(
            "a trial without room",
            fine().refused_by(&with_limits(|limits| limits.memory = 24 << 20)),
            CheckError::Try { source: TryError::Crashed { .. }, .. },
            ["brought its trial process down", "24 MiB"]
        ),
        kind!(
            "no trial at all",
            fine().refused_by(&absent),
            CheckError::Try { source: TryError::NoTrial(_), .. },
            ["cannot start the trial process"]
        ),
        kind!(
            "another answer than the reference",
            reference.refused(),
            CheckError::Try { source: TryError::Reference { robot: 1, .. }, .. },
            ["robot 1", "mean is 0.3", "expected 0.4", "not what was trained"]
        ),
        kind!("a broken reference set", garbage.refused(), CheckError::ReferenceFile { .. }, ["missing field"]),
    ]
}

#[test]
fn each_kind_of_bad_model_has_its_own_clear_error() {
    let kinds = kinds();
    assert!(kinds.len() >= 25);
    for kind in &kinds {
        let message = kind.error.to_string();
        assert!((kind.is)(&kind.error), "{}: {:?}", kind.what, kind.error);
        for words in kind.words {
            assert!(message.contains(words), "{}: {words:?} is missing in: {message}", kind.what);
        }
        assert!(!message.contains('\n') && message.len() < 700, "{}: {message}", kind.what);
    }
}

#[test]
fn the_good_model_that_all_of_these_were_made_from_may_act() {
    let good = Bad::new(|_, _| {});
    let (candidate, report) = prober().check(&good.model, Some(ROBOTS)).unwrap();
    assert_eq!(candidate.contract.robots, ROBOTS);
    assert!(report.canary_cases >= 16);
}

#[test]
fn the_command_line_says_the_same_once_and_exits_with_1() {
    let bad = Bad::new(|bytes, _| bytes.truncate(100));
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_policy-server"))
        .args([Path::new("check"), &bad.model])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.trim(), format!("error: {}", bad.refused()));
}
