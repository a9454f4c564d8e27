//! One file a command.

pub(crate) mod evaluate;
pub(crate) mod export;
pub(crate) mod lint;
pub(crate) mod optimize;
pub(crate) mod reproduce;
pub(crate) mod scenario;
pub(crate) mod validate;
