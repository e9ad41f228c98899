// Random numbers that are even over rounds: Owen-scrambled Sobol points in pairs, each pair shuffled by its own seed.
// B. Burley, "Practical Hash-based Owen Scrambling", JCGT 2020; the hash is N. Vegdahl's (2021). The CPU's points are of the same kind
// (crate sobol_burley), but other ones.

// Owen's scrambling of a number whose bits are reversed: each bit flips by a hash of those below it.
fn sobol_scramble(reversed: u32, seed: u32) -> u32 {
    var x = reversed;
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Mixes a word well. C. Wellons, "hash prospector", 2018.
fn sobol_hash(word: u32) -> u32 {
    var x = word;
    x ^= x >> 16u;
    x *= 0x21f0aaadu;
    x ^= x >> 15u;
    x *= 0x735a2d97u;
    x ^= x >> 15u;
    return x;
}

// Pascal's triangle modulo 2 times the bits of a number: the second dimension's matrix, as Kronecker products of five.
fn sobol_pascal(word: u32) -> u32 {
    var x = word;
    x ^= (x >> 1u) & 0x55555555u;
    x ^= (x >> 2u) & 0x33333333u;
    x ^= (x >> 4u) & 0x0f0f0f0fu;
    x ^= (x >> 8u) & 0x00ff00ffu;
    x ^= (x >> 16u) & 0x0000ffffu;
    return x;
}

// Two numbers in (0, 1) of a round.
fn sobol_pair(round: u32, seed: u32) -> vec2f {
    let mixed = sobol_hash(seed);
    let index = reverseBits(sobol_scramble(reverseBits(round), mixed));
    let x = reverseBits(sobol_scramble(index, sobol_hash(mixed ^ 0x9e3779b9u)));
    let y = reverseBits(sobol_scramble(sobol_pascal(index), sobol_hash(mixed ^ 0x7f4a7c15u)));
    return (vec2f(vec2u(x, y) >> vec2u(8u)) + 0.5) / 16777216.0;
}
