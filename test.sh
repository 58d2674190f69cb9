#!/usr/bin/env bash
# Everything that must hold before a change lands: format, lints, docs, tests.
# On a fresh Debian or Ubuntu it installs what is missing first.
set -euo pipefail
cd "$(dirname "$0")"

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# Rust links through a C compiler.
if ! command -v cc >/dev/null; then
  as_root apt-get update
  as_root apt-get install -y --no-install-recommends build-essential ca-certificates
fi
if ! command -v cargo >/dev/null; then
  as_root apt-get update
  as_root apt-get install -y --no-install-recommends rustup ||
    { echo "no rustup package here: install Rust from https://rustup.rs" >&2; exit 1; }
  rustup toolchain install stable --profile default
fi

step() {
  printf '\n== %s\n' "$*"
  "$@"
}

step cargo fmt --all --check
step cargo clippy --workspace --all-targets --locked -- -D warnings
RUSTDOCFLAGS="-D warnings" step cargo doc --workspace --no-deps --locked
step cargo test --workspace --locked
