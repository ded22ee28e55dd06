// fetch.glsl: one texel of a buffer texture, or a uniform, by the way that is cheap here.
//
// llvmpipe makes a function call of texelFetch, around which every register is saved, but loads images in line.
#ifdef SOFTWARE
#define FETCH_BUFFER(unit) layout(rgba32f, binding = unit) readonly restrict uniform imageBuffer
#define FETCH_FLOATS(unit) layout(r32f, binding = unit) readonly restrict uniform imageBuffer
#define FETCH_INTS(unit, format) layout(format, binding = unit) readonly restrict uniform iimageBuffer
#define fetch(buffer, i) imageLoad(buffer, i)
#else
#define FETCH_BUFFER(unit) uniform samplerBuffer
#define FETCH_FLOATS(unit) uniform samplerBuffer
#define FETCH_INTS(unit, format) uniform isamplerBuffer
#define fetch(buffer, i) texelFetch(buffer, i)
#endif

// What a loop reads of uniforms is read once, before it, and kept: llvmpipe gathers a uniform lane by lane, at each place
// that reads it. A mere copy would not do, for compilers put the uniform in its place again. Floats are above KEEP_LEAST; ints, not
// negative.
#ifdef SOFTWARE
const float KEEP_LEAST = -3.0e38;
int keep(int x) { return max(x, 0); }
float keep(float x) { return max(x, KEEP_LEAST); }
vec2 keep(vec2 x) { return max(x, KEEP_LEAST); }
vec3 keep(vec3 x) { return max(x, KEEP_LEAST); }
vec4 keep(vec4 x) { return max(x, KEEP_LEAST); }
#else
#define keep(x) (x)
#endif
