/* columns.c: see columns.h. */
#include "edit/columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Weight of all that lies below a scalar, values spread evenly in their bins. */
static double tc_weight_below(const tc_histogram *h, const double *sum, double scalar)
{
    double at;
    if (h->log)
        at = scalar > 0 ? (log(scalar) - log(h->range[0])) / (log(h->range[1]) - log(h->range[0])) : -1;
    else
        at = (scalar - h->range[0]) / (h->range[1] - h->range[0]);
    at *= h->n;
    if (!(at > 0))
        return 0;
    if (at >= h->n)
        return sum[h->n];
    const int bin = (int)at;
    return sum[bin] + (at - bin) * h->weight[bin];
}

double tc_columns_count(double *out, size_t n, const tc_histogram *histogram, const tc_document *document)
{
    memset(out, 0, n * sizeof *out);
    double *sum = malloc(((size_t)histogram->n + 1) * sizeof *sum);
    if (!sum || n == 0) {
        free(sum);
        return 0;
    }
    sum[0] = 0;
    for (int i = 0; i < histogram->n; i++)
        sum[i + 1] = sum[i] + histogram->weight[i];
    double most = 0, before = tc_weight_below(histogram, sum, tc_document_scalar(document, 0));
    for (size_t i = 0; i < n; i++) {
        const double place = (double)(i + 1) / (double)n;
        const double after = tc_weight_below(histogram, sum, tc_document_scalar(document, place));
        out[i] = fmax(after - before, 0);
        most = fmax(most, out[i]);
        before = after;
    }
    free(sum);
    return most;
}

double tc_columns_height(const tc_histogram *histogram, double weight, double most, bool log)
{
    if (!(most > 0) || !(weight > 0))
        return 0;
    if (!log)
        return weight / most;
    /* In counts, whatever the weights are. */
    const double count = histogram->total > 0 ? (double)histogram->counted / histogram->total : 1;
    return log1p(weight * count) / log1p(most * count);
}
