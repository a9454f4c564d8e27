//! One binary for all integration tests.

mod reference;
mod tidy;
