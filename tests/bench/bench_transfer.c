/* bench_transfer: a new transfer function to the next frame, against a frame alone. JSON on stdout.
 * Usage: bench_transfer INPUT [FIELD] [SIZE] [PAIRS]
 * In turn, a frame with the function of the frame before and one with another, freshly made: of the same shape, other
 * opacity. The change is what the second call takes longer (wall time; tables, upload), besides the frame. Median of
 * the ratios (frame + change) / frame over the pairs, for the default integrator and for the 2003 paper's table. */
#include "bench_scene.h"

#include <stdio.h>
#include <stdlib.h>

enum { PAIRS_MOST = 1000 };

/* Wall time of making a picture, and the frame's within. */
static double draw(tc_render_stats *stats, tc_renderer *renderer, const bench_scene *scene, const tc_transfer *tf,
                   const tc_camera *camera, const tc_render_options *options)
{
    tc_image *image = NULL;
    tc_error err = {0};
    double start = bench_now_ms();
    bench_check(tc_render(&image, stats, renderer, scene->mesh, tf, camera, options, NULL, &err), "a frame", &err);
    double ms = bench_now_ms() - start;
    tc_image_destroy(&image);
    return ms;
}

static json_t *measure(const bench_scene *scene, tc_integrator integrator, int size, int pairs)
{
    static double frame[PAIRS_MOST], change[PAIRS_MOST], ratio[PAIRS_MOST], table[PAIRS_MOST];
    tc_renderer *renderer = NULL;
    tc_render_stats stats;
    tc_render_options options;
    tc_error err = {0};
    tc_render_defaults(&options);
    options.width = options.height = size;
    options.integrator = integrator;
    const tc_camera camera = bench_camera(scene, 0, 0);
    bench_check(tc_renderer_create(&renderer, NULL, NULL, &err), "a renderer", &err);
    tc_transfer *tf = bench_transfer(scene, 0.3);
    draw(&stats, renderer, scene, tf, &camera, &options);
    for (int i = 0; i < pairs; i++) {
        double same = draw(&stats, renderer, scene, tf, &camera, &options);
        frame[i] = stats.ms_frame;
        double start = bench_now_ms();
        tc_transfer *next = bench_transfer(scene, i % 2 ? 0.3 : 0.27);
        double other = bench_now_ms() - start;
        other += draw(&stats, renderer, scene, next, &camera, &options);
        tc_transfer_destroy(&tf);
        tf = next;
        /* Of the two calls all is alike but the change; their frames differ by chance. */
        change[i] = (other - stats.ms_frame) - (same - frame[i]);
        ratio[i] = (stats.ms_frame + change[i]) / frame[i];
        table[i] = stats.ms_table;
    }
    json_t *out = json_object();
    json_object_set_new(out, "integrator", json_string(stats.integrator));
    bench_set(out, "frame_ms", bench_median(frame, (size_t)pairs));
    bench_set(out, "change_ms", bench_median(change, (size_t)pairs));
    bench_set(out, "table_ms", bench_median(table, (size_t)pairs));
    bench_set(out, "ratio", bench_median(ratio, (size_t)pairs));
    tc_transfer_destroy(&tf);
    tc_renderer_destroy(&renderer);
    return out;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fprintf(stderr, "usage: bench_transfer INPUT [FIELD] [SIZE] [PAIRS]\n");
        return 2;
    }
    int size = argc > 3 ? atoi(argv[3]) : 512, pairs = argc > 4 ? atoi(argv[4]) : 31;
    if (size < 1 || pairs < 1 || pairs > PAIRS_MOST) {
        fprintf(stderr, "bench_transfer: SIZE is above 0, PAIRS 1 to %d\n", PAIRS_MOST);
        return 2;
    }
    bench_scene scene;
    bench_scene_open(&scene, argv[1], argc > 2 && *argv[2] ? argv[2] : NULL, TC_ANY_DATA, TC_REENTRY_AUTO, 0);
    json_t *out = json_object();
    json_object_set_new(out, "pairs", json_integer(pairs));
    json_object_set_new(out, "size", json_integer(size));
    json_object_set_new(out, "default", measure(&scene, TC_INTEGRATOR_AUTO, size, pairs));
    json_object_set_new(out, "table", measure(&scene, TC_INTEGRATOR_TABLE, size, pairs));
    int code = json_dumpf(out, stdout, JSON_INDENT(1)) == 0 && fflush(stdout) == 0 ? 0 : 1;
    json_decref(out);
    bench_scene_close(&scene);
    return code;
}
