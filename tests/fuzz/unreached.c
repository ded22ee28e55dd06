/* unreached.c: what the program's parts call beyond the library's parts that are fuzzed: defaults, and functions that a
 * command line or a scene that is only read does not reach. */
#include "cli/commands.h"
#include "cli/picture/render_options.h"

int tc_render_run_command(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    (void)talk, (void)command, (void)argc, (void)argv;
    return TC_EXIT_DONE;
}

void tc_render_defaults(tc_render_options *options)
{
    *options = (tc_render_options){.width = 512, .height = 512, .opacity_stop = 0.999};
}

void tc_shade_defaults(tc_shade *shade)
{
    *shade = (tc_shade){.ambient = 0.2, .diffuse = 0.8, .specular = 0.2, .power = 20, .magnitude = 1};
}

const tc_synth_info *tc_synth_list(size_t *n)
{
    static const tc_synth_info list[] = {{"kuhn", "cubes of six", "x"}, {"ball", "a ball", "r"}};
    *n = 2;
    return list;
}

tc_status tc_synth_create(tc_mesh **out, const char *name, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)name, (void)n_cells, (void)seed, (void)err;
    *out = NULL;
    return TC_E_ARG;
}

tc_status tc_mesh_write_vtu(const tc_mesh *mesh, const char *path, tc_error *err)
{
    (void)mesh, (void)path, (void)err;
    return TC_E_ARG;
}

tc_status tc_render(tc_image **out, tc_render_stats *stats, tc_renderer *renderer, const tc_mesh *mesh,
                    const tc_transfer *tf, const tc_camera *camera, const tc_render_options *options, const tc_log *log,
                    tc_error *err)
{
    (void)stats, (void)renderer, (void)mesh, (void)tf, (void)camera, (void)options, (void)log, (void)err;
    *out = NULL;
    return TC_E_ARG;
}
