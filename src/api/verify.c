/* verify.c: tc_verify: the reference judges a picture. */
#include "api/driver.h"

#include <string.h>

tc_status tc_verify_image(tc_verify_result *out, tc_image **errors, const tc_image *image, size_t n, uint64_t seed,
                          const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                          const tc_render_options *options, const tc_log *log, tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (errors)
        *errors = NULL;
    tc_rays rays;
    double unit;
    tc_status status = tc_render_resolve(&unit, &rays, mesh, tf, camera, options, err);
    if (status == TC_OK && (image->width != options->width || image->height != options->height))
        status = tc_fail(err, TC_E_ARG, "the picture is %dx%d, the options say %dx%d", image->width, image->height,
                         options->width, options->height);
    for (int i = 0; status == TC_OK && options->look && i < options->look->n_geometry; i++)
        if (options->look->geometry[i].n_line > 0)
            status = tc_fail(err, TC_E_ARG,
                             "the reference draws no lines, and geometry %d of the look has %zu; verify a picture without "
                             "them",
                             i, options->look->geometry[i].n_line);
    tc_reference *reference = NULL;
    if (status == TC_OK && errors)
        status = tc_image_create(errors, image->width, image->height, err);
    if (status == TC_OK)
        status = tc_reference_create(&reference, mesh, 0, err);
    if (status == TC_OK) {
        tc_reference_set_nan_color(reference, options->has_nan_color ? options->nan_color : NULL);
        tc_reference_set_samples(reference, options->samples);
        status = tc_reference_set_look(reference, options->look, err);
    }
    if (status == TC_OK)
        status =
            tc_reference_verify(out, errors ? *errors : NULL, image, n, seed, reference, tf, unit, &rays, 0, log, err);
    out->rays_lost = -1; /* a picture does not tell */
    tc_reference_destroy(&reference);
    if (status != TC_OK && errors)
        tc_image_destroy(errors);
    return status;
}

tc_status tc_verify(tc_verify_result *out, const tc_image *image, size_t n, uint64_t seed, const tc_mesh *mesh,
                    const tc_transfer *tf, const tc_camera *camera, const tc_render_options *options, const tc_log *log,
                    tc_error *err)
{
    return tc_verify_image(out, NULL, image, n, seed, mesh, tf, camera, options, log, err);
}
