// What glyphs are made of: the words of their records, and what all of them share.

@group(0) @binding(3) var<storage, read> records: array<u32>;
// The sharpness of the view, the style, and the table.
@group(0) @binding(13) var<storage, read> common_words: array<u32>;

fn word(at: u32, k: u32) -> u32 {
    return records[at * WORDS + k];
}

fn real(at: u32, k: u32) -> f32 {
    return bitcast<f32>(records[at * WORDS + k]);
}

fn id_of(at: u32) -> u32 {
    return word(at, WORDS - 1u);
}

fn style_word(k: u32) -> u32 {
    return common_words[1u + k];
}

fn style_real(k: u32) -> f32 {
    return bitcast<f32>(common_words[1u + k]);
}

fn table_word(i: u32) -> u32 {
    return common_words[min(1u + STYLE + i, arrayLength(&common_words) - 1u)];
}

fn table_real(i: u32) -> f32 {
    return bitcast<f32>(table_word(i));
}
