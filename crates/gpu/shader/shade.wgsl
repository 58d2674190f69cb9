// From ids to colors: as `shade.rs` of the CPU's renderer.

@group(0) @binding(10) var<storage, read> seen: array<u32>;
@group(0) @binding(13) var<storage, read> bases: array<u32>;
@group(0) @binding(15) var<storage, read> table: array<Entry>;
@group(0) @binding(16) var image: texture_storage_2d<rgba8unorm, write>;
@group(0) @binding(17) var depths: texture_storage_2d<r32float, write>;

@compute @workgroup_size(64)
fn shade_band(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = number(group, groups, lane);
    if index >= shade.rows * shade.size.x {
        return;
    }
    let at = vec2(index % shade.size.x, shade.first_row + index / shade.size.x);
    var sum = vec3(0.0);
    var covered = 0.0;
    var nearest = 0u;
    for (var i = 0u; i < shade.factor * shade.factor; i++) {
        let pixel = at * shade.factor + vec2(i % shade.factor, i / shade.factor);
        let place = pixel.y * camera.width + pixel.x;
        if is_covered(place) {
            sum += light(id_at(place), vec2<i32>(pixel));
            covered += 1.0;
            nearest = max(nearest, visibility[place].y);
        }
    }
    textureStore(image, at, mixed(sum, covered, at.y));
    // What is kept is inverted, so that the nearest is the largest.
    let depth = bitcast<f32>(min(~nearest, INFINITY_BITS));
    textureStore(depths, at, vec4(depth, 0.0, 0.0, 0.0));
}

// What a record shows at a pixel.
fn light(id: u32, pixel: vec2<i32>) -> vec3<f32> {
    let below = seen[id >> 5u] & ((1u << (id & 31u)) - 1u);
    let entry = table[bases[id >> 5u] + countOneBits(below)];
    let m = entry.m + turn(entry.k, vec2<f32>(pixel - whole_of(entry.whole)));
    let ray = (vec2<f32>(pixel) - camera.middle) * camera.step;
    let a = 1.0 + dot(ray, ray);
    // At a silhouette the surface is seen edge-on, whatever rounding says.
    let facing = sqrt(clamp((a - dot(m, m)) / a, 0.0, 1.0));
    let color = vec3(linear(entry.color), linear(entry.color >> 8u), linear(entry.color >> 16u));
    return color * (shade.ambient + (1.0 - shade.ambient) * facing);
}

fn linear(word: u32) -> f32 {
    let byte = word & 255u;
    return shade.decode[byte >> 2u][byte & 3u];
}

// A pixel from the sum of its covered samples.
fn mixed(sum: vec3<f32>, covered: f32, row: u32) -> vec4<f32> {
    let samples = f32(shade.factor * shade.factor);
    let share = covered / samples;
    let down = f32(row) / f32(max(shade.size.y, 2u) - 1u);
    let behind = decode((shade.top + (shade.bottom - shade.top) * down) / 255.0);
    let whole = vec4(encode(sum / samples + behind * (1.0 - share)), 1.0);
    // Without a background, what is covered has its own color, and the rest none.
    let cut = select(vec4(0.0), vec4(encode(sum / covered), share), covered > 0.0);
    return to_bytes(select(cut, whole, shade.has_background != 0u));
}

fn to_bytes(color: vec4<f32>) -> vec4<f32> {
    return floor(clamp(color, vec4(0.0), vec4(1.0)) * 255.0 + 0.5) / 255.0;
}

fn decode(srgb: vec3<f32>) -> vec3<f32> {
    let curve = pow((srgb + 0.055) / 1.055, vec3(2.4));
    return select(curve, srgb / 12.92, srgb <= vec3(0.04045));
}

fn encode(light: vec3<f32>) -> vec3<f32> {
    let curve = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
    return select(curve, light * 12.92, light <= vec3(0.0031308));
}
