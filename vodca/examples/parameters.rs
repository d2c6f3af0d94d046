//! Prints PARAMETERS.md: `cargo run -p shared --example parameters > PARAMETERS.md`.

fn main() {
    print!("{}", vodca::params::table::markdown());
}
