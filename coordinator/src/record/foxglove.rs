//! Foxglove's published messages, as far as we write them. The only file of this crate that imports `prost`.
//!
//! Numbers and names are those of the published schemas (`schemas/*.bin`, which go into the log as well).
//! A number of 0 is left out, as in proto3; `-0.0` is not 0 in that sense, so what may be one is
//! optional here (see [`nonzero`]) and reads back to the same bits.

pub(super) use prost::Message;

/// Descriptors of `foxglove.SceneUpdate` and everything it uses (Foxglove SDK, MIT licence).
pub(super) const SCENE_UPDATE: &[u8] = include_bytes!("schemas/SceneUpdate.bin");
/// Descriptors of `foxglove.PosesInFrame` and everything it uses (Foxglove SDK, MIT licence).
pub(super) const POSES_IN_FRAME: &[u8] = include_bytes!("schemas/PosesInFrame.bin");

/// A number for a field that is left out when it is +0.0.
pub(super) fn nonzero(value: f64) -> Option<f64> {
    (value.to_bits() != 0).then_some(value)
}

/// `foxglove.SceneUpdate`
#[derive(Clone, PartialEq, Message)]
pub(super) struct SceneUpdate {
    #[prost(message, repeated, tag = "2")]
    pub(super) entities: Vec<SceneEntity>,
}

/// `foxglove.SceneEntity`
#[derive(Clone, PartialEq, Message)]
pub(super) struct SceneEntity {
    #[prost(message, optional, tag = "1")]
    pub(super) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(super) frame_id: String,
    #[prost(string, tag = "3")]
    pub(super) id: String,
    #[prost(message, repeated, tag = "10")]
    pub(super) cylinders: Vec<CylinderPrimitive>,
    #[prost(message, repeated, tag = "11")]
    pub(super) lines: Vec<LinePrimitive>,
    #[prost(message, repeated, tag = "12")]
    pub(super) triangles: Vec<TriangleListPrimitive>,
    #[prost(message, repeated, tag = "13")]
    pub(super) texts: Vec<TextPrimitive>,
}

/// `foxglove.TriangleListPrimitive`
#[derive(Clone, PartialEq, Message)]
pub(super) struct TriangleListPrimitive {
    #[prost(message, optional, tag = "1")]
    pub(super) pose: Option<Pose>,
    /// Three for each triangle, m.
    #[prost(message, repeated, tag = "2")]
    pub(super) points: Vec<Vector3>,
    #[prost(message, optional, tag = "3")]
    pub(super) color: Option<Color>,
}

/// `foxglove.CylinderPrimitive`
#[derive(Clone, PartialEq, Message)]
pub(super) struct CylinderPrimitive {
    #[prost(message, optional, tag = "1")]
    pub(super) pose: Option<Pose>,
    #[prost(message, optional, tag = "2")]
    pub(super) size: Option<Vector3>,
    #[prost(double, tag = "3")]
    pub(super) bottom_scale: f64,
    #[prost(double, tag = "4")]
    pub(super) top_scale: f64,
    #[prost(message, optional, tag = "5")]
    pub(super) color: Option<Color>,
}

/// `foxglove.LinePrimitive`
#[derive(Clone, PartialEq, Message)]
pub(super) struct LinePrimitive {
    #[prost(enumeration = "LineType", tag = "1")]
    pub(super) r#type: i32,
    #[prost(message, optional, tag = "2")]
    pub(super) pose: Option<Pose>,
    /// m.
    #[prost(double, tag = "3")]
    pub(super) thickness: f64,
    #[prost(message, repeated, tag = "5")]
    pub(super) points: Vec<Vector3>,
    #[prost(message, optional, tag = "6")]
    pub(super) color: Option<Color>,
}

/// `foxglove.LinePrimitive.Type`
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, prost::Enumeration)]
#[repr(i32)]
pub(super) enum LineType {
    Strip = 0,
    Loop = 1,
}

/// `foxglove.TextPrimitive`
#[derive(Clone, PartialEq, Message)]
pub(super) struct TextPrimitive {
    #[prost(message, optional, tag = "1")]
    pub(super) pose: Option<Pose>,
    /// Whether it faces the camera.
    #[prost(bool, tag = "2")]
    pub(super) billboard: bool,
    /// m.
    #[prost(double, tag = "3")]
    pub(super) font_size: f64,
    #[prost(message, optional, tag = "5")]
    pub(super) color: Option<Color>,
    #[prost(string, tag = "6")]
    pub(super) text: String,
}

/// `foxglove.PosesInFrame`
#[derive(Clone, PartialEq, Message)]
pub(super) struct PosesInFrame {
    #[prost(message, optional, tag = "1")]
    pub(super) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(super) frame_id: String,
    #[prost(message, repeated, tag = "3")]
    pub(super) poses: Vec<Pose>,
}

/// `foxglove.Pose`
#[derive(Clone, PartialEq, Message)]
pub(super) struct Pose {
    #[prost(message, optional, tag = "1")]
    pub(super) position: Option<Vector3>,
    #[prost(message, optional, tag = "2")]
    pub(super) orientation: Option<Quaternion>,
}

/// `foxglove.Vector3` and `foxglove.Point3`, which are written alike, m.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Vector3 {
    #[prost(double, optional, tag = "1")]
    pub(super) x: Option<f64>,
    #[prost(double, optional, tag = "2")]
    pub(super) y: Option<f64>,
    #[prost(double, optional, tag = "3")]
    pub(super) z: Option<f64>,
}

/// `foxglove.Quaternion` of a turn about z: x and y are 0.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Quaternion {
    #[prost(double, optional, tag = "3")]
    pub(super) z: Option<f64>,
    #[prost(double, optional, tag = "4")]
    pub(super) w: Option<f64>,
}

/// `foxglove.Color`, 0..=1.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Color {
    #[prost(double, tag = "1")]
    pub(super) r: f64,
    #[prost(double, tag = "2")]
    pub(super) g: f64,
    #[prost(double, tag = "3")]
    pub(super) b: f64,
    #[prost(double, tag = "4")]
    pub(super) a: f64,
}

/// `google.protobuf.Timestamp`
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Timestamp {
    #[prost(int64, tag = "1")]
    pub(super) seconds: i64,
    #[prost(int32, tag = "2")]
    pub(super) nanos: i32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_is_left_out_and_minus_zero_is_not() {
        let point = |x| Vector3 { x: nonzero(x), ..Vector3::default() };
        assert_eq!(point(1.0).encode_to_vec(), [0x09, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f]);
        assert_eq!(point(0.0).encode_to_vec(), [0u8; 0]);
        let minus = Vector3::decode(point(-0.0).encode_to_vec().as_slice()).unwrap();
        assert_eq!(minus.x.map(f64::to_bits), Some((-0.0f64).to_bits()));
    }
}
