// What is hidden by what was drawn: as the tiles tell.

struct Tile {
    deepest: f32,
    shallowest: f32,
}

@group(0) @binding(8) var<storage, read> tiles: array<Tile>;

// Whether all tiles around some pixels are nearer than a depth. Equal is not enough: of two records at one
// depth, the one with the lower id is shown. Columns and rows are given as two halves of a word.
fn is_hidden(columns: u32, rows: u32, nearest: f32) -> bool {
    let first = vec2(low(columns), low(rows)) / TILE;
    let last = vec2(high(columns), high(rows)) / TILE;
    for (var row = first.y; row <= last.y; row++) {
        for (var column = first.x; column <= last.x; column++) {
            if !(tiles[row * camera.across + column].deepest < nearest) {
                return false;
            }
        }
    }
    return true;
}
