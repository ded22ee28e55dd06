/* plan.c: frames and their order, ranges of steps, and shards. */
#include "cli/batch/plan.h"

#include <errno.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TC_WHY = 64 };

/* The whole number in text [length]; false: it is none. */
static bool tc_number_parse(long long *out, const char *text, size_t length)
{
    char part[24], *end;
    if (length == 0 || length >= sizeof part)
        return false;
    memcpy(part, text, length);
    part[length] = 0;
    if (strspn(part, "-0123456789") != length || strchr(part + 1, '-'))
        return false;
    errno = 0;
    *out = strtoll(part, &end, 10);
    return end == part + length && !errno;
}

/* A range in text [length]. */
static bool tc_range_parse(tc_plan_range *out, const char *text, size_t length, char *why)
{
    const char *part[3] = {text};
    size_t size[3] = {0}, n = 1;
    for (const char *at = text; at < text + length; at++) {
        if (*at != ':') {
            size[n - 1]++;
            continue;
        }
        if (n == 3)
            return false;
        part[n++] = at + 1;
    }
    *out = (tc_plan_range){.has_from = size[0] > 0, .has_to = n > 1 && size[1] > 0, .one = n == 1, .stride = 1};
    if ((n == 1 && !out->has_from) || (out->has_from && !tc_number_parse(&out->from, part[0], size[0])) ||
        (out->has_to && !tc_number_parse(&out->to, part[1], size[1])) ||
        (n == 3 && !tc_number_parse(&out->stride, part[2], size[2])))
        return false;
    if (out->stride < 1)
        snprintf(why, TC_WHY, "a stride of 1 or more");
    return out->stride >= 1;
}

bool tc_plan_ranges_parse(void *field, const char *text, char *why)
{
    tc_plan_ranges ranges = {0};
    for (const char *at = text;; at++) {
        const size_t length = strcspn(at, ",");
        if (ranges.n == TC_PLAN_RANGES) {
            snprintf(why, TC_WHY, "at most %d ranges", TC_PLAN_RANGES);
            return false;
        }
        if (!tc_range_parse(&ranges.range[ranges.n++], at, length, why))
            return false;
        at += length;
        if (!*at)
            break;
    }
    *(tc_plan_ranges *)field = ranges;
    return true;
}

bool tc_plan_shard_parse(void *field, const char *text, char *why)
{
    const char *slash = strchr(text, '/');
    long long index, of;
    if (!slash || !tc_number_parse(&index, text, (size_t)(slash - text)) ||
        !tc_number_parse(&of, slash + 1, strlen(slash + 1)))
        return false;
    if (index < 1 && of > 0)
        snprintf(why, TC_WHY, "shards count from 1, as in 1/%lld", of);
    else if (of < 1 || of > TC_PLAN_SHARDS_MOST)
        snprintf(why, TC_WHY, "1 to %d shards", TC_PLAN_SHARDS_MOST);
    else if (index > of)
        snprintf(why, TC_WHY, "of %lld shards the last is %lld/%lld", of, of, of);
    else
        *(tc_plan_shard *)field = (tc_plan_shard){(int)index, (int)of};
    return index >= 1 && of >= 1 && of <= TC_PLAN_SHARDS_MOST && index <= of;
}

/* --------------------------------------------------------------------------------------------------------- steps */

/* Marks a range's steps in taken [n]. */
static bool tc_range_mark(bool *taken, long long n, bool timeless, const tc_plan_range *range, char *why,
                          size_t capacity)
{
    long long from = range->has_from ? range->from : 0, to = range->one      ? range->from
                                                             : range->has_to ? range->to
                                                                             : n - 1;
    const long long asked[2] = {from, to};
    from += from < 0 ? n : 0;
    to += to < 0 ? n : 0;
    if (!range->one && to >= n)
        to = n - 1;
    const bool first = from < 0 || from >= n;
    if (first || to < 0) {
        if (timeless)
            snprintf(why, capacity, "has no time steps, so there is no step %lld", asked[first ? 0 : 1]);
        else
            snprintf(why, capacity, "has %lld time steps (0 to %lld), so there is no step %lld", n, n - 1,
                     asked[first ? 0 : 1]);
        return false;
    }
    if (from > to) {
        snprintf(why, capacity, "has no steps from %lld to %lld: the first lies behind the last", asked[0], asked[1]);
        return false;
    }
    for (long long i = from; i <= to; i = range->stride > to - i ? n : i + range->stride)
        taken[i] = true;
    return true;
}

static bool tc_steps_take(tc_plan *out, const tc_plan_options *options, char *why, size_t capacity)
{
    const size_t n = options->n_time > 0 ? options->n_time : 1;
    if (n > INT_MAX) {
        snprintf(why, capacity, "has more than %d time steps", INT_MAX);
        return false;
    }
    bool *taken = calloc(n, sizeof *taken);
    bool good = taken != NULL;
    const size_t n_range = options->ranges ? options->ranges->n : 0;
    for (size_t i = 0; i < n_range && good; i++)
        good = tc_range_mark(taken, (long long)n, options->n_time == 0, &options->ranges->range[i], why, capacity);
    if (taken && n_range == 0)
        memset(taken, true, n);
    for (size_t i = 0; i < n && good; i++)
        out->n_step += taken[i];
    out->step = good ? malloc(out->n_step * sizeof *out->step) : NULL;
    if (good && out->step)
        for (size_t i = 0, k = 0; i < n; i++)
            if (taken[i])
                out->step[k++] = (int)i;
    if (!taken || (good && !out->step))
        snprintf(why, capacity, "needs more memory than there is for the list of its %zu steps", n);
    free(taken);
    return out->step != NULL;
}

bool tc_plan_make(tc_plan *out, const tc_plan_options *options, char *why, size_t capacity_why)
{
    *out = (tc_plan){.n_field = options->n_field,
                     .n_function = options->n_function,
                     .n_view = options->along ? 1 : options->n_view,
                     .along = options->along,
                     .shard = options->shard.of > 0 ? options->shard : (tc_plan_shard){1, 1}};
    if (out->n_field == 0 || out->n_function == 0 || out->n_view == 0) {
        snprintf(why, capacity_why, "has no frames: there must be a field, a function and a view");
        return false;
    }
    if (!tc_steps_take(out, options, why, capacity_why))
        return false;
    unsigned long long n = out->n_step;
    const size_t factor[] = {out->n_field, out->n_function, out->n_view};
    for (int i = 0; i < 3; i++) {
        if (factor[i] > TC_PLAN_FRAMES_MOST / n) {
            snprintf(why, capacity_why, "has more than %llu frames: take fewer steps, fields, functions or views",
                     TC_PLAN_FRAMES_MOST);
            return false;
        }
        n *= factor[i];
    }
    out->n = (size_t)n;
    out->n_of_step = (size_t)(n / out->n_step);
    return true;
}

void tc_plan_finish(tc_plan *plan)
{
    free(plan->step);
    *plan = (tc_plan){0};
}

/* -------------------------------------------------------------------------------------------------------- frames */

tc_plan_frame tc_plan_frame_at(const tc_plan *plan, size_t frame)
{
    tc_plan_frame out;
    out.view = frame % plan->n_view;
    frame /= plan->n_view;
    out.function = frame % plan->n_function;
    frame /= plan->n_function;
    out.field = frame % plan->n_field;
    out.position = frame / plan->n_field;
    out.step = plan->step[out.position];
    if (plan->along)
        out.view = out.position;
    return out;
}

size_t tc_plan_frame_of(const tc_plan *plan, const tc_plan_frame *place)
{
    const size_t view = plan->along ? 0 : place->view;
    return ((place->position * plan->n_field + place->field) * plan->n_function + place->function) * plan->n_view +
           view;
}

tc_plan_span tc_plan_span_of(const tc_plan *plan, size_t position)
{
    const size_t shard = (size_t)plan->shard.index - 1, of = (size_t)plan->shard.of, first = position * plan->n_of_step;
    if (plan->n_step >= of)
        return (tc_plan_span){first, position % of == shard ? plan->n_of_step : 0};
    if (shard % plan->n_step != position)
        return (tc_plan_span){first, 0};
    /* The shards position, position + n_step, position + 2 n_step … share the step. */
    const size_t share = shard / plan->n_step, shares = (of - position - 1) / plan->n_step + 1;
    const uint64_t from = (uint64_t)plan->n_of_step * share / shares;
    const uint64_t to = (uint64_t)plan->n_of_step * (share + 1) / shares;
    return (tc_plan_span){first + (size_t)from, (size_t)(to - from)};
}

bool tc_plan_mine(const tc_plan *plan, size_t frame)
{
    const tc_plan_span span = tc_plan_span_of(plan, frame / plan->n_of_step);
    return frame >= span.first && frame - span.first < span.n;
}

size_t tc_plan_n_mine(const tc_plan *plan)
{
    size_t n = 0;
    for (size_t i = 0; i < plan->n_step; i++)
        n += tc_plan_span_of(plan, i).n;
    return n;
}
