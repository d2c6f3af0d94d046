//! What crosses a process border: messages, services, the exchange, the folder of a run.

pub mod chaos;
pub mod exchange;
pub mod messages;
pub mod os;
pub mod raw;
pub mod runtime_dir;
pub mod services;
pub mod stop;
pub mod team;
