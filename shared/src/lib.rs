//! What crosses a process border: messages, services, the exchange, the folder of a run.

pub mod exchange;
pub mod messages;
pub mod os;
pub mod place;
pub mod raw;
pub mod services;
pub mod stop;
pub mod team;
