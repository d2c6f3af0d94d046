//! x
/// x
pub fn x() { ort::set_api(ort_tract::api()); }
