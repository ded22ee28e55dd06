// kept_begin.frag: rays at the beginning of what is kept of their walks, in place of first hits.
uniform isampler2D kept_first; // 1 + the ray's first record; the one behind its last; 0: none
layout(location = 0) out ivec4 out_walk;

void main()
{
    ivec2 first = texelFetch(kept_first, ivec2(gl_FragCoord.xy), 0).xy;
    out_walk = ivec4(first.x - 1, first.y, 0, 0);
}
