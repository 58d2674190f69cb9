//! A hash of numbers.

/// Mixes the bits of a number: different numbers have different hashes that look like chance.
///
/// Source: the output function of `SplitMix64`, Steele, Lea, Flood: Fast Splittable Pseudorandom
/// Number Generators, 2014.
pub(crate) const fn mix(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
