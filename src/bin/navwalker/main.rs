//! The `navwalker` program.

fn main() {}
