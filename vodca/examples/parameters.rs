//! Prints docs/PARAMETERS.md: `cargo run -p vodca --example parameters > docs/PARAMETERS.md`.

fn main() {
    print!("{}", vodca::params::table::markdown());
}
