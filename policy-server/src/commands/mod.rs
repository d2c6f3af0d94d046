//! One command per file.

pub(crate) mod bench;
pub(crate) mod check;
pub(crate) mod contract;
pub(crate) mod control;
pub(crate) mod eval;
pub(crate) mod new;
pub(crate) mod publish;
