//! Kinds of files and their colors.

use super::{glyphs::palette::PALETTE, tree::Folder};
use std::collections::HashMap;

/// What all other kinds have.
const OTHER: [u8; 3] = [165, 170, 153];

/// The colors of the kinds of files that there are most bytes of.
#[derive(Debug)]
pub(crate) struct Kinds {
    colors: HashMap<String, [u8; 3]>,
    /// The kinds in words, the largest first.
    pub(crate) key: Vec<String>,
}

impl Kinds {
    pub(crate) fn of(root: &Folder) -> Self {
        let mut sums: HashMap<&str, (u64, u64)> = HashMap::new();
        for file in root.all_files() {
            let sum = sums.entry(&file.kind).or_default();
            *sum = (sum.0 + file.bytes, sum.1 + 1);
        }
        let mut kinds: Vec<(&str, (u64, u64))> = sums.into_iter().collect();
        kinds.sort_by_key(|&(kind, (bytes, _))| (std::cmp::Reverse(bytes), kind.to_owned()));
        let colors =
            kinds.iter().zip(PALETTE).map(|((kind, _), color)| ((*kind).to_owned(), color));
        let line = |name: &str, (bytes, files): (u64, u64), [r, g, b]: [u8; 3]| {
            format!("#{r:02x}{g:02x}{b:02x} {name}: {files} files, {bytes} bytes")
        };
        let name =
            |kind: &str| if kind.is_empty() { "(no ending)".into() } else { format!(".{kind}") };
        let named = kinds.iter().zip(PALETTE);
        let mut key: Vec<String> =
            named.map(|((kind, sum), color)| line(&name(kind), *sum, color)).collect();
        if let Some(rest) = kinds.get(PALETTE.len()..).filter(|rest| !rest.is_empty()) {
            let sum =
                rest.iter().fold((0, 0), |sum, (_, (bytes, files))| (sum.0 + bytes, sum.1 + files));
            key.push(line("others", sum, OTHER));
        }
        Self { colors: colors.collect(), key }
    }

    pub(crate) fn color(&self, kind: &str) -> [u8; 3] {
        self.colors.get(kind).copied().unwrap_or(OTHER)
    }
}
