// fetch.glsl: one texel of a buffer texture, by the way that is cheap here.
// llvmpipe makes a function call of texelFetch, around which every register is saved, but loads images in line.
#ifdef SOFTWARE
#define FETCH_BUFFER(unit) layout(rgba32f, binding = unit) readonly restrict uniform imageBuffer
#define FETCH_INTS(unit, format) layout(format, binding = unit) readonly restrict uniform iimageBuffer
#define fetch(buffer, i) imageLoad(buffer, i)
#else
#define FETCH_BUFFER(unit) uniform samplerBuffer
#define FETCH_INTS(unit, format) uniform isamplerBuffer
#define fetch(buffer, i) texelFetch(buffer, i)
#endif
#define FETCH_IBUFFER(unit) FETCH_INTS(unit, r32i)
