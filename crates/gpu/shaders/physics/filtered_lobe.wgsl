// The lobe of a pixel whose normals differ, as the difference of two. Needs ltc. Twin: optics::filtered_lobe, which explains it.

struct FilteredLobe {
    alphas: vec2f,              // of the first
    excess: f32,                // the weight of the second; the first has 1 and this
}

fn filtered_lobe(alpha: f32, variance: vec2f, cos_o: f32) -> FilteredLobe {
    let within = min(variance, vec2f(min(0.06, 0.1 * cos_o * cos_o), 0.06));
    let sharp2 = alpha * alpha;
    let widening = 2.6 + 2.5 / (1.0 + 1.5 * sqrt(within) / alpha);
    let wide2 = min(sharp2 + widening * within, vec2f(1.0));
    let excess = 1.0 - 2.0 * sharp2 / (wide2.x + wide2.y);
    return FilteredLobe(sqrt(wide2), select(excess, 0.0, excess < 0.02));
}

// One of the two lobes, and its weight.
struct FilteredLobePart {
    lobe: LtcLobe,
    weight: f32,
}

fn filtered_lobe_part(sharp: LtcLobe, filtered: FilteredLobe, i: u32) -> FilteredLobePart {
    let first = i == 0u;
    let alphas = filtered.alphas * select(1.41421356, 1.0, first);
    return FilteredLobePart(ltc_widened(sharp, alphas, filtered.excess), select(-filtered.excess, 1.0 + filtered.excess, first));
}
