/* fuzz.h: what the fuzz targets share: cutting the input into numbers, and a check that ends the run. */
#ifndef TC_TESTS_FUZZ_H
#define TC_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif
/* libFuzzer calls this with one input; gives 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerInitialize(int *argc, char ***argv);
#ifdef __cplusplus
}
#endif

/* A promise of the code under test. */
#define TC_FUZZ_CHECK(condition)                                                                                       \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "%s:%d: broken promise: %s\n", __FILE__, __LINE__, #condition);                            \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)

/* What is left of the input. Past its end everything is 0. */
typedef struct tc_fuzz_input {
    const uint8_t *data;
    size_t n;
} tc_fuzz_input;

static inline void tc_fuzz_take(void *out, tc_fuzz_input *in, size_t bytes)
{
    size_t n = bytes < in->n ? bytes : in->n;
    memset(out, 0, bytes);
    if (n > 0)
        memcpy(out, in->data, n);
    in->data += n;
    in->n -= n;
}

static inline uint8_t tc_fuzz_u8(tc_fuzz_input *in)
{
    uint8_t v;
    tc_fuzz_take(&v, in, sizeof v);
    return v;
}

static inline uint16_t tc_fuzz_u16(tc_fuzz_input *in)
{
    uint16_t v;
    tc_fuzz_take(&v, in, sizeof v);
    return v;
}

/* Mostly small whole numbers, which make ties; behind a mark any double there is, NaN and Inf too. */
static inline double tc_fuzz_real(tc_fuzz_input *in)
{
    uint8_t b = tc_fuzz_u8(in);
    double v;
    if (b < 240)
        return (double)(b % 16) - 4 + (b >= 192 ? 1.0 / 3 : 0);
    tc_fuzz_take(&v, in, sizeof v);
    return v;
}

/* The input up to `stop` as a string of its own (free it); the input goes on behind it. */
static inline char *tc_fuzz_text(tc_fuzz_input *in, int stop)
{
    const uint8_t *end = in->n > 0 ? (const uint8_t *)memchr(in->data, stop, in->n) : NULL;
    size_t n = end ? (size_t)(end - in->data) : in->n;
    char *text = (char *)malloc(n + 1);
    if (!text)
        abort();
    if (n > 0)
        memcpy(text, in->data, n);
    text[n] = 0;
    in->data += n + (end ? 1 : 0);
    in->n -= n + (end ? 1 : 0);
    return text;
}

#endif
