/* view_figure.c: title, colour bar and axes over the window's picture. */
#include "window/view_figure.h"
#include "cli/picture/render_figure.h"

#include <stdlib.h>
#include <string.h>

bool tc_view_figure_asked(const tc_session *session)
{
    tc_figure figure;
    return session->run.mesh && tc_render_figure(&figure, &session->run);
}

/* Rows from the bottom. */
static bool turn_over(tc_image *image)
{
    const size_t row = 4 * (size_t)image->width;
    float *swap = malloc(row * sizeof *swap);
    for (int y = 0; swap && y < image->height / 2; y++) {
        float *a = image->rgba + (size_t)y * row, *b = image->rgba + (size_t)(image->height - 1 - y) * row;
        memcpy(swap, a, row * sizeof *swap);
        memcpy(a, b, row * sizeof *swap);
        memcpy(b, swap, row * sizeof *swap);
    }
    free(swap);
    return swap != NULL;
}

tc_image *tc_view_figure_make(const tc_session *session, int width, int height, const float background[3])
{
    const tc_document *document = session->document;
    tc_render_command options = session->options; /* as they are now: of the beginning are */
    tc_render_run run = session->run;             /* function, range and camera of both */
    tc_transfer *tf = NULL;
    tc_image *image = NULL;
    tc_figure figure;
    const float light = 0.2126f * background[0] + 0.7152f * background[1] + 0.0722f * background[2];
    if (!session->run.mesh || tc_document_function(&tf, document, NULL) != TC_OK)
        return NULL;
    options.log = document->log;
    run.options = &options;
    run.tf = tf;
    run.camera = session->camera;
    run.ink = light > 0.4f ? TC_INK_DARK : TC_INK_LIGHT;
    memcpy(run.range, document->range, sizeof run.range);
    if (tc_render_figure(&figure, &run) && tc_image_create(&image, width, height, NULL) == TC_OK &&
        (tc_figure_draw(image, &figure, NULL, NULL) != TC_OK || !turn_over(image)))
        tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    return image;
}
