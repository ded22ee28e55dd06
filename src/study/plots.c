/* plots.c: what is plotted of each scene: error against time, error and time against table size, several rays a pixel,
 * and the 2003 paper's figures 7 and 8. */
#define _GNU_SOURCE
#include "study/study.h"

#include "core/file.h"
#include "core/memory.h"
#include "study/sheet.h"
#include "study/summary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FUNCTIONS = 8, MAX_POINTS = TC_STUDY_SETTINGS };
static const double HALF_STEP = 1.0 / 510, AIM = 1.0 / 2000; /* half an 8-bit step; what defaults aim at */
static const double FAR = 12;                                /* times the default's time: beyond the sheet */
static const double LEAST_ERROR = 1e-9;                      /* on a log axis */

/* The functions of one scene. */
typedef struct scene {
    const char *name;
    char title[3 * sizeof(((tc_study_row *)0)->scene)]; /* the name as gnuplot takes it */
    const tc_summary *summary;
    int n;
    const char *function[MAX_FUNCTIONS];
} scene;

static const tc_sum *find(const scene *s, const char *function, const char *setting)
{
    for (size_t i = 0; i < s->summary->n; i++) {
        const tc_study_row *r = &s->summary->sum[i].row;
        if (!strcmp(r->scene, s->name) && !strcmp(r->function, function) && !strcmp(r->setting, setting))
            return &s->summary->sum[i];
    }
    return NULL;
}

static bool has_time(const tc_sum *sum)
{
    return sum && isfinite(sum->row.ms_median) && sum->row.ms_median > 0 && isfinite(sum->row.max_error);
}

static tc_status save(tc_study *study, tc_sheet *sheet, const char *kind, const scene *s, tc_error *err)
{
    char stem[112];
    char *path = NULL;
    tc_text script = {0};
    snprintf(stem, sizeof stem, "%s-%s", kind, s->name);
    tc_sheet_end(&script, sheet, stem);
    tc_status status = script.failed ? tc_fail_memory(err, "a plot", script.length, 1) : TC_OK;
    if (status == TC_OK && study->n_plot < TC_STUDY_PLOTS) {
        snprintf(study->plot[study->n_plot], sizeof study->plot[0], "%s.gp", stem);
        status = tc_study_path(&path, study, study->plot[study->n_plot], err);
        if (status == TC_OK)
            status = tc_file_replace(path, script.text, script.length, err);
        study->n_plot += status == TC_OK;
    }
    free(path);
    tc_text_finish(&script);
    return status;
}

/* --------------------------------------------------------------------------------------------- error against time */

/* How a knob is drawn: a group of settings in one colour; in order of the table where they are joined by a line. */
typedef struct group {
    const char *prefix, *title; /* settings whose names begin so, or knob where knob is set */
    bool knob, line, label;
    int colour, point;
} group;

static const group groups[] = {
    {"table8-", "table of 8 bits, by size", false, true, false, 1, 6},
    {"table16f-", "table of half floats, by size", false, true, false, 6, 7},
    {"split", "integral split 0.05 to 1", true, true, false, 5, 9},
    {"stop", "opacity stop 0.99 to 1", true, true, false, 3, 13},
    {"pass", "steps per pass", true, true, false, 4, 11},
    {"lock", "z-updates", true, false, false, 7, 1},
    {"state", "state format", true, false, false, 7, 4},
    {"reentry", "re-entry", true, false, false, 7, 8},
    {"driver", "driver", true, false, false, 7, 12},
    {"integrator", "integrator", true, false, true, 2, 5},
    {"default", "default", true, false, true, 0, 7},
};
enum { N_GROUP = sizeof groups / sizeof *groups };

static bool in_group(const group *g, const tc_study_setting *setting)
{
    return g->knob ? !strcmp(setting->knob, g->prefix) : !strncmp(setting->name, g->prefix, strlen(g->prefix));
}

/* A sum that the sheet shows. */
static const tc_sum *shown(const scene *s, const char *function, const char *setting, double most_ms)
{
    const tc_sum *sum = find(s, function, setting);
    bool good = has_time(sum) && !strcmp(sum->row.truth, "ray") && sum->row.rays_lost <= 0 &&
                sum->row.max_error > LEAST_ERROR && sum->row.ms_median <= most_ms;
    return good ? sum : NULL;
}

static void fit_front(tc_axis *x, tc_axis *y, const scene *s, const char *function, double most_ms)
{
    size_t n, n_x = 0;
    const tc_study_setting *setting = tc_study_settings(&n);
    double time[MAX_POINTS], error[MAX_POINTS + 2];
    for (size_t k = 0; k < n; k++) {
        const tc_sum *sum = shown(s, function, setting[k].name, most_ms);
        if (!sum)
            continue;
        time[n_x] = sum->row.ms_median;
        error[n_x++] = sum->row.max_error;
    }
    tc_axis_fit(x, time, n_x);
    error[n_x] = HALF_STEP;
    error[n_x + 1] = AIM;
    tc_axis_fit(y, error, n_x + 2);
}

/* The steps of the front, from the fastest on: a point, then down below the next. */
static void plot_front(tc_text *data, const scene *s, const char *function, int panel, double most_ms, const tc_axis *x,
                       const tc_axis *y)
{
    size_t n, n_point = 0;
    const tc_study_setting *setting = tc_study_settings(&n);
    const tc_sum *point[MAX_POINTS];
    for (size_t k = 0; k < n; k++) {
        const tc_sum *sum = shown(s, function, setting[k].name, most_ms);
        if (!sum || !sum->front)
            continue;
        size_t at = n_point++;
        for (; at > 0 && point[at - 1]->row.ms_median > sum->row.ms_median; at--)
            point[at] = point[at - 1];
        point[at] = sum;
    }
    tc_text_add(data, "$front%d << EOD\n", panel);
    for (size_t i = 0; i < n_point; i++) {
        tc_text_add(data, "%.9g %.9g\n", point[i]->row.ms_median, i ? point[i - 1]->row.max_error : y->hi);
        tc_text_add(data, "%.9g %.9g\n", point[i]->row.ms_median, point[i]->row.max_error);
    }
    if (n_point)
        tc_text_add(data, "%.9g %.9g\n", x->hi, point[n_point - 1]->row.max_error);
    tc_text_add(data, "EOD\n");
}

static void label_front(tc_sheet *sheet, const scene *s, const char *function, double most_ms)
{
    size_t n;
    const tc_study_setting *setting = tc_study_settings(&n);
    for (size_t k = 0; k < n; k++) {
        const tc_sum *sum = shown(s, function, setting[k].name, most_ms);
        if (sum)
            tc_sheet_mark(sheet, sum->row.ms_median, sum->row.max_error);
    }
    for (int pass = 0; pass < 2; pass++) /* what is always named first, so that it gets the best places */
        for (size_t k = 0; k < n; k++) {
            const tc_sum *sum = shown(s, function, setting[k].name, most_ms);
            const group *g = groups;
            while (g < groups + N_GROUP && !in_group(g, &setting[k]))
                g++;
            if (!sum || g == groups + N_GROUP || g->label != (pass == 0) || (pass == 1 && !sum->front))
                continue;
            tc_sheet_label(sheet, sum->row.ms_median, sum->row.max_error, setting[k].name, tc_sheet_colour[g->colour]);
        }
}

static void plot_groups(tc_sheet *sheet, const scene *s, const char *function, int panel, double most_ms)
{
    size_t n;
    const tc_study_setting *setting = tc_study_settings(&n);
    tc_text_add(&sheet->body,
                "plot %.9g with lines lw 1.4 dt 2 lc rgb \"#606060\", %.9g with lines lw 1.4 dt 3 lc rgb \"#606060\", "
                "$front%d with lines lw 5 lc rgb \"#D8D8D8\"",
                HALF_STEP, AIM, panel);
    for (int g = 0; g < N_GROUP; g++) {
        int points = 0;
        tc_text_add(&sheet->data, "$group%d_%d << EOD\n", panel, g);
        for (size_t k = 0; k < n; k++) {
            const tc_sum *sum = in_group(&groups[g], &setting[k]) ? shown(s, function, setting[k].name, most_ms) : NULL;
            if (!sum)
                continue;
            tc_text_add(&sheet->data, "%.9g %.9g\n", sum->row.ms_median, sum->row.max_error);
            points++;
        }
        tc_text_add(&sheet->data, "EOD\n");
        if (points)
            tc_text_add(&sheet->body, ", $group%d_%d with %s lw 1.2 pt %d ps %g lc rgb \"%s\"", panel, g,
                        groups[g].line && points > 1 ? "linespoints" : "points", groups[g].point,
                        groups[g].knob && !strcmp(groups[g].prefix, "default") ? 1.7 : 1.1,
                        tc_sheet_colour[groups[g].colour]);
    }
    tc_text_add(&sheet->body, "\n");
}

static const tc_entry half_step = {"half an 8-bit step, 1/510", "#606060", 1.4, 2, 0};

static tc_status error_time(tc_study *study, const scene *s, tc_error *err)
{
    tc_sheet sheet;
    tc_entry legend[N_GROUP + 3];
    size_t n = 0;
    char title[300];
    snprintf(title, sizeof title, "%s: error against time (%dx%d pixels, %d view%s)", s->title, study->options.width,
             study->options.height, study->options.views, study->options.views == 1 ? "" : "s");
    tc_sheet_begin(&sheet, title, s->n, N_GROUP + 3);
    for (int f = 0; f < s->n; f++) {
        const tc_sum *standard = find(s, s->function[f], "default");
        double most_ms = has_time(standard) ? FAR * standard->row.ms_median : INFINITY;
        tc_axis x = {"frame time, median over views (ms)", 0, 0, true, NULL},
                y = {"largest error of a channel, over views", 0, 0, true, NULL};
        fit_front(&x, &y, s, s->function[f], most_ms);
        tc_sheet_panel(&sheet, s->function[f], &x, &y);
        plot_front(&sheet.data, s, s->function[f], f, most_ms, &x, &y);
        label_front(&sheet, s, s->function[f], most_ms);
        plot_groups(&sheet, s, s->function[f], f, most_ms);
    }
    for (int g = N_GROUP - 1; g >= 0; g--)
        legend[n++] = (tc_entry){groups[g].title, tc_sheet_colour[groups[g].colour], groups[g].line ? 1.4 : 0, 1,
                                 groups[g].point};
    legend[n++] = (tc_entry){"front: nothing is faster and errs less", "#D8D8D8", 5, 1, 0};
    legend[n++] = half_step;
    legend[n++] = (tc_entry){"1/2000", "#606060", 1.4, 3, 0};
    tc_sheet_legend(&sheet, legend, n);
    return save(study, &sheet, "error-time", s, err);
}

/* ----------------------------------------------------------------------------------------------------- table size */

static const int function_colour[MAX_FUNCTIONS] = {1, 2, 3, 4, 5, 6, 7, 0};

/* One line of the sheet: y over the number of entries, of tables in one format. */
static int table_data(tc_text *data, const scene *s, int f, const char *prefix, bool time)
{
    size_t n;
    int points = 0;
    const tc_study_setting *setting = tc_study_settings(&n);
    tc_text_add(data, "$%s%d_%d << EOD\n", time ? "time" : "error", f, prefix[5] == '8' ? 8 : 16);
    for (size_t k = 0; k < n; k++) {
        const int *size = tc_study_changes[k].table_size;
        const tc_sum *sum =
            strncmp(setting[k].name, prefix, strlen(prefix)) ? NULL : find(s, s->function[f], setting[k].name);
        if (!has_time(sum))
            continue;
        tc_text_add(data, "%.9g %.9g\n", (double)size[0] * size[1] * size[2],
                    time ? sum->row.ms_median : fmax(sum->row.max_error, LEAST_ERROR));
        points++;
    }
    tc_text_add(data, "EOD\n");
    return points;
}

static void table_panel(tc_sheet *sheet, const scene *s, bool time)
{
    static const char tics[] =
        "(\"32^2x32\" 32768, \"64^2x64\" 262144, \"128^2x64\" 1048576, \"128^2x128\" 2097152, "
        "\"128^2x256\" 4194304, \"256^2x128\" 8388608, \"512^2x128\" 33554432) rotate by 35 right "
        "font small";
    double value[MAX_FUNCTIONS * MAX_POINTS + 1];
    size_t n, n_value = 0;
    const tc_study_setting *setting = tc_study_settings(&n);
    for (int f = 0; f < s->n; f++)
        for (size_t k = 0; k < n; k++) {
            const tc_sum *sum =
                k == 0 || !strcmp(setting[k].knob, "table") ? find(s, s->function[f], setting[k].name) : NULL;
            if (has_time(sum))
                value[n_value++] = time ? sum->row.ms_median : fmax(sum->row.max_error, LEAST_ERROR);
        }
    if (!time)
        value[n_value++] = HALF_STEP;
    tc_axis x = {" ", 2e4, 5e7, true, tics},
            y = {time ? "frame time, median over views (ms)" : "largest error of a channel, over views", 0, 0, true,
                 NULL};
    tc_axis_fit(&y, value, n_value);
    tc_sheet_panel(sheet, time ? "time" : "error", &x, &y);
    tc_text_add(&sheet->body, "plot %s", time ? "NaN notitle" : "");
    if (!time)
        tc_text_add(&sheet->body, "%.9g with lines lw 1.4 dt 2 lc rgb \"#606060\"", HALF_STEP);
    for (int f = 0; f < s->n; f++) {
        const tc_sum *standard = find(s, s->function[f], "default");
        const char *colour = tc_sheet_colour[function_colour[f]];
        if (has_time(standard))
            tc_text_add(&sheet->body, ", %.9g with lines lw 1.4 dt 3 lc rgb \"%s\"",
                        time ? standard->row.ms_median : fmax(standard->row.max_error, LEAST_ERROR), colour);
        if (table_data(&sheet->data, s, f, "table8-", time))
            tc_text_add(&sheet->body, ", $%s%d_8 with linespoints lw 1.5 dt 4 pt 6 lc rgb \"%s\"",
                        time ? "time" : "error", f, colour);
        if (table_data(&sheet->data, s, f, "table16f-", time))
            tc_text_add(&sheet->body, ", $%s%d_16 with linespoints lw 1.5 pt 7 lc rgb \"%s\"", time ? "time" : "error",
                        f, colour);
    }
    tc_text_add(&sheet->body, "\n");
}

/* The scene's functions by their colours. */
static size_t function_entries(tc_entry *out, const scene *s, int point)
{
    for (int f = 0; f < s->n; f++)
        out[f] = (tc_entry){s->function[f], tc_sheet_colour[function_colour[f]], 2, 1, point};
    return (size_t)s->n;
}

static tc_status table_size(tc_study *study, const scene *s, tc_error *err)
{
    tc_sheet sheet;
    tc_entry legend[MAX_FUNCTIONS + 4];
    char title[300];
    snprintf(title, sizeof title, "%s: table size (front scalar x back scalar x length)", s->title);
    tc_sheet_begin(&sheet, title, 2, (size_t)s->n + 4);
    table_panel(&sheet, s, false);
    table_panel(&sheet, s, true);
    size_t n = function_entries(legend, s, 0);
    legend[n++] = (tc_entry){"8 bits", "#404040", 1.5, 4, 6};
    legend[n++] = (tc_entry){"half floats", "#404040", 1.5, 1, 7};
    legend[n++] = (tc_entry){"default, without a table", "#404040", 1.4, 3, 0};
    legend[n++] = half_step;
    tc_sheet_legend(&sheet, legend, n);
    return save(study, &sheet, "table-size", s, err);
}

/* ---------------------------------------------------------------------------------------------------- rays a pixel */

static tc_status samples(tc_study *study, const scene *s, tc_error *err)
{
    static const char *const setting[] = {"samples-1", "samples-4", "samples-16", "samples-adaptive"};
    tc_sheet sheet;
    tc_text plot = {0};
    tc_entry legend[MAX_FUNCTIONS];
    char title[300];
    double time[4 * MAX_FUNCTIONS], error[4 * MAX_FUNCTIONS];
    size_t n = 0;
    tc_axis x = {"frame time, median over views (ms)", 0, 0, true, NULL},
            y = {"mean error of a channel against the mean over the pixel's area", 0, 0, true, NULL};
    for (int f = 0; f < s->n; f++)
        for (int k = 0; k < 4; k++) {
            const tc_sum *sum = find(s, s->function[f], setting[k]);
            if (!has_time(sum))
                continue;
            time[n] = sum->row.ms_median;
            error[n++] = fmax(sum->row.mean_error, LEAST_ERROR);
        }
    snprintf(title, sizeof title, "%s: rays a pixel", s->title);
    tc_axis_fit(&x, time, n);
    tc_axis_fit(&y, error, n);
    tc_sheet_begin(&sheet, title, 1, (size_t)s->n);
    tc_sheet_panel(&sheet, "", &x, &y);
    for (size_t i = 0; i < n; i++)
        tc_sheet_mark(&sheet, time[i], error[i]);
    for (int f = 0; f < s->n; f++) {
        const char *colour = tc_sheet_colour[function_colour[f]];
        tc_text_add(&sheet.data, "$line%d << EOD\n", f);
        for (int k = 0; k < 4; k++) {
            const tc_sum *sum = find(s, s->function[f], setting[k]);
            if (!has_time(sum))
                continue;
            double e = fmax(sum->row.mean_error, LEAST_ERROR);
            tc_text_add(&sheet.data, "%s%.9g %.9g\n", k == 3 ? "\n" : "", sum->row.ms_median, e);
            tc_sheet_label(&sheet, sum->row.ms_median, e, setting[k] + strlen("samples-"), colour);
        }
        tc_text_add(&sheet.data, "EOD\n");
        tc_text_add(&plot, "%s $line%d with linespoints lw 1.5 pt 7 lc rgb \"%s\"", f ? "," : "", f, colour);
    }
    tc_text_add(&sheet.body, "plot %s\n", plot.text ? plot.text : "NaN");
    tc_sheet_legend(&sheet, legend, function_entries(legend, s, 7));
    sheet.body.failed = sheet.body.failed || plot.failed;
    tc_text_finish(&plot);
    return save(study, &sheet, "samples", s, err);
}

/* ----------------------------------------------------------------------------------------------- figures 7 and 8 */

static tc_status rotation(tc_study *study, const scene *s, tc_error *err)
{
    tc_sheet sheet;
    tc_entry legend[MAX_FUNCTIONS];
    char title[300];
    snprintf(title, sizeof title, "%s: a full turn (after Weiler et al. 2003, figure 7; %dx%d)", s->title,
             study->options.width, study->options.height);
    double *value = tc_alloc(study->n_turn, sizeof *value);
    if (!value)
        return tc_fail_memory(err, "a plot", study->n_turn, sizeof *value);
    tc_sheet_begin(&sheet, title, 2, (size_t)s->n);
    for (int steps = 0; steps < 2; steps++) {
        size_t n = 0;
        tc_axis x = {"azimuth (degrees)", 0, 360, false, "60"},
                y = {steps ? "cell steps a frame (millions)" : "frame time (ms)", 0, 0, false, NULL};
        for (size_t i = 0; i < study->n_turn; i++)
            if (!strcmp(study->turn[i].scene, s->name))
                value[n++] = steps ? 1e-6 * (double)study->turn[i].steps : study->turn[i].ms;
        tc_axis_fit(&y, value, n);
        tc_sheet_panel(&sheet, steps ? "work" : "time", &x, &y);
        tc_text_add(&sheet.body, "plot NaN notitle");
        for (int f = 0; f < s->n; f++) {
            tc_text_add(&sheet.data, "$turn%d_%d << EOD\n", steps, f);
            double first = NAN;
            for (size_t i = 0; i < study->n_turn; i++) {
                const tc_turn *t = &study->turn[i];
                if (strcmp(t->scene, s->name) || strcmp(t->function, s->function[f]))
                    continue;
                double v = steps ? 1e-6 * (double)t->steps : t->ms;
                first = isnan(first) ? v : first;
                tc_text_add(&sheet.data, "%.9g %.9g\n", t->angle, v);
            }
            if (isfinite(first)) /* round */
                tc_text_add(&sheet.data, "360 %.9g\n", first);
            else
                tc_text_add(&sheet.data, "0 NaN\n");
            tc_text_add(&sheet.data, "EOD\n");
            tc_text_add(&sheet.body, ", $turn%d_%d with linespoints lw 1.5 pt 7 ps 0.5 lc rgb \"%s\"", steps, f,
                        tc_sheet_colour[function_colour[f]]);
        }
        tc_text_add(&sheet.body, "\n");
    }
    free(value);
    tc_sheet_legend(&sheet, legend, function_entries(legend, s, 0));
    return save(study, &sheet, "rotation", s, err);
}

static tc_status fragments(tc_study *study, const scene *s, tc_error *err)
{
    static const struct {
        const char *rule, *title;
        int colour;
        double width; /* curves that coincide are both seen */
    } curve[TC_FRAGMENT_CURVES] = {{"all", "without early z", 2, 2},
                                   {"locked", "early z", 6, 6},
                                   {"stopped", "early z and early ray termination", 1, 1.6}};
    tc_sheet sheet;
    tc_entry legend[TC_FRAGMENT_CURVES];
    char title[300];
    snprintf(title, sizeof title,
             "%s: fragments in each pass, one cell a pass (after Weiler et al. 2003, figure 8; %dx%d)", s->title,
             study->options.width, study->options.height);
    tc_sheet_begin(&sheet, title, s->n, TC_FRAGMENT_CURVES);
    for (int f = 0; f < s->n; f++) {
        double most = 0, passes = 0;
        tc_axis x = {"pass", 0, 0, false, NULL}, y = {"fragments (thousands)", 0, 0, false, NULL};
        for (int k = 0; k < TC_FRAGMENT_CURVES; k++) {
            tc_text_add(&sheet.data, "$curve%d_%d << EOD\n", f, k);
            size_t shown_n = 0;
            for (size_t i = 0; i < study->n_curve; i++) {
                const tc_curve *c = &study->curve[i];
                if (strcmp(c->scene, s->name) || strcmp(c->function, s->function[f]) || strcmp(c->rule, curve[k].rule))
                    continue;
                for (size_t p = 0; p < c->n; p++) {
                    tc_text_add(&sheet.data, "%zu %.9g\n", p + 1, 1e-3 * (double)c->fragments[p]);
                    most = fmax(most, 1e-3 * (double)c->fragments[p]);
                }
                passes = fmax(passes, (double)c->n);
                shown_n += c->n;
            }
            tc_text_add(&sheet.data, "%sEOD\n", shown_n ? "" : "0 NaN\n");
        }
        tc_axis_fit(&x, &passes, 1);
        tc_axis_fit(&y, &most, 1);
        tc_sheet_panel(&sheet, s->function[f], &x, &y);
        for (int k = 0; k < TC_FRAGMENT_CURVES; k++)
            tc_text_add(&sheet.body, "%s $curve%d_%d with lines lw %g lc rgb \"%s\"", k ? "," : "plot", f, k,
                        curve[k].width, tc_sheet_colour[curve[k].colour]);
        tc_text_add(&sheet.body, "\n");
    }
    for (int k = 0; k < TC_FRAGMENT_CURVES; k++)
        legend[k] = (tc_entry){curve[k].title, tc_sheet_colour[curve[k].colour], curve[k].width, 1, 0};
    tc_sheet_legend(&sheet, legend, TC_FRAGMENT_CURVES);
    return save(study, &sheet, "fragments", s, err);
}

/* ------------------------------------------------------------------------------------------------------------ all */

static bool is_new(const scene *s, const char *function)
{
    for (int f = 0; f < s->n; f++)
        if (!strcmp(s->function[f], function))
            return false;
    return s->n < MAX_FUNCTIONS;
}

static bool has_knob(const scene *s, const char *knob)
{
    for (size_t i = 0; i < s->summary->n; i++)
        if (!strcmp(s->summary->sum[i].row.scene, s->name) && !strcmp(s->summary->sum[i].row.knob, knob) &&
            has_time(&s->summary->sum[i]))
            return true;
    return false;
}

tc_status tc_study_plots(tc_study *study, const struct tc_summary *summary, tc_error *err)
{
    tc_status status = TC_OK;
    study->n_plot = 0;
    for (size_t i = 0; i < summary->n && status == TC_OK; i++) {
        scene s = {.name = summary->sum[i].row.scene, .summary = summary};
        bool seen = false, turned = false, curved = false;
        for (size_t j = 0; j < i && !seen; j++)
            seen = !strcmp(summary->sum[j].row.scene, s.name);
        if (seen)
            continue;
        char *to = s.title;
        for (const char *from = s.name; *from; from++) { /* an underscore would lower what follows */
            if (*from == '_')
                *to++ = '\\', *to++ = '\\';
            *to++ = *from;
        }
        for (size_t j = i; j < summary->n; j++)
            if (!strcmp(summary->sum[j].row.scene, s.name) && is_new(&s, summary->sum[j].row.function))
                s.function[s.n++] = summary->sum[j].row.function;
        for (size_t j = 0; j < study->n_turn; j++)
            turned = turned || !strcmp(study->turn[j].scene, s.name);
        for (size_t j = 0; j < study->n_curve; j++)
            curved = curved || !strcmp(study->curve[j].scene, s.name);
        status = error_time(study, &s, err);
        if (status == TC_OK && has_knob(&s, "table"))
            status = table_size(study, &s, err);
        if (status == TC_OK && has_knob(&s, "samples"))
            status = samples(study, &s, err);
        if (status == TC_OK && turned)
            status = rotation(study, &s, err);
        if (status == TC_OK && curved)
            status = fragments(study, &s, err);
    }
    return status;
}
