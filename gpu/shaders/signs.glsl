// signs.glsl: on which side of an edge the ray passes, exactly (design: "Exact signs"; docs/stability.md).

// Below this share of |p| + |q| the float cross is replaced by the double one: its sign would be safe down to 4.8e-7,
// its value as a weight is not.
const float SIGN_NEAR = 1.0e-5;
// What a true zero counts as weight: nothing, but with a sign.
const float SIGN_TINY = 1.0e-30;

// Cross product of two projected vertices in float. `sure` becomes false where that is not enough.
float sign_cross_fast(vec2 p, vec2 q, inout bool sure)
{
    precise float m = p.x * q.y;
    precise float n = p.y * q.x;
    precise float c = m - n;
    sure = sure && abs(c) > SIGN_NEAR * (abs(m) + abs(n));
    return c;
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
