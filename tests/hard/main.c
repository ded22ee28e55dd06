/* main.c: hard: every mesh, view and function of the catalogue, judged by the invariants (docs/stability.md).
 *
 *   hard --context osmesa|egl|reference   where the pictures are made
 *        [--driver pingpong|compute]      by which driver with GL; compute is compared with pingpong
 *        [--long]                         every view and function with every mesh, larger pictures
 *        [--filter TEXT]                  only cases whose name ("mesh; view; function; relation") holds TEXT
 *        [--list]                         print the cases' names and end
 *        [--size N] [--judged N] [--verified N]   pixels a side; of each case random rays by brute force and
 *                                         pixels by the reference
 *        [--blind N]                      the judge overlooks cell N: the run must fail
 *        [--json FILE] [--table FILE.md] [--write DIR] [--export DIR]
 *
 * Ends with 0 when every bound was kept, 1 when one was not (each failed case with a command that repeats it), 2 when
 * the command line is wrong, 77 when the context is missing. */
#include "api/driver.h"
#include "catalogue.h"
#include "export.h"
#include "table.h"
#include "tests/common/backend.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct settings {
    const char *context, *driver, *filter, *json, *table, *export;
    char name[64]; /* of context and driver, which becomes the context */
    bool long_run, list;
    bool small; /* smaller pictures than usual were asked for: fewer rays */
    int size;
    size_t blind;
    hard_bench bench;
} settings;

typedef struct session {
    const settings *s;
    const char *program;
    hard_table *table;
    hard_mesh relative; /* the variant made last, of the mesh at hand: the next case is likely to want it, too */
    tc_error err;
} session;

static bool parse(settings *s, int argc, char **argv)
{
    *s = (settings){.blind = SIZE_MAX};
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i], *value = i + 1 < argc ? argv[i + 1] : NULL;
        const struct {
            const char *name, **text;
        } texts[] = {{"--context", &s->context}, {"--driver", &s->driver}, {"--filter", &s->filter},
                     {"--json", &s->json},       {"--table", &s->table},   {"--write", &s->bench.write},
                     {"--export", &s->export}};
        const struct {
            const char *name;
            size_t *number;
        } numbers[] = {{"--judged", &s->bench.judged}, {"--verified", &s->bench.verified}, {"--blind", &s->blind}};
        bool known = true;
        if (strcmp(name, "--long") == 0) {
            s->long_run = true;
            continue;
        }
        if (strcmp(name, "--list") == 0) {
            s->list = true;
            continue;
        }
        if (!value)
            return false;
        if (strcmp(name, "--size") == 0) {
            s->size = atoi(value);
            known = s->size > 0;
        } else {
            known = false;
            for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
                if (strcmp(name, texts[k].name) == 0)
                    *texts[k].text = value, known = true;
            for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
                if (strcmp(name, numbers[k].name) == 0)
                    *numbers[k].number = strtoull(value, NULL, 10), known = true;
        }
        if (!known)
            return false;
        i++;
    }
    const int usual = s->long_run ? 192 : 96;
    if (!s->size)
        s->size = usual;
    s->small = s->size < usual;
    if (!s->bench.judged)
        s->bench.judged = s->long_run ? 256 : 64;
    if (!s->bench.verified)
        s->bench.verified = s->long_run ? 1024 : 256;
    if (s->driver && s->context && strcmp(s->driver, "pingpong") != 0) { /* as tests/common/backend.h names it */
        snprintf(s->name, sizeof s->name, "%s-%s", s->context, s->driver);
        s->context = s->name;
    }
    return s->context || s->list;
}

static void report(session *run, const hard_result *r, const char *name)
{
    if (r->failure[0])
        fprintf(stderr, "FAILED %s: %s\n  again: %s --context %s%s --filter '%s'\n", name, r->failure, run->program,
                run->s->context, run->s->long_run ? " --long" : "", name);
}

/* One case of a mesh that was not refused. */
static tc_status judge(session *run, const hard_mesh *mesh, const hard_case *c, const char *name)
{
    const settings *s = run->s;
    hard_view view;
    hard_function function;
    hard_mesh *relative = &run->relative;
    hard_result r = {.rays = 0};
    bool variant = c->relation > 0 && c->relation < HARD_KINDS;
    if (!hard_view_make(&view, c->view, mesh, s->size) || !hard_relation_fits(c->relation, mesh) ||
        (c->relation == HARD_OTHER_CONTEXT && !s->bench.other))
        return TC_OK;
    tc_status status = hard_function_make(&function, c->function, mesh, &run->err);
    if (status != TC_OK)
        return status;
    if (!function.tf) {
        hard_table_refuse(run->table);
        return TC_OK;
    }
    if (variant && (int)relative->kind != c->relation) {
        hard_mesh_close(relative);
        status = hard_mesh_vary(relative, mesh, (hard_kind)c->relation, &run->err);
    }
    if (status == TC_OK && variant && !relative->mesh && c->relation == HARD_OTHER_GAPS) {
        /* there is but one way */
    } else if (status == TC_OK && variant && !relative->mesh) {
        hard_fail(&r, "the variant is refused: %s", relative->refused.text);
    } else if (status == TC_OK && c->relation) {
        hard_judge_relation(&r, &s->bench, c->relation, mesh, variant ? relative : NULL, &view, &function);
    } else if (status == TC_OK) {
        hard_judge_case(NULL, &r, &s->bench, s->bench.renderer, mesh, &view, &function, c->integrator);
    }
    if (status == TC_OK && (r.mesh[0] || r.failure[0])) {
        report(run, &r, name);
        status = hard_table_add(run->table, &r, &run->err);
    }
    hard_function_close(&function);
    return status;
}

static bool wanted(const settings *s, const char *name)
{
    return !s->filter || strstr(name, s->filter);
}

/* All cases of mesh number index. */
static tc_status judge_mesh(session *run, size_t index)
{
    const settings *s = run->s;
    hard_case c[HARD_CASES_MOST];
    const char *name = hard_catalogue_mesh(index);
    char what[256];
    size_t n = hard_catalogue_cases(c, index, s->long_run, s->bench.gpu || s->list), left = 0;
    for (size_t i = 0; i < n; i++) {
        hard_case_name(what, sizeof what, index, &c[i]);
        left += wanted(s, what);
        if (s->list && wanted(s, what))
            printf("%s\n", what);
    }
    if (left == 0 || s->list)
        return TC_OK;
    hard_mesh mesh;
    tc_status status = hard_mesh_open(&mesh, name, hard_catalogue_cells(index, s->long_run), 1, &run->err);
    if (status == TC_OK)
        status = hard_table_begin(run->table, &mesh, &run->err);
    if (status == TC_OK) {
        hard_result r = {.rays = 0};
        snprintf(r.mesh, sizeof r.mesh, "%s", name);
        hard_mesh_missing(what, sizeof what, &mesh);
        if (what[0]) {
            hard_fail(&r, "%s", what);
            report(run, &r, name);
            status = hard_table_add(run->table, &r, &run->err);
        }
        if (!mesh.mesh)
            hard_table_refuse(run->table);
    }
    if (mesh.judge)
        hard_judge_blind(mesh.judge, s->blind);
    for (size_t i = 0; i < n && status == TC_OK && mesh.mesh; i++) {
        hard_case_name(what, sizeof what, index, &c[i]);
        if (wanted(s, what))
            status = judge(run, &mesh, &c[i], what);
    }
    hard_mesh_close(&run->relative);
    hard_mesh_close(&mesh);
    if (s->long_run) { /* minutes: what it is at */
        const hard_row *t = hard_table_total(run->table);
        printf("%s: %s; %lld rays so far, %zu cases failed\n", s->context, name, (long long)t->sum.rays, t->failed);
        fflush(stdout);
    }
    return status;
}

/* Of all rays at most a share may be ill-posed. */
static bool too_many(const char *what, size_t ill, size_t n)
{
    if (ill <= 1 || (double)ill <= HARD_ILL_POSED * (double)n)
        return false;
    fprintf(stderr, "FAILED %zu of %zu %s are ill-posed, more than %g\n", ill, n, what, HARD_ILL_POSED);
    return true;
}

/* A whole run must hold what the catalogue promises. */
static bool too_few(const session *run)
{
    const settings *s = run->s;
    size_t used[3], rays = (size_t)hard_table_total(run->table)->sum.rays;
    const struct {
        const char *what;
        size_t least;
    } promised[] = {{"meshes", 60}, {"views", 20}, {"functions", 12}};
    bool bad = false;
    if (s->filter)
        return false;
    hard_table_used(used, run->table);
    printf("  %zu meshes, %zu views and %zu functions gave pictures\n", used[0], used[1], used[2]);
    for (size_t i = 0; i < sizeof promised / sizeof *promised; i++)
        if (used[i] < promised[i].least) {
            fprintf(stderr, "FAILED %zu %s gave pictures, fewer than %zu\n", used[i], promised[i].what,
                    promised[i].least);
            bad = true;
        }
    size_t least = s->long_run ? 100000000 : 2000000;
    if (s->bench.gpu && !s->small && rays < least) {
        fprintf(stderr, "FAILED %zu rays are fewer than %zu\n", rays, least);
        bad = true;
    }
    return bad;
}

static bool summarise(const session *run)
{
    const hard_row *t = hard_table_total(run->table);
    const hard_result *r = &t->sum;
    printf("%s: %zu cases, %lld rays, %lld lost; %zu rays by brute force, %zu with other cells, %zu with closed paths\n"
           "  worst: length %.1e, real length %.1e diagonals (%zu jump and lie between their sides'), %.1e from exact "
           "weights; picture %.1e of "
           "%zu pixels (%zu ill-posed); "
           "alpha %.1e of %zu (%zu ill-posed); the same picture %.1e of %zu pixels (%zu ill-posed)\n"
           "  %zu meshes or functions refused, %zu cases failed\n",
           run->s->context, t->cases, (long long)r->rays, (long long)r->lost, r->judged, r->wrong, r->cycles,
           r->length_error, r->real_error, r->jumps, r->walk_error, r->picture_error, r->pixels, r->ill_posed,
           r->alpha_error, r->chords, r->ill_chord, r->difference, r->compared, r->ill_compared, t->refused, t->failed);
    bool bad = r->lost > 0 || r->broken > 0;
    bad = too_many("pixels", r->ill_posed, r->pixels) || bad;
    bad = too_many("analytic chords", r->ill_chord, r->chords) || bad;
    bad = too_many("compared pixels", r->ill_compared, r->compared) || bad;
    bad = too_few(run) || bad;
    return t->cases > 0 && t->failed == 0 && !bad;
}

int main(int argc, char **argv)
{
    settings s;
    session run = {.s = &s, .program = argv[0]};
    if (!parse(&s, argc, argv) || (s.context && !backend_known(s.context))) {
        fprintf(stderr,
                "usage: %s --context osmesa|egl|reference [--driver pingpong|compute] [--long] [--filter TEXT] "
                "[--list] [--size N] [--judged N] "
                "[--verified N] [--blind CELL] [--json FILE] [--table FILE.md] [--write DIR] [--export DIR]\n",
                argv[0]);
        return 2;
    }
    int code = s.list ? 0 : backend_open(&s.bench.renderer, s.context);
    if (code != 0)
        return code;
    s.bench.context = s.context;
    s.bench.gpu = s.context && strcmp(s.context, "reference") != 0;
    tc_status status = hard_table_create(&run.table, s.context ? s.context : "", &run.err);
    if (!s.list && s.bench.gpu) {
        s.bench.exact = tc_gpu_renderer_context(s.bench.renderer->gpu)->software;
        const tc_renderer_options made = backend_options(s.context);
        const char *other = strcmp(made.driver, "compute") == 0 ? made.gl
                            : strcmp(made.gl, "egl") == 0       ? "osmesa"
                                                                : NULL;
        if (other && backend_open(&s.bench.other, other) != 0)
            s.bench.other = NULL;
    }
    for (size_t i = 0; i < hard_catalogue_meshes(s.long_run) && status == TC_OK; i++)
        status = s.export ? hard_export_mesh(s.export, i, s.filter, s.bench.renderer, &run.err) : judge_mesh(&run, i);
    bool good = status == TC_OK && (s.list || s.export || summarise(&run));
    if (status == TC_OK && s.table)
        status = hard_table_write_markdown(run.table, s.table, &run.err);
    if (status == TC_OK && s.json)
        status = hard_table_write_json(run.table, s.json, &run.err);
    if (status != TC_OK)
        fprintf(stderr, "%s\n", run.err.text);
    hard_table_destroy(&run.table);
    tc_renderer_destroy(&s.bench.renderer);
    tc_renderer_destroy(&s.bench.other);
    return good && status == TC_OK ? 0 : 1;
}
