/* layers.h: what the rays of one frame meet of a look's geometry, nearest first: for each pixel a list of colours and
 * depths, which the march and the resolving of the picture read (shaders/effects/geometry.glsl).
 *
 * Opaque triangles and lines are drawn with a depth test, since one fragment of a pixel is all that is seen of them;
 * what lies before it and lets light through goes into lists, of all pixels in one buffer, which a pass then sorts
 * (after Yang, Hensley, Grün and Thibieroz 2010). So all is drawn once, however many layers lie behind one another, and
 * memory goes with the fragments that there are. Software renderers, which cut loops, sort 2500 in a pixel; of more the picture is
 * refused. */
#ifndef TC_GPU_LAYERS_H
#define TC_GPU_LAYERS_H

#include "gpu/geometry.h"
#include "gpu/job.h"

typedef struct tc_layers {
    int width, height;
    GLuint heads, heads_framebuffer; /* R32UI: the first node of a pixel's list, 0: none */
    tc_texture_buffer nodes;         /* RGBA32I, two texels each; node 0 is none */
    GLint n_node;
    GLuint used; /* buffer: how many nodes fragments asked for */
    GLuint color, z, depth,
        opaque_framebuffer; /* RGBA32F, R32F and depth of the nearest opaque fragments; 0: no such geometry */
    size_t bytes;
} tc_layers;

/* What is drawn. */
typedef struct tc_layers_scene {
    const tc_gpu_geometry *buffers;
    const tc_geometry *geometry; /* [buffers->n_part] */
    const tc_shade *shade;       /* of lit triangles */
} tc_layers_scene;

/* Compiles what tc_layers_draw will use. Errors: TC_E_GL. */
tc_status tc_layers_compile(const tc_layers_scene *scene, const tc_job *job, tc_error *err);
/* The lists of the job's frame, within the scissor rectangle; the first list of a pixel outside of it is not written.
 * Empties what rays keep of their way (tc_state_set.at, both sets). Binds framebuffers, image units 0 and 1. Errors:
 * TC_E_MEMORY (more fragments than fit or can be sorted, with the remedy), TC_E_GL. Cost: triangles and lines once, or twice where they
 * have more fragments than any frame before. */
tc_status tc_layers_draw(tc_layers *layers, const tc_layers_scene *scene, const tc_job *job, tc_error *err);
void tc_layers_finish(tc_layers *layers, const tc_gl *gl);

/* Is any of it seen? What has no opacity is not. */
bool tc_layers_seen(const tc_geometry *geometry);

#endif
