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

# Without a GPU, the software driver draws; the viewer is tried in a virtual display.
# PUNCTA_NO_GPU=1 leaves out the tests that need either.
if [ "${PUNCTA_NO_GPU:-}" != 1 ] && [ "$(uname)" = Linux ] && command -v apt-get >/dev/null; then
  wanted=()
  ls /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json >/dev/null 2>&1 ||
    wanted+=(mesa-vulkan-drivers)
  ldconfig -p | grep -q libvulkan.so.1 || wanted+=(libvulkan1)
  command -v Xvfb >/dev/null || wanted+=(xvfb)
  for library in libxkbcommon-x11 libXcursor libXi libXrandr libX11-xcb; do
    ldconfig -p | grep -q "$library.so" ||
      wanted+=(libxkbcommon-x11-0 libxcursor1 libxi6 libxrandr2 libx11-xcb1)
  done
  if [ "${#wanted[@]}" -gt 0 ]; then
    as_root apt-get update
    as_root apt-get install -y --no-install-recommends "${wanted[@]}"
  fi
fi

step() {
  printf '\n== %s\n' "$*"
  "$@"
}

step cargo fmt --all --check
step cargo clippy --workspace --all-targets --locked -- -D warnings
RUSTDOCFLAGS="-D warnings" step cargo doc --workspace --no-deps --locked
step cargo test --workspace --locked
