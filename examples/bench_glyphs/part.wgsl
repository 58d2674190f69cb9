// The records that are drawn at a time.

struct Part {
    first: u32,
    count: u32,
    // Workgroups of `GROUP` records.
    groups: u32,
    // The number of indices that there is room for.
    room: u32,
}

@group(0) @binding(2) var<uniform> part: Part;
