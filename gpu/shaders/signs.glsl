// signs.glsl: on which side of an edge the ray passes, exactly (design: "Exact signs"; docs/stability.md).
//
// The crosses are weights, too (stepper.glsl), so they must be right to the last digits even where the two products nearly
// cancel: where a ray passes an edge closely, or a face edge-on. A product of two floats is exact in double; doubles are
// cheap on the CPU and dear on GPUs, which have a fused multiply-add instead.

// A cross nearer to zero than this is looked at again; what a true zero counts as weight: nothing, but with a sign.
const float SIGN_TINY = 1.0e-30;
#ifndef SOFTWARE
// Bound of a float cross's rounding, as a share of its two products; holds with and without fused multiply-add.
const float SIGN_ROUNDING = 4.8e-7;
#endif

// Cross product of two projected vertices. `sure` becomes false where its sign may not be that of the exact one.
float sign_cross_fast(vec2 p, vec2 q, inout bool sure)
{
#ifdef SOFTWARE
    precise double e = double(p.x) * double(q.y) - double(p.y) * double(q.x);
    float c = float(e);
    sure = sure && abs(c) > SIGN_TINY;
    return c;
#else
    // Kahan's difference of products: 1.5 units in the last place (Jeannerod, Louvet and Muller 2013).
    precise float n = p.y * q.x;
    precise float rest = fma(-p.y, q.x, n);
    precise float c = fma(p.x, q.y, -n) + rest;
    sure = sure && abs(c) > max(SIGN_ROUNDING * (abs(c) + 2.0 * abs(n)), SIGN_TINY);
    return c;
#endif
}

// Cross product of two projected vertices i and j: never zero; its sign is that of the exact cross of the float
// coordinates, ties broken as if the ray stood at (e, e^2) beside its place, coincident points by their ids.
// Antisymmetric in (p, i) and (q, j); the same as the fast one where that is sure.
float sign_cross(vec2 p, vec2 q, int i, int j)
{
    bool sure = true;
    float c = sign_cross_fast(p, q, sure);
    if (!sure) {
        precise double e = double(p.x) * double(q.y) - double(p.y) * double(q.x); // both products are exact
        bool positive = e > 0.0LF;
        if (e == 0.0LF)
            positive = p.y != q.y ? p.y > q.y : q.x != p.x ? q.x > p.x : i < j;
        c = float(e);
        if (!(abs(c) > SIGN_TINY))
            c = positive ? SIGN_TINY : -SIGN_TINY;
    }
    return c;
}
