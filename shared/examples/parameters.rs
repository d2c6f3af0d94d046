//! Prints PARAMETERS.md: `cargo run -p shared --example parameters > PARAMETERS.md`.

fn main() {
    print!("{}", shared::params::table::markdown());
}
