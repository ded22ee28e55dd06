/* test_edit_columns.c: histograms as columns: nothing of their weight is lost or made, and it lies where its scalars
 * lie. */
#include "edit/columns.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

enum { BINS = 64 };

/* Weights that differ, over 1 to 9. */
static void fill(tc_histogram *out, double weight[BINS], bool log)
{
    *out = (tc_histogram){.n = BINS, .range = {1, 9}, .log = log, .weight = weight};
    for (int i = 0; i < BINS; i++) {
        weight[i] = 3 + (i * 37) % 11;
        out->total += weight[i];
        out->most = fmax(out->most, weight[i]);
    }
    out->counted = (uint64_t)out->total;
}

static tc_document *document_over(double lo, double hi, bool log)
{
    tc_document *document = NULL;
    tc_error err;
    const double range[2] = {lo, hi};
    assert_int_equal(tc_document_create(&document, range, &err), TC_OK);
    document->log = log;
    return document;
}

static double sum_of(const double *column, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += column[i];
    return sum;
}

static void no_weight_is_lost_or_made(void **state)
{
    (void)state;
    static const size_t counts[] = {1, 7, 64, 500, 3001};
    static const double ranges[][2] = {{1, 9}, {0.01, 40}, {0.999, 9.5}};
    for (int both = 0; both < 4; both++)
        for (size_t r = 0; r < sizeof ranges / sizeof *ranges; r++)
            for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
                double weight[BINS];
                tc_histogram histogram;
                fill(&histogram, weight, both & 1);
                tc_document *document = document_over(ranges[r][0], ranges[r][1], both & 2);
                double *column = malloc(counts[c] * sizeof *column);
                assert_non_null(column);
                const double most = tc_columns_count(column, counts[c], &histogram, document);
                assert_true(fabs(sum_of(column, counts[c]) - histogram.total) < 1e-9 * histogram.total);
                double largest = 0;
                for (size_t i = 0; i < counts[c]; i++)
                    largest = fmax(largest, column[i]);
                assert_true(most == largest);
                free(column);
                tc_document_destroy(&document);
            }
}

static void columns_that_are_bins_have_their_weights(void **state)
{
    (void)state;
    for (int log = 0; log < 2; log++) {
        double weight[BINS], column[BINS];
        tc_histogram histogram;
        fill(&histogram, weight, log);
        tc_document *document = document_over(1, 9, log);
        tc_columns_count(column, BINS, &histogram, document);
        for (int i = 0; i < BINS; i++)
            assert_true(fabs(column[i] - weight[i]) < 1e-9);
        tc_document_destroy(&document);
    }
}

/* A spike of one bin is found at its scalar, whatever range and scale it is looked at by. */
static void a_spike_lies_at_its_scalar(void **state)
{
    (void)state;
    static const double ranges[][2] = {{1, 9}, {2, 7}, {0.05, 100}};
    for (int log = 0; log < 2; log++)
        for (size_t r = 0; r < sizeof ranges / sizeof *ranges; r++) {
            double weight[BINS] = {0}, column[400];
            const int bin = 20;
            weight[bin] = 5;
            const tc_histogram histogram = {
                .n = BINS, .range = {1, 9}, .weight = weight, .most = 5, .total = 5, .counted = 5};
            tc_document *document = document_over(ranges[r][0], ranges[r][1], log);
            tc_columns_count(column, 400, &histogram, document);
            const double from = tc_document_place(document, 1 + bin / 8.0);
            const double to = tc_document_place(document, 1 + (bin + 1) / 8.0);
            for (int i = 0; i < 400; i++)
                assert_true((column[i] > 0) == ((i + 1) / 400.0 > from + 1e-12 && i / 400.0 < to - 1e-12));
            tc_document_destroy(&document);
        }
}

static void what_lies_beside_the_range_is_in_no_column(void **state)
{
    (void)state;
    double weight[BINS], column[10];
    tc_histogram histogram;
    fill(&histogram, weight, false);
    tc_document *document = document_over(20, 30, false);
    assert_true(tc_columns_count(column, 10, &histogram, document) == 0);
    assert_true(sum_of(column, 10) == 0);
    tc_document_destroy(&document);
}

static void heights_are_even_or_logarithmic_in_counts(void **state)
{
    (void)state;
    tc_histogram histogram = {.n = 1, .total = 0.5, .counted = 1000}; /* by volume: a value weighs 0.0005 on average */
    assert_true(fabs(tc_columns_height(&histogram, 0.1, 0.4, false) - 0.25) < 1e-15);
    assert_true(fabs(tc_columns_height(&histogram, 0.1, 0.4, true) - log1p(200) / log1p(800)) < 1e-12);
    assert_true(tc_columns_height(&histogram, 0.4, 0.4, true) == 1);
    assert_true(tc_columns_height(&histogram, 0, 0.4, true) == 0);
    assert_true(tc_columns_height(&histogram, 0, 0, false) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_weight_is_lost_or_made),
        cmocka_unit_test(columns_that_are_bins_have_their_weights),
        cmocka_unit_test(a_spike_lies_at_its_scalar),
        cmocka_unit_test(what_lies_beside_the_range_is_in_no_column),
        cmocka_unit_test(heights_are_even_or_logarithmic_in_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
