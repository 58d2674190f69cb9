// What the CPU has drawn, in a rectangle of pixels: the nearer of these and what is there.

struct Patch {
    first: vec2<u32>,
    size: vec2<u32>,
}

@group(0) @binding(3) var<uniform> rectangle: Patch;
@group(0) @binding(4) var<storage, read> drawn: array<vec2<u32>>;
@group(0) @binding(9) var<storage, read_write> visibility: array<vec2<u32>>;

@compute @workgroup_size(64)
fn merge(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = number(group, groups, lane);
    if index >= rectangle.size.x * rectangle.size.y {
        return;
    }
    let at = rectangle.first + vec2(index % rectangle.size.x, index / rectangle.size.x);
    let place = at.y * camera.width + at.x;
    let fresh = drawn[index];
    let old = visibility[place];
    if fresh.y > old.y || (fresh.y == old.y && fresh.x > old.x) {
        visibility[place] = fresh;
    }
}
