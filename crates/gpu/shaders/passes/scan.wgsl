// Exclusive prefix sums in place, block after block. Guy Blelloch, "Prefix Sums and Their Applications", 1990.
// Needs: layout.

const SCAN_LANES: u32 = 256u;
// Elements of a lane.
const SCAN_EACH: u32 = 8u;

@group(0) @binding(0) var<uniform> scan_settings: ScanSettings;
@group(0) @binding(1) var<storage, read_write> scan_values: array<u32>;
// The sum of each block.
@group(0) @binding(2) var<storage, read_write> scan_totals: array<u32>;

var<workgroup> scan_sums: array<u32, SCAN_LANES>;

@compute @workgroup_size(SCAN_LANES)
fn scan_blocks(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) lane: u32) {
    let first = (workgroup.x * SCAN_LANES + lane) * SCAN_EACH;
    var sum = 0u;
    for (var i = first; i < min(first + SCAN_EACH, scan_settings.count); i += 1u) {
        sum += scan_values[i];
    }
    scan_sums[lane] = sum;
    for (var step = 1u; step < SCAN_LANES; step *= 2u) {
        workgroupBarrier();
        let before = select(0u, scan_sums[max(lane, step) - step], lane >= step);
        workgroupBarrier();
        scan_sums[lane] += before;
    }
    var before = scan_sums[lane] - sum;
    for (var i = first; i < min(first + SCAN_EACH, scan_settings.count); i += 1u) {
        let value = scan_values[i];
        scan_values[i] = before;
        before += value;
    }
    if lane == SCAN_LANES - 1u {
        scan_totals[workgroup.x] = before;
    }
}

// Adds what lies before each block.
@compute @workgroup_size(SCAN_LANES)
fn scan_add(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) lane: u32) {
    let first = (workgroup.x * SCAN_LANES + lane) * SCAN_EACH;
    let before = scan_totals[workgroup.x];
    for (var i = first; i < min(first + SCAN_EACH, scan_settings.count); i += 1u) {
        scan_values[i] += before;
    }
}
