// geometry_order.frag: puts the list of a pixel's fragments in order, nearest first, ties by number, and the nearest opaque
// fragment behind them. A node is two texels: r, g, b, opacity (bits); depth (bits), the next node (0: none), number.
layout(r32ui, binding = 0) restrict uniform uimage2D layer_heads;
layout(rgba32i, binding = 1) restrict uniform iimageBuffer layer_nodes;
#ifdef OPAQUE
uniform sampler2D opaque_color, opaque_z;
uniform int picture_width;
#endif
#ifdef SAMPLE_MASK
uniform usampler2D sample_mask; // 1 where a pixel has a ray
#endif

int node_next(int node)
{
    return imageLoad(layer_nodes, 2 * node + 1).y;
}

void node_link(int node, int next)
{
    ivec4 place = imageLoad(layer_nodes, 2 * node + 1);
    place.y = next;
    imageStore(layer_nodes, 2 * node + 1, place);
}

#if defined(LISTS) && defined(SOFTWARE)
layout(std430, binding = 0) restrict buffer Used {
    uint nodes_used, longest; // of all lists; nodes of the longest one
};
#endif

#ifdef LISTS
bool node_first(int a, int b)
{
    ivec4 p = imageLoad(layer_nodes, 2 * a + 1), q = imageLoad(layer_nodes, 2 * b + 1);
    float pz = intBitsToFloat(p.x), qz = intBitsToFloat(q.x);
    return pz < qz || (pz == qz && p.z <= q.z);
}

// Merge sort from the bottom up: pairs of runs become runs of twice the length, until there is one.
int sorted(int list, out int last)
{
    last = 0;
    for (int run = 1, merges = 2; merges > 1; run *= 2) {
        int p = list;
        list = 0;
        last = 0;
        merges = 0;
        while (p != 0) {
            int q = p, n_p = 0, n_q = run;
            merges++;
            for (; n_p < run && q != 0; n_p++)
                q = node_next(q);
            while (n_p > 0 || (n_q > 0 && q != 0)) {
                bool from_p = n_p > 0 && (n_q == 0 || q == 0 || node_first(p, q));
                int taken = from_p ? p : q, next = node_next(taken);
                p = from_p ? next : p;
                n_p -= from_p ? 1 : 0;
                q = from_p ? q : next;
                n_q -= from_p ? 0 : 1;
                if (last != 0)
                    node_link(last, taken);
                else
                    list = taken;
                last = taken;
            }
            p = q;
        }
        if (last != 0)
            node_link(last, 0);
    }
    return list;
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int head = 0, last = 0;
#ifdef LISTS
    head = int(imageLoad(layer_heads, pixel).x);
#ifdef SOFTWARE
    int n = 0;
    for (int p = head; p != 0; p = node_next(p))
        n++;
    atomicMax(longest, uint(n));
#endif
    head = sorted(head, last);
#endif
#ifdef OPAQUE
    float z = texelFetch(opaque_z, pixel, 0).x;
    if (!isinf(z)) {
        int node = 1 + pixel.y * picture_width + pixel.x;
        imageStore(layer_nodes, 2 * node, floatBitsToInt(texelFetch(opaque_color, pixel, 0)));
        imageStore(layer_nodes, 2 * node + 1, ivec4(floatBitsToInt(z), 0, 0, 0));
        if (last != 0)
            node_link(last, node);
        else
            head = node;
    }
#endif
#ifdef SAMPLE_MASK
    head = texelFetch(sample_mask, pixel, 0).x == 1u ? head : 0;
#endif
    imageStore(layer_heads, pixel, uvec4(head));
}
