/* stats_sum.c: what several renders did. */
#include "cli/picture/stats_sum.h"

#include <math.h>

/* Negative or NaN: not measured. */
static void add_real(double *sum, double one)
{
    *sum = *sum >= 0 && one >= 0 ? *sum + one : -1;
}

static void add_time(double *sum, double one) /* what is done once is measured once */
{
    if (one >= 0)
        *sum = *sum >= 0 ? *sum + one : one;
}

static void raise_real(double *sum, double one)
{
    *sum = fmax(*sum, one);
}

static void add_count(int64_t *sum, int64_t one)
{
    *sum = *sum >= 0 && one >= 0 ? *sum + one : -1;
}

static void add_int(int *sum, int one)
{
    *sum = *sum >= 0 && one >= 0 ? *sum + one : -1;
}

void tc_stats_sum_add(tc_render_stats *sum, const tc_render_stats *one, bool first)
{
    if (first) {
        *sum = *one;
        sum->n_fragments_per_pass = 0;
        sum->fragments_per_pass = NULL;
        return;
    }
    add_time(&sum->ms_pack, one->ms_pack);
    add_time(&sum->ms_upload, one->ms_upload);
    add_time(&sum->ms_table, one->ms_table);
    add_time(&sum->ms_compile, one->ms_compile);
    add_real(&sum->ms_first_hit, one->ms_first_hit);
    add_real(&sum->ms_march, one->ms_march);
    add_real(&sum->ms_frame, one->ms_frame);
    add_real(&sum->ms_readback, one->ms_readback);
    raise_real(&sum->gpu_bytes_mesh, one->gpu_bytes_mesh);
    raise_real(&sum->gpu_bytes_other, one->gpu_bytes_other);
    raise_real(&sum->gpu_bytes_table, one->gpu_bytes_table);
    raise_real(&sum->gpu_bytes_state, one->gpu_bytes_state);
    add_real(&sum->gpu_bytes_sent, one->gpu_bytes_sent);
    add_int(&sum->passes, one->passes);
    add_int(&sum->z_updates, one->z_updates);
    sum->layers = one->layers > sum->layers ? one->layers : sum->layers;
    add_count(&sum->refined, one->refined);
    add_count(&sum->rays, one->rays);
    add_count(&sum->rays_lost, one->rays_lost);
    add_count(&sum->steps, one->steps);
    sum->steps_max = one->steps_max > sum->steps_max ? one->steps_max : sum->steps_max;
    add_count(&sum->audit_broken, one->audit_broken);
}
