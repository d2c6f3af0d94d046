//! A look at the skeleton of an ONNX file before it is decoded.
//!
//! An empty node takes two bytes of a file and some two hundred of memory. So the entries of every
//! list are counted first, without decoding or allocating what they hold: after [`check`], decoding
//! takes at most a small multiple of the file's own size.

use super::OnnxError;
use super::proto::{DecodeError, decode_length_delimiter};
use std::collections::BTreeMap;

/// Most nodes, tensors, ports or other entries of a file, each counted over the whole file.
pub(super) const MAX_ENTRIES: usize = 4096;

/// Why bytes are not a protobuf message that ONNX would write.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WireError {
    /// A field that needs more bytes than there are.
    #[error("field {field} of a message reaches beyond its end")]
    Truncated {
        /// Field number.
        field: usize,
    },
    /// A wire type that ONNX does not use: groups, and types that do not exist.
    #[error("field {field} of a message has wire type {wire_type}, which ONNX does not use")]
    WireType {
        /// Field number.
        field: usize,
        /// Wire type, 0..=7.
        wire_type: usize,
    },
    /// Anything else.
    #[error(transparent)]
    Decode(#[from] DecodeError),
}

/// A kind of entry: what an error calls it, and the fields of it whose entries are counted as well (none:
/// it is not looked into, it may be text).
struct Kind {
    what: &'static str,
    inside: &'static [(usize, Kind)],
}

const fn leaf(what: &'static str) -> Kind {
    Kind { what, inside: &[] }
}

const TENSOR: Kind = Kind { what: "tensors", inside: &[(6, leaf("strings")), (13, leaf("external files"))] };
const SUBGRAPH: Kind = leaf("graphs");
const ATTRIBUTE: Kind =
    Kind { what: "attributes", inside: &[(5, TENSOR), (6, SUBGRAPH), (10, TENSOR), (11, SUBGRAPH)] };
const NODE: Kind =
    Kind { what: "nodes", inside: &[(1, leaf("connections")), (2, leaf("connections")), (5, ATTRIBUTE)] };
const SHAPE: Kind = Kind { what: "shapes", inside: &[(1, leaf("dimensions"))] };
const TENSOR_TYPE: Kind = Kind { what: "tensor types", inside: &[(2, SHAPE)] };
const TYPE: Kind = Kind { what: "types", inside: &[(1, TENSOR_TYPE)] };
const INPUT: Kind = Kind { what: "inputs", inside: &[(2, TYPE)] };
const OUTPUT: Kind = Kind { what: "outputs", inside: &[(2, TYPE)] };
const GRAPH: Kind =
    Kind { what: "graphs", inside: &[(1, NODE), (5, TENSOR), (11, INPUT), (12, OUTPUT), (15, leaf("sparse tensors"))] };
const MODEL: Kind = Kind {
    what: "models",
    inside: &[(7, GRAPH), (8, leaf("operator sets")), (14, leaf("metadata entries")), (25, leaf("functions"))],
};

/// Refuses `file` if it is cut, no protobuf message or has more than [`MAX_ENTRIES`] of anything.
pub(super) fn check(file: &[u8]) -> Result<(), OnnxError> {
    count(file, &MODEL, &mut BTreeMap::new())
}

/// Counts the entries in a message of `kind`. It calls itself as deep as the kinds above, whatever
/// the file says.
fn count(mut rest: &[u8], kind: &Kind, counts: &mut BTreeMap<&'static str, usize>) -> Result<(), OnnxError> {
    while !rest.is_empty() {
        let (field, block) = take_field(&mut rest)?;
        let Some((_, inner)) = kind.inside.iter().find(|(number, _)| *number == field) else { continue };
        let entries = counts.entry(inner.what).or_default();
        *entries += 1;
        if *entries > MAX_ENTRIES {
            return Err(OnnxError::TooMany { what: inner.what, most: MAX_ENTRIES });
        }
        if !inner.inside.is_empty() {
            count(block, inner, counts)?;
        }
    }
    Ok(())
}

/// Takes the next field off: its number, and what is in it if it is a string, a list or a message.
fn take_field<'a>(rest: &mut &'a [u8]) -> Result<(usize, &'a [u8]), WireError> {
    let key = decode_length_delimiter(&mut *rest)?;
    let (field, wire_type) = (key >> 3, key & 7);
    let length = match wire_type {
        0 => {
            decode_length_delimiter(&mut *rest)?;
            return Ok((field, &[]));
        }
        1 => 8,
        2 => decode_length_delimiter(&mut *rest)?,
        5 => 4,
        _ => return Err(WireError::WireType { field, wire_type }),
    };
    let (block, after) = rest.split_at_checked(length).ok_or(WireError::Truncated { field })?;
    *rest = after;
    Ok((field, if wire_type == 2 { block } else { &[] }))
}

#[cfg(test)]
mod tests {
    use super::super::proto::{AttributeProto, GraphProto, Message, ModelProto, NodeProto, TensorProto};
    use super::*;
    use proptest::prelude::*;

    fn with_graph(graph: GraphProto) -> Vec<u8> {
        ModelProto { graph: Some(graph), ..Default::default() }.encode_to_vec()
    }

    #[test]
    fn a_file_that_would_fill_the_memory_is_refused_before_it_is_decoded() {
        let too_many = |what| Err(OnnxError::TooMany { what, most: MAX_ENTRIES });
        let nodes = |count| with_graph(GraphProto { node: vec![NodeProto::default(); count], ..Default::default() });
        assert_eq!(check(&nodes(MAX_ENTRIES)), Ok(()));
        assert_eq!(check(&nodes(MAX_ENTRIES + 1)), too_many("nodes"));
        // Few of each in every node, too many of them together.
        let tensors = vec![TensorProto::default(); 100];
        let attribute = AttributeProto { tensors, ..Default::default() };
        let node = NodeProto { attribute: vec![attribute], ..Default::default() };
        assert_eq!(check(&with_graph(GraphProto { node: vec![node; 50], ..Default::default() })), too_many("tensors"));
    }

    #[test]
    fn what_is_no_message_says_where() {
        let wire = |error| Err(OnnxError::Wire(error));
        assert_eq!(check(&[0x3a, 0x7f]), wire(WireError::Truncated { field: 7 }));
        assert_eq!(check(&[0x0b]), wire(WireError::WireType { field: 1, wire_type: 3 }));
        assert!(matches!(check(&[0x80; 11]), Err(OnnxError::Wire(WireError::Decode(_)))));
    }

    proptest! {
        #[test]
        fn any_bytes_are_counted_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            let _ = check(&bytes);
        }
    }
}
