//! The viewer: see the library of this package.

fn main() -> std::process::ExitCode {
    puncta_viewer::main()
}
